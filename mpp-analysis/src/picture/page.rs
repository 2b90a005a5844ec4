//! The page, and its data.

/// The page, with places for its data.
const PAGE: &str = concat!(
    include_str!("page_head.html"),
    include_str!("page.css"),
    include_str!("page_body.html"),
    include_str!("draw.js"),
    include_str!("plane.js"),
    include_str!("charts.js"),
    include_str!("strip.js"),
    include_str!("numbers.js"),
    include_str!("page.js"),
    "</script>\n</html>\n"
);
/// The page of a flight in space, with a place for its data.
const SPACE: &str = concat!(
    include_str!("page_head.html"),
    include_str!("page.css"),
    include_str!("space/space.css"),
    include_str!("space/body.html"),
    include_str!("draw.js"),
    include_str!("space/flight.js"),
    include_str!("space/camera.js"),
    include_str!("space/scene.js"),
    include_str!("space/maps.js"),
    include_str!("space/replay.js"),
    include_str!("charts.js"),
    include_str!("strip.js"),
    "</script>\n</html>\n"
);
/// The place of the data in the page. The page gets its data here, or null for a live flight.
const DATA: &str = "/*DATA*/null";
/// Where the page of a live flight takes its token from.
const TOKEN: &str = "/*TOKEN*/";

/// The page of flights: their JSON, through gzip, as text of 64 letters.
#[must_use]
pub(super) fn page(packed: &str) -> String {
    PAGE.replacen(DATA, &format!("\"{packed}\""), 1)
}

/// The page of a flight in space.
#[must_use]
pub(super) fn space_page(packed: &str) -> String {
    SPACE.replacen(DATA, &format!("\"{packed}\""), 1)
}

/// The page of a live flight, which may change its pace with this token, a text of digits and letters.
#[must_use]
pub fn live_page(token: &str) -> String {
    PAGE.replacen(TOKEN, token, 1)
}

#[cfg(test)]
mod tests {
    use super::PAGE;
    use mpp_sim::outcome::{ALTITUDE_BAND, FLIGHT_PATH_LIMIT, PITCH_LIMIT};
    use mpp_sim::scenario::ALTITUDE;

    #[test]
    fn the_page_draws_the_limits_that_flights_are_judged_by() {
        let (pitch, path) = (
            PITCH_LIMIT.to_degrees().round(),
            FLIGHT_PATH_LIMIT.to_degrees().round(),
        );
        let limits = format!(
            "pitch: {pitch}, flight_path: {path}, altitude: {ALTITUDE}, band: {ALTITUDE_BAND} }}"
        );
        assert!(PAGE.contains(&limits), "{limits}");
    }
}
