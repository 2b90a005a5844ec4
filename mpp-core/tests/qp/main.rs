//! Tests properties of the program's solver: optimality, invariances, ends.
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod brute_force;
mod certificates;
mod conditions;
mod degenerate;
mod dense;
#[path = "../common/draw.rs"]
mod draw;
mod ends;
mod invariances;
mod optimality;
mod programs;
mod small_programs;
mod symmetries;
mod varying;
