//! Tests of the sweeps: how many points, where they look, when, and with which errors.

use super::*;
use crate::space::Quaternion;
use crate::space::world::{Body, Extent, Vector, World, WorldConfig, WorldName};

fn world(bodies: &[Body]) -> World {
    World::new(bodies.to_vec(), Extent::USUAL).unwrap()
}

fn level(at: Vector) -> Pose {
    Pose {
        at,
        attitude: Quaternion::ONE,
    }
}

/// A plate, `width` by `height`, square to the x axis at a distance \[m\].
fn plate(distance: f64, width: f64, height: f64) -> Body {
    Body::Box {
        least: [distance, -0.5 * width, 500.0 - 0.5 * height],
        most: [distance + 0.1, 0.5 * width, 500.0 + 0.5 * height],
    }
}

const HIGH: Vector = [0.0, 0.0, 500.0];

/// Data sheets: Mid-360 200,000 points a second, Avia 240,000, Ouster OS1 655,360 with 64 lines, Puck 300,000; each sixty-fourth
/// pixel of 640 x 480 at 30 Hz, which are 10 million a second.
#[test]
fn a_sweep_has_the_points_of_the_data_sheet() {
    for (name, per_second, tolerance) in [
        (LidarName::Mid360, 200_000.0, 0.0),
        (LidarName::Avia, 240_000.0, 0.0),
        (LidarName::Os1x32, 655_360.0 / 2.0, 0.0),
        (LidarName::PuckHiRes, 300_000.0, 0.0),
        (LidarName::Depth, 1e7 / 64.0, 0.1),
        (LidarName::Grid90x16, 14_400.0, 0.0),
    ] {
        let config = name.config();
        let sweep = SpaceLidar::new(1, config).sweep_at(&world(&[]), &level(HIGH));
        assert_eq!(sweep.len(), config.beams());
        let rate = sweep.len() as f64 / config.period;
        assert!(
            (rate / per_second - 1.0).abs() <= tolerance + 1e-9,
            "{name}: {rate}"
        );
        assert_eq!(name.name().parse::<LidarName>().unwrap(), name);
    }
}

/// What 0.28 m by 4 m at 30 m return in a frame of 0.1 s, by points per solid angle: 3,500, 16,300, 6,800 and 13,700.
#[test]
fn a_trunk_returns_the_points_of_its_solid_angle() {
    for (name, expected) in [
        (LidarName::Mid360, 4.4),
        (LidarName::Avia, 20.0),
        (LidarName::Os1x32, 8.5),
        (LidarName::PuckHiRes, 17.0),
    ] {
        let config = SpaceLidarConfig {
            false_returns: 0.0,
            ..name.config()
        };
        let mut lidar = SpaceLidar::new(3, config);
        let trunk = world(&[plate(30.0, 0.28, 4.0)]);
        let sweeps = 60;
        let mut points = 0;
        for sweep in 0..sweeps {
            // Rings stand still, 0.7 to 0.76 m from each other there, and their columns up to 0.18 m: the trunk moves.
            let aside = 0.18 * f64::from(sweep % 10) / 10.0;
            let up = 0.73 * f64::from(sweep / 10) / 6.0;
            let sweep = lidar.sweep_at(&trunk, &level([0.0, aside, 500.0 + up]));
            let near = sweep.iter().filter_map(|beam| beam.range);
            points += near.filter(|range| *range < 35.0).count();
        }
        let mean = points as f64 / f64::from(sweeps);
        assert!(
            (mean / expected - 1.0).abs() < 0.1,
            "{name}: {mean}, not {expected}"
        );
    }
}

#[test]
fn views_are_those_of_the_preset() {
    for name in LidarName::ALL {
        let config = name.config();
        let sweep = SpaceLidar::new(2, config).sweep_at(&world(&[]), &level(HIGH));
        let angles = sweep.iter().map(|beam| {
            let [x, y, down] = beam.direction;
            assert!((x * x + y * y + down * down - 1.0).abs() < 1e-12);
            [libm::atan2(y, x), libm::atan2(-down, libm::hypot(x, y))].map(f64::to_degrees)
        });
        let mut seen = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for angle in angles {
            for axis in 0..2 {
                let [low, high] = seen[axis];
                seen[axis] = [low.min(angle[axis]), high.max(angle[axis])];
            }
        }
        for (seen, asked) in seen.into_iter().zip([config.azimuth, config.elevation]) {
            let off = [0, 1].map(|end| (seen[end] - asked[end]).abs());
            assert!(
                off.iter().all(|it| *it < 1.1),
                "{name}: {seen:?}, not {asked:?}"
            );
        }
    }
}

#[test]
fn a_body_to_the_right_and_below_is_seen_there() {
    let ball = world(&[Body::Sphere {
        centre: [10.0, 3.0, 498.0],
        radius: 0.5,
    }]);
    let config = LidarName::Grid90x16.config();
    let seen = |pose: &Pose, config| {
        let sweep = SpaceLidar::new(1, config).sweep_at(&ball, pose);
        let hits = sweep.into_iter().filter(|beam| beam.range.is_some());
        let hits: Vec<Beam> = hits.collect();
        assert!(!hits.is_empty());
        let mean =
            |axis: usize| hits.iter().map(|it| it.direction[axis]).sum::<f64>() / hits.len() as f64;
        [mean(1), mean(2)]
    };
    let [right, down] = seen(&level(HIGH), config);
    assert!(right > 0.2 && down > 0.1);
    // Banked by 90 deg to the right, the right wing is low: what is right comes from above, what is below from the right.
    let banked = Pose {
        at: HIGH,
        attitude: Quaternion::roll(core::f64::consts::FRAC_PI_2),
    };
    let [right, down] = seen(&banked, config);
    assert!(right > 0.1 && down < -0.2);
    // A sensor that is mounted upside down tells the same in the body's axes.
    let inverted = SpaceLidarConfig {
        mount: Quaternion::roll(core::f64::consts::PI),
        ..config
    };
    let [right, down] = seen(&level(HIGH), inverted);
    assert!(right > 0.2 && down > 0.1);
    let ahead = SpaceLidarConfig {
        offset: [2.0, 0.0, 0.0],
        noise: [0.0; 3],
        ..config
    };
    let wall = world(&[plate(20.0, 200.0, 200.0)]);
    let sweep = SpaceLidar::new(1, ahead).sweep_at(&wall, &level(HIGH));
    let nearest = sweep
        .iter()
        .filter_map(|beam| beam.range)
        .fold(50.0, f64::min);
    assert!((18.0..18.02).contains(&nearest), "{nearest}");
}

/// A turning aircraft: each beam leaves from where the aircraft is at its time.
#[test]
fn each_beam_has_the_pose_of_its_time() {
    let forest = WorldConfig::usual(WorldName::Forest, 1).build().unwrap();
    let pose = |time: f64| Pose {
        at: [12.0 * time, 0.0, 7.5],
        attitude: Quaternion::roll(2.0 * time),
    };
    for name in LidarName::ALL {
        let config = SpaceLidarConfig {
            noise: [0.0; 3],
            drop_outs: 0.0,
            false_returns: 0.0,
            ..name.config()
        };
        let [nearest, farthest] = config.range;
        let sweep = SpaceLidar::new(5, config).sweep(&forest, pose, 3.0);
        let mut last = 0.0;
        for beam in &sweep {
            assert!(beam.time >= last && beam.time < config.period, "{name}");
            last = beam.time;
            let then = pose(3.0 + beam.time);
            let ray = forest.ray(then.at, then.direction(beam.direction), farthest);
            assert_eq!(beam.range, ray.filter(|range| *range >= nearest), "{name}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_sweeps() {
    let forest = WorldConfig::usual(WorldName::Forest, 1).build().unwrap();
    let pose = level([0.0, 0.0, 7.5]);
    for name in LidarName::ALL {
        let sweeps = |seed| {
            let mut lidar = SpaceLidar::new(seed, name.config());
            [0; 2].map(|_| lidar.sweep_at(&forest, &pose))
        };
        assert_eq!(sweeps(1), sweeps(1));
        assert_ne!(sweeps(1), sweeps(2));
        // One more body changes the beams that see it, and no other.
        let with_ball = {
            let ball = Body::Sphere {
                centre: [8.0, 0.0, 7.5],
                radius: 0.5,
            };
            world(&[forest.bodies(), &[ball]].concat())
        };
        let other = SpaceLidar::new(1, name.config()).sweep_at(&with_ball, &pose);
        let [first, _] = sweeps(1);
        let pairs = other.iter().zip(&first);
        let changed = pairs.filter(|(one, two)| one != two).count();
        assert!(changed < other.len() / 20, "{name}: {changed}");
    }
}

/// Cells of a degree, within 30 deg ahead, that one sweep and ten of them look into.
#[test]
fn what_is_scattered_or_staggered_sees_more_with_time() {
    let lit = |name: LidarName, sweeps| {
        let mut lidar = SpaceLidar::new(4, name.config());
        let mut cells = std::collections::BTreeSet::new();
        for _ in 0..sweeps {
            for beam in lidar.sweep_at(&world(&[]), &level(HIGH)) {
                let [x, y, down] = beam.direction;
                let cell = [y / x, down / x].map(|it| (60.0 * it).floor() as i32);
                if x > 0.0 && cell.iter().all(|it| it.abs() < 15) {
                    cells.insert(cell);
                }
            }
        }
        cells.len() as f64
    };
    for (name, grows) in [
        (LidarName::Mid360, true),
        (LidarName::Grid90x16, true),
        (LidarName::PuckHiRes, false),
        (LidarName::Depth, false),
    ] {
        let growth = lit(name, 10) / lit(name, 1);
        assert!(
            if grows { growth > 1.2 } else { growth < 1.001 },
            "{name}: {growth}"
        );
    }
}

#[test]
fn errors_have_the_shares_and_the_size_asked() {
    let config = SpaceLidarConfig {
        azimuth: [-1.0, 1.0],
        elevation: [-1.0, 1.0],
        noise: [0.02, 0.001, 1e-4],
        drop_outs: 0.1,
        false_returns: 0.05,
        ..LidarName::Mid360.config()
    };
    let wall = world(&[plate(20.0, 200.0, 200.0)]);
    let sweep = SpaceLidar::new(8, config).sweep_at(&wall, &level(HIGH));
    let ranges: Vec<f64> = sweep.iter().filter_map(|beam| beam.range).collect();
    let beams = sweep.len() as f64;
    let missed = 1.0 - ranges.len() as f64 / beams;
    assert!((missed - 0.95 * 0.1).abs() < 0.01, "{missed}");
    let (close, others): (Vec<f64>, Vec<f64>) = ranges
        .iter()
        .partition(|range| (**range - 20.0).abs() < 0.5);
    let early = others.len() as f64 / beams;
    assert!((early - 0.05).abs() < 0.008, "{early}");
    assert!(others.iter().all(|range| (0.1..20.1).contains(range)));
    let mean = close.iter().sum::<f64>() / close.len() as f64;
    let square = close
        .iter()
        .map(|it| (it - mean) * (it - mean))
        .sum::<f64>();
    let sigma = (square / close.len() as f64).sqrt();
    // 0.02 m, 0.1 % of 20 m, and 1e-4 / m of its square.
    assert!((sigma / 0.08 - 1.0).abs() < 0.05, "{sigma}");
}

#[test]
fn a_flier_keeps_the_beams_ahead_for_which_the_core_has_room() {
    let kept = SpaceLidarConfig::kept("mid-360").unwrap();
    let ahead = SpaceLidarConfig {
        pattern: Pattern::Scattered { beams: 2000 },
        azimuth: [-45.0, 45.0],
        elevation: [2.5, 42.5],
        mount: Quaternion::pitch(-22.5_f64.to_radians()),
        ..LidarName::Mid360.config()
    };
    assert_eq!(kept, ahead);
    // It looks up, so it is tilted down: it sees as much above as below what is ahead.
    let sweep = SpaceLidar::new(1, kept).sweep_at(&world(&[]), &level(HIGH));
    let down = sweep.iter().map(|beam| beam.direction[2]);
    assert!((down.sum::<f64>() / sweep.len() as f64).abs() < 0.05);
    let grid = SpaceLidarConfig::kept("grid-90x16").unwrap();
    assert_eq!(grid, LidarName::Grid90x16.config());
    // Of rings some columns are kept, to the sides too.
    let puck = SpaceLidarConfig::kept("puck-hi-res").unwrap();
    assert_eq!((puck.beams(), puck.azimuth), (2000, [-90.0, 90.0]));
    for (name, advice) in [("depth", "room for 2048 of its"), ("os2", "mid-360")] {
        let refused = SpaceLidarConfig::kept(name).unwrap_err().to_string();
        assert!(refused.contains(advice), "{refused}");
    }
}

/// A plate before a larger one: the first returns stay, and the farther plate is seen behind the near one. Without room for all
/// returns each sweep has a share of them, and in turns none is left out.
#[test]
fn beams_that_see_through_return_what_is_hidden() {
    let two = world(&[plate(10.0, 4.0, 4.0), plate(20.0, 20.0, 20.0)]);
    let of = |most: Option<usize>, sweeps: usize| {
        let mut lidar = SpaceLidar::new(4, LidarName::Grid90x16.config());
        if let Some(most) = most {
            lidar.see_through(most);
        }
        let sweeps = (0..sweeps).map(|_| lidar.sweep_at(&two, &level(HIGH)));
        sweeps.collect::<Vec<_>>()
    };
    let [first] = &of(None, 1)[..] else { panic!() };
    let [all] = &of(Some(10_000), 1)[..] else {
        panic!()
    };
    let near = |beam: &&Beam| beam.range.is_some_and(|range| range < 15.0);
    let hidden = first.iter().filter(near).count();
    assert!(hidden > 50);
    assert_eq!(all.len(), first.len() + hidden);
    for beam in first.iter().filter(near) {
        let behind = all.iter().find(|it| {
            let same = it.direction.map(f64::to_bits) == beam.direction.map(f64::to_bits);
            same && it.range.is_some_and(|range| range > 15.0)
        });
        let [ahead, ..] = beam.direction;
        assert!((behind.unwrap().range.unwrap() * ahead - 20.0).abs() < 1e-9);
    }
    let behind = |sweep: &[Beam]| {
        let far = (sweep.iter().enumerate()).filter(|(at, beam)| {
            let before = at
                .checked_sub(1)
                .map(|at| sweep[at].direction.map(f64::to_bits));
            before == Some(beam.direction.map(f64::to_bits))
        });
        far.map(|(_, beam)| *beam).collect::<Vec<_>>()
    };
    let most = first.len() + hidden / 3;
    // Of 4 returns each sweep has one: that of another number.
    let mut numbers = std::collections::HashSet::new();
    for (sweep, all) in of(Some(most), 4).iter().zip(of(Some(10_000), 4)) {
        let (some, all) = (behind(sweep), behind(&all));
        assert!(sweep.len() <= most && some.len() >= all.len() / 4);
        for beam in some {
            let number = all.iter().position(|it| *it == beam);
            numbers.insert(number.unwrap() % 4);
        }
    }
    assert_eq!(numbers.len(), 4);
}

/// What stands beyond the sight returns nothing, what stands before it is measured as without.
#[test]
fn beams_end_at_the_sight_that_is_asked_for() {
    let two = world(&[plate(10.0, 2.0, 2.0), plate(20.0, 20.0, 20.0)]);
    let returns = |sight| {
        let config = LidarName::Grid90x16.config().seeing(sight).unwrap();
        let sweep = SpaceLidar::new(4, config).sweep_at(&two, &level(HIGH));
        (sweep.iter().filter_map(|beam| beam.range)).collect::<Vec<_>>()
    };
    let all = returns(None);
    let near: Vec<f64> = all.iter().copied().filter(|it| *it < 15.0).collect();
    assert!(!near.is_empty() && near.len() < all.len());
    assert_eq!(returns(Some(15.0)), near);
    assert_eq!(returns(Some(300.0)), all);
}
