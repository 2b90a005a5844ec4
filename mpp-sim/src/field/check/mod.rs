//! What a field file must keep to, and the message if it does not.

use super::file::FieldFile;
use super::geometry::{Point, between_segments, cross, edges, legs, minus};
use super::obstacle::Obstacle;
use super::shape::Shape;
use crate::toml_error::place_and_cause;

/// Greatest number of points that a field may have: corners, points of lines, centres. A lidar beam
/// looks at each of them.
pub const MAX_VERTICES: usize = 10_000;
/// Greatest number of corners of a polygon. Each pair of its edges is compared.
const MAX_CORNERS: usize = 1_000;
/// Greatest distance from the origin \[m\]: as far as the longest flight gets.
const MAX_COORDINATE: f64 = 1e5;
/// Greatest speed of an obstacle [m/s].
const MAX_SPEED: f64 = 1e3;

/// The reason why a text is no field.
#[derive(Debug, thiserror::Error)]
pub enum FieldError {
    /// The text with this name is no field; the message names line and key.
    #[error("field {0}{why}", why = place_and_cause(.1))]
    Toml(String, #[source] Box<toml::de::Error>),
    /// The file with this name holds no obstacle.
    #[error("field {0} holds no obstacle: give one, or leave the field out and give --obstacles 0")]
    Empty(String),
    /// The file has an obstacle that cannot be flown past.
    #[error("field{of}{name}, {key}: {advice}", of = if .name.is_empty() { "" } else { " " })]
    Obstacle {
        /// Name of the file; empty for a field that is part of something else.
        name: String,
        /// Kind and number of the obstacle, and its key.
        key: String,
        /// What to do.
        advice: String,
    },
}

impl FieldError {
    /// The same error in the file with this name.
    #[must_use]
    pub fn named(self, file: &str) -> Self {
        match self {
            Self::Obstacle { key, advice, .. } => Self::Obstacle {
                name: file.to_owned(),
                key,
                advice,
            },
            named @ (Self::Toml(..) | Self::Empty(_)) => named,
        }
    }
}

/// What is wrong: a key and what to do.
type Flaw = (&'static str, String);

impl FieldFile {
    /// Reads a field file from text. An error shows `name` as the name of the text.
    ///
    /// # Errors
    /// [`FieldError`].
    pub fn parse(name: &str, text: &str) -> Result<Self, FieldError> {
        let file: Self = toml::from_str(text)
            .map_err(|error| FieldError::Toml(name.to_owned(), Box::new(error)))?;
        // A scenario takes a field without obstacles for none, and would draw its own.
        if file.is_empty() {
            return Err(FieldError::Empty(name.to_owned()));
        }
        file.check().map_err(|error| error.named(name))?;
        Ok(file)
    }

    /// Whether every obstacle is sound.
    ///
    /// # Errors
    /// [`FieldError::Obstacle`] for the first one that is not.
    pub fn check(&self) -> Result<(), FieldError> {
        for (key, line) in [("ground", &self.ground), ("ceiling", &self.ceiling)] {
            for (number, line) in (1..).zip(line) {
                fail(&format!("{key} {number}"), flaw_of_line(&line.points))?;
            }
        }
        let named = self.named();
        let vertices: usize = named.iter().map(|(_, one)| one.shape.vertices()).sum();
        let many = (
            "points",
            format!("it has {vertices} points: give at most {MAX_VERTICES}"),
        );
        fail("all", (vertices > MAX_VERTICES).then_some(many))?;
        named
            .iter()
            .try_for_each(|(key, obstacle)| fail(key, flaw(obstacle)))
    }

    /// Whether a body of this radius \[m\] is clear of every obstacle at the start of a flight.
    ///
    /// # Errors
    /// [`FieldError::Obstacle`] for the first one in the way.
    pub fn check_start(&self, start: Point, body_radius: f64) -> Result<(), FieldError> {
        for (key, obstacle) in self.named() {
            let covers = obstacle.clearance(start, 0.0) <= body_radius;
            let advice = format!(
                "it covers the start ({} m, {} m) of a body of {body_radius} m: move it or make it smaller",
                start.0, start.1
            );
            fail(&key, covers.then_some(("place", advice)))?;
        }
        Ok(())
    }
}

fn fail(obstacle: &str, flaw: Option<Flaw>) -> Result<(), FieldError> {
    flaw.map_or(Ok(()), |(key, advice)| {
        Err(FieldError::Obstacle {
            name: String::new(),
            key: format!("{obstacle}, {key}"),
            advice,
        })
    })
}

fn flaw(obstacle: &Obstacle) -> Option<Flaw> {
    let (x, z) = obstacle.velocity;
    if !(x.abs() <= MAX_SPEED && z.abs() <= MAX_SPEED) {
        return Some(("velocity", format!("give at most {MAX_SPEED} m/s")));
    }
    let radius = |key: &'static str, value: f64| {
        let sound = value > 0.0 && value <= MAX_COORDINATE;
        let advice = format!("give more than 0 and at most {MAX_COORDINATE} m");
        (!sound).then_some((key, advice))
    };
    match &obstacle.shape {
        Shape::Circle { centre, radius: r } => {
            far("x and z", &[*centre]).or_else(|| radius("radius", *r))
        }
        Shape::Line { points, radius: r } if points.len() == 2 => {
            far("from and to", points).or_else(|| radius("radius or thickness", *r))
        }
        Shape::Line { points, radius: r } => {
            let few = points.len() < 2;
            let few = few.then(|| ("points", "give at least 2".to_owned()));
            few.or_else(|| far("points", points))
                .or_else(|| radius("thickness", *r))
        }
        Shape::Polygon { corners } => flaw_of_polygon(corners),
        // Their lines were checked.
        Shape::Ground(_) | Shape::Ceiling(_) => None,
    }
}

/// Points that are no numbers, or too far away.
fn far(key: &'static str, points: &[Point]) -> Option<Flaw> {
    let sound = |(x, z): &Point| x.abs() <= MAX_COORDINATE && z.abs() <= MAX_COORDINATE;
    let advice = format!("give numbers of at most {MAX_COORDINATE} m");
    (!points.iter().all(sound)).then_some((key, advice))
}

fn flaw_of_line(points: &[Point]) -> Option<Flaw> {
    if points.is_empty() {
        return Some(("points", "give at least 1".to_owned()));
    }
    let advice = "give each point farther downrange than the one before".to_owned();
    let falls = |[a, b]: [Point; 2]| a.0 >= b.0;
    far("points", points).or_else(|| legs(points).any(falls).then_some(("points", advice)))
}

fn flaw_of_polygon(corners: &[Point]) -> Option<Flaw> {
    let count = corners.len();
    if !(3..=MAX_CORNERS).contains(&count) {
        let advice = format!("it has {count} corners: give 3 to {MAX_CORNERS}");
        return Some(("points", advice));
    }
    if let Some(flaw) = far("points", corners) {
        return Some(flaw);
    }
    let edges: Vec<[Point; 2]> = edges(corners).collect();
    if let Some(corner) = edges.iter().position(|[a, b]| a == b) {
        let advice = format!("corner {} is the next one too: leave one out", corner + 1);
        return Some(("points", advice));
    }
    for first in 0..count {
        for second in first + 1..count {
            let neighbours = second == first + 1 || (first == 0 && second == count - 1);
            let (a, b) = (edges[first], edges[second]);
            let meet = if neighbours {
                // They share a corner; they must not lie upon each other.
                let (shared, one, other) = if second == first + 1 {
                    (a[1], a[0], b[1])
                } else {
                    (a[0], a[1], b[0])
                };
                folds_back(shared, one, other)
            } else {
                between_segments(a, b) <= 0.0
            };
            if meet {
                let advice = format!(
                    "edges {} and {} meet: give a polygon that does not cut itself",
                    first + 1,
                    second + 1
                );
                return Some(("points", advice));
            }
        }
    }
    None
}

/// Whether two edges from a shared corner leave it in the same direction.
fn folds_back(shared: Point, one: Point, other: Point) -> bool {
    let (a, b) = (minus(one, shared), minus(other, shared));
    cross(a, b) == 0.0 && a.0 * b.0 + a.1 * b.1 > 0.0
}

#[cfg(test)]
mod tests;
