//! A field as text: TOML in a field file, JSON in the header of a log. `docs/fields.md` describes
//! every key.

use super::geometry::Point;
use super::obstacle::Obstacle;
use super::shape::Shape;
use serde::{Deserialize, Deserializer, Serialize};

/// The content of a field file, by kinds of obstacles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FieldFile {
    /// Circles.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub circle: Vec<Circle>,
    /// Capsules: everything within a radius of a segment.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub capsule: Vec<Capsule>,
    /// Simple polygons.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub polygon: Vec<Polygon>,
    /// Lines with a thickness.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub polyline: Vec<Polyline>,
    /// Lines below which everything is solid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ground: Vec<Line>,
    /// Lines above which everything is solid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ceiling: Vec<Line>,
}

/// A circle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Circle {
    /// Centre, downrange \[m\].
    pub x: f64,
    /// Centre, height \[m\].
    pub z: f64,
    /// Radius \[m\].
    pub radius: f64,
    /// Velocity, downrange and up [m/s]; not written if it is 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub velocity: Point,
}

/// Everything within a radius of a segment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capsule {
    /// One end of the segment \[m\].
    pub from: Point,
    /// Its other end \[m\].
    pub to: Point,
    /// Radius \[m\].
    pub radius: f64,
    /// Velocity, downrange and up [m/s]; not written if it is 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub velocity: Point,
}

/// A simple polygon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// Its corners, in either direction \[m\].
    #[serde(deserialize_with = "ring")]
    pub points: Vec<Point>,
    /// Velocity, downrange and up [m/s]; not written if it is 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub velocity: Point,
}

/// A line with a thickness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polyline {
    /// Its points \[m\].
    pub points: Vec<Point>,
    /// Its whole thickness \[m\]. Its ends and its bends are round.
    pub thickness: f64,
    /// Velocity, downrange and up [m/s]; not written if it is 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub velocity: Point,
}

/// The line of ground or ceiling. It goes on level beyond its ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Its points \[m\], each farther downrange than the one before. One point makes it level.
    pub points: Vec<Point>,
}

fn is_zero(velocity: &Point) -> bool {
    *velocity == (0.0, 0.0)
}

impl Polygon {
    /// A polygon at rest. Its last corner may repeat the first one, as in GeoJSON and WKT, and is left out then.
    #[must_use]
    pub fn of_ring(points: Vec<Point>) -> Self {
        Self {
            points: opened(points),
            velocity: (0.0, 0.0),
        }
    }
}

fn ring<'a, D: Deserializer<'a>>(input: D) -> Result<Vec<Point>, D::Error> {
    Vec::deserialize(input).map(opened)
}

fn opened(mut ring: Vec<Point>) -> Vec<Point> {
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    ring
}

impl FieldFile {
    /// The file of these obstacles. It sorts them by kind.
    #[must_use]
    pub fn of(obstacles: &[Obstacle]) -> Self {
        let mut file = Self::default();
        for obstacle in obstacles {
            file.add(obstacle);
        }
        file
    }

    fn add(&mut self, obstacle: &Obstacle) {
        let velocity = obstacle.velocity;
        match &obstacle.shape {
            &Shape::Circle {
                centre: (x, z),
                radius,
            } => self.circle.push(Circle {
                x,
                z,
                radius,
                velocity,
            }),
            Shape::Line { points, radius } => match points[..] {
                [from, to] => self.capsule.push(Capsule {
                    from,
                    to,
                    radius: *radius,
                    velocity,
                }),
                _ => self.polyline.push(Polyline {
                    points: points.clone(),
                    thickness: 2.0 * radius,
                    velocity,
                }),
            },
            Shape::Polygon { corners } => self.polygon.push(Polygon {
                points: corners.clone(),
                velocity,
            }),
            Shape::Ground(sheet) => self.ground.push(Line {
                points: sheet.line().to_vec(),
            }),
            Shape::Ceiling(sheet) => self.ceiling.push(Line {
                points: sheet.line().to_vec(),
            }),
        }
    }

    /// Its obstacles, by kind, each with its key: the kind and the number within it, from 1.
    pub(super) fn named(&self) -> Vec<(String, Obstacle)> {
        let circles = self.circle.iter().map(|one| Obstacle {
            velocity: one.velocity,
            ..Obstacle::circle(one.x, one.z, one.radius)
        });
        let line = |points: Vec<Point>, radius, velocity| Obstacle {
            shape: Shape::Line { points, radius },
            velocity,
        };
        let capsules = self.capsule.iter();
        let capsules = capsules.map(|one| line(vec![one.from, one.to], one.radius, one.velocity));
        let polygons = self.polygon.iter().map(|one| Obstacle {
            shape: Shape::Polygon {
                corners: one.points.clone(),
            },
            velocity: one.velocity,
        });
        let polylines = self.polyline.iter();
        let polylines =
            polylines.map(|one| line(one.points.clone(), 0.5 * one.thickness, one.velocity));
        let grounds = self.ground.iter();
        let grounds = grounds.map(|one| Obstacle::at_rest(Shape::ground(&one.points)));
        let ceilings = self.ceiling.iter();
        let ceilings = ceilings.map(|one| Obstacle::at_rest(Shape::ceiling(&one.points)));
        let mut all = Vec::new();
        all.extend(numbered("circle", circles));
        all.extend(numbered("capsule", capsules));
        all.extend(numbered("polygon", polygons));
        all.extend(numbered("polyline", polylines));
        all.extend(numbered("ground", grounds));
        all.extend(numbered("ceiling", ceilings));
        all
    }

    /// Its obstacles, by kind.
    #[must_use]
    pub fn obstacles(&self) -> Vec<Obstacle> {
        let named = self.named().into_iter();
        named.map(|(_, obstacle)| obstacle).collect()
    }

    /// Its text, which [`FieldFile::parse`] reads back to the last bit.
    ///
    /// # Errors
    /// What the writer of TOML says.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }

    /// Whether there is no obstacle.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// What is left without the first obstacles of each kind, as many as another file has.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        fn rest<T: Clone>(all: &[T], first: &[T]) -> Vec<T> {
            all.iter().skip(first.len()).cloned().collect()
        }
        Self {
            circle: rest(&self.circle, &other.circle),
            capsule: rest(&self.capsule, &other.capsule),
            polygon: rest(&self.polygon, &other.polygon),
            polyline: rest(&self.polyline, &other.polyline),
            ground: rest(&self.ground, &other.ground),
            ceiling: rest(&self.ceiling, &other.ceiling),
        }
    }
}

fn numbered(
    kind: &str,
    obstacles: impl Iterator<Item = Obstacle>,
) -> impl Iterator<Item = (String, Obstacle)> {
    let numbers = 1..;
    numbers
        .zip(obstacles)
        .map(move |(number, obstacle)| (format!("{kind} {number}"), obstacle))
}
