//! Integration tests of the link, in one binary: each of several would be linked alone.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod decoder;
mod display;
mod frozen_bytes;
mod mavlink;
mod sizes;
mod support;
