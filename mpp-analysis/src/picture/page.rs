//! The page, and its data.

/// The page, with places for its data.
const PAGE: &str = concat!(
    include_str!("page_head.html"),
    include_str!("page.css"),
    include_str!("page_body.html"),
    include_str!("draw.js"),
    include_str!("page.js"),
    "</script>\n</html>\n"
);
/// The place of the data in the page. The page gets its data here, or null for a live flight.
const DATA: &str = "/*DATA*/null";
/// Where the page of a live flight takes its token from.
const TOKEN: &str = "/*TOKEN*/";

/// Returns the page with its data, which is a JSON text. With `null` the page shows a live flight.
#[must_use]
pub fn page(data: &str) -> String {
    // Inside a script, `</` would end the script. JSON can write the same text without it.
    PAGE.replacen(DATA, &data.replace("</", "<\\/"), 1)
}

/// The page of a live flight, which may change its pace with this token, a text of digits and letters.
#[must_use]
pub fn live_page(token: &str) -> String {
    PAGE.replacen(TOKEN, token, 1)
}
