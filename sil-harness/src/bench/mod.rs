//! Benchmarks: our solver beside others on the same programs, in one run, on one thread.

mod full_form;
mod generate;
mod instance;
mod qp;

pub use full_form::{Form, FullForm};
pub use generate::{GenerateError, generate};
pub use instance::{Instance, InstanceError, read_instances, write_instances};
pub use qp::{QpReport, SolverReport, run_qp};
