//! Tests of distances, rays and files, against dense samples of the shapes.

use super::*;
use crate::random::{self, Draws, Stream};
use proptest::prelude::*;

/// Number of samples along a motion or a ray.
const SAMPLES: usize = 4000;
/// Error of what they tell \[m\].
const TOLERANCE: f64 = 2e-3;

fn uniform(generator: &mut Draws, low: f64, high: f64) -> f64 {
    low + (high - low) * random::uniform(generator)
}

/// Points around the origin, at rising angles: the corners of a simple polygon.
fn star(generator: &mut Draws, corners: usize) -> Vec<Point> {
    let angle = |k: usize| core::f64::consts::TAU * k as f64 / corners as f64;
    (0..corners)
        .map(|k| {
            let (sin, cos) = libm::sincos(angle(k));
            let radius = uniform(generator, 0.5, 4.0);
            (radius * cos, radius * sin)
        })
        .collect()
}

/// A line with rising downrange distances.
fn profile(generator: &mut Draws, points: usize) -> Vec<Point> {
    let place = |k: usize| -6.0 + 12.0 * k as f64 / points as f64;
    (0..points)
        .map(|k| (place(k), uniform(generator, -3.0, 3.0)))
        .collect()
}

/// One shape of each kind about the origin.
fn shapes(seed: u64) -> Vec<Shape> {
    let random = &mut random::generator(seed, Stream::Field);
    let place = |random: &mut Draws| (uniform(random, -3.0, 3.0), uniform(random, -3.0, 3.0));
    let (thin, count) = (uniform(random, 0.01, 0.2), 3 + (seed % 6) as usize);
    let centre = place(random);
    let ends = vec![place(random), place(random)];
    let bends = vec![place(random), place(random), place(random), place(random)];
    vec![
        Shape::Circle {
            centre,
            radius: 10.0 * thin,
        },
        Shape::Line {
            points: ends,
            radius: thin,
        },
        Shape::Line {
            points: bends,
            radius: thin,
        },
        Shape::Polygon {
            corners: star(random, count),
        },
        Shape::ground(&profile(random, count)),
        Shape::ceiling(&profile(random, count)),
    ]
}

/// Distance from a point to a segment, found by trying many points of it.
fn near(point: Point, ends: [Point; 2]) -> f64 {
    let [a, b] = ends;
    evenly_spaced(0.0, 1.0, SAMPLES + 1)
        .map(|s| {
            let (x, z) = (a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1));
            libm::hypot(x - point.0, z - point.1)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Whether a point is in a shape, by rules that the code under test does not use: distances to
/// sampled lines, the winding number of a polygon, heights over a profile.
fn holds(shape: &Shape, point: Point) -> bool {
    match shape {
        Shape::Circle { centre, radius } => {
            libm::hypot(point.0 - centre.0, point.1 - centre.1) < *radius
        }
        Shape::Line { points, radius } => points
            .windows(2)
            .any(|leg| near(point, [leg[0], leg[1]]) < *radius),
        Shape::Polygon { corners } => {
            let angle = |p: Point| libm::atan2(p.1 - point.1, p.0 - point.0);
            let turn = |a: Point, b: Point| {
                let turn = angle(b) - angle(a);
                turn - core::f64::consts::TAU * (turn / core::f64::consts::TAU).round()
            };
            let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
            let winding: f64 = pairs.map(|(a, b)| turn(*a, *b)).sum();
            winding.abs() > 1.0
        }
        Shape::Ground(sheet) => point.1 < height(sheet.line(), point.0),
        Shape::Ceiling(sheet) => point.1 > height(sheet.line(), point.0),
    }
}

/// Height of a line at a place.
fn height(line: &[Point], x: f64) -> f64 {
    if x <= line[0].0 {
        return line[0].1;
    }
    let leg = line.windows(2).find(|leg| x <= leg[1].0);
    leg.map_or(line[line.len() - 1].1, |leg| {
        let share = (x - leg[0].0) / (leg[1].0 - leg[0].0);
        leg[0].1 + share * (leg[1].1 - leg[0].1)
    })
}

fn along(from: Point, to: Point, share: f64) -> Point {
    (
        from.0 + share * (to.0 - from.0),
        from.1 + share * (to.1 - from.1),
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// A motion has hit a shape exactly if one of its points is in it.
    #[test]
    fn a_motion_enters_what_one_of_its_points_is_in(
        seed in 0_u64..10_000,
        from in (-6.0_f64..6.0, -6.0_f64..6.0),
        step in (-2.0_f64..2.0, -2.0_f64..2.0),
    ) {
        const COARSE: usize = 60;
        let to = (from.0 + step.0, from.1 + step.1);
        for shape in shapes(seed) {
            let clearance = shape.clearance_of_segment(from, to);
            let inside = evenly_spaced(0.0, 1.0, COARSE + 1)
                .any(|share| holds(&shape, along(from, to, share)));
            // A sample is at most so far from the point where the motion is deepest.
            let between = libm::hypot(step.0, step.1) / COARSE as f64 + TOLERANCE;
            if inside {
                prop_assert!(clearance < TOLERANCE, "{shape:?}: {clearance}");
            } else {
                prop_assert!(clearance > -between, "{shape:?}: {clearance}");
            }
        }
    }

    /// The clearance of a motion is the least over its points, and that of a point is as far as one
    /// can go in every direction.
    #[test]
    fn nothing_of_a_shape_is_nearer_than_its_clearance(
        seed in 0_u64..10_000,
        point in (-6.0_f64..6.0, -6.0_f64..6.0),
        step in (-1.0_f64..1.0, -1.0_f64..1.0),
    ) {
        const DIRECTIONS: usize = 90;
        let to = (point.0 + step.0, point.1 + step.1);
        for shape in shapes(seed) {
            let clearance = shape.clearance_of_segment(point, point);
            if clearance > TOLERANCE {
                let at = |k: usize, distance: f64| {
                    let angle = core::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
                    let (sin, cos) = libm::sincos(angle);
                    (point.0 + distance * cos, point.1 + distance * sin)
                };
                let hits = |distance: f64| {
                    (0..DIRECTIONS).any(|k| holds(&shape, at(k, distance)))
                };
                prop_assert!(!hits(clearance - TOLERANCE), "{shape:?}: {clearance}");
            }
            let least = evenly_spaced(0.0, 1.0, 201)
                .map(|share| along(point, to, share))
                .map(|place| shape.clearance_of_segment(place, place))
                .fold(f64::INFINITY, f64::min);
            let swept = shape.clearance_of_segment(point, to);
            if least > 0.0 {
                let between = 0.5 * libm::hypot(step.0, step.1) / 200.0;
                prop_assert!(swept <= least + 1e-9 && least <= swept + between + 1e-9);
            } else {
                prop_assert!(swept <= 1e-9);
            }
        }
    }

    /// A ray ends where it comes into a shape: nothing of the shape is before that place.
    #[test]
    fn a_ray_ends_at_the_first_point_of_a_shape(
        seed in 0_u64..10_000,
        from in (-8.0_f64..8.0, -8.0_f64..8.0),
        angle in 0.0_f64..core::f64::consts::TAU,
    ) {
        const LENGTH: f64 = 12.0;
        let (up, ahead) = libm::sincos(angle);
        let at = |range: f64| (from.0 + range * ahead, from.1 + range * up);
        for shape in shapes(seed) {
            let clear = |place: Point| shape.clearance_of_segment(place, place);
            match shape.range(from, (ahead, up)).filter(|range| *range < LENGTH) {
                Some(range) => {
                    prop_assert!(clear(at(range)).abs() < 1e-6 || range == 0.0);
                    let before = shape.clearance_of_segment(from, at((range - 1e-6).max(0.0)));
                    prop_assert!(range == 0.0 || before > -1e-6, "{shape:?}: {before}");
                    prop_assert_eq!(range == 0.0, clear(from) < 0.0);
                }
                None => {
                    let ray = shape.clearance_of_segment(from, at(LENGTH - 1e-6));
                    prop_assert!(ray > -1e-9, "{shape:?}: {ray}");
                }
            }
        }
    }

    /// A square is touched if the shape is in one of its points, and is not if the shape is farther
    /// than its corners.
    #[test]
    fn a_square_is_touched_by_what_is_in_it(
        seed in 0_u64..10_000,
        centre in (-5.0_f64..5.0, -5.0_f64..5.0),
    ) {
        const HALF: f64 = 0.25;
        const GRID: usize = 21;
        for shape in shapes(seed) {
            let places = || evenly_spaced(-HALF, HALF, GRID);
            let mut inside = false;
            let mut nearest = f64::INFINITY;
            for x in places() {
                for z in places() {
                    let place = (centre.0 + x, centre.1 + z);
                    let clearance = shape.clearance_of_segment(place, place);
                    inside |= clearance <= 0.0;
                    nearest = nearest.min(clearance);
                }
            }
            let touched = shape.touches_square(centre, HALF);
            prop_assert!(touched || !inside, "{shape:?}");
            // The grid is so wide that something thin may stand between its points.
            prop_assert!(!touched || nearest < 2.0 * HALF / (GRID - 1) as f64, "{shape:?}");
        }
    }

    /// Seen from the ground, an obstacle that moves is hit by whatever meets it at the same time.
    #[test]
    fn a_moving_obstacle_is_met_where_it_is_at_that_time(
        seed in 0_u64..10_000,
        velocity in (-8.0_f64..8.0, -8.0_f64..8.0),
        from in (-6.0_f64..6.0, -6.0_f64..6.0),
        step in (-1.0_f64..1.0, -1.0_f64..1.0),
    ) {
        let to = (from.0 + step.0, from.1 + step.1);
        let times = [0.7, 0.9];
        for shape in shapes(seed).into_iter().take(4) {
            let moving = Obstacle { shape: shape.clone(), velocity };
            let swept = moving.clearance_of_motion(from, to, times);
            // Each instant on its own, with a shape that was really moved there.
            let least = evenly_spaced(0.0, 1.0, 401).map(|share| {
                let time = times[0] + share * (times[1] - times[0]);
                let mut there = shape.clone();
                there.shift((velocity.0 * time, velocity.1 * time));
                let place = along(from, to, share);
                there.clearance_of_segment(place, place)
            });
            let least = least.fold(f64::INFINITY, f64::min);
            if least > 0.0 {
                prop_assert!(swept <= least + 1e-9 && least < swept + 0.02);
            } else {
                prop_assert!(swept < 1e-9);
            }
        }
    }

    #[test]
    fn a_field_reads_back_as_it_was(seed in 0_u64..10_000, velocity in (-9.0_f64..9.0, 0.1_f64..9.0)) {
        let mut obstacles: Vec<Obstacle> = shapes(seed).into_iter().map(Obstacle::at_rest).collect();
        obstacles[0].velocity = velocity;
        obstacles[3].velocity = velocity;
        let file = FieldFile::of(&obstacles);
        let text = file.to_toml().unwrap();
        let read = FieldFile::parse("again.toml", &text).unwrap();
        prop_assert_eq!(&read, &file);
        // The file sorts by kind.
        let mut again = read.obstacles();
        prop_assert_eq!(again.len(), obstacles.len());
        again.retain(|one| !obstacles.contains(one));
        prop_assert!(again.is_empty(), "{again:?}");
    }
}

/// A wire of 1 mm is not jumped over, however long the motion is.
#[test]
fn a_fast_step_cannot_jump_over_a_wire() {
    let radius = 0.0005;
    let wire = Obstacle::circle(0.0, 0.0, radius);
    let times = [0.0, 0.01];
    assert!(wire.clearance_of_motion((-50.0, 0.0004), (50.0, 0.0004), times) < 0.0);
    assert!(wire.clearance_of_motion((-50.0, 0.0006), (50.0, 0.0006), times) > 0.0);
    let bar = Obstacle::at_rest(Shape::Line {
        points: vec![(0.0, -1.0), (0.0, 1.0)],
        radius,
    });
    assert!(bar.clearance_of_motion((-50.0, 0.9), (50.0, -0.9), times) < 0.0);
    // The wire itself may jump over the aircraft.
    let falling = Obstacle {
        velocity: (0.0, -1000.0),
        ..Obstacle::circle(5.0, 5.0, radius)
    };
    assert!(falling.clearance_of_motion((5.0, 0.0), (5.0, 0.0), times) < 0.0);
    assert!(falling.clearance_of_motion((5.0, 0.0), (5.0, 0.0), [0.0, 0.004]) > 0.0);
}

/// A motion that cuts off the corner of an area has hit it, though both of its ends are outside.
#[test]
fn a_corner_cannot_be_cut_off() {
    let square = Shape::Polygon {
        corners: vec![(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)],
    };
    let clearance = square.clearance_of_segment((-0.1, 0.9), (0.1, 1.1));
    assert!(clearance.abs() < 1e-12, "{clearance}");
    let clearance = square.clearance_of_segment((-0.1, 0.8), (0.2, 1.1));
    assert!((clearance + 0.05).abs() < 1e-9, "{clearance}");
    let through = square.clearance_of_segment((-1.0, 0.5), (2.0, 0.5));
    assert!((through + 0.5).abs() < 1e-12, "{through}");
}

/// The least of many, in any order, at rest and in motion, is to the bit what each of them gives.
#[test]
fn a_field_tells_what_its_nearest_obstacle_does() {
    for seed in 0..300 {
        let random = &mut random::generator(seed, Stream::Field);
        let mut obstacles: Vec<Obstacle> = (0..12)
            .map(|_| Obstacle {
                velocity: (uniform(random, -3.0, 3.0), uniform(random, -3.0, 3.0)),
                ..Obstacle::circle(
                    uniform(random, -60.0, 60.0),
                    uniform(random, -9.0, 9.0),
                    1.0,
                )
            })
            .collect();
        if seed % 3 == 0 {
            obstacles.extend(shapes(seed).into_iter().map(Obstacle::at_rest));
        }
        let mut field = ObstacleField::new(obstacles);
        let time = uniform(random, 0.0, 5.0);
        field.move_to(time);
        let from = (uniform(random, -70.0, 70.0), uniform(random, -9.0, 9.0));
        let to = (from.0 + uniform(random, -4.0, 4.0), from.1 + 1.0);
        let times = [time, time + 0.01];
        let each = (field.obstacles.iter()).map(|it| it.clearance_of_motion(from, to, times));
        let least = each.fold(f64::INFINITY, f64::min);
        assert_eq!(
            field.clearance_of_motion(from, to, 0.01).to_bits(),
            least.to_bits()
        );
        let directions: Vec<Point> = (0..30).map(|beam| libm::sincos(f64::from(beam))).collect();
        let ranges = field.ranges(from, &directions, 45.0);
        for (range, direction) in ranges.iter().zip(&directions) {
            let within = |range: &f64| *range <= 45.0;
            assert_eq!(
                range.filter(within),
                field.range(from, *direction).filter(within)
            );
        }
    }
}
