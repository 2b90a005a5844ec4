//! Flights as pages for a browser: one that holds a whole flight or two, and one that shows a flight live.
//!
//! Both are the same page. It holds all that it needs and loads nothing else.

mod pack;
mod page;
pub mod replay;

pub use page::live_page;
