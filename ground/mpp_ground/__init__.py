"""Ground station of the MPP vehicle."""
