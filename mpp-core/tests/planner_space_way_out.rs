//! Ways out of plans in space: circles over one place, in what the map has seen free.

use super::planner_space::{Draw, KEEP, finish, level, model, plan, to_trunks, with_planner};
use core::f64::consts::TAU;
use mpp_core::map::{SpaceBeam, VoxelGrid};
use mpp_core::planner::space::{Keep, SpacePlanner, WayOut, next_start_on_circle};
use mpp_core::vehicle::{Loiter, SPACE_STATES, SpacePath, within_half_turn};
use rand_core::SeedableRng;
use rand_pcg::Pcg64Mcg;

const SIGHT: f64 = 90.0;

/// Shows trunks `(x, y, radius)` by level beams all around, from places on the way to the start.
fn show(map: &mut VoxelGrid, trunks: &[[f64; 3]]) {
    show_to(map, [0.0; 2], trunks);
}

/// As [`show`], from places up to `(x, y)`.
fn show_to(map: &mut VoxelGrid, [x, y]: [f64; 2], trunks: &[[f64; 3]]) {
    for back in (0..12).rev() {
        let from = x - 2.0 * f64::from(back);
        let moved: Vec<_> = (trunks.iter())
            .map(|[x, there, r]| [x - from, there - y, *r])
            .collect();
        let beams: Vec<SpaceBeam> = (0..2160)
            .map(|at| {
                let (side, ahead) = libm::sincos(f64::from(at) * TAU / 720.0);
                let up = 0.01 * f64::from(at / 720 - 1);
                let flat = libm::sqrt(1.0 - up * up);
                let direction = [flat * ahead, flat * side, up];
                let range = Some(to_trunks(&moved, &direction)).filter(|it| *it < SIGHT);
                SpaceBeam { direction, range }
            })
            .collect();
        map.insert(&[from, y, 7.5], beams.iter().copied(), SIGHT);
    }
}

fn least(trunks: &[[f64; 3]], at: &SpacePath) -> f64 {
    let [x, y, _] = at.position;
    let gaps = trunks
        .iter()
        .map(|[tx, ty, radius]| libm::hypot(tx - x, ty - y) - radius);
    gaps.fold(f64::INFINITY, f64::min)
}

fn way_out(map: &mut VoxelGrid, planner: &mut SpacePlanner, trunks: &[[f64; 3]]) -> Option<WayOut> {
    map.clear(-30.0);
    map.cover(&KEEP.heights, KEEP.altitude);
    show(map, trunks);
    let _ = plan(planner, map, &level(&model()), 0.0);
    planner.way_out().copied()
}

/// In winds of up to half of the airspeed: what moves as the circle says stays on it, at the airspeed of level flight, and turns as
/// its bank and its lift do.
#[test]
fn a_circle_stays_over_one_place_in_any_wind() {
    let mut draw = Draw(Pcg64Mcg::seed_from_u64(21));
    for round in 0..200 {
        let mut model = model();
        let (wind, from) = (draw.between(0.0, 6.0), draw.between(-3.0, 3.0));
        model.wind = [wind * libm::cos(from), wind * libm::sin(from), 0.0];
        let start = SpacePath {
            course: draw.between(-3.0, 3.0),
            ..level(&model)
        };
        let side = if round % 2 == 0 { 1.0 } else { -1.0 };
        let loiter = Loiter::joined(&model, &start, side, 7.5).unwrap();
        let (angle, short) = (draw.between(-3.0, 3.0), 1e-4);
        let [before, at, after] =
            [-short, 0.0, short].map(|time| loiter.at(&model, loiter.later(&model, angle, time)));
        let velocity = at.ground_velocity(&model.wind);
        for axis in 0..3 {
            let moved = (after.position[axis] - before.position[axis]) / (2.0 * short);
            assert!(
                (moved - velocity[axis]).abs() < 1e-3,
                "{axis}: {moved} {velocity:?}"
            );
        }
        assert!((at.airspeed - model.trim.state.airspeed).abs() < 1e-9);
        let turned = within_half_turn(after.course - before.course) / (2.0 * short);
        let rates = at.after(&model, &loiter.control(&model, &at), short);
        let flown = (rates.course - at.course) / short;
        // The model has the thrust's part of the lift besides.
        assert!(
            (turned - flown).abs() < 0.05 * flown.abs(),
            "{turned} {flown}"
        );
        assert!(turned * side > 0.0 && at.bank.abs() < model.bank);
    }
}

/// In winds of up to half of the airspeed: the next start on a circle is as far from the centre as what is flown, as far around as the
/// deviation is along, and turned as far. What is across moves nothing.
#[test]
fn the_next_start_stays_on_the_circle() {
    let mut draw = Draw(Pcg64Mcg::seed_from_u64(23));
    for _ in 0..200 {
        let mut model = model();
        model.wind = [draw.between(-4.0, 4.0), draw.between(-4.0, 4.0), 0.0];
        let loiter = Loiter::joined(&model, &level(&model), 1.0, 7.5).unwrap();
        let angle = draw.between(-3.0, 3.0);
        let (at, (sin, cos)) = (loiter.at(&model, angle), libm::sincos(angle));
        let [along, across] = [draw.between(-2.0, 2.0), draw.between(-2.0, 2.0)];
        let mut deviation = [0.0; SPACE_STATES];
        deviation[..2].copy_from_slice(&[across * cos - along * sin, across * sin + along * cos]);
        let next = next_start_on_circle(&at, &deviation, &loiter);
        let turned = along / loiter.radius;
        let place = loiter.place(angle + turned);
        let off = (0..3).map(|axis| libm::fabs(next.position[axis] - place[axis]));
        assert!(off.fold(0.0, f64::max) < 1e-9, "{next:?} {place:?}");
        assert!(libm::fabs(next.course - at.course - turned) < 1e-9);
        let (position, course) = (next.position, next.course);
        assert_eq!(
            next,
            SpacePath {
                position,
                course,
                ..at
            }
        );
    }
}

/// In country as open as one trunk in 200 m^2: each way out that is found is clear of the trunks, up to its circle and all around.
#[test]
fn ways_out_are_clear_of_the_trunks() {
    with_planner(KEEP, |map, planner| {
        let mut draw = Draw(Pcg64Mcg::seed_from_u64(22));
        let (mut found, model) = (0, model());
        for _ in 0..16 {
            let trunks: Vec<[f64; 3]> = (0..30)
                .map(|_| [draw.between(8.0, 70.0), draw.between(-50.0, 50.0), 0.3])
                .collect();
            let Some(way_out) = way_out(map, planner, &trunks) else {
                continue;
            };
            found += 1;
            assert!(way_out.holds > 0.0);
            let knots = way_out.plan.knots.iter();
            let ring = (0..120).map(|at| way_out.loiter.at(&model, TAU * f64::from(at) / 120.0));
            for at in knots.copied().chain(ring) {
                assert!(least(&trunks, &at) > 0.4, "{at:?}");
            }
            let [.., last] = &way_out.plan.knots;
            let [x, y, _] = way_out.loiter.centre;
            let off = libm::hypot(last.position[0] - x, last.position[1] - y);
            assert!((off - way_out.loiter.radius).abs() < 1.0, "{off}");
        }
        assert!(found >= 8, "{found}");
    });
}

/// Where nobody has looked, and between rows of trunks that leave no room for a circle, there is none.
#[test]
fn there_is_no_way_out_of_the_unknown_or_of_a_lane() {
    with_planner(KEEP, |map, planner| {
        map.clear(0.0);
        map.cover(&KEEP.heights, KEEP.altitude);
        let _ = plan(planner, map, &level(&model()), 0.0);
        assert_eq!(planner.way_out(), None);
        let lane = |at: i32| [f64::from(at / 2), if at % 2 == 0 { 6.0 } else { -6.0 }, 0.4];
        let lane: Vec<_> = (0..160).map(lane).collect();
        assert_eq!(way_out(map, planner, &lane), None);
        assert!(way_out(map, planner, &[]).is_some());
    });
}

/// A way out that is flown is lost once a trunk is seen on its circle, and not by one beside it.
#[test]
fn a_trunk_on_the_circle_ends_a_way_out() {
    with_planner(KEEP, |map, planner| {
        let found = way_out(map, planner, &[]).unwrap();
        planner.hold();
        let [x, y, _] = found.loiter.centre;
        for (share, holds) in [(1.6, true), (1.0, false)] {
            // The side that is seen lies on the circle.
            let near = x + share * found.loiter.radius;
            show(map, &[[near + 0.3, y, 0.3]]);
            planner.begin(&level(&model()), 0.0);
            assert_eq!(planner.held(), None, "nobody has looked");
            finish(planner, map);
            assert_eq!(planner.held().is_some(), holds, "{share}");
            assert!(!planner.is_lost(), "{share}");
        }
    });
}

/// Where a trunk comes up close on the way to the circle, the best plan is flown, also if it meets a wall later.
#[test]
fn a_way_out_that_meets_something_first_is_given_up() {
    with_planner(KEEP, |map, planner| {
        let _ = way_out(map, planner, &[]).unwrap();
        planner.hold();
        let wall = (0..240).map(|at| [30.0, 0.5 * f64::from(at) - 60.0, 0.3]);
        show(map, &wall.chain([[13.0, 0.2, 0.3]]).collect::<Vec<_>>());
        planner.begin(&level(&model()), 0.0);
        finish(planner, map);
        assert!(!planner.is_lost() && planner.held().is_none());
    });
}

/// A circle does not leave the band.
#[test]
fn a_narrow_band_has_no_way_out() {
    let half_width = 12.0;
    with_planner(Keep { half_width, ..KEEP }, |map, planner| {
        assert_eq!(way_out(map, planner, &[]), None);
    });
}

/// On the circle a trunk 60 deg ahead ends it, and one that is nearly half a turn ahead does not yet. Where the best plan meets a
/// wall, it is flown on and told as lost.
#[test]
fn a_circle_is_left_for_what_is_near_ahead() {
    with_planner(KEEP, |map, planner| {
        for (ahead, walled, held) in [
            (170.0_f64, false, true),
            (60.0, false, false),
            (60.0, true, true),
        ] {
            let found = way_out(map, planner, &[]).unwrap();
            planner.hold();
            let since = found.plan.length() - 0.1;
            let start = found.plan.at(&model(), since).0;
            let loiter = &found.loiter;
            let angle = loiter.angle(&start.position) + loiter.side * ahead.to_radians();
            let [x, y, _] = loiter.place(angle);
            let wall = (-60..60).filter(|_| walled).map(|at| {
                let (sin, cos) = libm::sincos(start.course + 0.03 * f64::from(at));
                let [x, y, _] = start.position;
                [x + 12.0 * cos, y + 12.0 * sin, 0.3]
            });
            let trunks: Vec<_> = wall.chain([[x, y, 0.3]]).collect();
            show_to(map, [start.position[0], start.position[1]], &trunks);
            planner.begin(&start, since);
            finish(planner, map);
            assert_eq!(
                [planner.held().is_some(), planner.is_lost()],
                [held, walled],
                "{ahead}"
            );
        }
    });
}

/// A cycle that is cut short before it has looked at what is flown leaves the time until the turn as it was.
#[test]
fn a_cycle_that_is_cut_short_moves_no_way_out() {
    with_planner(KEEP, |map, planner| {
        let (step, model) = (0.1, model());
        // Calls of the search until the way out that is flown has been looked at.
        let mut calls = 0;
        for cut in 0..4 {
            let found = way_out(map, planner, &[]).unwrap();
            planner.hold();
            planner.begin(&found.plan.at(&model, step).0, step);
            let mut made = 0;
            while planner.held().is_none() && (cut == 0 || made < calls - cut) {
                assert!(!planner.advance(map));
                made += 1;
            }
            calls = calls.max(made);
            assert_eq!(planner.held().is_some(), cut == 0);
            let since = if cut == 0 { step } else { 2.0 * step };
            assert_eq!(planner.way_out(), None, "{cut}");
            planner.refuse();
            planner.begin(&found.plan.at(&model, 2.0 * step).0, since);
            finish(planner, map);
            let held = planner.held().unwrap();
            let off = held.holds - (found.holds - 2.0 * step);
            assert!(off.abs() < 1e-9, "{cut}: {off}");
        }
    });
}

/// Beams that pass a thin trunk in its cell do not hide it, and the window keeps what lies 30 m behind the aircraft.
#[test]
fn the_level_of_flight_keeps_thin_trunks() {
    let mut map = Box::new(VoxelGrid::new());
    map.clear(0.0);
    map.cover(&KEEP.heights, KEEP.altitude);
    let trunk = [20.2, 3.3, 7.5];
    let beam = |to: [f64; 3], hits: bool| {
        let range = libm::sqrt(to.iter().map(|it| it * it).sum());
        let direction = to.map(|it| it / range);
        let range = hits.then_some(range);
        SpaceBeam { direction, range }
    };
    let past: Vec<_> = (0..9)
        .map(|at| beam([20.2, 3.15 + 0.02 * f64::from(at), 0.0], false))
        .collect();
    for scan in 0..10 {
        let hit = (scan % 2 == 0).then(|| beam([20.2, 3.3, 0.0], true));
        let beams = past.iter().copied().chain(hit);
        map.insert(&[0.0, 0.0, 7.5], beams, SIGHT);
    }
    assert!(map.is_met(&trunk, 0.1) == Some(true) && !map.is_free(&trunk, 0.1));
    assert_eq!(
        map.is_met(&[20.2, 45.0, 7.5], 0.1),
        None,
        "beyond the window"
    );
    assert!(map.is_free(&[12.2, 1.8, 7.5], 0.1));
    assert!(
        !map.is_free(&[12.2, 1.8, 9.5], 0.1),
        "it has left the level"
    );
    for x in [20.0, 44.0, 20.0, 0.0] {
        map.insert(&[x, 0.0, 7.5], std::iter::empty(), SIGHT);
    }
    assert!(map.is_met(&trunk, 0.1) == Some(true) && map.is_free(&[12.2, 1.8, 7.5], 0.1));
}
