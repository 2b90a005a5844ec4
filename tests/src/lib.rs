//! Cross-crate tests; they stand in `tests/`. The library only compiles the README's example.

#[doc = include_str!("../../README.md")]
#[cfg(doctest)]
pub struct Readme;
