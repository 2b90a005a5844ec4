//! Tests settings that the planner refuses.

use mpp_core::config::MAX_PATHS;
use mpp_core::planner::{Planner, SetupError};
use mpp_core::qp::{Penalty, Weights};
use mpp_core::settings::{FlightSettings, Method, PlannerSettings, Settings};
use mpp_core::vehicle::{Airframe, TrimError};

#[test]
fn settings_that_cannot_be_flown_are_refused_with_their_cause() {
    let flight = Settings::flight();
    let p = flight.planner;
    let own = *p.flight().unwrap();
    let with_own = |own: FlightSettings| PlannerSettings {
        method: Method::Flight(own),
        ..p
    };
    let priced = |linear, quadratic| {
        let penalty = Penalty { linear, quadratic };
        with_own(FlightSettings { penalty, ..own })
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
    let none = PlannerSettings { paths: 0, ..p };
    assert_eq!(refused(none), SetupError::NoPaths);
    let lost = PlannerSettings {
        altitude: f64::NAN,
        ..p
    };
    assert_eq!(refused(lost), SetupError::Altitude);
    let blind = with_own(FlightSettings { sight: 0.0, ..own });
    assert_eq!(refused(blind), SetupError::Sight);
    let late = Settings {
        wind_change: Some(0.0),
        ..flight
    };
    let mut planner = Box::new(Planner::new());
    assert_eq!(planner.set_up(&late), Err(SetupError::WindChange));
    for broken in [
        priced(0.0, 1.0),
        priced(1.0, 0.0),
        priced(f64::NAN, 1.0),
        priced(1.0, -1.0),
    ] {
        assert_eq!(refused(broken), SetupError::Penalty);
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
    assert!(matches!(planner.set_up(&floppy), Err(SetupError::Model(_))));
    let heavy = Settings {
        airframe: Airframe {
            mass: f64::NAN,
            ..Airframe::PAPER
        },
        ..flight
    };
    let error = SetupError::Trim(TrimError::Airframe);
    assert_eq!(planner.set_up(&heavy), Err(error));
}
