"""A ground station for the MPP vehicle."""
