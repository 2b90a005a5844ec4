//! The attitude in space: samples that are refused, that are few, and a bias of the bank.

use crate::space_estimate::{Turn, estimator, flown, time};
use mpp_core::estimate::{InertialSample, MeasurementStatus, SpaceEstimator, Trust};

/// Level flight in still air.
const LEVEL: Turn = Turn {
    bank: 0.0,
    wind: [0.0; 3],
};

/// Flies level for some ticks, with a sample of each so many, whose attitude is off by so much at a tick \[rad\].
fn told(ticks: u32, each: u32, off: impl Fn(u32) -> [f64; 3]) -> SpaceEstimator {
    let mut estimator = estimator();
    for tick in 10..10 + ticks {
        let mut sample = LEVEL.sample(time(tick), 0);
        sample.attitude = core::array::from_fn(|axis| sample.attitude[axis] + off(tick)[axis]);
        estimator.predict(tick.is_multiple_of(each).then_some(&sample));
        let fix = LEVEL.fix(time(tick), 0);
        estimator.observe_fix(tick.is_multiple_of(10).then_some(&fix));
    }
    estimator
}

#[test]
fn while_the_attitude_is_refused_the_rates_carry_it_on() {
    let mut estimator = flown(LEVEL, 200);
    let bank = |estimator: &SpaceEstimator| estimator.pose(0.0).unwrap().attitude.angles()[0];
    for tick in 210..220 {
        let status = estimator.predict(Some(&InertialSample {
            attitude: [0.7, 0.1, 1e-9 * f64::from(tick)],
            rates: [1.0, 0.0, 0.0],
            ..LEVEL.sample(time(tick), 0)
        }));
        assert_eq!(status, MeasurementStatus::Gated);
    }
    // Nine ticks, and half of the rate in the three since the sample before.
    assert!((bank(&estimator) - 0.105).abs() < 0.002);
}

/// Told attitudes of a second weigh the same, however many they are: a heading that is off from some time on is followed as fast.
#[test]
fn fewer_samples_tell_as_much() {
    let heading = |each: u32| {
        let off = |tick| [0.0, 0.0, if tick < 110 { 0.0 } else { 0.01 }];
        let pose = told(300, each, off).pose(0.0).unwrap();
        pose.attitude.angles()[2]
    };
    let often = heading(1);
    assert!((0.002..0.009).contains(&often), "{often}");
    assert!((heading(5) - often).abs() < 0.05 * often, "{often}");
}

#[test]
fn a_bias_of_the_bank_is_found_and_told() {
    let biased = |bias: f64| {
        let off = |tick| [bias + 1e-6 * f64::from(tick % 7), 0.0, 0.0];
        let estimator = told(2000, 1, off);
        (
            estimator.bank_bias(),
            estimator.trust().pitch,
            estimator.motion().unwrap(),
        )
    };
    let bias = 3_f64.to_radians();
    let (found, trust, motion) = biased(bias);
    assert!((found - bias).abs() < 0.3_f64.to_radians(), "{found}");
    assert_eq!(trust, Trust::Suspected);
    assert!(motion.path.bank.abs() < 0.3_f64.to_radians());
    let (found, trust, _) = biased(0.0);
    assert!(found.abs() < 1e-3 && trust == Trust::Healthy);
}
