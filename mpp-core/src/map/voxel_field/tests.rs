//! The field against distances that are computed one by one.

extern crate std;

use super::{CELL, HEIGHT, LENGTH, MOST_CLEARANCE, NearSlices, UNIT, VoxelField};
use crate::map::{SpaceBeam, VoxelGrid};
use core::f64::consts::PI;
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::boxed::Box;
use std::vec::Vec;

/// Numbers between two limits.
fn draws(seed: u64) -> impl FnMut(f64, f64) -> f64 {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    move |low, high| low + (high - low) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Beams at random points, one a column: the field has the distance to the nearest part of a column that one of them shows,
/// the surface has them all, and the slope is that of the clearance.
#[test]
fn the_field_has_the_distance_to_what_hits_have_shown() {
    let mut draw = draws(5);
    let (mut map, mut field) = (Box::new(VoxelGrid::new()), Box::new(VoxelField::new()));
    map.clear(0.0);
    let from = [0.25, 0.25, 8.25];
    // Least and greatest coordinates of a sixteenth of a column, and of a voxel in height.
    let part = |at: f64, edge: f64| [0.0, 1.0].map(|end| (libm::floor(at / edge) + end) * edge);
    let mut shown: Vec<[[f64; 2]; 3]> = Vec::new();
    let mut columns: Vec<[i64; 2]> = Vec::new();
    let mut beams = Vec::new();
    while shown.len() < 60 {
        let to = [draw(3.0, 40.0), draw(-12.0, 12.0), draw(1.0, 15.0)];
        let column = [to[0], to[1]].map(|at| libm::floor(at / CELL) as i64);
        if columns.contains(&column) {
            continue;
        }
        columns.push(column);
        let way: Vec<f64> = to.iter().zip(&from).map(|(to, from)| to - from).collect();
        let range = libm::sqrt(way.iter().map(|it| it * it).sum());
        let direction = core::array::from_fn(|axis| way[axis] / range);
        beams.push(SpaceBeam {
            direction,
            range: Some(range),
        });
        let fine = CELL / 16.0;
        shown.push([
            part(to[0], fine),
            part(to[1], fine),
            part(to[2], CELL / 4.0),
        ]);
    }
    // What else is there to see is free.
    for _ in 0..400 {
        let way = [20.0, draw(-12.0, 12.0), draw(-8.0, 8.0)];
        let length = libm::sqrt(way.iter().map(|it| it * it).sum());
        beams.push(SpaceBeam {
            direction: way.map(|it| it / length),
            range: None,
        });
    }
    map.insert(&from, beams.iter().copied(), 45.0);
    field.begin(&map, &from, 0.0);
    field.look(&map, 0..LENGTH);
    let mut near = NearSlices::ZEROS;
    (0..LENGTH).for_each(|slice| field.measure(slice, &mut near));
    // A side in height counts where the voxel beyond was seen.
    let mut sides = 0;
    for box_shown in &mut shown {
        let [x, y, z] = box_shown.map(|[low, high]| 0.5 * (low + high));
        let voxel = part(z, CELL);
        for (side, beyond) in [-CELL, CELL].into_iter().enumerate() {
            if field.is_unknown(&[x, y, z + beyond]) {
                box_shown[2][side] = voxel[side];
            } else {
                sides += 1;
            }
        }
    }
    assert!((20..100).contains(&sides), "{sides}");
    let mut seen = 0;
    field.surface(&[0.0, -15.0, 0.0], &[45.0, 15.0, 15.9], |[least, most]| {
        let same = |shown: &[[f64; 2]; 3]| {
            (0..3).all(|axis| {
                let [low, high] = shown[axis];
                (low - least[axis]).abs() < 1e-9 && (high - most[axis]).abs() < 1e-9
            })
        };
        assert!(shown.iter().any(same), "{least:?} {most:?}");
        seen += 1;
    });
    assert!(seen > 50, "{seen}");
    let distance = |point: &[f64; 3], shown: &[[f64; 2]; 3]| {
        let off = point.iter().zip(shown);
        let squares = off.map(|(at, [low, high])| {
            let off = (low - at).max(at - high).max(0.0);
            off * off
        });
        libm::sqrt(squares.sum())
    };
    let (mut clear, mut lines) = (0, 0);
    for _ in 0..2000 {
        let point = [draw(0.0, 42.0), draw(-14.0, 14.0), draw(0.5, 15.0)];
        let centre = point.map(|it| (libm::floor(it / CELL) + 0.5) * CELL);
        let all = shown.iter().map(|shown| distance(&centre, shown));
        let nearest = all.fold(MOST_CLEARANCE, f64::min);
        assert!(
            (field.clearance(&centre) - nearest).abs() < 0.5 * UNIT + 1e-9,
            "{point:?}"
        );
        // Within a cell between centres the clearance is linear along an axis.
        let (_, slope) = field.clearance_and_slope(&point);
        for axis in 0..3 {
            let mut moved = point;
            let middle = libm::floor(point[axis] / CELL - 0.5) * CELL + CELL;
            moved[axis] += if point[axis] < middle { 0.01 } else { -0.01 };
            let by = field.clearance(&moved) - field.clearance(&point);
            let expected = slope[axis] * (moved[axis] - point[axis]);
            assert!((by - expected).abs() < 1e-9, "{point:?} {axis}");
        }
        let wanted = draw(0.3, 2.0);
        if field.is_clear(&point, super::needed(wanted)) {
            assert!(field.clearance(&point) >= wanted, "{point:?} {wanted}");
            clear += 1;
        }
        let line = field.upright(point[0], point[1], super::needed(wanted));
        if line.is_all_clear() {
            let mut heights = (0..HEIGHT).map(|z| field.storey(z as f64 * CELL));
            assert!(heights.all(|at| line.is_clear(&at)), "{point:?} {wanted}");
            lines += 1;
        }
    }
    assert!(clear > 500 && lines > 50, "{clear} {lines}");
}

/// Whatever its course, the aircraft has in map and field what it was shown ahead of it.
#[test]
fn the_windows_lie_ahead_of_the_aircraft() {
    let mut draw = draws(6);
    let (mut map, mut field) = (Box::new(VoxelGrid::new()), Box::new(VoxelField::new()));
    let from = [100.25, -40.25, 8.25];
    for _ in 0..100 {
        map.clear(0.0);
        let course = draw(-PI, PI);
        let (sin, cos) = libm::sincos(course + draw(-0.2, 0.2));
        let range = draw(3.0, 14.0);
        let beam = SpaceBeam {
            direction: [cos, sin, 0.0],
            range: Some(range),
        };
        map.begin(&from, course);
        map.mark(&beam);
        map.pass(&beam, 45.0);
        field.begin(&map, &from, course);
        field.look(&map, 0..LENGTH);
        let mut near = NearSlices::ZEROS;
        (0..LENGTH).for_each(|slice| field.measure(slice, &mut near));
        let trunk = [from[0] + range * cos, from[1] + range * sin, from[2]];
        assert!(field.clearance(&trunk) < CELL, "{course} {range}");
    }
}
