//! Benchmarks. They compare our parts with others on the same work, in one run and on one thread.

mod error;
mod full_form;
mod generate;
mod percentile;
mod planning_time;
mod qp;

pub use error::QpBenchError;
pub use full_form::{Form, FullForm};
pub use generate::generate;
pub use planning_time::{CycleBench, CycleReport, PresetReport, Ratio, Times, run_cycle};
pub use qp::{QpReport, SolverReport, run_qp};
