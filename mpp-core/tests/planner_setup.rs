//! Tests settings that step and planner refuse: every number, and what no range shows.

use crate::common::planning::presets;
use mpp_core::config::MAX_PATHS;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::{Planner, SetupError};
use mpp_core::settings::{Cruise, PlaneSettings, Setting, Settings};
use mpp_core::vehicle::{Airframe, TrimError};

/// A number: its name, and how to set it.
type Row = (Setting, Box<dyn Fn(&mut Settings, f64)>);

fn own(settings: &mut Settings) -> &mut PlaneSettings {
    settings.planner.plane_mut().unwrap()
}

/// Sets a number of the settings.
type Change = fn(&mut Settings, f64);

/// The numbers of all presets, beside those of the airframe.
const SHARED: [(Setting, Change); 32] = {
    use Setting::*;
    [
        (LengthUnit, |s, n| s.units.length = n),
        (TimeUnit, |s, n| s.units.time = n),
        (MassUnit, |s, n| s.units.mass = n),
        (MotorThrust, |s, n| s.actuators.thrust_max = Some(n)),
        (ThrustLag, |s, n| s.actuators.thrust_lag = Some(n)),
        (ElevatorBelow, |s, n| s.actuators.elevator_below = Some(n)),
        (ElevatorAbove, |s, n| s.actuators.elevator_above = Some(n)),
        (ElevatorRate, |s, n| s.actuators.elevator_rate = Some(n)),
        (ElevatorDelay, |s, n| s.actuators.elevator_delay = Some(n)),
        (ThrustDelay, |s, n| s.actuators.thrust_delay = Some(n)),
        (CruiseAirspeed, |s, n| s.cruise = Cruise::Airspeed(n)),
        (DesignThrust, |s, n| s.design_thrust = Some(n)),
        (SpeedNoise, |s, n| s.estimator.process_noise[0] = n),
        (PitchNoise, |s, n| s.estimator.process_noise[1] = n),
        (RateNoise, |s, n| s.estimator.process_noise[2] = n),
        (PathNoise, |s, n| s.estimator.process_noise[3] = n),
        (AirspeedVariance, |s, n| s.estimator.airspeed_variance = n),
        (PitchVariance, |s, n| s.estimator.pitch_variance = n),
        (InitialVariance, |s, n| s.estimator.initial_variance = n),
        (Gate, |s, n| s.estimator.gate = n),
        (WindChange, |s, n| s.wind_change = Some(n)),
        (SpeedWeight, |s, n| s.regulator.state[0] = n),
        (PitchWeight, |s, n| s.regulator.state[1] = n),
        (RateWeight, |s, n| s.regulator.state[2] = n),
        (PathWeight, |s, n| s.regulator.state[3] = n),
        (ElevatorWeight, |s, n| s.regulator.elevator = n),
        (CrossTrack, |s, n| s.cross_track = n),
        (AirspeedHold, |s, n| s.airspeed_hold = n),
        (Altitude, |s, n| s.planner.altitude = n),
        (PlanElevatorWeight, |s, n| s.planner.weights.control[0] = n),
        (PlanThrustWeight, |s, n| s.planner.weights.control[1] = n),
        (PlanTerminalWeight, |s, n| s.planner.weights.terminal = n),
    ]
};

/// The numbers of the flight planner.
const FLIGHT: [(Setting, Change); 13] = {
    use Setting::*;
    [
        (Sight, |s, n| own(s).sight = n),
        (Latency, |s, n| own(s).latency = n),
        (PenaltyLinear, |s, n| own(s).penalty.linear = n),
        (PenaltyQuadratic, |s, n| own(s).penalty.quadratic = n),
        (AngleOfAttackLimit, |s, n| {
            own(s).attitude.angle_of_attack = n;
        }),
        (FlightPathLimit, |s, n| own(s).attitude.flight_path = n),
        (Margin, |s, n| own(s).margin = n),
        (BodyRadius, |s, n| own(s).body_radius = n),
        (Stall, |s, n| own(s).stall = Some(n)),
        (Band, |s, n| own(s).band = n),
        (PlanThrust, |s, n| own(s).thrust_max = n),
        // These two are whole numbers, so that each value here stands for the nearest one.
        (SqpIterations, |s, n| own(s).sqp_iterations = n as u8),
        (RefinedCandidates, |s, n| {
            own(s).refined_candidates = n as usize;
        }),
    ]
};

/// The numbers of the paper's method.
const PAPER: [(Setting, Change); 2] = {
    use Setting::*;
    [
        (PaddingNear, |s, n| {
            s.planner.paper_mut().unwrap().padding.near = n;
        }),
        (PaddingFar, |s, n| {
            s.planner.paper_mut().unwrap().padding.far = n;
        }),
    ]
};

/// The numbers of the airframe.
fn airframe() -> impl Iterator<Item = Row> {
    let settings = Airframe::SETTINGS.iter().enumerate();
    settings.map(|(at, setting)| -> Row {
        let set = move |s: &mut Settings, n| {
            let mut numbers = s.airframe.numbers();
            numbers[at] = n;
            s.airframe = Airframe::of_numbers(numbers);
        };
        (*setting, Box::new(set))
    })
}

/// Each method's settings with all its numbers.
fn methods() -> [(Settings, Vec<Row>); 2] {
    let rows = |own: &'static [(Setting, Change)]| {
        let plain = SHARED.iter().chain(own);
        let plain = plain.map(|(setting, set)| -> Row { (*setting, Box::new(set)) });
        airframe().chain(plain).collect()
    };
    [
        (Settings::flight(), rows(&FLIGHT)),
        (Settings::paper(), rows(&PAPER)),
    ]
}

/// Two absurd values of a number, below and above its range.
fn absurd(setting: Setting) -> [f64; 2] {
    let [least, most] = setting.range();
    match setting {
        // The range is that of the magnitude.
        Setting::MomentElevator => [0.0, -most - 1.0],
        // There is no count below 0.
        Setting::RefinedCandidates => [most + 1.0, 1e9],
        _ => [least - 1.0, most + 1.0],
    }
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
        for (setting, set) in rows {
            let whole = matches!(setting, Setting::SqpIterations | Setting::RefinedCandidates);
            let infinite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
            for number in absurd(setting)
                .iter()
                .chain(infinite.iter().filter(|_| !whole))
            {
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
        for (setting, set) in &rows {
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
        for (setting, set) in rows {
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
