//! Tests the distance field and the surface of random maps against the definition.

use crate::common::cells::{CELL, COLS, Cells, ROWS, centre, occupied};
use crate::common::draw::Draw;
use crate::common::rolling_grid::{field, random_map};
use mpp_core::map::{DistanceField, FAR, RollingGrid};

/// Distances are kept in 64ths of a metre, rounded down.
const ROUNDED: f64 = 1.0 / 64.0;

fn rounds() -> impl Iterator<Item = (Draw, RollingGrid)> {
    (0..12).map(|seed| {
        let mut draw = Draw::new(seed);
        let x = draw.between(-300.0, 3000.0);
        let map = random_map(&mut draw, x, 1 + seed as usize % 3);
        (draw, map)
    })
}

#[test]
fn distances_at_cell_centres_are_the_nearest_occupied_centres() {
    let (mut near, mut far) = (0, 0);
    for (_, map) in rounds() {
        let (field, occupied) = (field(&map), Cells::completed(&map).centres(&map));
        for row in 0..ROWS as i32 {
            for col in 0..COLS as i32 {
                let (x, z) = centre(&map, row, col);
                let nearest = occupied
                    .iter()
                    .map(|(at_x, at_z)| libm::hypot(x - at_x, z - at_z))
                    .fold(FAR, f64::min);
                let error = nearest - field.distance(x, z);
                assert!(
                    (-1e-6..ROUNDED + 1e-6).contains(&error),
                    "{error} at {row}, {col}"
                );
                *(if nearest < FAR { &mut near } else { &mut far }) += 1;
            }
        }
    }
    assert!(near > 10_000 && far > 1_000, "{near} {far}");
}

#[test]
fn distances_between_centres_change_no_faster_than_one_walks() {
    for (mut draw, map) in rounds() {
        let (field, occupied) = (field(&map), Cells::completed(&map).centres(&map));
        for _ in 0..300 {
            let x = map.first_x() + draw.between(1.0, 63.0);
            let z = map.floor() + draw.between(1.0, 31.0);
            let nearest = occupied
                .iter()
                .map(|(at_x, at_z)| libm::hypot(x - at_x, z - at_z))
                .fold(FAR, f64::min);
            let error = (nearest - field.distance(x, z)).abs();
            assert!(error < 0.75 * CELL, "{error} at {x}, {z}");
        }
    }
}

#[test]
fn the_surface_is_every_occupied_cell_of_the_box_with_a_free_neighbour() {
    let mut inner = 0;
    for (mut draw, map) in rounds() {
        let (field, cells) = (field(&map), Cells::completed(&map));
        for _ in 0..20 {
            let corners = |draw: &mut Draw, low: f64, length: f64| {
                let (a, b) = (draw.between(0.0, length), draw.between(0.0, length));
                [low + a.min(b), low + a.max(b)]
            };
            let (x, z) = (
                corners(&mut draw, map.first_x(), 64.0),
                corners(&mut draw, map.floor(), 32.0),
            );
            let cell = |value: f64, low: f64| libm::floor((value - low) / CELL) as i32;
            let mut expected = Vec::new();
            for row in cell(z[0], map.floor())..=cell(z[1], map.floor()) {
                for col in cell(x[0], map.first_x())..=cell(x[1], map.first_x()) {
                    let free = [(0, 1), (0, -1), (1, 0), (-1, 0)]
                        .iter()
                        .any(|(up, right)| !cells.at(row + up, col + right));
                    if cells.at(row, col) && free {
                        expected.push(centre(&map, row, col));
                    }
                    inner += usize::from(cells.at(row, col) && !free);
                }
            }
            let mut found = Vec::new();
            field.surface(x, z, |x, z| found.push((x, z)));
            assert_eq!(found, expected);
        }
    }
    assert!(inner > 100, "{inner} cells had no free neighbour");
}

#[test]
fn single_cells_read_as_the_map_says() {
    let mut completed = 0;
    for (_, map) in rounds() {
        let (field, cells) = (field(&map), Cells::completed(&map));
        for row in 0..ROWS as i32 {
            for col in 0..COLS as i32 {
                let (x, z) = centre(&map, row, col);
                let unknown = map.row(row as usize).1 >> col & 1 == 1;
                assert_eq!(field.is_occupied(x, z), cells.at(row, col));
                completed += usize::from(cells.at(row, col) && !occupied(&map, row, col));
                assert_eq!(field.is_unknown(x, z), unknown);
            }
        }
    }
    assert!(
        completed > 100,
        "{completed} cells are taken for hidden parts"
    );
}

#[test]
fn beyond_the_window_the_distance_is_that_at_its_edge_and_nothing_is_marked() {
    let map = random_map(&mut Draw::new(3), 100.0, 3);
    let field = field(&map);
    let (right, top) = (map.first_x() + 64.0, map.floor() + 32.0);
    for step in 0..64 {
        let along = 0.5 * f64::from(step) + 0.25;
        let (x, z) = (map.first_x() + along, map.floor() + along);
        for (outside, edge) in [
            ((map.first_x() - 9.0, z), (map.first_x(), z)),
            ((right + 1e6, z), (right, z)),
            ((x, map.floor() - 20.0), (x, map.floor())),
            ((x, top + 0.5), (x, top)),
        ] {
            let (there, here) = (
                field.distance(outside.0, outside.1),
                field.distance(edge.0, edge.1),
            );
            assert!((there - here).abs() < 1e-6, "{outside:?}");
            assert!(!field.is_occupied(outside.0, outside.1));
            assert!(!field.is_unknown(outside.0, outside.1));
        }
    }
}

#[test]
fn a_box_outside_of_the_window_has_no_surface() {
    let map = random_map(&mut Draw::new(5), 100.0, 3);
    let field = field(&map);
    let count = |x: [f64; 2], z: [f64; 2]| {
        let mut count = 0;
        field.surface(x, z, |_, _| count += 1);
        count
    };
    let (right, top) = (map.first_x() + 64.0, map.floor() + 32.0);
    let all = ([map.first_x(), right], [map.floor(), top]);
    let wide = |[low, high]: [f64; 2]| [low - 100.0, high + 100.0];
    assert!(count(all.0, all.1) > 100);
    assert_eq!(count(wide(all.0), wide(all.1)), count(all.0, all.1));
    for x in [
        [right, right + 9.0],
        [map.first_x() - 9.0, map.first_x() - 1e-9],
    ] {
        assert_eq!(count(x, all.1), 0);
    }
    for z in [[top, top + 9.0], [map.floor() - 9.0, map.floor() - 1e-9]] {
        assert_eq!(count(all.0, z), 0);
    }
}

#[test]
fn an_empty_field_is_far_from_everything_and_no_number_is_too_wild() {
    let map = random_map(&mut Draw::new(4), 100.0, 3);
    let empty = DistanceField::new();
    let full = field(&map);
    for wild in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
        for (x, z) in [(wild, 50.0), (100.0, wild), (wild, wild)] {
            for field in [&empty, &full] {
                assert!(!field.is_occupied(x, z));
                assert!(!field.is_unknown(x, z));
                let distance = field.distance(x, z);
                assert!(distance.is_nan() || (0.0..256.0 / 64.0).contains(&distance));
                field.surface([x, x], [z, z], |_, _| panic!("nothing is there"));
            }
        }
    }
    assert!(empty.distance(1.0, 2.0) >= FAR);
}
