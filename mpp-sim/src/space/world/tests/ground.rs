//! Tests of terrain: its questions against the ground at many places, and height maps as files.

#![expect(clippy::float_cmp, reason = "these numbers have no rounding")]

use super::super::body::{length, minus, plus};
use super::super::*;
use super::{direction, draws, within};
use crate::random::{Draws, uniform};

/// A map of 60 m x 40 m with slopes of up to about 1.
fn random_map(draws: &mut Draws) -> Terrain {
    let row = |draws: &mut Draws| (0..13).map(|_| 5.0 * uniform(draws)).collect();
    Terrain {
        corner: [-10.0, -20.0],
        cell: 5.0,
        rows: (0..9).map(|_| row(draws)).collect(),
    }
}

fn over_map(draws: &mut Draws) -> Vector {
    [
        within(-20.0, 60.0, draws),
        within(-30.0, 30.0, draws),
        within(-4.0, 9.0, draws),
    ]
}

#[test]
fn rays_end_where_the_ground_begins() {
    let (mut met, mut missed) = (0, 0);
    for seed in 0..10 {
        let mut draws = draws(seed);
        let world = World::over(random_map(&mut draws), 9.0).unwrap();
        let above = |[x, y, z]: Vector| z - world.ground(x, y);
        for ray in 0..500 {
            let from = over_map(&mut draws);
            let direction = match ray % 10 {
                0 => [0.0, 0.0, -1.0],
                1 => [0.0, -1.0, 0.0],
                2 => [1.0, 0.0, 0.0],
                3 => [0.5_f64.sqrt(), 0.5_f64.sqrt(), 0.0],
                _ => direction(&mut draws),
            };
            let steps = (0..=4000).map(|step| 0.01 * f64::from(step));
            let brute = steps
                .into_iter()
                .find(|way| above(plus(from, direction, *way)) <= 0.0);
            match (world.ray(from, direction, 40.0), brute) {
                (Some(way), Some(brute)) => {
                    assert!(way <= brute + 1e-9 && way > brute - 0.0101, "{way} {brute}");
                    assert!(way == 0.0 || above(plus(from, direction, way)).abs() < 1e-9);
                    met += 1;
                }
                (found, None) => {
                    // Between two steps it may touch an edge.
                    let at = found.map_or(0.0, |way| above(plus(from, direction, way)));
                    assert!(at.abs() < 1e-9);
                    missed += 1;
                }
                (None, Some(brute)) => panic!("missed the ground after {brute} m"),
            }
        }
    }
    assert!(met > 1000 && missed > 1000, "{met} {missed}");
}

#[test]
fn clearances_are_those_of_the_nearest_place_of_the_ground() {
    for seed in 0..6 {
        let mut draws = draws(20 + seed);
        let world = World::over(random_map(&mut draws), 9.0).unwrap();
        for _ in 0..10 {
            let a = over_map(&mut draws);
            let b = plus(a, direction(&mut draws), 1.5);
            let along = (0..=20).map(|share| plus(a, minus(b, a), f64::from(share) / 20.0));
            let along: Vec<Vector> = along.collect();
            let (most, mut brute) = (4.0, [4.0_f64; 2]);
            for x in -110..=110 {
                for y in -110..=110 {
                    let [x, y] = [a[0] + 0.05 * f64::from(x), a[1] + 0.05 * f64::from(y)];
                    let ground = [x, y, world.ground(x, y)];
                    brute[0] = brute[0].min(length(minus(a, ground)));
                    let near = along.iter().map(|at| length(minus(*at, ground)));
                    brute[1] = near.fold(brute[1], f64::min);
                }
            }
            let inside = |[x, y, z]: &Vector| *z <= world.ground(*x, *y);
            let brute = [
                if inside(&a) { 0.0 } else { brute[0] },
                if along.iter().any(inside) {
                    0.0
                } else {
                    brute[1]
                },
            ];
            let found = [
                world.clearance(a, most),
                world.clearance_of_segment(a, b, most),
            ];
            for (found, brute) in found.iter().zip(brute) {
                assert!(
                    found - brute < 1e-9 && brute - found < 0.08,
                    "{found} {brute}"
                );
            }
        }
    }
}

#[test]
fn hills_are_as_steep_as_asked_and_no_steeper() {
    for density in [0.2, 0.5, 1.5] {
        let mut steepest = 0.0_f64;
        for seed in 0..10 {
            let config = WorldConfig {
                density,
                ..WorldConfig::usual(WorldName::Hills, seed)
            };
            let world = config.build().unwrap();
            let terrain = world.terrain().unwrap();
            let [low, top] = terrain.heights();
            assert_eq!(
                (low, world.ground(0.0, 0.0), world.altitude()),
                (0.0, 0.0, 15.0)
            );
            assert_eq!(world.extent().ceiling, top.max(15.0) + 20.0);
            steepest = steepest.max(terrain.steepest());
        }
        assert!((0.85 * density..=density).contains(&steepest), "{steepest}");
    }
}

const GRID: &str = "ncols 3\nNROWS 2\nxllcorner -5\nyllcorner -20\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 5 6.5\n";

#[test]
fn a_survey_lies_with_its_east_ahead() {
    let terrain = ascii_grid("it.asc", GRID).unwrap();
    let rows = vec![vec![1.0, 2.0, 3.0], vec![4.0, 5.0, 6.5]];
    assert_eq!(
        terrain,
        Terrain {
            corner: [0.0, 5.0],
            cell: 10.0,
            rows
        }
    );
    // In the middle of the northern row of cells, 5 m to the left of y = 10.
    let around = ascii_grid("it.asc", &GRID.replace("yllcorner -20", "yllcorner -10")).unwrap();
    assert_eq!(around.corner, [0.0, -5.0]);
    let world = World::over(around, 20.0).unwrap();
    assert_eq!(
        [world.ground(0.0, -5.0), world.ground(0.0, 5.0)],
        [-1.5, 1.5]
    );
    assert_eq!(
        (world.ground(0.0, 0.0), world.extent().ceiling),
        (0.0, 40.0)
    );
}

#[test]
fn a_height_map_that_is_none_is_refused() {
    let refused = |text: &str| ascii_grid("it.asc", text).unwrap_err().to_string();
    for (change, to, told) in [
        ("cellsize 10\n", "", "there is no `cellsize`"),
        (
            "ncols 3",
            "ncols 1",
            "line 1, `ncols`: give a whole number from 2",
        ),
        ("NROWS 2", "NROWS two", "line 2, `two`: give a number"),
        (
            "xllcorner -5",
            "xllcentre -5",
            "line 3, `xllcentre`: give one of the keys",
        ),
        ("4 5", "4 5,0", "line 8, `5,0`: give a number"),
        ("4 5", "4 -9999", "line 8, `-9999`: fill the gaps"),
        ("4 5", "4", "line 8: 5 heights where the header says 6"),
        ("4 5", "4 5 6", "line 8: 7 heights where the header says 6"),
    ] {
        let text = GRID.replace(change, to);
        let found = refused(&text);
        assert!(found.contains(told) && found.contains("it.asc"), "{found}");
    }
    assert!(refused("").contains("there is no `ncols`"));
    let map = random_map(&mut draws(1));
    let over =
        |map: &Terrain, altitude| World::over(map.clone(), altitude).unwrap_err().to_string();
    assert!(over(&map, 0.0).starts_with("altitude: give more than 0"));
    let aside = Terrain {
        corner: [-10.0, 20.0],
        ..map.clone()
    };
    assert!(over(&aside, 9.0).contains("the start at x = y = 0 must lie in the map"));
    let cell = Terrain {
        cell: 0.0,
        ..map.clone()
    };
    assert!(over(&cell, 9.0).starts_with("terrain cell: give"));
    let mut ragged = map.clone();
    ragged.rows[3].pop();
    assert!(over(&ragged, 9.0).contains("all with the same number"));
    let mut holed = map;
    holed.rows[3][2] = f64::NAN;
    assert!(over(&holed, 9.0).contains("give numbers of at most"));
}
