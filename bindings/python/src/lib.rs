//! The native half of the Python package `mppflight`. `python/mppflight/__init__.py` is what people import;
//! `docs/python.md` describes it.
//!
//! ```text
//! errors          exceptions for the errors of core and simulation
//! input, typed, output   Python values to numbers and to the types of files, and back
//! aside           long work on a thread of its own, while Python runs on
//! aircraft, field, lidar, scenario    what a flight is made of
//! flight, campaign                    whole flights
//! episode                             a flight without a core
//! batch, choice                       episodes for learning: control, and choice among candidates
//! core, planner, world                core and world for a loop of the caller's own
//! ```
//!
//! A class is frozen, and a lock guards what changes: a second thread gets an exception at once.

mod aircraft;
mod aside;
mod batch;
mod campaign;
mod choice;
mod core;
mod episode;
mod errors;
mod field;
mod flight;
mod input;
mod lidar;
mod look;
mod output;
mod planner;
mod scenario;
mod typed;
mod world;

/// The module `mppflight._native`.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "Python's name")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
    #[pymodule_export]
    use super::{
        aircraft::Aircraft, batch::Batch, batch::SavedFlight, campaign::Campaign, campaign::wilson,
        choice::Choice, choice::Fork, core::Core, field::Field, flight::Flight, flight::fly,
        lidar::Lidar, planner::Planner, world::World,
    };
}
