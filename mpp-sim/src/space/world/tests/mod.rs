//! Tests of bodies, and of the queries against every body at once.

mod drawn;
mod ground;

use super::body::{length, minus, plus};
use super::*;
use crate::random::{self, Draws, Stream, gaussian, uniform};

const BIG: Extent = Extent {
    length: 100.0,
    half_width: 50.0,
    ceiling: 30.0,
};

fn draws(seed: u64) -> Draws {
    random::generator(seed, Stream::Scene)
}

fn within(least: f64, most: f64, draws: &mut Draws) -> f64 {
    least + (most - least) * uniform(draws)
}

fn place(draws: &mut Draws) -> Vector {
    [
        within(-20.0, 120.0, draws),
        within(-60.0, 60.0, draws),
        within(0.0, 30.0, draws),
    ]
}

fn direction(draws: &mut Draws) -> Vector {
    let vector = [gaussian(draws), gaussian(draws), gaussian(draws)];
    let size = length(vector);
    vector.map(|part| part / size)
}

/// A body of each kind in turn, some of them large and some without a top.
fn body(number: usize, draws: &mut Draws) -> Body {
    let [x, y, z] = place(draws);
    let radius = within(0.05, 1.0, draws);
    let size = [0, 1, 2].map(|_| within(0.2, 8.0, draws));
    match number % 5 {
        0 => Body::Cylinder {
            x,
            y,
            radius,
            height: f64::INFINITY,
        },
        1 => Body::Cylinder {
            x,
            y,
            radius,
            height: z + 0.1,
        },
        2 => Body::Capsule {
            from: [x, y, z],
            to: plus([x, y, z], direction(draws), within(0.0, 12.0, draws)),
            radius,
        },
        3 => Body::Sphere {
            centre: [x, y, z],
            radius,
        },
        _ => Body::Box {
            least: [x, y, z],
            most: plus([x, y, z], size, 1.0),
        },
    }
}

fn random_world(seed: u64, count: usize) -> World {
    let mut draws = draws(seed);
    let bodies = (0..count).map(|number| body(number, &mut draws)).collect();
    World::new(bodies, BIG).unwrap()
}

#[test]
fn rays_meet_what_any_body_shows() {
    for seed in 0..20 {
        let world = random_world(seed, 10 * seed as usize);
        let mut draws = draws(100 + seed);
        for ray in 0..500 {
            let from = place(&mut draws);
            let direction = match ray % 10 {
                0 => [0.0, 0.0, 1.0],
                1 => [0.0, -1.0, 0.0],
                2 => [1.0, 0.0, 0.0],
                _ => direction(&mut draws),
            };
            let ground = (direction[2] < 0.0).then(|| from[2] / -direction[2]);
            let hits = world
                .bodies()
                .iter()
                .filter_map(|it| it.hit(from, direction));
            let nearest = hits.chain(ground).fold(f64::INFINITY, f64::min);
            for most in [7.0, 60.0, 500.0] {
                let expected = (nearest <= most).then_some(nearest);
                assert_eq!(world.ray(from, direction, most), expected, "{seed} {ray}");
            }
        }
    }
}

#[test]
fn clearances_are_those_of_the_nearest_body() {
    for seed in 0..20 {
        let world = random_world(seed, 10 * seed as usize);
        let mut draws = draws(200 + seed);
        for _ in 0..500 {
            let a = place(&mut draws);
            let b = plus(a, direction(&mut draws), within(0.0, 5.0, &mut draws));
            let all = world.bodies().iter();
            let point = all.clone().map(|it| it.clearance(a)).fold(a[2], f64::min);
            let segment = all.map(|it| it.clearance_of_segment(a, b));
            let segment = segment.fold(a[2].min(b[2]).max(0.0), f64::min);
            for most in [0.5, 6.0, f64::INFINITY] {
                let found = [
                    world.clearance(a, most),
                    world.clearance_of_segment(a, b, most),
                ];
                let expected = [point.min(most), segment.min(most)];
                assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
            }
        }
    }
}

/// A march by the distance knows nothing of the equations of a ray.
#[test]
fn a_ray_ends_where_the_distance_vanishes() {
    let mut draws = draws(1);
    let mut hits = 0;
    for number in 0..4000 {
        let body = body(number, &mut draws);
        let from = place(&mut draws);
        // Towards a point near the body.
        let aim = plus(
            minus(from, body.separation(from)),
            direction(&mut draws),
            0.5,
        );
        let way = minus(aim, from);
        let direction = way.map(|part| part / length(way));
        let mut marched = 0.0;
        while marched < 300.0 && body.clearance(plus(from, direction, marched)) > 1e-9 {
            marched += body.clearance(plus(from, direction, marched)).max(1e-9);
        }
        match body.hit(from, direction) {
            Some(hit) => {
                assert!(
                    body.clearance(plus(from, direction, hit)) < 1e-9,
                    "{body:?}"
                );
                assert!(marched <= hit + 1e-6, "{body:?}: {marched} {hit}");
                // A ray that grazes is at once near and slow to arrive.
                assert!(hit - marched < 1e-3, "{body:?}: {marched} {hit}");
                hits += 1;
            }
            None => assert!(marched >= 300.0 || grazes(&body, from, direction, marched)),
        }
    }
    assert!(hits > 1000, "{hits}");
}

/// Whether a ray passes a body within the rounding of a march.
fn grazes(body: &Body, from: Vector, direction: Vector, marched: f64) -> bool {
    let ahead = (0..1000).map(|step| marched + 1e-6 * f64::from(step));
    let mut deepest = ahead.map(|way| body.clearance(plus(from, direction, way)));
    deepest.all(|distance| distance > 0.0)
}

#[test]
fn the_distance_of_a_segment_is_the_least_of_its_points() {
    let mut draws = draws(2);
    for number in 0..2000 {
        let body = body(number, &mut draws);
        let middle = plus(place(&mut draws), [0.0; 3], 1.0);
        let near = plus(
            middle,
            body.separation(middle),
            -within(0.8, 1.0, &mut draws),
        );
        let along = direction(&mut draws).map(|part| 2.0 * part);
        let (a, b) = (minus(near, along), plus(near, along, 1.0));
        let points = (0..=4000).map(|step| plus(a, minus(b, a), f64::from(step) / 4000.0));
        let sampled = points
            .map(|at| body.clearance(at))
            .fold(f64::INFINITY, f64::min);
        let found = body.clearance_of_segment(a, b);
        assert!(found <= sampled + 1e-12, "{body:?}: {found} {sampled}");
        assert!(found >= sampled - 0.0006, "{body:?}: {found} {sampled}");
    }
}

#[test]
fn bodies_have_the_distances_of_geometry() {
    let trunk = Body::Cylinder {
        x: 10.0,
        y: 0.0,
        radius: 1.0,
        height: 5.0,
    };
    let wire = Body::Capsule {
        from: [0.0, -10.0, 8.0],
        to: [0.0, 10.0, 8.0],
        radius: 0.5,
    };
    let house = Body::Box {
        least: [20.0, 20.0, 0.0],
        most: [30.0, 30.0, 6.0],
    };
    let ball = Body::Sphere {
        centre: [0.0, 0.0, 10.0],
        radius: 2.0,
    };
    let [ahead, up] = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    for (body, from, direction, hit, clearance) in [
        (trunk, [0.0, 0.0, 1.0], ahead, Some(9.0), 9.0),
        (trunk, [0.0, 0.0, 5.5], ahead, None, 81.25_f64.sqrt()),
        (trunk, [10.0, 0.5, 9.0], [0.0, 0.0, -1.0], Some(4.0), 4.0),
        (trunk, [6.0, 0.0, 9.0], ahead, None, 5.0),
        (trunk, [10.5, 0.0, 2.0], ahead, Some(0.0), 0.0),
        (trunk, [12.0, 0.0, 2.0], ahead, None, 1.0),
        (wire, [-3.0, 9.0, 8.0], ahead, Some(2.5), 2.5),
        (wire, [0.0, 14.0, 8.0], [0.0, -1.0, 0.0], Some(3.5), 3.5),
        (wire, [0.0, 5.0, 0.0], up, Some(7.5), 7.5),
        (house, [15.0, 25.0, 3.0], ahead, Some(5.0), 5.0),
        (house, [17.0, 16.0, 3.0], ahead, None, 5.0),
        (house, [25.0, 25.0, 9.0], up, None, 3.0),
        (ball, [0.0, 0.0, 1.0], up, Some(7.0), 7.0),
        (ball, [0.0, 0.0, 13.0], up, None, 1.0),
    ] {
        assert_eq!(body.hit(from, direction), hit, "{body:?} {from:?}");
        assert!((body.clearance(from) - clearance).abs() < 1e-12, "{body:?}");
    }
    // A wing that leans past the top of a trunk at 45 deg.
    let wing = ([8.0, 0.0, 9.0], [14.0, 0.0, 3.0]);
    let expected = (11.0 + 5.0 - 17.0_f64).abs() / 2.0_f64.sqrt();
    assert!((trunk.clearance_of_segment(wing.0, wing.1) - expected).abs() < 1e-12);
    assert!(trunk.clearance_of_segment([8.0, 0.0, 2.0], [14.0, 0.0, 2.0]) < 1e-12);
}

#[test]
fn an_unsound_body_is_refused_by_number_and_key() {
    let sphere = |z, radius| Body::Sphere {
        centre: [1.0, 2.0, z],
        radius,
    };
    let flat = Body::Box {
        least: [0.0; 3],
        most: [1.0, 0.0, 1.0],
    };
    for (bad, told) in [
        (sphere(f64::NAN, 1.0), "body 2, centre: give numbers"),
        (sphere(1.0, -1.0), "body 2, radius: give more than 0"),
        (sphere(1.0, f64::NAN), "body 2, radius: give more than 0"),
        (flat, "body 2, most: give more than `least`"),
    ] {
        let bodies = vec![sphere(1.0, 1.0), bad];
        let error = World::new(bodies, BIG).unwrap_err().to_string();
        assert!(error.starts_with(told), "{error}");
    }
    let no_width = Extent {
        half_width: 0.0,
        ..BIG
    };
    let error = World::new(Vec::new(), no_width).unwrap_err().to_string();
    assert!(error.starts_with("half width: give more"), "{error}");
}
