//! Benchmarks: our parts beside others on the same work, in one run, on one thread.

mod cycle;
mod full_form;
mod generate;
mod instance;
mod qp;

pub use cycle::{CycleBench, CycleReport, run_cycle};
pub use full_form::{Form, FullForm};
pub use generate::generate;
pub use instance::{Instance, InstanceError, read_instances, write_instances};
pub use qp::{QpReport, SolverReport, run_qp};

/// Nearest-rank percentile of sorted values.
fn percentile<T: Copy>(sorted: &[T], percent: usize) -> Option<T> {
    let rank = (sorted.len() * percent).div_ceil(100).max(1);
    sorted.get(rank - 1).copied()
}
