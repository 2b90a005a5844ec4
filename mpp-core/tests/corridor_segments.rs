//! Tests faces between segments and cells. A segment whose ends keep the faces keeps its distance
//! all along.

use crate::common::draw::Draw;
use crate::common::rolling_grid::{field, random_map};
use mpp_core::config::{KNOTS, STAGE_PERIOD};
use mpp_core::corridor::{Corridor, DIRECTION_VECTORS, Keep};
use mpp_core::map::DistanceField;
use mpp_core::vehicle::PathState;

const CRUISE: f64 = 12.0;
const KEEP: Keep = Keep {
    margin: 0.85,
    room: 0.0,
    body_radius: 0.0,
    floor: 39.7,
    ceiling: 60.3,
};
/// Distance within which a cell counts as near a segment \[m\].
const REACH: f64 = 4.0;

type Knots = [PathState; KNOTS];

/// A trajectory that wanders from about `(100, 50)` onwards at about cruise.
fn knots(draw: &mut Draw) -> Knots {
    let mut at = PathState {
        x: 100.0,
        z: draw.between(44.0, 56.0),
        ..PathState::default()
    };
    core::array::from_fn(|_| {
        let now = at;
        at.x += draw.between(2.0, 3.5);
        at.z += draw.between(-1.0, 1.0);
        now
    })
}

/// Fields with a trajectory each, and a generator for further numbers.
fn scenes() -> impl Iterator<Item = (Draw, DistanceField, Knots)> {
    (0..60).map(|seed| {
        let mut draw = Draw::new(seed);
        let field = field(&random_map(&mut draw, 100.0, 1));
        let knots = knots(&mut draw);
        (draw, field, knots)
    })
}

/// The slack of a place in the faces of a stage \[m\]; negative where the place breaks a face.
fn slack(corridor: &Corridor, knots: &Knots, stage: usize, (x, z): (f64, f64)) -> f64 {
    let level = knots[0].x + CRUISE * STAGE_PERIOD * stage as f64;
    let slacks = DIRECTION_VECTORS.iter().zip(&corridor.bounds[stage]);
    slacks
        .map(|([up, forward], bound)| bound - up * (z - knots[0].z) - forward * (x - level))
        .fold(f64::INFINITY, f64::min)
}

fn separated(field: &DistanceField, knots: &Knots, keep: &Keep) -> Corridor {
    let mut corridor = Corridor::new();
    corridor.separate(field, knots, CRUISE, keep);
    corridor
}

/// Distance from a point to the nearest cell.
fn distance(cells: &[(f64, f64)], x: f64, z: f64) -> f64 {
    cells
        .iter()
        .map(|(at_x, at_z)| libm::hypot(x - at_x, z - at_z))
        .fold(f64::INFINITY, f64::min)
}

/// The surface cells near a segment.
fn about(field: &DistanceField, from: &PathState, to: &PathState) -> Vec<(f64, f64)> {
    let range = |a: f64, b: f64| [a.min(b) - REACH, a.max(b) + REACH];
    let mut cells = Vec::new();
    field.surface(range(from.x, to.x), range(from.z, to.z), |x, z| {
        cells.push((x, z));
    });
    cells
}

#[test]
fn a_segment_whose_ends_keep_the_faces_keeps_the_margin_all_along() {
    let (mut near, mut kept) = (0, 0);
    for (mut draw, field, knots) in scenes() {
        let corridor = separated(&field, &knots, &KEEP);
        for stage in 0..KNOTS - 1 {
            let (from, to) = (&knots[stage], &knots[stage + 1]);
            let cells = about(&field, from, to);
            for _ in 0..60 {
                let mut end = |knot: &PathState| {
                    (
                        knot.x + draw.between(-3.0, 3.0),
                        knot.z + draw.between(-3.0, 3.0),
                    )
                };
                let (a, b) = (end(from), end(to));
                if slack(&corridor, &knots, stage, a) < 0.0
                    || slack(&corridor, &knots, stage + 1, b) < 0.0
                {
                    continue;
                }
                kept += 1;
                for sample in 0..=10 {
                    let share = f64::from(sample) / 10.0;
                    let x = a.0 + (b.0 - a.0) * share;
                    let z = a.1 + (b.1 - a.1) * share;
                    let distance = distance(&cells, x, z);
                    assert!(distance >= KEEP.margin - 1e-9, "{distance} at {x}, {z}");
                    near += usize::from(distance < 2.0 * KEEP.margin);
                }
            }
        }
    }
    assert!(kept > 1_000 && near > 1_000, "{kept} {near}");
}

/// Faces give way by 0.2 m of the room that a trajectory has. In a gap they ask for the margin
/// alone.
#[test]
fn faces_keep_the_room_that_the_trajectory_has() {
    const ROOM: f64 = 1.6;
    let (mut roomy, mut tight) = (0, 0);
    for (_, field, knots) in scenes() {
        let margin = separated(&field, &knots, &KEEP);
        let room = separated(&field, &knots, &Keep { room: ROOM, ..KEEP });
        let kept = |pair: &[PathState]| {
            let at = |share: f64| {
                let (run, rise) = (pair[1].x - pair[0].x, pair[1].z - pair[0].z);
                field.distance(pair[0].x + share * run, pair[0].z + share * rise)
            };
            let least = at(0.0).min(at(0.5)).min(at(1.0));
            (least - 0.2).clamp(KEEP.margin, ROOM)
        };
        for stage in 0..KNOTS {
            let neighbours = stage.saturating_sub(1)..(stage + 2).min(KNOTS);
            let more = knots[neighbours].windows(2).map(kept);
            let most = more.fold(KEEP.margin, f64::max) - KEEP.margin;
            for (wide, narrow) in margin.bounds[stage].iter().zip(&room.bounds[stage]) {
                let closer = wide - narrow;
                assert!(
                    (-1e-9..=most + 1e-9).contains(&closer),
                    "{closer} of {most}"
                );
                roomy += usize::from(closer > 0.5);
            }
            tight += usize::from(most == 0.0);
        }
    }
    assert!(roomy > 100 && tight > 50, "{roomy} {tight}");
}

/// A segment that has the room may move there: faces are no tighter than the best of eight.
#[test]
fn a_trajectory_well_away_from_everything_keeps_its_own_faces() {
    let mut clear = 0;
    for (_, field, knots) in scenes() {
        let corridor = separated(&field, &knots, &KEEP);
        for stage in 0..KNOTS {
            let neighbours = stage.saturating_sub(1)..(stage + 2).min(KNOTS);
            let segments = knots[neighbours].windows(2);
            let room = segments.map(|pair| {
                let cells = about(&field, &pair[0], &pair[1]);
                (0..=20)
                    .map(|sample| {
                        let share = f64::from(sample) / 20.0;
                        let x = pair[0].x + (pair[1].x - pair[0].x) * share;
                        let z = pair[0].z + (pair[1].z - pair[0].z) * share;
                        distance(&cells, x, z)
                    })
                    .fold(f64::INFINITY, f64::min)
            });
            // The best of eight directions loses at most cos(22.5 deg). The slope of a segment
            // costs more.
            if room.fold(f64::INFINITY, f64::min) > 2.0 * KEEP.margin {
                clear += 1;
                let at = (knots[stage].x, knots[stage].z);
                let slack = slack(&corridor, &knots, stage, at);
                assert!(slack >= 0.0, "{slack} at stage {stage} of {knots:?}");
            }
        }
    }
    assert!(clear > 50, "{clear}");
}

#[test]
fn floor_and_ceiling_bound_the_height_of_every_stage_and_nothing_else_does() {
    let knots = knots(&mut Draw::new(1));
    let corridor = separated(&DistanceField::new(), &knots, &KEEP);
    for (stage, knot) in knots.iter().enumerate() {
        let slack = |z: f64| slack(&corridor, &knots, stage, (knot.x, z));
        for inside in [KEEP.floor + 1e-6, KEEP.ceiling - 1e-6] {
            assert!(slack(inside) > 0.0);
        }
        for outside in [KEEP.floor - 1e-6, KEEP.ceiling + 1e-6] {
            assert!(slack(outside) < 0.0);
        }
        for far in [-50.0, 50.0] {
            let there = (knot.x + far, knot.z);
            assert!(self::slack(&corridor, &knots, stage, there) > 0.0);
        }
    }
}

/// A corridor belongs to its last trajectory only.
#[test]
fn faces_of_a_former_trajectory_are_gone() {
    let mut draw = Draw::new(2);
    let field = field(&random_map(&mut draw, 100.0, 1));
    let (first, second) = (knots(&mut draw), knots(&mut draw));
    let mut corridor = separated(&field, &first, &KEEP);
    corridor.separate(&field, &second, CRUISE, &KEEP);
    assert_eq!(corridor, separated(&field, &second, &KEEP));
}
