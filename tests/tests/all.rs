//! Tests of several crates together, in one binary: each of several would be linked alone.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod aircraft;
mod book;
mod conditions;
mod documents;
mod fault_pairs;
mod flights;
mod flyable;
mod fuzz;
mod golden;
mod ground;
mod hostile_logs;
mod link;
mod packages;
mod qp_against_clarabel;
mod recorded;
mod safety;
mod structure;
mod tasks;
