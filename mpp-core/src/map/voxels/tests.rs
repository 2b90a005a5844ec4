//! The map over terrain, against a slow one that is a list of voxels.

extern crate std;

use super::{CELL, CELLS, HIT_DOUBT, RANGE_DOUBT, SpaceBeam, VoxelGrid, filled, voxel};
use crate::tuning::grid::UNANSWERED_SHARE;
use crate::tuning::grid::{FREE, HIT, LIMIT, OCCUPIED, PASSED, PASSED_UNANSWERED};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::boxed::Box;
use std::collections::{BTreeMap, BTreeSet};
use std::vec::Vec;

const SIGHT: f64 = 45.0;

/// Log-odds of the voxels that a beam has seen.
type Slow = BTreeMap<[i64; 3], i8>;

fn change(slow: &mut Slow, at: [i64; 3], by: i8) {
    let sum = slow.get(&at).copied().unwrap_or(0).saturating_add(by);
    let sum = sum.clamp(-FREE, LIMIT);
    slow.insert(at, if sum == 0 { -10 } else { sum });
}

/// Takes up beams along the axes, as far as they lie in the window.
fn insert(
    slow: &mut Slow,
    from: [f64; 3],
    beams: &[SpaceBeam],
    inside: impl Fn(&[i64; 3]) -> bool,
) {
    let at = |beam: &SpaceBeam, way: f64| {
        core::array::from_fn(|axis| voxel(from[axis] + way * beam.direction[axis]))
    };
    let ends = beams.iter().filter_map(|beam| Some(at(beam, beam.range?)));
    let hits: Vec<[i64; 3]> = ends.filter(|end| inside(end)).collect();
    hits.iter().for_each(|hit| change(slow, *hit, HIT));
    let hits: BTreeSet<_> = hits.into_iter().collect();
    for beam in beams {
        let (end, by) = match beam.range {
            Some(range) => (range * (1.0 - RANGE_DOUBT) - HIT_DOUBT, -PASSED),
            None => (UNANSWERED_SHARE * SIGHT, -PASSED_UNANSWERED),
        };
        let (first, last): ([i64; 3], [i64; 3]) = (at(beam, 0.0), at(beam, end.max(0.0)));
        let steps = (0..3)
            .map(|axis| (last[axis] - first[axis]).abs())
            .max()
            .unwrap();
        for step in 0..=steps {
            let passed = core::array::from_fn(|axis| {
                first[axis] + step * (last[axis] - first[axis]).signum()
            });
            if !inside(&passed) {
                break;
            }
            if !hits.contains(&passed) {
                change(slow, passed, by);
            }
        }
    }
}

/// A walk up and down, with jumps, over heights below zero too: the aircraft is near the middle of the window, every voxel of it
/// has what the slow map has, and all that has left it is forgotten.
#[test]
fn the_window_knows_in_every_height_what_it_saw() {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let mut draw = |low: f64, high: f64| {
        low + (high - low) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut map = Box::new(VoxelGrid::new());
    map.clear(0.0);
    map.cover(&[0.0, 100.0], 30.0);
    let (mut slow, mut at) = (Slow::new(), [0.0, 0.0, 30.0]);
    let (mut known, mut floors) = (0, BTreeSet::new());
    for scan in 0..120 {
        at[0] += draw(0.0, 0.6);
        at[1] += draw(-0.5, 0.5);
        at[2] += draw(-1.2, 1.1) - f64::from(scan % 40 == 39) * 12.0;
        let beams: Vec<SpaceBeam> = (0..40)
            .map(|_| {
                let mut direction = [0.0; 3];
                direction[draw(0.0, 3.0) as usize] = if draw(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 };
                let range = (draw(0.0, 1.0) < 0.8).then(|| draw(0.3, 12.0));
                SpaceBeam { direction, range }
            })
            .collect();
        // It flies to all sides in turn.
        map.begin(&at, 0.08 * f64::from(scan));
        beams.iter().for_each(|beam| map.mark(beam));
        beams.iter().for_each(|beam| map.pass(beam, SIGHT));
        let first = [map.first[0], map.first[1], map.floor()];
        let inside = |place: &[i64; 3]| {
            (0..3).all(|axis| (0..CELLS[axis] as i64).contains(&(place[axis] - first[axis])))
        };
        let above = voxel(at[2]) - map.floor();
        assert!((12..=20).contains(&above), "{above}");
        floors.insert(map.floor());
        slow.retain(|place, _| inside(place));
        insert(&mut slow, at, &beams, inside);
        for x in first[0]..first[0] + CELLS[0] as i64 {
            for y in first[1]..first[1] + CELLS[1] as i64 {
                let (mut occupied, mut unknown) = (0_u32, u32::MAX);
                for z in 0..CELLS[2] as i64 {
                    if let Some(log_odds) = slow.get(&[x, y, first[2] + z]) {
                        occupied |= u32::from(*log_odds >= OCCUPIED) << z;
                        unknown &= !(1 << z);
                        known += 1;
                    }
                }
                let occupied = filled(occupied, unknown);
                let ([found, open], _) = map.column(x, y);
                assert_eq!(
                    [found, open],
                    [occupied, unknown & !occupied],
                    "{x} {y} {scan}"
                );
            }
        }
    }
    assert!(known > 100_000 && floors.len() > 8, "{known} {floors:?}");
    assert!(floors.first() < Some(&0) && floors.last() > Some(&30));
    let far = map.floor() as f64 * CELL + 1000.0;
    map.insert(&[at[0], at[1], far], core::iter::empty(), SIGHT);
    let (x, y) = (map.first[0], map.first[1]);
    for x in x..x + CELLS[0] as i64 {
        assert!((y..y + CELLS[1] as i64).all(|y| map.column(x, y).0 == [0, u32::MAX]));
    }
}

#[test]
fn below_a_hit_the_unseen_is_filled_down_to_what_was_seen() {
    let seen = !(1 << 20 | 1 << 5);
    assert_eq!(filled(1 << 21 | 1 << 6, !seen), 3 << 20 | 3 << 5);
    assert_eq!(filled(1 << 31, u32::MAX >> 1), u32::MAX);
    assert_eq!(filled(1 << 9, 0xfff0 ^ 1 << 9), 0x3f0);
    assert_eq!(filled(0, u32::MAX), 0);
}
