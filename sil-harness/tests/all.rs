//! Integration tests of the harness, in one binary: each of several would be linked alone.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod cli;
mod common;
mod fields;
mod robustness;
