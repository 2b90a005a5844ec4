//! Tests settings at random: they are refused with an error, or the loop that they give flies.

use crate::common::motion::after_tick;
use crate::common::seeded::seeded;
use crate::common::sensors::frame;
use mpp_core::config::TICK_PERIOD;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::{Planner, SetupError};
use mpp_core::settings::{Cruise, Settings};
use mpp_core::vehicle::{Trim, VehicleState};
use proptest::prelude::*;

/// Number of settings that are drawn.
const NUMBERS: usize = 35;

/// Flies an aircraft as the settings know it for 3 s, with plans in free air.
fn fly(settings: &Settings, flight: &mut FlightLoop, trim: &Trim) {
    let mut state = VehicleState {
        x: 0.0,
        z: settings.planner.altitude,
        air: trim.state,
    };
    let limits = &settings.actuators;
    let mut last = trim.control;
    for tick in 0..300 {
        let out = flight.step(f64::from(tick) * TICK_PERIOD, &frame(&state));
        let control = out.control;
        assert!(control.thrust.is_finite() && control.elevator.is_finite());
        assert!((0.0..=limits.thrust_max.unwrap_or(f64::MAX)).contains(&control.thrust));
        let off = control.elevator - trim.control.elevator;
        assert!(
            off.abs()
                <= limits
                    .elevator_above
                    .unwrap_or(f64::MAX)
                    .max(limits.elevator_below.unwrap_or(f64::MAX))
                    * (1.0 + 1e-9)
        );
        let step = control.elevator - last.elevator;
        let most = limits.elevator_rate.unwrap_or(f64::MAX / 2.0) * TICK_PERIOD;
        assert!(step.abs() <= most * (1.0 + 1e-9) + 1e-9);
        last = control;
        state = after_tick(&settings.airframe, &state, control);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..seeded() })]

    /// Aircraft from a tenth to ten times the reference in every number, all at once, with as many other
    /// settings at random within the tenth and tenfold.
    #[test]
    fn settings_at_random_are_refused_or_fly(
        factors in prop::collection::vec(-1.0..1.0_f64, NUMBERS),
        spread in 0.0..1.0_f64,
        limited in any::<[bool; 4]>(),
    ) {
        let mut settings = Settings::flight();
        let limits = [15.0, 0.1, 2.0, 20.0];
        let places = [
            &mut settings.actuators.thrust_max,
            &mut settings.actuators.thrust_lag,
            &mut settings.actuators.elevator_below,
            &mut settings.actuators.elevator_above,
            &mut settings.actuators.elevator_rate,
        ];
        let kept = |place: usize| libm::pow(10.0, spread * factors[place]);
        for ((place, limit), (is, at)) in places.into_iter().zip(limits).zip(limited.into_iter().zip(0..)) {
            *place = is.then(|| limit * kept(at));
        }
        let a = &mut settings.airframe;
        let e = &mut settings.estimator;
        let numbers = [
            &mut a.mass, &mut a.pitch_inertia, &mut a.wing_area, &mut a.moment_length,
            &mut a.air_density, &mut a.lift_zero, &mut a.lift_alpha, &mut a.drag_zero,
            &mut a.drag_induced, &mut a.moment_zero, &mut a.moment_alpha, &mut a.moment_alpha_rate,
            &mut a.moment_elevator, &mut e.airspeed_variance, &mut e.pitch_variance,
            &mut e.initial_variance, &mut e.gate, &mut settings.regulator.elevator,
            &mut settings.cross_track, &mut settings.airspeed_hold, &mut settings.planner.altitude,
        ];
        for (place, number) in numbers.into_iter().enumerate() {
            *number *= kept(place + 4);
        }
        for place in 0..4 {
            settings.estimator.process_noise[place] *= kept(place + 25);
            settings.regulator.state[place] *= kept(place + 29);
        }
        settings.cruise = Cruise::Airspeed(12.0 * kept(33));
        settings.wind_change = Some(1.0 * kept(34));
        let mut planner = Box::new(Planner::new());
        match (FlightLoop::new(&settings), planner.set_up(&settings)) {
            (Ok(mut flight), Ok(())) => fly(&settings, &mut flight, planner.trim()),
            // The regulator has more causes to refuse than the planner.
            (Err(step), Err(plan)) => prop_assert_eq!(step, plan),
            (Err(SetupError::Regulator(_) | SetupError::Unstable), Ok(())) | (Ok(_), Err(SetupError::Condense(_))) => {}
            (step, plan) => prop_assert!(false, "{:?} {plan:?}", step.err()),
        }
    }
}
