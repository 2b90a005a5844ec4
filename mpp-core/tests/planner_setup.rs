//! Settings that the planner refuses.

use mpp_core::config::MAX_PATHS;
use mpp_core::planner::{Planner, SetupError};
use mpp_core::qp::{Penalty, Weights};
use mpp_core::settings::{PlannerSettings, Settings};
use mpp_core::vehicle::Airframe;

#[test]
fn settings_that_cannot_be_flown_are_refused_with_their_cause() {
    let flight = Settings::flight();
    let p = flight.planner;
    let priced = |linear, quadratic| PlannerSettings {
        penalty: Some(Penalty { linear, quadratic }),
        ..p
    };
    let weighted = |control, terminal| PlannerSettings {
        weights: Weights { control, terminal },
        ..p
    };
    let refused = |planner: PlannerSettings| {
        let mut fresh = Box::new(Planner::new());
        fresh.set_up(&Settings { planner, ..flight }).unwrap_err()
    };
    let many = PlannerSettings {
        paths: MAX_PATHS + 1,
        ..p
    };
    assert_eq!(refused(many), SetupError::TooManyPaths);
    let lost = PlannerSettings {
        altitude: f64::NAN,
        ..p
    };
    for broken in [
        lost,
        priced(0.0, 1.0),
        priced(1.0, 0.0),
        priced(f64::NAN, 1.0),
        priced(1.0, -1.0),
    ] {
        assert_eq!(refused(broken), SetupError::Number);
    }
    for broken in [
        weighted([0.0, 0.0], 0.0),
        weighted([1.0, f64::NAN], 1.0),
        weighted([-1.0, 1.0], 1.0),
    ] {
        assert!(matches!(refused(broken), SetupError::Condense(_)));
    }
    let floppy = Settings {
        airframe: Airframe {
            moment_alpha: 0.0,
            ..Airframe::PAPER
        },
        ..flight
    };
    let mut planner = Box::new(Planner::new());
    assert!(matches!(planner.set_up(&floppy), Err(SetupError::Model(_))));
    let heavy = Settings {
        airframe: Airframe {
            mass: f64::NAN,
            ..Airframe::PAPER
        },
        ..flight
    };
    assert!(matches!(planner.set_up(&heavy), Err(SetupError::Trim(_))));
}
