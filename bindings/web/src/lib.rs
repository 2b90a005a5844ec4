//! Flights in the browser.
//!
//! A module has one door: a question as JSON goes in, an answer as JSON comes out. Both are bytes in
//! the module's memory.
//!
//! ```text
//! at = question(length)     room for a question of so many bytes; write them to `at`
//! length = ask()            answers it
//! at = answer()             where the answer stands until the next question
//! ```
//!
//! [`desk::Question`] lists the questions of the module `plane`, [`space::Question`] those of `space`: each page has its own, because
//! both would be too large. A module needs one function, `env.clock`: any clock in
//! milliseconds. It measures the planner's cycles; nothing that is flown depends on it.

pub mod desk;
pub mod space;
