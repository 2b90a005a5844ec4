//! Integration tests of the simulation, in one binary: each of several would be linked alone.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod again;
mod bank;
mod baselines;
mod common;
mod faults;
mod forest;
mod loops;
mod open;
mod orders;
mod own_world;
mod space;
mod space_air;
mod space_estimate;
mod terrain;
