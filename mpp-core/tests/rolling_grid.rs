//! Tests what the rolling grid keeps, unlearns and forgets.

use crate::common::cells::{CELL, COLS, ROWS, centre, occupied};
use crate::common::draw::Draw;
use crate::common::rolling_grid::{field, noise, pose, random_map};
use mpp_core::map::RollingGrid;
use mpp_core::sense::LidarScan;

/// One beam along the body axis. Range 0 means a beam that did not return.
fn beam(range: f32) -> LidarScan {
    let mut scan = LidarScan::new();
    assert!(scan.ranges.push(range).is_ok());
    scan
}

/// A map about `(100, 50)`.
fn started() -> RollingGrid {
    let mut map = RollingGrid::new();
    map.roll(100.0, 50.0);
    map
}

/// All rows of the map that a reader can see.
fn rows(map: &RollingGrid) -> Vec<(u128, u128)> {
    (0..ROWS).map(|row| map.row(row)).collect()
}

/// Centres of the occupied cells, by row and column.
fn centres(map: &RollingGrid) -> Vec<(f64, f64)> {
    let mut centres = Vec::new();
    for row in 0..ROWS as i32 {
        for col in (0..COLS as i32).filter(|col| occupied(map, row, *col)) {
            centres.push(centre(map, row, col));
        }
    }
    centres
}

#[test]
fn a_hit_is_marked_where_the_beam_ended_and_completed_behind() {
    for (pitch, range) in [(0.0, 20.1), (0.4, 15.3), (-0.5, 25.7), (0.1, 0.4)] {
        let mut map = started();
        map.insert(&beam(range), 45.0, &pose(100.2, 50.2, pitch));
        let known = field(&map);
        let (up, ahead) = libm::sincos(pitch);
        let at = |along: f64| (100.2 + along * ahead, 50.2 + along * up);
        let range = f64::from(range);
        for along in [0.0, 0.5, 1.0] {
            let (x, z) = at(range + along);
            assert!(known.is_occupied(x, z), "{along} behind the hit");
        }
        for (x, z) in centres(&map) {
            let off = (x - 100.2) * ahead + (z - 50.2) * up - range;
            let beside = (z - 50.2) * ahead - (x - 100.2) * up;
            assert!((-CELL..CELL).contains(&off) && beside.abs() < CELL);
        }
        // The way is known as free up to a metre and 3 % before the hit. It is unknown elsewhere.
        let (x, z) = at(0.5 * (range - 1.6));
        assert!(range < 2.0 || !known.is_unknown(x, z) && !known.is_occupied(x, z));
        let (x, z) = at(range + 2.5);
        assert!(known.is_unknown(x, z));
    }
}

#[test]
fn a_hit_stays_when_it_is_out_of_sight() {
    let mut map = started();
    map.insert(&beam(20.1), 45.0, &pose(100.2, 50.2, 0.0));
    let before = centres(&map);
    assert!(!before.is_empty());
    for step in 1..100 {
        let x = 100.0 + 0.25 * f64::from(step);
        map.roll(x, 50.0);
        // The aircraft looks up, past the obstacle.
        map.insert(&beam(0.0), 45.0, &pose(x, 51.0, 0.6));
    }
    assert_eq!(centres(&map), before);
}

#[test]
fn passing_beams_clear_a_false_hit_and_the_more_often_it_was_seen_the_later() {
    let passes_to_clear = |hits: usize, passing: f32| {
        let mut map = started();
        for _ in 0..hits {
            map.insert(&beam(20.1), 45.0, &pose(100.2, 50.2, 0.0));
        }
        assert!(field(&map).is_occupied(120.3, 50.2));
        (1..40).find(|_| {
            map.insert(&beam(passing), 45.0, &pose(100.2, 50.2, 0.0));
            !field(&map).is_occupied(120.3, 50.2)
        })
    };
    let (once, often) = (passes_to_clear(1, 35.0), passes_to_clear(10, 35.0));
    assert!(once.is_some() && once < often, "{once:?} {often:?}");
    // Evidence is bounded: a cell seen a hundred times is unlearned as fast as a cell seen ten
    // times.
    assert_eq!(often, passes_to_clear(100, 35.0));
    // A beam that never returned may have been lost, so it says less.
    let unanswered = passes_to_clear(1, 0.0);
    assert!(once < unanswered && unanswered.is_some(), "{unanswered:?}");
    // A hit right behind the cell does not clear it, because the range may be wrong by that much.
    assert_eq!(passes_to_clear(1, 20.9), None);
}

#[test]
fn one_hit_on_what_was_free_long_is_believed() {
    let mut map = started();
    for _ in 0..100 {
        map.insert(&beam(35.0), 45.0, &pose(100.2, 50.2, 0.0));
    }
    map.insert(&beam(20.1), 45.0, &pose(100.2, 50.2, 0.0));
    assert!(field(&map).is_occupied(120.3, 50.2));
}

#[test]
fn unanswered_beams_speak_for_eight_ninths_of_the_sight() {
    for (sight, seen) in [(45.0, 40.0), (18.0, 16.0)] {
        let mut map = started();
        map.insert(&beam(0.0), sight, &pose(100.2, 50.2, 0.0));
        let known = field(&map);
        assert!(centres(&map).is_empty());
        for step in 1..2 * seen as i32 {
            let along = 0.5 * f64::from(step);
            assert!(!known.is_unknown(100.2 + along, 50.2), "{along}");
        }
        assert!(known.is_unknown(100.2 + seen + 1.0, 50.2));
        assert!(known.is_unknown(100.2 + 10.0, 51.2), "beside the beam");
    }
}

/// Two beams that pass take back the log-odds of a hit. The cell is then free, not unknown again.
#[test]
fn what_was_seen_is_never_unknown_again() {
    let mut map = started();
    let at = (120.3, 50.2);
    map.insert(&beam(20.1), 45.0, &pose(100.2, 50.2, 0.0));
    for _ in 0..4 {
        map.insert(&beam(35.0), 45.0, &pose(100.2, 50.2, 0.0));
        assert!(!field(&map).is_unknown(at.0, at.1));
    }
    assert!(!field(&map).is_occupied(at.0, at.1));
}

#[test]
fn the_window_rolls_along_and_loses_only_what_it_left() {
    for seed in 0..10 {
        let mut draw = Draw::new(seed);
        let x = draw.between(-200.0, 2000.0);
        let mut map = random_map(&mut draw, x, 3);
        let before = rows(&map);
        let first = map.first_x();
        assert!((first..first + 64.0).contains(&x) && x - first >= 8.0 - CELL);
        let ahead = draw.between(0.0, 70.0);
        map.roll(x + ahead, 50.0);
        let columns = ((map.first_x() - first) / CELL) as u32;
        assert!((f64::from(columns) * CELL - ahead).abs() <= CELL);
        for (row, (occupied, unknown)) in before.iter().enumerate() {
            let kept = |bits: u128| bits.checked_shr(columns).unwrap_or(0);
            let fresh = u128::MAX.checked_shl(COLS as u32 - columns.min(COLS as u32));
            let fresh = if columns == 0 { 0 } else { fresh.unwrap_or(0) };
            assert_eq!(map.row(row), (kept(*occupied), kept(*unknown) | fresh));
        }
        // The window moves back a little, and nothing is lost.
        let there = rows(&map);
        map.roll(x + ahead - 3.0, 50.0);
        assert_eq!(rows(&map), there);
    }
}

/// One position far ahead must not leave the aircraft without a map.
#[test]
fn an_aircraft_behind_its_window_gets_a_new_one() {
    for wrong in [170.0, 1e6, 1e300] {
        let mut map = random_map(&mut Draw::new(7), 100.0, 1);
        map.roll(wrong, 50.0);
        map.roll(100.0, 50.0);
        assert!(
            (map.first_x()..map.first_x() + 10.0).contains(&100.0),
            "{wrong}"
        );
        map.insert(&beam(20.1), 45.0, &pose(100.2, 50.2, 0.0));
        assert!(field(&map).is_occupied(120.3, 50.2));
    }
}

/// The window goes up and down with the altitude. What stays in it keeps its place, and what comes into it is
/// not known.
#[test]
fn the_window_follows_the_altitude() {
    for altitude in [50.1, 55.0, 43.5, 61.0, 90.0, -500.0, 1e9] {
        let mut map = RollingGrid::new();
        map.roll(100.0, 50.0);
        for height in [40.2, 50.2, 60.2] {
            map.insert(&beam(20.1), 45.0, &pose(100.2, height, 0.0));
        }
        let before = centres(&map);
        map.roll(100.0, altitude);
        let low = map.floor();
        assert!((low + 16.0 - altitude).abs() <= 0.25, "{altitude}: {low}");
        let kept: Vec<_> = before
            .into_iter()
            .filter(|(_, z)| (low..low + 32.0).contains(z))
            .collect();
        assert_eq!(centres(&map), kept, "{altitude}");
        // The map works at its new height.
        map.insert(&beam(20.1), 45.0, &pose(100.2, low + 3.2, 0.0));
        assert!(field(&map).is_occupied(120.3, low + 3.2));
    }
}

#[test]
fn a_cleared_map_is_as_new_wherever_it_starts_again() {
    let mut map = random_map(&mut Draw::new(7), 900.0, 3);
    map.clear();
    let mut new = RollingGrid::new();
    for map in [&mut map, &mut new] {
        map.roll(30.0, 80.0);
    }
    assert_eq!((map.first_x(), map.floor()), (new.first_x(), new.floor()));
    assert_eq!(rows(&map), rows(&new));
    assert!(centres(&map).is_empty());
    assert!(
        (map.floor() - 64.0).abs() < 1e-12,
        "the window is laid about the altitude"
    );
}

#[test]
fn no_number_is_too_wild() {
    let mut draw = Draw::new(8);
    let wild = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        1e9,
        -1e9,
    ];
    for first in wild {
        for second in wild {
            let mut map = RollingGrid::new();
            map.roll(first, 50.0);
            map.insert(&noise(&mut draw), 45.0, &pose(second, first, 0.0));
            map.roll(second, 50.0);
            map.insert(&noise(&mut draw), 45.0, &pose(second, 50.0, second));
            assert!(field(&map).distance(second, 50.0).is_nan() || rows(&map).len() == ROWS);
        }
    }
}

/// Knowledge replaces observations in the whole window, wherever it has rolled.
#[test]
fn what_is_known_leaves_nothing_unknown() {
    for x in [0.0, 37.3, 1000.1] {
        let mut map = RollingGrid::new();
        map.roll(x, 50.0);
        map.insert(&beam(5.0), 45.0, &pose(x, 50.0, 0.0));
        let wall = |at: f64, z: f64| at > x + 20.0 && z < 45.0;
        map.know(wall);
        assert!(rows(&map).iter().all(|(_, unknown)| *unknown == 0));
        let known = field(&map);
        for (at, z) in centres(&map) {
            assert_eq!(known.is_occupied(at, z), wall(at, z), "{at}, {z}");
        }
    }
}

/// Near by several beams of a scan share a cell. Those that pass do not speak against the one that ended
/// there: a pole fills a part of its cell. A later scan without the hit does.
#[test]
fn beams_of_the_same_scan_do_not_unlearn_a_hit() {
    let mut map = RollingGrid::new();
    map.roll(100.2, 50.0);
    // The middle beam ends in a cell that the four others pass, within 0.01 rad of it.
    let fan = |middle: f32| {
        let mut scan = LidarScan::new();
        (scan.angle_min, scan.angle_increment) = (-0.01, 0.005);
        for range in [0.0, 0.0, middle, 30.0, 30.0] {
            assert!(scan.ranges.push(range).is_ok());
        }
        scan
    };
    let known = |map: &RollingGrid| {
        let row = ((50.2 - map.floor()) / CELL) as i32;
        let col = ((110.3 - map.first_x()) / CELL) as i32;
        occupied(map, row, col)
    };
    for _ in 0..3 {
        map.insert(&fan(10.1), 45.0, &pose(100.2, 50.2, 0.0));
        assert!(known(&map), "the pole stays");
    }
    for _ in 0..2 {
        map.insert(&fan(0.0), 45.0, &pose(100.2, 50.2, 0.0));
    }
    assert!(!known(&map), "what is gone is unlearned");
}

/// A fan of 100 beams over 100 deg from `(100, 50)`. A circle of 1 m stands `ahead`, or has moved on; `behind` is
/// the range of what stands behind it, or 0.
fn fan(ahead: f64, there: bool, behind: f32) -> LidarScan {
    let mut scan = LidarScan::new();
    (scan.angle_min, scan.angle_increment) = (-0.8727, 0.017_63);
    for number in 0..100 {
        let (up, along) = libm::sincos(scan.beam_angle(number));
        let half_chord = libm::sqrt(1.0 - (ahead * up) * (ahead * up));
        let meets = there && !half_chord.is_nan();
        let range = if meets {
            (ahead * along - half_chord) as f32
        } else {
            behind
        };
        assert!(scan.ranges.push(range).is_ok());
    }
    scan
}

/// Scans until the map has forgotten a circle that stood still for eight scans and has then moved on.
#[test]
fn what_has_moved_on_is_forgotten() {
    // Distance [m], and the most scans before open space and before a wall.
    for (ahead, open, walled) in [(10.0, 3, 1), (20.0, 8, 3), (30.0, 8, 3), (38.0, 8, 3)] {
        for (behind, most) in [(0.0, open), (44.0, walled)] {
            let mut map = started();
            let at = pose(100.0, 50.0, 0.0);
            for _ in 0..8 {
                map.insert(&fan(ahead, true, behind), 45.0, &at);
            }
            let near = |(x, z): &(f64, f64)| libm::hypot(x - 100.0 - ahead, z - 50.0) < 3.0;
            assert!(centres(&map).iter().any(near));
            let mut scans = 0;
            while centres(&map).iter().any(near) && scans < 50 {
                map.insert(&fan(ahead, false, behind), 45.0, &at);
                scans += 1;
            }
            assert!(
                scans <= most,
                "{ahead} m ahead, behind it {behind}: {scans} scans"
            );
        }
    }
}
