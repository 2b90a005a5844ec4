//! Flights as pages for a browser: one that holds a whole flight, and one that shows it live.
//!
//! Both are the same page. It holds all that it needs and asks nobody else for anything.

pub mod detail;
pub mod live;
pub mod replay;

/// The page, with places for its data.
const PAGE: &str = include_str!("picture/page.html");
/// Where the page takes its data from: the data itself, or null for a live flight.
const DATA: &str = "/*DATA*/null";

/// The page with its data in it.
fn page(data: &str) -> String {
    // Inside of a script, `</` would end it; JSON writes the same without that.
    PAGE.replacen(DATA, &data.replace("</", "<\\/"), 1)
}
