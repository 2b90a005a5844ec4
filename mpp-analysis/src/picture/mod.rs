//! Flights as pages for a browser: one that holds a whole flight, and one that shows it live.
//!
//! Both are the same page. It holds all that it needs and loads nothing else.

mod page;
pub mod replay;

pub use page::{live_page, page};
