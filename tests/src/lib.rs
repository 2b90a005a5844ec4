//! Cross-crate tests, which stand in `tests/`. The library holds the golden flights and the hostile
//! frames, and compiles the example of docs/embed.md.

pub mod fuzz;
pub mod golden;
pub mod project;

#[doc = include_str!("../../docs/embed.md")]
#[cfg(doctest)]
pub struct Embed;
