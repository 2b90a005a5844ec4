//! A plan of a similar aircraft in a similar world is the similar plan.

use mpp_core::planner::{Planner, Verdict};
use mpp_core::sense::LidarScan;
use mpp_core::settings::{Aircraft, Settings};
use mpp_core::trajectory::Trajectory;
use mpp_core::vehicle::{ActuatorLimits, Airframe, Conditions, VehicleState, Wind};

/// Preset `flight` for the reference aircraft with limits, a body and an elevator with lift, and lengths `scale` times
/// as long.
fn flight_of(scale: f64) -> Settings {
    let (time, cube) = (scale.sqrt(), scale.powi(3));
    let base = Airframe::REFERENCE;
    let aircraft = Aircraft {
        airframe: Airframe {
            mass: base.mass * cube,
            pitch_inertia: base.pitch_inertia * cube * scale * scale,
            wing_area: base.wing_area * scale * scale,
            moment_length: base.moment_length * scale,
            moment_alpha_rate: base.moment_alpha_rate * time,
            moment_pitch_rate: -0.1 * time,
            lift_alpha_rate: 0.02 * time,
            lift_pitch_rate: 0.05 * time,
            lift_elevator: 0.02,
            ..base
        },
        cruise: 12.0 * time,
        body_radius: 0.2 * scale,
        stall: Some(0.25),
    };
    let actuators = ActuatorLimits {
        thrust_max: Some(15.0 * cube),
        thrust_lag: Some(0.2 * time),
        elevator_below: Some(6.0),
        elevator_above: Some(4.0),
        elevator_rate: Some(40.0 / time),
        elevator_delay: Some(0.05 * time),
        thrust_delay: Some(0.03 * time),
    };
    Settings::flight_of(&aircraft, &actuators)
}

/// A scan of a disc of 1 m radius 25 m ahead, of a world that is `scale` times as long.
fn scan(pitch: f64, scale: f64) -> LidarScan {
    let mut scan = LidarScan::new();
    (scan.angle_min, scan.angle_increment) = (-0.5, 0.01);
    for beam in 0..100 {
        let (up, ahead) = libm::sincos(pitch + scan.beam_angle(beam));
        let missed_by = 25.0 * up;
        let half_chord = libm::sqrt(1.0 - missed_by * missed_by);
        let range = if half_chord.is_nan() {
            0.0
        } else {
            25.0 * ahead - half_chord
        };
        // A power of two as the scale loses no bit of the range.
        scan.ranges.push((range * scale) as f32).unwrap();
    }
    scan
}

fn plan(scale: f64) -> Trajectory {
    let mut settings = flight_of(scale);
    settings.planner.altitude = 50.0 * scale;
    let own = settings.planner.plane_mut().unwrap();
    own.sight = 45.0 * scale;
    own.latency = 0.2 * scale.sqrt();
    let mut planner = Box::new(Planner::new());
    planner.set_up(&settings).unwrap();
    let trim = settings.cruise.trim(&settings.airframe).unwrap();
    let state = VehicleState {
        x: 7.0 * scale,
        z: 50.2 * scale,
        air: trim.state,
    };
    let conditions = Conditions {
        wind: Wind {
            x: -0.5 * scale.sqrt(),
            z: 0.3 * scale.sqrt(),
        },
        lift: 0.05,
    };
    let scan = scan(trim.state.pitch, scale);
    // The second cycle takes up the plan of the first.
    for cycle in 0..2 {
        let time = f64::from(cycle) * 0.01 * scale.sqrt();
        planner.begin(time, &state, &conditions, &scan);
        while planner.advance() {}
        assert_eq!(planner.finish(), Verdict::Feasible);
    }
    planner.best().clone()
}

#[test]
fn a_similar_aircraft_flies_the_similar_plan() {
    let first = plan(1.0);
    let climbs = first.knots.iter().map(|knot| knot.state.z - 50.0);
    assert!(climbs.fold(0.0, |most: f64, z| most.max(z.abs())) > 1.5);
    for scale in [0.25_f64, 4.0, 16.0] {
        let (time, force) = (scale.sqrt(), scale.powi(3));
        let other = plan(scale);
        assert!((other.stage_period - 0.25 * time).abs() < 1e-12);
        let ahead = 7.0 * scale;
        for (a, b) in first.knots.iter().zip(&other.knots) {
            let (a, b) = (a.state, b.state);
            let near = |a: f64, b: f64, size: f64| (a - b).abs() < 1e-6 * size;
            assert!(
                near(a.x * scale - ahead, b.x - ahead, 100.0 * scale),
                "{a:?} {b:?}"
            );
            assert!(near(a.z * scale, b.z, 10.0 * scale), "{a:?} {b:?}");
            assert!(near(a.air.airspeed * time, b.air.airspeed, 10.0 * time));
            assert!(near(a.air.pitch, b.air.pitch, 1.0));
            assert!(near(a.air.pitch_rate, b.air.pitch_rate * time, 1.0));
        }
        for (a, b) in first.knots.iter().zip(&other.knots) {
            let (a, b) = (a.feedforward, b.feedforward);
            assert!((a.thrust * force - b.thrust).abs() < 1e-5 * force);
            assert!((a.elevator - b.elevator).abs() < 1e-5);
        }
        // So is the thrust that the motor gives.
        for elapsed in [0.0, 0.1, 1.3, 4.4] {
            let given = |plan: &Trajectory, time: f64| plan.thrust(plan.start + elapsed * time);
            let (a, b) = (given(&first, 1.0).unwrap(), given(&other, time).unwrap());
            assert!((a * force - b).abs() < 1e-5 * force, "{a} {b}");
        }
    }
}

#[test]
fn the_reference_aircraft_has_the_settings_of_the_preset() {
    assert_eq!(
        Settings::flight_of(&Aircraft::REFERENCE, &ActuatorLimits::NONE),
        Settings::flight()
    );
}

/// Plans keep the body clear of obstacles, not only its centre.
#[test]
fn a_body_keeps_its_radius_and_the_margin() {
    let clearance = |body_radius: f64| {
        let mut settings = Settings::flight();
        let own = settings.planner.plane_mut().unwrap();
        own.body_radius = body_radius;
        let mut planner = Box::new(Planner::new());
        planner.set_up(&settings).unwrap();
        let state = VehicleState {
            x: 0.0,
            z: 50.0,
            air: planner.trim().state,
        };
        planner.begin(0.0, &state, &Conditions::STILL, &scan(state.air.pitch, 1.0));
        while planner.advance() {}
        assert_eq!(planner.finish(), Verdict::Feasible);
        let best = planner.best();
        (0..450)
            .filter_map(|tick| best.sample(0.01 * f64::from(tick)))
            .map(|at| libm::hypot(at.state.x - 25.0, at.state.z - 50.0) - 1.0)
            .fold(f64::INFINITY, f64::min)
    };
    let (point, body) = (clearance(0.0), clearance(1.0));
    assert!(body > point + 0.8 && body > 1.5, "{point} {body}");
}
