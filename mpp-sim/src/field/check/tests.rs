//! Tests of what is refused, and of the message.

use super::*;

fn refused(text: &str) -> String {
    FieldFile::parse("bad.toml", text).unwrap_err().to_string()
}

#[test]
fn a_file_without_an_obstacle_is_refused() {
    for text in ["", "# nothing\n", "circle = []"] {
        let error = refused(text);
        assert!(
            error.starts_with("field bad.toml holds no obstacle: give one, or leave"),
            "{error}"
        );
    }
}

/// Files in one line each, the key that is refused, and what is told.
const REFUSED: &str = "
[[circle]]; x = 1.0; z = 2.0 | `radius` | missing field
[[circle]]; x = nan; z = 2.0; radius = 1.0 | circle 1, x and z | give
[[circle]]; x = 1.0; z = 2.0; radius = -1.0 | circle 1, radius | give more than 0
[[circle]]; x = 1.0; z = 2.0; radius = inf | circle 1, radius | give more than 0
[[circle]]; x = 1.0; z = 2.0; radius = 1.0; velocity = [nan, 0.0] | circle 1, velocity | give at most
[[circle]]; x = 1.0; z = 2.0; radius = 1.0; colour = 1 | `colour` | unknown field
[[sphere]]; x = 1.0 | `sphere` | unknown field
[[capsule]]; from = [0.0, inf]; to = [1.0, 1.0]; radius = 1.0 | capsule 1, from and to | give numbers
[[capsule]]; from = [0.0, 1.0]; to = [1.0, 1.0]; radius = 0.0 | capsule 1, radius | give more than 0
[[polygon]]; points = [[0.0, 0.0], [1.0, 0.0]] | polygon 1, points | give 3 to
[[polygon]]; points = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]] | polygon 1, points | does not cut itself
[[polygon]]; points = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]] | polygon 1, points | does not cut itself
[[polygon]]; points = [[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0]] | polygon 1, points | leave one out
[[polyline]]; points = [[0.0, 0.0]]; thickness = 1.0 | polyline 1, points | at least 2
[[ground]]; points = [] | ground 1, points | at least 1
[[ground]]; points = [[1.0, 0.0], [1.0, 2.0]] | ground 1, points | farther downrange
[[ceiling]]; points = [[1.0, nan]] | ceiling 1, points | give numbers";

#[test]
fn a_bad_file_is_refused_by_file_and_key() {
    let many = format!(
        "[[polyline]]\nthickness = 1.0\npoints = [{}]",
        "[0.0, 0.0], ".repeat(MAX_VERTICES + 1)
    );
    let rows = REFUSED.lines().filter(|row| !row.is_empty()).map(|row| {
        let cells: Vec<_> = row.split(" | ").collect();
        let [file, key, hint] = cells.try_into().unwrap();
        (file.replace("; ", "\n"), key, hint)
    });
    for (text, key, hint) in rows.chain([(many, "all, points", "give at most 10000")]) {
        let error = refused(&text);
        assert!(error.starts_with("field bad.toml"), "{error}");
        assert!(error.contains(key) && error.contains(hint), "{error}");
    }
}

/// GeoJSON, WKT and shapely write rings so.
#[test]
fn the_last_corner_may_repeat_the_first() {
    let open =
        "[[polygon]]\npoints = [[30.0, 0.0], [40.0, 0.0], [30.0, 9.0]]\nvelocity = [1.0, 0.0]";
    let closed = open.replace("9.0]]", "9.0], [30.0, 0.0]]");
    let parsed = |text: &str| FieldFile::parse("ring.toml", text).unwrap();
    assert_eq!(parsed(&closed), parsed(open));
    assert_eq!(parsed(open).polygon[0].points.len(), 3);
    let few = refused("[[polygon]]\npoints = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]");
    assert!(few.contains("give 3 to"), "{few}");
}

#[test]
fn what_covers_the_start_is_refused() {
    let file = FieldFile::of(&[
        Obstacle::circle(30.0, 50.0, 1.0),
        Obstacle::at_rest(Shape::ground(&[(0.0, 49.5)])),
    ]);
    let start = (0.0, 50.0);
    assert!(file.check_start(start, 0.4).is_ok());
    let error = file.check_start(start, 0.6).unwrap_err().to_string();
    assert!(
        error.contains("ground 1") && error.contains("covers the start"),
        "{error}"
    );
}
