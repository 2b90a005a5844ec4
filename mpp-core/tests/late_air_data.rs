//! Tests the filter of the motion through the air with measurements that come late.

use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{Ekf, EkfTuning, Innovation, LaggedEkf, MeasurementStatus, Taken};
use mpp_core::sense::Measurement;
use mpp_core::vehicle::{AirState, Airframe, Control, Trim, air_rate};
use proptest::prelude::*;

const AIRFRAME: Airframe = Airframe::REFERENCE;
const BOTH: [bool; 2] = [true, true];

fn trim() -> Trim {
    Trim::at_speed(&AIRFRAME, 12.0, 0.0).unwrap()
}

/// A lively elevator about trim.
fn control(tick: u32) -> Control {
    let trim = trim().control;
    let swing = f64::from(tick) * 0.03;
    Control {
        elevator: trim.elevator + libm::sin(swing) * 0.8,
        ..trim
    }
}

/// The motion by the filter's own equations.
fn truth(ticks: u32) -> Vec<AirState> {
    let mut states = vec![trim().state];
    for tick in 0..ticks {
        let state = *states.last().unwrap();
        let rate = air_rate(&AIRFRAME, &state, control(tick)).to_vector();
        states.push(AirState::from_vector(
            &(state.to_vector() + rate * TICK_PERIOD),
        ));
    }
    states
}

fn measured(state: &AirState) -> Measurement {
    Measurement {
        airspeed: state.airspeed,
        pitch: state.pitch,
    }
}

fn filter() -> LaggedEkf {
    LaggedEkf::new(AIRFRAME, EkfTuning::SENSORS, trim().state)
}

#[test]
fn fresh_measurements_give_the_plain_filter_to_the_last_bit() {
    let states = truth(300);
    let (mut lagged, mut plain) = (
        filter(),
        Ekf::new(AIRFRAME, EkfTuning::SENSORS, trim().state),
    );
    for tick in 0..300 {
        lagged.predict(control(tick), TICK_PERIOD).unwrap();
        plain.predict(control(tick), TICK_PERIOD).unwrap();
        let mut seen = measured(&states[tick as usize + 1]);
        seen.airspeed += 0.3 * f64::from(tick % 3) - 0.3;
        lagged.take(0, &seen, BOTH);
        plain.update(&seen);
        assert_eq!(lagged.present(), plain.estimate());
    }
    assert_eq!(lagged.lag(), 0);
}

proptest! {
    /// Whatever the age of the measurements, the estimate for the present is the truth.
    #[test]
    fn late_measurements_give_the_present(age in 1_u32..31) {
        let states = truth(400);
        let mut filter = filter();
        for tick in 1..=400_u32 {
            filter.predict(control(tick - 1), TICK_PERIOD).unwrap();
            if let Some(then) = tick.checked_sub(age) {
                filter.take(age, &measured(&states[then as usize]), BOTH);
            }
            let off = filter.present().to_vector() - states[tick as usize].to_vector();
            prop_assert!(off.amax() < 1e-6, "{off} at {tick}");
        }
        prop_assert_eq!(filter.lag(), age);
    }

    /// An error of the start is corrected as soon as the measurements have arrived for a while.
    #[test]
    fn late_measurements_correct_the_estimate(age in 1_u32..25, off in 0.02_f64..0.06) {
        let states = truth(400);
        let start = AirState { pitch: trim().state.pitch + off, ..trim().state };
        let mut filter = LaggedEkf::new(AIRFRAME, EkfTuning::SENSORS, start);
        for tick in 1..=400_u32 {
            filter.predict(control(tick - 1), TICK_PERIOD).unwrap();
            if let Some(then) = tick.checked_sub(age) {
                filter.take(age, &measured(&states[then as usize]), BOTH);
            }
        }
        let left = filter.present().to_vector() - states[400].to_vector();
        prop_assert!(left.amax() < 2e-3, "{left}");
    }
}

/// One measurement that is late is left out and the next ones are used; measurements that become fresher are
/// used at once.
#[test]
fn the_lag_follows_the_measurements() {
    let states = truth(400);
    let mut filter = filter();
    for tick in 1..=400_u32 {
        filter.predict(control(tick - 1), TICK_PERIOD).unwrap();
        let age = match tick {
            50 => 4,
            100..200 => 20,
            200.. => 5,
            _ => 0,
        };
        let taken = filter.take(age, &measured(&states[(tick - age) as usize]), BOTH);
        let used = matches!(
            taken,
            Taken::Measured(Innovation {
                airspeed: MeasurementStatus::Accepted,
                pitch: MeasurementStatus::Accepted
            })
        );
        let expected = match tick {
            // The filter waits for three late measurements, and then until it has their age.
            50 | 100..122 => false,
            _ => true,
        };
        assert_eq!(used, expected, "{tick}");
        let off = filter.present().to_vector() - states[tick as usize].to_vector();
        assert!(off.amax() < 1e-6, "{off} at {tick}");
    }
    assert_eq!(filter.lag(), 5);
    assert_eq!(filter.take(51, &measured(&states[300]), BOTH), Taken::Late);
}
