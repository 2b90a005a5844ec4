//! Tests what the flight planner does when the lidar shows nothing, or shows what cannot be.

use crate::common::planning::{level, plan, planner};
use crate::common::world::{Disc, scan};
use mpp_core::planner::{Planner, Verdict};
use mpp_core::sense::LidarScan;
use mpp_core::settings::Settings;
use mpp_core::tuning::scan_match::AGES;
use mpp_core::vehicle::{ActuatorLimits, Conditions, Pose, VehicleState};

/// Plans one cycle, from a scan if there is one.
fn plan_from(planner: &mut Planner, state: &VehicleState, scan: Option<&LidarScan>) -> Verdict {
    planner.begin_from(
        3.0,
        &[Pose::of(state); AGES],
        state,
        &Conditions::STILL,
        scan,
    );
    while planner.advance() {}
    planner.finish()
}

/// Airspeed at the end of the best plan [m/s].
fn last_airspeed(planner: &Planner) -> f64 {
    planner
        .best()
        .knots
        .last()
        .map_or(f64::NAN, |knot| knot.state.air.airspeed)
}

/// Greatest angle of attack of the best plan \[rad\].
fn greatest_angle(planner: &Planner) -> f64 {
    let knots = planner.best().knots.iter();
    knots.fold(0.0, |most: f64, knot| {
        most.max(knot.state.air.angle_of_attack())
    })
}

#[test]
fn without_a_scan_the_aircraft_flies_slowly_and_with_one_at_cruise_again() {
    let mut planner = planner(&Settings::flight());
    let state = level(&planner);
    let cruise = planner.trim().state;
    let allowed = cruise.angle_of_attack() + 0.2;
    plan_from(&mut planner, &state, None);
    assert!(planner.summary().blind);
    let slow = last_airspeed(&planner);
    assert!(slow < cruise.airspeed - 2.0, "{slow} m/s");
    let angle = greatest_angle(&planner);
    assert!(angle < allowed + 1e-6, "{angle} rad");

    plan(&mut planner, &state, &[(130.0, 57.0, 1.0)]);
    assert!(!planner.summary().blind);
    let again = last_airspeed(&planner);
    assert!((again - cruise.airspeed).abs() < 0.5, "{again} m/s");
}

/// Slow flight moves trim up to a limit of the programs. Only what the elevator limits must stay hard there.
#[test]
fn rows_of_the_angle_of_attack_are_hard_without_a_scan_as_with_one() {
    let held = ActuatorLimits {
        elevator_below: Some(4.0),
        elevator_above: Some(4.0),
        ..ActuatorLimits::NONE
    };
    for (actuators, hard) in [(ActuatorLimits::NONE, false), (held, true)] {
        let settings = Settings {
            actuators,
            ..Settings::flight()
        };
        let mut planner = planner(&settings);
        let state = level(&planner);
        let empty = scan(&[], &state);
        for scan in [Some(&empty), None] {
            planner.begin_from(
                3.0,
                &[Pose::of(&state); AGES],
                &state,
                &Conditions::STILL,
                scan,
            );
            let mut programs = 0;
            while planner.advance() {
                if let Some((_, program)) = planner.candidate() {
                    assert_eq!(program.hard_angle_of_attack, [hard; 2]);
                    programs += 1;
                }
            }
            assert!(programs > 0);
        }
    }
}

/// A motor that cannot carry the slow flight is no reason to fly it.
#[test]
fn slow_flight_needs_less_than_the_greatest_thrust() {
    let mut settings = Settings::flight();
    settings.actuators = ActuatorLimits {
        thrust_max: Some(4.6),
        ..settings.actuators
    };
    let mut planner = planner(&settings);
    let state = level(&planner);
    let cruise = planner.trim().state.airspeed;
    plan_from(&mut planner, &state, None);
    let last = last_airspeed(&planner);
    assert!((last - cruise).abs() < 0.5, "{last} m/s");
}

/// A lidar without returns contradicts the wall that the map knows. Behind the wall it contradicts nothing, and it is still not
/// believed, until a beam returns.
#[test]
fn a_lidar_that_has_lied_is_not_believed_until_a_beam_returns() {
    let wall: [Disc; 1] = [(128.0, 50.0, 2.0)];
    let mut planner = planner(&Settings::flight());
    let before = level(&planner);
    plan(&mut planner, &before, &wall);
    plan(&mut planner, &before, &[]);
    assert!(planner.summary().blind, "the wall has not gone");
    let behind = VehicleState { x: 140.0, ..before };
    plan(&mut planner, &behind, &[]);
    assert!(planner.summary().blind, "no beam has returned");
    plan(&mut planner, &behind, &[(160.0, 50.0, 1.0)]);
    assert!(!planner.summary().blind, "a beam has returned");
    let beyond = VehicleState { x: 180.0, ..before };
    plan(&mut planner, &beyond, &[]);
    assert!(!planner.summary().blind, "nothing is known ahead");
}

/// The greatest height of the best plan \[m\].
fn highest(planner: &Planner) -> f64 {
    let knots = planner.best().knots.iter();
    knots.fold(0.0, |most: f64, knot| most.max(knot.state.z))
}

/// A plan climbs while the half beneath the body axis is silent, but not while the upper half is.
#[test]
fn what_lies_beneath_a_silent_half_is_flown_over() {
    let discs: [Disc; 2] = [(128.0, 42.0, 2.0), (128.0, 66.0, 2.0)];
    for (lower, climbs) in [(true, true), (false, false)] {
        let mut planner = planner(&Settings::flight());
        let state = level(&planner);
        plan(&mut planner, &state, &discs);
        assert!(highest(&planner) < 53.0);
        let mut half = scan(&discs, &state);
        let beams = half.ranges.len() / 2;
        let ranges = half.ranges.iter_mut();
        if lower {
            ranges.take(beams).for_each(|it| *it = 0.0);
        } else {
            ranges.skip(beams).for_each(|it| *it = 0.0);
        }
        plan_from(&mut planner, &state, Some(&half));
        assert!(planner.summary().blind);
        let most = highest(&planner);
        assert_eq!(most > 55.0, climbs, "{most} m");
    }
}

/// Without any scan the aircraft stays level, as in mode CRUISE.
#[test]
fn an_aircraft_that_has_been_in_the_dark_for_long_climbs_above_the_band() {
    for (lies, late) in [(true, true), (false, false)] {
        let mut planner = planner(&Settings::flight());
        let state = level(&planner);
        plan(&mut planner, &state, &[(128.0, 50.0, 2.0)]);
        let empty = scan(&[], &state);
        for (time, climbs) in [(6.5, false), (7.5, late)] {
            let seen = lies.then_some(&empty);
            planner.begin_from(
                time,
                &[Pose::of(&state); AGES],
                &state,
                &Conditions::STILL,
                seen,
            );
            while planner.advance() {}
            planner.finish();
            let end = planner.best().knots.last().unwrap().state.z;
            assert_eq!(end > 55.0, climbs, "{time} s, a scan {lies}: {end} m");
        }
    }
}

/// A new flight does not inherit the doubt about the lidar.
#[test]
fn a_lie_is_forgotten_with_the_map() {
    let wall: [Disc; 1] = [(128.0, 50.0, 2.0)];
    let settings = Settings::flight();
    let mut planner = planner(&settings);
    let state = level(&planner);
    let empty = scan(&[], &state);
    for forget in [
        |it: &mut Planner, _: &Settings| it.forget(),
        |it: &mut Planner, own: &Settings| {
            assert_eq!(it.set_up(own), Ok(()));
        },
    ] {
        plan(&mut planner, &state, &wall);
        plan_from(&mut planner, &state, Some(&empty));
        assert!(planner.summary().blind);
        forget(&mut planner, &settings);
        plan_from(&mut planner, &state, Some(&empty));
        assert!(!planner.summary().blind);
    }
}

/// The paper's method has no map from earlier scans.
#[test]
fn the_papers_method_plans_nothing_without_a_scan() {
    let mut planner = planner(&Settings::paper());
    let state = level(&planner);
    assert_eq!(plan(&mut planner, &state, &[]), Verdict::Feasible);
    assert_eq!(plan_from(&mut planner, &state, None), Verdict::Nothing);
}
