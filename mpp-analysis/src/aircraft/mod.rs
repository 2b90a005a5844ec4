//! An aircraft file as an engineer wants to see it before the first flight: trim, modes, authority, what the
//! planner makes of it, and what is implausible.

mod doubts;
mod lateral;
mod lateral_doubts;
mod modes;
mod report;
mod variants;

pub use doubts::Doubt;
pub use lateral::{LateralModes, LateralReport, LevelTurn};
pub use modes::{Mode, Modes};
pub use report::AircraftReport;
pub use variants::{Variant, flown_cells, in_sizes, in_units};
