//! Tests settings that step and planner refuse: every number, and what no range shows.
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod common {
    pub(crate) mod presets;
}

use common::presets::presets;
use mpp_core::config::MAX_PATHS;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::{Planner, SetupError};
use mpp_core::settings::{Cruise, PlaneSettings, Setting, Settings};
use mpp_core::vehicle::TrimError;

/// A number: its name, how to set it, and two absurd values below and above its range.
type Row = (Setting, fn(&mut Settings, f64), [f64; 2]);

fn own(settings: &mut Settings) -> &mut PlaneSettings {
    settings.planner.plane_mut().unwrap()
}

/// The numbers of all presets.
const SHARED: [Row; 47] = {
    use Setting::*;
    [
        (LengthUnit, |s, n| s.units.length = n, [0.0, 1e6]),
        (TimeUnit, |s, n| s.units.time = n, [0.0, 1e6]),
        (MassUnit, |s, n| s.units.mass = n, [0.0, 1e9]),
        (Mass, |s, n| s.airframe.mass = n, [-1.0, 1e6]),
        (
            PitchInertia,
            |s, n| s.airframe.pitch_inertia = n,
            [0.0, 1e9],
        ),
        (WingArea, |s, n| s.airframe.wing_area = n, [-0.25, 1e4]),
        (
            MomentLength,
            |s, n| s.airframe.moment_length = n,
            [0.0, 1e3],
        ),
        (AirDensity, |s, n| s.airframe.air_density = n, [0.0, 1e3]),
        (LiftZero, |s, n| s.airframe.lift_zero = n, [-1e3, 1e3]),
        (LiftAlpha, |s, n| s.airframe.lift_alpha = n, [-5.73, 1e3]),
        (
            LiftElevator,
            |s, n| s.airframe.lift_elevator = n,
            [-1e3, 1e3],
        ),
        (DragZero, |s, n| s.airframe.drag_zero = n, [-0.1, 1e3]),
        (
            DragInduced,
            |s, n| s.airframe.drag_induced = n,
            [-0.05, 1e3],
        ),
        (MomentZero, |s, n| s.airframe.moment_zero = n, [-1e3, 1e3]),
        (MomentAlpha, |s, n| s.airframe.moment_alpha = n, [-1e6, 0.0]),
        (
            MomentAlphaRate,
            |s, n| s.airframe.moment_alpha_rate = n,
            [-1e6, 0.46],
        ),
        (
            MomentPitchRate,
            |s, n| s.airframe.moment_pitch_rate = n,
            [-1e6, 0.1],
        ),
        (
            MomentElevator,
            |s, n| s.airframe.moment_elevator = n,
            [0.0, -1e6],
        ),
        (
            MotorThrust,
            |s, n| s.actuators.thrust_max = Some(n),
            [0.0, 1e9],
        ),
        (
            ThrustLag,
            |s, n| s.actuators.thrust_lag = Some(n),
            [-0.1, 1e4],
        ),
        (
            ElevatorBelow,
            |s, n| s.actuators.elevator_below = Some(n),
            [0.0, 1e9],
        ),
        (
            ElevatorAbove,
            |s, n| s.actuators.elevator_above = Some(n),
            [0.0, 1e9],
        ),
        (
            ElevatorRate,
            |s, n| s.actuators.elevator_rate = Some(n),
            [-1.0, 1e12],
        ),
        (
            CruiseAirspeed,
            |s, n| s.cruise = Cruise::Airspeed(n),
            [-12.0, 340.0],
        ),
        (
            LiftAlphaRate,
            |s, n| s.airframe.lift_alpha_rate = n,
            [-1.0, 1.0],
        ),
        (
            LiftPitchRate,
            |s, n| s.airframe.lift_pitch_rate = n,
            [-1.0, 1.0],
        ),
        (DesignThrust, |s, n| s.design_thrust = Some(n), [-1.0, 1e9]),
        (
            SpeedNoise,
            |s, n| s.estimator.process_noise[0] = n,
            [-1e-9, 1e9],
        ),
        (
            PitchNoise,
            |s, n| s.estimator.process_noise[1] = n,
            [-1e-9, 1e9],
        ),
        (
            RateNoise,
            |s, n| s.estimator.process_noise[2] = n,
            [-1e-9, 1e9],
        ),
        (
            PathNoise,
            |s, n| s.estimator.process_noise[3] = n,
            [-1e-9, 1e9],
        ),
        (
            AirspeedVariance,
            |s, n| s.estimator.airspeed_variance = n,
            [0.0, 1e9],
        ),
        (
            PitchVariance,
            |s, n| s.estimator.pitch_variance = n,
            [-1e-9, 1e9],
        ),
        (
            InitialVariance,
            |s, n| s.estimator.initial_variance = n,
            [0.0, 1e9],
        ),
        (Gate, |s, n| s.estimator.gate = n, [0.0, 1e9]),
        (WindChange, |s, n| s.wind_change = Some(n), [0.0, 1e9]),
        (SpeedWeight, |s, n| s.regulator.state[0] = n, [-1.0, 1e12]),
        (PitchWeight, |s, n| s.regulator.state[1] = n, [-1.0, 1e12]),
        (RateWeight, |s, n| s.regulator.state[2] = n, [-1.0, 1e12]),
        (PathWeight, |s, n| s.regulator.state[3] = n, [-1.0, 1e12]),
        (ElevatorWeight, |s, n| s.regulator.elevator = n, [0.0, 1e12]),
        (CrossTrack, |s, n| s.cross_track = n, [-0.08, 1e3]),
        (AirspeedHold, |s, n| s.airspeed_hold = n, [-10.0, 1e9]),
        (Altitude, |s, n| s.planner.altitude = n, [-1e6, 1e6]),
        (
            PlanElevatorWeight,
            |s, n| s.planner.weights.control[0] = n,
            [-1.0, 1e12],
        ),
        (
            PlanThrustWeight,
            |s, n| s.planner.weights.control[1] = n,
            [0.0, 1e12],
        ),
        (
            PlanTerminalWeight,
            |s, n| s.planner.weights.terminal = n,
            [-1.0, 1e12],
        ),
    ]
};

/// The numbers of the flight planner.
const FLIGHT: [Row; 13] = {
    use Setting::*;
    [
        (Sight, |s, n| own(s).sight = n, [0.0, 1e9]),
        (Latency, |s, n| own(s).latency = n, [-0.01, 4.51]),
        (PenaltyLinear, |s, n| own(s).penalty.linear = n, [0.0, 1e15]),
        (
            PenaltyQuadratic,
            |s, n| own(s).penalty.quadratic = n,
            [-1.0, 1e15],
        ),
        (
            AngleOfAttackLimit,
            |s, n| own(s).attitude.angle_of_attack = n,
            [0.0, 2.0],
        ),
        (
            FlightPathLimit,
            |s, n| own(s).attitude.flight_path = n,
            [-0.6, 2.0],
        ),
        (Margin, |s, n| own(s).margin = n, [0.0, 1e3]),
        (BodyRadius, |s, n| own(s).body_radius = n, [-0.1, 1e3]),
        (Stall, |s, n| own(s).stall = Some(n), [0.0, 2.0]),
        (Band, |s, n| own(s).band = n, [-10.0, 1e6]),
        (PlanThrust, |s, n| own(s).thrust_max = n, [0.0, 1e9]),
        // These two are whole numbers, so that each value here stands for the nearest one.
        (
            SqpIterations,
            |s, n| own(s).sqp_iterations = n as u8,
            [0.0, 255.0],
        ),
        (
            RefinedCandidates,
            |s, n| own(s).refined_candidates = n as usize,
            [51.0, 1e9],
        ),
    ]
};

/// The numbers of the paper's method.
const PAPER: [Row; 2] = {
    use Setting::*;
    [
        (
            PaddingNear,
            |s, n| s.planner.paper_mut().unwrap().padding.near = n,
            [-1.0, 1e3],
        ),
        (
            PaddingFar,
            |s, n| s.planner.paper_mut().unwrap().padding.far = n,
            [-1.0, 1e3],
        ),
    ]
};

/// Each method's settings with all its numbers.
fn methods() -> [(Settings, Vec<Row>); 2] {
    let shared = |own: &[Row]| SHARED.iter().chain(own).copied().collect();
    [
        (Settings::flight(), shared(&FLIGHT)),
        (Settings::paper(), shared(&PAPER)),
    ]
}

/// Checks that step and planner give the same error.
fn refused(settings: &Settings) -> SetupError {
    let mut planner = Box::new(Planner::new());
    let error = planner.set_up(settings).unwrap_err();
    assert_eq!(FlightLoop::new(settings).err(), Some(error));
    error
}

#[test]
fn every_absurd_number_is_refused_by_its_name() {
    for (preset, rows) in methods() {
        for (setting, set, absurd) in rows {
            let whole = matches!(setting, Setting::SqpIterations | Setting::RefinedCandidates);
            let infinite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
            for number in absurd.iter().chain(infinite.iter().filter(|_| !whole)) {
                let mut settings = preset;
                set(&mut settings, *number);
                let error = refused(&settings);
                assert_eq!(error, SetupError::OutOfRange(setting), "{number}");
            }
        }
    }
}

/// Every number of the settings has a row above, and a setting of its own. All of them are written out
/// with the same number: a field without a row still shows another one.
#[test]
fn the_table_leaves_no_number_out() {
    let mut named: Vec<Setting> = vec![];
    for (mut settings, rows) in methods() {
        for (setting, set, _) in &rows {
            set(&mut settings, 77.0);
            if !named.contains(setting) {
                named.push(*setting);
            }
        }
        // A path count and a seed are no measure, and the check of the paths has its own errors.
        (settings.planner.paths, settings.planner.seed) = (77, 77);
        let text = format!("{settings:?}");
        let numbers = text
            .split(|letter: char| !(letter.is_ascii_digit() || ".-e".contains(letter)))
            .filter(|word| word.chars().any(|letter| letter.is_ascii_digit()));
        let mut count = 0;
        for number in numbers {
            assert_eq!(number.parse(), Ok(77.0), "{text}");
            count += 1;
        }
        assert_eq!(count, rows.len() + 2, "{text}");
    }
    assert_eq!(named.len(), Setting::ALL.len());
}

#[test]
fn every_end_of_a_range_is_in_it_and_every_preset_flies() {
    for preset in presets() {
        assert_eq!(Planner::new().set_up(&preset), Ok(()));
        assert!(FlightLoop::new(&preset).is_ok());
    }
    for (preset, rows) in methods() {
        for (setting, set, _) in rows {
            for end in setting.range() {
                let mut settings = preset;
                set(&mut settings, end);
                assert_eq!(settings.out_of_range(), None, "{setting} {end}");
            }
        }
    }
}

#[test]
fn what_no_range_shows_is_refused_too() {
    let mut settings = Settings::flight();
    settings.planner.paths = MAX_PATHS + 1;
    assert_eq!(refused(&settings), SetupError::TooManyPaths);
    settings.planner.paths = 0;
    assert_eq!(refused(&settings), SetupError::NoPaths);
    let mut settings = Settings::flight();
    settings.actuators.thrust_max = Some(0.5);
    assert_eq!(refused(&settings), SetupError::ThrustTooLow);
    settings.airframe.mass = 500.0;
    let error = SetupError::Trim(TrimError::NotConverged);
    assert_eq!(refused(&settings), error);
}

/// The regulator's design is for a controller without pauses. One that acts once in a tick cannot be as
/// firm, and a design for another aircraft need not hold this one.
#[test]
fn a_regulator_that_does_not_hold_the_aircraft_is_refused() {
    let unstable = |change: fn(&mut Settings)| {
        let mut settings = Settings::flight();
        change(&mut settings);
        assert_eq!(settings.out_of_range(), None);
        assert_eq!(Planner::new().set_up(&settings), Ok(()));
        FlightLoop::new(&settings).err() == Some(SetupError::Unstable)
    };
    assert!(!unstable(|_| {}));
    assert!(unstable(|s| s.regulator.state[2] = 1e4));
    assert!(unstable(|s| s.regulator.elevator = 1e-4));
    assert!(unstable(|s| s.cross_track = 5.0));
    assert!(unstable(|s| s.airspeed_hold = 400.0));
    // Without a turn back to the path nothing holds the height. This is no fault: the paper flies so.
    assert!(!unstable(|s| s.cross_track = 0.0));
    assert!(!unstable(|s| s.airspeed_hold = 0.0));
}

/// A change in flight is checked as the set-up is, and a refused one changes nothing.
#[test]
fn a_change_in_flight_is_refused_by_its_name() {
    let settings = Settings::flight();
    let mut planner = Box::new(Planner::new());
    planner.set_up(&settings).unwrap();
    let mut late = settings;
    own(&mut late).latency = 5.0;
    let error = SetupError::OutOfRange(Setting::Latency);
    assert_eq!(planner.retune(&late.planner), Err(error));
    let mut none = settings;
    none.planner.paths = 0;
    assert_eq!(planner.retune(&none.planner), Err(SetupError::NoPaths));
}
