//! Benchmarks. They compare our parts with others on the same work, in one run and on one thread.
//! The one beside Clarabel needs the cargo feature `clarabel`.

#[cfg(feature = "clarabel")]
mod error;
#[cfg(feature = "clarabel")]
mod full_form;
mod generate;
mod percentile;
mod planning_time;
#[cfg(feature = "clarabel")]
mod qp;

#[cfg(feature = "clarabel")]
pub use error::QpBenchError;
#[cfg(feature = "clarabel")]
pub use full_form::{Form, FullForm};
pub use generate::{DENSE, SPARSE, generate};
pub use planning_time::{CycleBench, CycleReport, PresetReport, Ratio, Times, run_cycle};
#[cfg(feature = "clarabel")]
pub use qp::{QpReport, SolverReport, run_qp};
