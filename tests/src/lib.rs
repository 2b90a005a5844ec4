//! Cross-crate tests, which stand in `tests/`. The library holds the golden flights, and compiles
//! the README's example.

pub mod golden;

#[doc = include_str!("../../README.md")]
#[cfg(doctest)]
pub struct Readme;
