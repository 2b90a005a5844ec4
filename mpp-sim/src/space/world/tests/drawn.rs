//! Tests of the generators, of stem maps and of the figures of worlds.

use super::super::body::{length, minus};
use super::super::*;
use super::BIG;

#[test]
fn the_same_seed_draws_the_same_world() {
    for name in WorldName::ALL {
        let drawn = |seed| WorldConfig::usual(name, seed).build().unwrap();
        let text = |seed| format!("{:?} {:?}", drawn(seed).bodies(), drawn(seed).terrain());
        assert_eq!(text(7), text(7));
        assert_ne!(text(7), text(8));
        assert_eq!(name.name().parse::<WorldName>().unwrap(), name);
        // Nothing stands about the start.
        assert!(
            drawn(7).clearance([0.0, 0.0, 7.5], 20.0) >= 7.5 - 1e-9,
            "{name}"
        );
        for density in [0.0, -1.0, f64::NAN, 2.0] {
            let config = WorldConfig {
                density,
                ..WorldConfig::usual(name, 7)
            };
            let error = config.build().unwrap_err().to_string();
            assert!(
                error.starts_with("density: give more than 0 and at most"),
                "{error}"
            );
        }
    }
}

/// The number of trunks over 20 seeds, beside the density; of a Poisson process also its variance.
#[test]
fn trunks_are_as_dense_as_asked() {
    let area = 310.0 * 80.0 - core::f64::consts::PI * 15.28 * 15.28;
    for name in [WorldName::Forest, WorldName::Grid, WorldName::Disc] {
        let counts = (0..20).map(|seed| {
            let world = WorldConfig::usual(name, seed).build().unwrap();
            world.bodies().len() as f64
        });
        let mean = counts.sum::<f64>() / 20.0;
        // The free circle lies in the area but for what is behind its first 10 m.
        assert!((mean / (0.04 * area) - 1.0).abs() < 0.03, "{name}: {mean}");
    }
}

#[test]
fn discs_keep_their_distance() {
    let world = WorldConfig::usual(WorldName::Disc, 3).build().unwrap();
    let axes: Vec<Vector> = (world.bodies().iter())
        .map(|body| match body {
            Body::Cylinder { x, y, .. } => [*x, *y, 0.0],
            other => panic!("{other:?}"),
        })
        .collect();
    let least = (0..axes.len())
        .flat_map(|one| (0..one).map(move |other| (one, other)))
        .map(|(one, other)| length(minus(axes[one], axes[other])))
        .fold(f64::INFINITY, f64::min);
    assert!((3.75..3.80).contains(&least), "{least}");
}

#[test]
fn each_wall_has_one_window() {
    let usual = WorldConfig::usual(WorldName::Walls, 5);
    let world = usual.build().unwrap();
    assert_eq!(world.bodies().len(), 4 * 7);
    let open = |world: &World, x: f64| {
        let (mut area, ahead) = (0.0, [1.0, 0.0, 0.0]);
        for y in -300..=300 {
            for z in 0..150 {
                let from = [x - 5.0, 0.1 * f64::from(y), 0.1 * f64::from(z) + 0.05];
                area += f64::from(world.ray(from, ahead, 10.0).is_none()) * 0.01;
            }
        }
        area
    };
    for wall in 1..=6 {
        assert!((open(&world, 40.0 * f64::from(wall)) - 25.0).abs() < 0.6);
    }
    let of = |window| WorldConfig { window, ..usual }.build();
    assert!((open(&of(3.0).unwrap(), 80.0) - 9.0).abs() < 0.4);
    for window in [0.1, 11.0, f64::NAN] {
        let refused = of(window).unwrap_err().to_string();
        assert!(refused.contains("give 0.5 to 10 m"), "{refused}");
    }
}

/// `1 / (2 w density)`, where `w` is half of the span and the mean radius.
#[test]
fn the_mean_free_path_is_that_of_a_poisson_forest() {
    let mut paths = 0.0;
    for seed in 0..10 {
        let world = WorldConfig::usual(WorldName::Forest, seed).build().unwrap();
        paths += world.mean_free_path(0.7, 7.5).unwrap() / 10.0;
    }
    let expected = 1.0 / (2.0 * (0.7 + 0.275 + 0.01) * 0.04);
    assert!((paths / expected - 1.0).abs() < 0.1, "{paths} {expected}");
    let empty = World::new(Vec::new(), BIG).unwrap();
    assert_eq!(empty.mean_free_path(0.7, 7.5), None);
    assert_eq!(empty.traversability(7.5), Some(40.0));
}

#[test]
fn a_stem_map_is_read_or_refused() {
    let map = "Tree,Y,x,diameter,height\n1,-2.5,3,0.4,20\n\n2,1,8.5,0.2,12\n";
    let trunk = |x, y, radius, height| Body::Cylinder {
        x,
        y,
        radius,
        height,
    };
    assert_eq!(
        stems("waka", map).unwrap(),
        [trunk(3.0, -2.5, 0.2, 20.0), trunk(8.5, 1.0, 0.1, 12.0)]
    );
    let endless = stems("a", "x,y,diameter\n1,2,0.5\n").unwrap();
    assert_eq!(endless, [trunk(1.0, 2.0, 0.25, f64::INFINITY)]);
    for (text, told) in [
        ("", "line 1: there is no column `x`"),
        ("x,y\n1,2\n", "line 1: there is no column `diameter`"),
        ("x,y,diameter\n", "a.csv holds no trunk"),
        (
            "x,y,diameter\n1,2,nan\n",
            "line 2, diameter `nan`: give a number",
        ),
        ("x,y,diameter\n1,2\n", "line 2, diameter ``: give a number"),
        (
            "x,y,diameter\n1,2,1\n1,2,-1\n",
            "line 3, diameter `-1`: give more than 0",
        ),
        (
            "x,y,diameter\n1,2,0\n",
            "line 2, diameter `0`: give more than 0",
        ),
        (
            "x,y,diameter\n580000,2,1\n",
            "line 2, x `580000`: give at most 100000 m: subtract",
        ),
        (
            "x,y,diameter,height\n1,2,1,-4\n",
            "line 2, height `-4`: give more",
        ),
        ("x;y;diameter\n1;2;1\n", "line 1: there is no column `x`"),
    ] {
        let error = stems("a.csv", text).unwrap_err().to_string();
        assert!(
            error.starts_with("stem map a.csv") && error.contains(told),
            "{error}"
        );
    }
}
