//! Tests each cause with a flight that was made up for it.

use super::*;
use crate::field::ObstacleField;
use crate::lidar::LidarConfig;
use crate::scenario::Preset;
use mpp_core::vehicle::AirState;

/// The obstacle that is hit.
fn wall() -> Obstacle {
    Obstacle::circle(60.0, 50.0, 1.0)
}

/// Positions of the aircraft a tick before impact and at impact.
const LAST: (Point, Point) = ((58.95, 50.0), (59.07, 50.0));

fn field(others: &[Obstacle]) -> ObstacleField {
    let mut obstacles = others.to_vec();
    obstacles.push(wall());
    ObstacleField::new(obstacles)
}

/// Scans of a level flight at a height of 50 m and 12 m/s, taken at 4 Hz from the time `from` on.
/// Impact is at 4.92 s.
fn sights(field: &ObstacleField, from: f64) -> Vec<Sight> {
    let lidar = LidarConfig::PAPER;
    let scenario = Scenario::new(Preset::Flight, 1);
    let times = (0..20).map(|scan| 0.25 * f64::from(scan));
    times
        .filter(|t| *t >= from && *t < 4.92)
        .map(|t| {
            let state = VehicleState {
                x: 12.0 * t,
                z: 50.0,
                air: AirState {
                    airspeed: 12.0,
                    pitch: 0.0,
                    pitch_rate: 0.0,
                    flight_path: 0.0,
                },
            };
            let ranges = lidar.exact_ranges(&state, field);
            let ranges: Vec<f32> = ranges.into_iter().map(|range| range as f32).collect();
            let scan = scenario.lidar.wire_scan(0, &ranges);
            Sight { t, state, scan }
        })
        .collect()
}

/// A plan that was made at a given time. It starts at the aircraft's position at that time and
/// leads along a given height.
fn plan(made: f64, height: f64, feasible: bool) -> Plan {
    let place = |stage: i32| (12.0 * made + 3.0 * f64::from(stage), height);
    Plan {
        made,
        used: made + 0.01,
        feasible,
        period: 0.25,
        path: (0..19).map(place).collect(),
    }
}

fn cause(field: &ObstacleField, sights: Vec<Sight>, plans: Vec<Plan>) -> Failure {
    let inquest = Inquest { sights, plans };
    let failure = inquest.conclude(Class::Collision, field, LAST, 4.92, 0.0);
    failure.unwrap()
}

#[test]
fn a_plan_that_kept_clear_was_not_tracked() {
    let field = field(&[]);
    let failure = cause(&field, sights(&field, 0.0), vec![plan(4.5, 51.9, true)]);
    assert_eq!(failure.cause, Cause::Tracking);
    assert!((failure.plan_clearance.unwrap() - 0.9).abs() < 1e-9);
    assert!((failure.off_plan.unwrap() - 1.9).abs() < 1e-9);
}

/// The obstacles from which a scan's returns come: the nearest one on each beam.
fn nearest_on_each_beam(sight: &Sight, field: &[Obstacle]) -> Vec<usize> {
    let scan = &sight.scan;
    let nearest = |(beam, range): (usize, &f32)| {
        let turned = f64::from(scan.angle_increment) * beam as f64;
        let (up, ahead) = libm::sincos(sight.state.air.pitch + f64::from(scan.angle_min) + turned);
        let entries = field.iter().enumerate().filter_map(|(index, one)| {
            let entry = one.range((sight.state.x, sight.state.z), (ahead, up), sight.t)?;
            Some((index, entry.max(RANGE_MIN)))
        });
        let (nearest, entry) = entries.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let range = f64::from(*range);
        let told = range > 0.0 && (range - entry).abs() <= RETURN_OFF + RETURN_OFF_SHARE * entry;
        told.then_some(nearest)
    };
    (scan.ranges.iter().enumerate())
        .filter_map(nearest)
        .collect()
}

/// Obstacles that hide each other, that move, that stand twice at one place, and one around the aircraft.
#[test]
fn an_obstacle_is_met_where_nothing_nearer_is() {
    let mut obstacles = Scenario::new(Preset::Flight, 3).field().obstacles;
    obstacles.push(obstacles[4].clone());
    obstacles.push(Obstacle::circle(24.0, 50.0, 1.5));
    obstacles[2].velocity = (-3.0, 1.0);
    let field = field(&obstacles);
    let sights = sights(&field, 0.0);
    let obstacles = field.obstacles();
    let first = |index: &usize| {
        let meets = |sight: &&Sight| nearest_on_each_beam(sight, obstacles).contains(index);
        sights.iter().find(meets).map(|sight| sight.t)
    };
    let expected: Vec<_> = (0..obstacles.len()).map(|index| first(&index)).collect();
    assert!(expected.contains(&None) && expected.iter().flatten().any(|t| *t > 1.0));
    let plans = Vec::new();
    let inquest = Inquest { sights, plans };
    let met = (0..obstacles.len()).map(|index| inquest.first_met(obstacles, index));
    assert_eq!(met.collect::<Vec<_>>(), expected);
}

#[test]
fn what_no_beam_met_was_hidden() {
    // The screen stands directly in front of the wall. The aircraft passes it only after the last
    // scan, so the wall is in its shadow until the end.
    let screen = Obstacle::circle(57.5, 50.0, 1.0);
    let both = field(&[screen]);
    let failure = cause(&both, sights(&both, 0.0), vec![plan(4.5, 50.0, true)]);
    assert_eq!((failure.cause, failure.seen_before), (Cause::Hidden, None));
}

#[test]
fn what_was_met_too_late_was_hidden() {
    let field = field(&[]);
    for (first, expected) in [
        (4.5, Cause::Hidden),
        (4.25, Cause::Hidden),
        (4.0, Cause::NoWay),
    ] {
        let plans = vec![plan(first, 50.0, false), plan(4.75, 50.0, false)];
        let failure = cause(&field, sights(&field, first), plans);
        assert_eq!(failure.cause, expected, "met at {first} s");
        assert!((failure.seen_before.unwrap() - (4.92 - first)).abs() < 1e-9);
    }
    // A beam met the obstacle early, but no plan was made after that.
    let failure = cause(&field, sights(&field, 2.0), vec![plan(1.0, 50.0, true)]);
    assert_eq!(failure.cause, Cause::Hidden);
}

#[test]
fn a_known_obstacle_that_a_feasible_cycle_flies_into_was_misjudged() {
    let field = field(&[]);
    let plans = vec![plan(2.0, 50.0, false), plan(4.0, 50.0, true)];
    let failure = cause(&field, sights(&field, 0.0), plans);
    assert_eq!(failure.cause, Cause::Misjudged);
}

#[test]
fn a_way_that_something_hidden_closed_was_a_blind_alley() {
    // This obstacle is off the way to impact but on the way of the earlier plan. Beams meet it only
    // from 3 s on.
    let late = Obstacle::circle(70.0, 58.0, 1.0);
    let both = field(&[late]);
    let mut seen = sights(&field(&[]), 0.0);
    seen.retain(|sight| sight.t < 3.0);
    seen.extend(sights(&both, 3.0));
    let open = |made| vec![plan(made, 58.0, true), plan(4.0, 50.0, false)];
    let failure = cause(&both, seen, open(2.75));
    assert_eq!(failure.cause, Cause::BlindAlley);
    // An obstacle that stands far behind the wall is not the cause.
    let far = field(&[Obstacle::circle(80.0, 58.0, 1.0)]);
    assert_eq!(
        cause(&far, sights(&field(&[]), 0.0), open(2.75)).cause,
        Cause::NoWay
    );
    // Here the same plan was made when the obstacle was known. No hidden obstacle closed the way.
    let failure = cause(&both, sights(&both, 0.0), open(3.5));
    assert_eq!(failure.cause, Cause::NoWay);
}

#[test]
fn other_failures_have_their_class_for_a_cause() {
    let (field, inquest) = (field(&[]), Inquest::default());
    for (class, cause) in [
        (Class::LeftBand, Cause::LeftBand),
        (Class::Pitch, Cause::Pitch),
        (Class::FlightPath, Cause::FlightPath),
        (Class::NoPlan, Cause::NoPlan),
    ] {
        let failure = inquest.conclude(class, &field, LAST, 4.92, 0.0).unwrap();
        assert_eq!((failure.cause, cause.name()), (cause, class.name()));
        assert_eq!(serde_json::to_value(cause).unwrap(), cause.name());
    }
    for class in [Class::Success, Class::Terminated, Class::Interrupted] {
        assert_eq!(inquest.conclude(class, &field, LAST, 4.92, 0.0), None);
    }
}

/// Lift at the preset's limit of the angle of attack moves the aircraft aside by one radius in half
/// a second. The aircraft needs a fifth of a second more to reach this limit.
#[test]
fn the_reaction_time_is_the_airframes() {
    let settings = mpp_core::settings::Settings::flight();
    let (a, limits) = (
        settings.airframe,
        settings.planner.plane().unwrap().attitude,
    );
    let lift = 0.5 * a.air_density * a.wing_area * a.lift_alpha * 12.0 * 12.0;
    let acceleration = lift * limits.angle_of_attack / a.mass;
    let aside = (2.0 * 1.0 / acceleration).sqrt();
    assert!((0.1..0.3).contains(&(REACTION - aside)), "{aside} s");
}
