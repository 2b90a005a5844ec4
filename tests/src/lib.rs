//! Cross-crate tests, which stand in `tests/`. The library holds the golden flights and the hostile
//! frames, and compiles the README's example.

pub mod fuzz;
pub mod golden;

#[doc = include_str!("../../README.md")]
#[cfg(doctest)]
pub struct Readme;
