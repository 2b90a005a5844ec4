//! Integration tests of the C interface, in one binary: each of several would be linked alone.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod flying;
mod header;
