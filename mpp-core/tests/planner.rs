//! Tests the planner: plans around obstacles, plans back to the altitude, and the report when there
//! is no plan.

use crate::common::planning::{FEASIBLE, SCATTERED, level, plan, planner, presets, with_planner};
use crate::common::world::{Disc, clearance, scan};
use mpp_core::config::{KNOTS, STAGE_PERIOD};
use mpp_core::planner::{Planner, Verdict};
use mpp_core::settings::{PlannerSettings, Settings};

#[test]
fn nothing_in_the_way_is_flown_straight_and_level() {
    // The authors' rays end at the edge of their window, which keeps their plans a little back.
    for (settings, tolerance, most_cost) in [
        (Settings::reference(), 3.0, 1e4),
        (Settings::paper(), 1e-6, 1e-9),
        (Settings::flight(), 1e-6, 1e-9),
    ] {
        let mut planner = planner(&settings);
        let state = level(&planner);
        assert_eq!(plan(&mut planner, &state, &[]), Verdict::Feasible);
        let trim = *planner.trim();
        let best = planner.best();
        assert!((best.start - 3.0).abs() < 1e-12);
        for (stage, knot) in best.knots.iter().enumerate() {
            let x = 100.0 + trim.state.airspeed * STAGE_PERIOD * stage as f64;
            assert!((knot.state.x - x).abs() < tolerance);
            assert!((knot.state.z - 50.0).abs() < tolerance);
            let off = (knot.state.air.to_vector() - trim.state.to_vector()).amax();
            assert!(off < tolerance, "{off}");
            assert!((knot.feedforward.thrust - trim.control.thrust).abs() < tolerance);
        }
        let summary = planner.summary();
        assert!(summary.complete && summary.cost < most_cost);
        assert!(summary.violation <= FEASIBLE);
    }
}

#[test]
fn plans_lead_around_obstacles() {
    for settings in presets() {
        let mut planner = planner(&settings);
        let state = level(&planner);
        let wall = [(128.0, 50.0, 3.0)];
        assert_eq!(plan(&mut planner, &state, &wall), Verdict::Feasible);
        let through = planner
            .best()
            .knots
            .map(|knot| clearance(&wall, knot.state.x, knot.state.z));
        assert!(
            through.iter().all(|clearance| *clearance > 0.5),
            "{through:?}"
        );
        assert!(
            planner.summary().cost > 0.01,
            "a way around costs something"
        );
    }
}

#[test]
fn plans_return_to_the_altitude() {
    for settings in presets() {
        for off in [-6.0, 4.0] {
            let mut planner = planner(&settings);
            let mut state = level(&planner);
            state.z += off;
            assert_eq!(plan(&mut planner, &state, &[]), Verdict::Feasible);
            let end = planner.best().knots[KNOTS - 1].state.z;
            assert!((end - 50.0).abs() < 0.5 * f64::abs(off), "{end} from {off}");
        }
    }
}

#[test]
fn hard_rows_that_cannot_hold_give_nothing_and_soft_ones_what_strikes_latest() {
    // The discs are nearer to the first collocation point than the padding. No path has a say on
    // this point, and the wall behind it is too high to climb.
    let near: Vec<Disc> = (0..30).map(|i| (112.0, 36.0 + f64::from(i), 1.0)).collect();
    let mut hard = planner(&Settings::paper());
    let state = level(&hard);
    assert_eq!(plan(&mut hard, &state, &near), Verdict::Nothing);
    assert!(hard.summary().cost == f64::INFINITY);

    let close = [(106.0, 50.0, 2.0)];
    let mut soft = planner(&Settings::flight());
    let mut hard = planner(&Settings::paper());
    assert_eq!(plan(&mut hard, &state, &close), Verdict::Nothing);
    // The disc is 4 m ahead: whatever the aircraft flies strikes it.
    assert_eq!(plan(&mut soft, &state, &close), Verdict::Latest);
    let summary = soft.summary();
    assert!(
        summary.violation > FEASIBLE && summary.violation < 5.0,
        "{summary:?}"
    );
    assert_eq!(summary.feasible, 0);
}

#[test]
fn the_baseline_follows_the_shortest_path_at_cruise_speed() {
    let paper = Settings::paper();
    let baseline = with_planner(
        paper,
        PlannerSettings {
            paths: 0,
            ..paper.planner
        },
    );
    let mut planner = planner(&baseline);
    let state = level(&planner);
    let wall = [(128.0, 50.0, 3.0)];
    assert_eq!(plan(&mut planner, &state, &wall), Verdict::Feasible);
    let knots = &planner.best().knots;
    assert!((knots[0].state.x - state.x).abs() < 1e-9);
    assert!((knots[0].state.z - state.z).abs() < 1e-9);
    assert!(
        knots
            .iter()
            .all(|knot| clearance(&wall, knot.state.x, knot.state.z) > 0.0)
    );
    assert!(knots.iter().all(|knot| knot.feedforward.thrust >= 0.0));
    let length: f64 = knots
        .windows(2)
        .map(|k| libm::hypot(k[1].state.x - k[0].state.x, k[1].state.z - k[0].state.z))
        .sum();
    assert!(
        length <= planner.summary().cost + 1e-9,
        "chords are no longer than the path"
    );
    assert!(length > 50.0 && planner.summary().cost < 70.0);
}

#[test]
fn the_baseline_forgets_the_shortest_path_of_the_cycle_before() {
    let paper = Settings::paper();
    let baseline = PlannerSettings {
        paths: 0,
        ..paper.planner
    };
    let mut planner = planner(&with_planner(paper, baseline));
    let mut state = level(&planner);
    assert_eq!(plan(&mut planner, &state, &[]), Verdict::Feasible);
    let straight = planner.summary().cost;
    state.x += 12.0;
    let wall = [(140.0, 50.0, 6.0)];
    assert_eq!(plan(&mut planner, &state, &wall), Verdict::Feasible);
    assert!(planner.summary().cost > straight, "a way around is longer");
    assert!((planner.best().knots[0].state.x - state.x).abs() < 1e-9);
}

#[test]
fn states_that_are_not_finite_give_no_plan() {
    for settings in presets() {
        for broken in 0..5 {
            let mut planner = planner(&settings);
            let mut state = level(&planner);
            let field = [
                &mut state.z,
                &mut state.air.airspeed,
                &mut state.air.pitch,
                &mut state.air.pitch_rate,
                &mut state.air.flight_path,
            ];
            *field.into_iter().nth(broken).unwrap() = f64::NAN;
            assert_eq!(
                plan(&mut planner, &state, &[]),
                Verdict::Nothing,
                "field {broken}"
            );
        }
    }
}

#[test]
fn a_planner_that_is_not_set_up_has_nothing_to_offer() {
    let mut planner = Box::new(Planner::new());
    let state = level(&planner);
    assert_eq!(plan(&mut planner, &state, &SCATTERED), Verdict::Nothing);
}

#[test]
fn the_lidar_of_these_tests_is_accepted() {
    let planner = planner(&Settings::flight());
    let scan = scan(&SCATTERED, &level(&planner));
    assert_eq!(scan.check(100), Ok(()));
    assert!(scan.ranges.iter().filter(|range| **range > 0.0).count() > 10);
}
