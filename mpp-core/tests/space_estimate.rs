//! The estimator in space against motions that are known, against least squares, and against inputs that make no sense.

use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{
    InertialSample, MeasurementStatus, PositionVerdict, SpaceEstimator, SpaceFix, Trust,
};
use mpp_core::vehicle::{
    Airframe, Derivatives, GRAVITY, LateralAirframe, LateralControl, Quaternion, SpaceModel,
};
use proptest::prelude::*;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

const AIRSPEED: f64 = 12.0;
pub(crate) const SIGMA: f64 = 0.0087;
const NEUTRAL: LateralControl = LateralControl {
    aileron: 0.0,
    rudder: 0.0,
};

fn model() -> SpaceModel {
    SpaceModel::new(&Airframe::PAPER, AIRSPEED, 0.45, 20.0, [0.96, 1.57]).unwrap()
}

fn lateral() -> LateralAirframe {
    let none = Derivatives {
        sideslip: 0.0,
        roll_rate: 0.0,
        yaw_rate: 0.0,
        aileron: 0.0,
        rudder: 0.0,
    };
    LateralAirframe {
        span: 1.5,
        roll_inertia: 0.1,
        yaw_inertia: 0.2,
        product_inertia: 0.0,
        side: Derivatives {
            sideslip: -0.5,
            ..none
        },
        roll: none,
        yaw: none,
    }
}

pub(crate) fn estimator() -> SpaceEstimator {
    SpaceEstimator::new(&model(), &lateral())
}

/// A steady level turn in a steady wind, by formulas.
#[derive(Clone, Copy)]
pub(crate) struct Turn {
    pub(crate) bank: f64,
    pub(crate) wind: [f64; 3],
}

impl Turn {
    fn rate(self) -> f64 {
        GRAVITY * libm::tan(self.bank) / AIRSPEED
    }

    fn position(self, time: f64) -> [f64; 3] {
        let (course, rate) = (self.rate() * time, self.rate());
        let [x, y] = if rate.abs() > 1e-9 {
            [libm::sin(course) / rate, (1.0 - libm::cos(course)) / rate]
        } else {
            [time, 0.0]
        };
        let [u, v, w] = self.wind;
        [
            AIRSPEED * x + u * time,
            AIRSPEED * y + v * time,
            50.0 + w * time,
        ]
    }

    fn velocity(self, time: f64) -> [f64; 3] {
        let (sin, cos) = libm::sincos(self.rate() * time);
        let [u, v, w] = self.wind;
        [AIRSPEED * cos + u, AIRSPEED * sin + v, w]
    }

    /// The angle of attack that carries the aircraft in this turn.
    fn angle_of_attack(self) -> f64 {
        model().angle_for(AIRSPEED, GRAVITY / libm::cos(self.bank))
    }

    fn attitude(self, time: f64) -> Quaternion {
        Quaternion::attitude([self.bank, 0.0, self.rate() * time])
            .times(Quaternion::pitch(self.angle_of_attack()))
    }

    pub(crate) fn sample(self, time: f64, age: u32) -> InertialSample {
        let attitude = self.attitude(time);
        let (sin, cos) = libm::sincos(self.rate() * time);
        let turning = AIRSPEED * self.rate();
        let [bank, pitch, heading] = attitude.angles();
        InertialSample {
            age,
            // The last bits of an attitude are never the same.
            attitude: [bank, pitch, heading + 1e-9 * libm::sin(1e3 * time)],
            sigma: SIGMA,
            rates: attitude.world_in([0.0, 0.0, self.rate()]),
            force: attitude.world_in([-turning * sin, turning * cos, -GRAVITY]),
        }
    }

    pub(crate) fn fix(self, time: f64, age: u32) -> SpaceFix {
        SpaceFix {
            age,
            position: self.position(time),
            sigma: 0.02,
            velocity: Some((self.velocity(time), 0.1)),
        }
    }
}

pub(crate) fn time(tick: u32) -> f64 {
    f64::from(tick) * TICK_PERIOD
}

/// Flies some ticks with exact sensors: attitudes two ticks late, ten fixes a second that are five ticks late.
pub(crate) fn flown(turn: Turn, ticks: u32) -> SpaceEstimator {
    let mut estimator = estimator();
    (10..10 + ticks).for_each(|tick| step(&mut estimator, turn, tick));
    estimator
}

fn step(estimator: &mut SpaceEstimator, turn: Turn, tick: u32) {
    estimator.predict(Some(&turn.sample(time(tick - 2), 2)));
    // The last bits of an airspeed are never the same.
    let airspeed = AIRSPEED + 1e-6 * f64::from(tick % 7);
    estimator.observe_airspeed(Some(airspeed), &NEUTRAL);
    let fix = turn.fix(time(tick - 5), 5);
    estimator.observe_fix((tick % 10 == 5).then_some(&fix));
}

pub(crate) fn off(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3)
        .map(|axis| (a[axis] - b[axis]).powi(2))
        .sum::<f64>()
        .sqrt()
}

proptest! {
    /// Whatever the wind and the turn, two seconds of good sensors tell all of the motion.
    #[test]
    fn motion_and_wind_are_found_within_two_seconds(
        bank in -0.9..0.9, x in -5.0..5.0, y in -5.0..5.0, z in -1.0..1.0,
    ) {
        let turn = Turn { bank, wind: [x, y, z] };
        let estimator = flown(turn, 200);
        let now = time(209);
        let motion = estimator.motion().unwrap();
        prop_assert!(off(motion.path.position, turn.position(now)) < 0.03);
        prop_assert!(off(estimator.ground_velocity().unwrap(), turn.velocity(now)) < 0.06);
        prop_assert!(off(estimator.wind(), turn.wind) < 0.2, "{:?}", estimator.wind());
        prop_assert!((motion.path.bank - bank).abs() < 0.02);
        let [attack, sideslip] = estimator.flow_angles().unwrap();
        prop_assert!((attack - turn.angle_of_attack()).abs() < 0.02);
        prop_assert!(sideslip.abs() < 0.02);
        // The two together are the velocity over ground, whatever the wind.
        let ground = motion.path.ground_velocity(&estimator.wind());
        prop_assert!(off(ground, estimator.ground_velocity().unwrap()) < 1e-9);
        prop_assert_eq!(estimator.refused(), Default::default());
        let trust = estimator.trust();
        prop_assert_eq!([trust.airspeed, trust.pitch, trust.position], [Trust::Healthy; 3]);
    }

    /// A point of the world that is seen from a moving aircraft stays where it is.
    #[test]
    fn beams_have_the_pose_of_their_own_time(
        bank in -0.9..0.9, y in -5.0..5.0, age in -0.015..0.25, direction in [0.2..1.0, -0.7..0.7, -0.3..0.3],
    ) {
        let turn = Turn { bank, wind: [0.0, y, 0.0] };
        let estimator = flown(turn, 300);
        let (now, then) = (time(309), time(309) - age);
        let length = off(direction, [0.0; 3]);
        let direction = direction.map(|it: f64| it / length);
        let [right_x, right_y, down] = turn.attitude(then).in_world(direction.map(|it| 30.0 * it));
        let [x, y, z] = turn.position(then);
        let point = [x + right_x, y + right_y, z - down];
        let origin = estimator.pose(0.0).unwrap().position;
        prop_assert!(off(origin, turn.position(now)) < 0.03);
        let beam = estimator.pose(age).unwrap().beam(direction, Some(30.0), &origin);
        let seen = [0, 1, 2].map(|axis| origin[axis] + beam.range.unwrap() * beam.direction[axis]);
        // A history of 10 ms and exact sensors: 2 mrad at 30 m.
        prop_assert!(off(seen, point) < 0.08, "{}", off(seen, point));
    }

    /// Numbers of any kind leave an estimate of finite numbers.
    #[test]
    fn no_input_makes_the_estimate_infinite(seed in any::<u64>()) {
        let mut draws = Pcg64Mcg::seed_from_u64(seed);
        let turn = Turn { bank: 0.3, wind: [1.0, 2.0, 0.0] };
        let mut estimator = flown(turn, 100);
        let mut any = |usual: f64| match draws.next_u64() % 8 {
            0 => f64::from_bits(draws.next_u64()),
            1 => usual * 1e3,
            _ => usual,
        };
        for tick in 110..400 {
            let mut sample = turn.sample(time(tick), 0);
            for part in [&mut sample.attitude, &mut sample.rates, &mut sample.force] {
                *part = part.map(&mut any);
            }
            sample.sigma = any(sample.sigma);
            sample.age = any(1.0) as u32;
            estimator.predict(Some(&sample));
            estimator.observe_airspeed(Some(any(AIRSPEED)), &NEUTRAL);
            let mut fix = turn.fix(time(tick), 0);
            fix.position = fix.position.map(&mut any);
            (fix.age, fix.sigma) = (any(3.0) as u32, any(fix.sigma));
            fix.velocity = fix.velocity.map(|(velocity, sigma)| (velocity.map(&mut any), any(sigma)));
            estimator.observe_fix(Some(&fix));
            if let Some(motion) = estimator.motion() {
                let numbers = motion.path.numbers();
                let all = numbers.iter().chain(&motion.rates);
                prop_assert!(all.clone().all(|it| it.is_finite()), "{numbers:?}");
            }
            prop_assert!(estimator.wind().iter().all(|it| it.abs() < 20.0));
            let variances = estimator.variances().unwrap();
            prop_assert!(variances.iter().all(|it| it.is_finite() && *it >= 0.0), "{variances:?}");
        }
    }
}

#[test]
fn outliers_are_refused_and_counted_and_what_stays_is_believed() {
    let turn = Turn {
        bank: 0.0,
        wind: [0.0, 3.0, 0.0],
    };
    let mut estimator = flown(turn, 200);
    let before = estimator.clone();
    let now = time(210);
    let wrong = |by: f64| SpaceFix {
        position: turn.position(now).map(|it| it + by),
        ..turn.fix(now, 0)
    };
    estimator.predict(Some(&InertialSample {
        attitude: [0.5, 0.1, 0.0],
        ..turn.sample(now, 0)
    }));
    assert_eq!(
        estimator.observe_airspeed(Some(25.0), &NEUTRAL),
        MeasurementStatus::Gated
    );
    assert_eq!(
        estimator.observe_fix(Some(&wrong(5.0))),
        Some(PositionVerdict::Gated)
    );
    let refused = estimator.refused();
    assert_eq!(
        [refused.inertial, refused.airspeed, refused.position],
        [1; 3]
    );
    assert!(off(estimator.wind(), before.wind()) < 1e-9);
    assert!(off(estimator.position().unwrap(), turn.position(now)) < 0.03);
    assert!(estimator.motion().unwrap().path.bank.abs() < 0.02);
    // The source has jumped for good: after a second it is believed.
    let mut verdicts = Vec::new();
    for tick in 211..340 {
        estimator.predict(Some(&turn.sample(time(tick), 0)));
        let jumped = SpaceFix {
            position: turn.position(time(tick)).map(|it| it + 5.0),
            ..turn.fix(time(tick), 0)
        };
        verdicts.extend(estimator.observe_fix((tick % 10 == 0).then_some(&jumped)));
    }
    assert_eq!(
        verdicts
            .iter()
            .filter(|it| **it == PositionVerdict::Restarted)
            .count(),
        1
    );
    assert_eq!(verdicts.last(), Some(&PositionVerdict::Accepted));
    let there = turn.position(time(339)).map(|it| it + 5.0);
    assert!(off(estimator.position().unwrap(), there) < 0.1);
}

#[test]
fn silent_and_frozen_sensors_are_told() {
    let turn = Turn {
        bank: 0.4,
        wind: [2.0, 0.0, 0.0],
    };
    let mut estimator = flown(turn, 200);
    for tick in 210..240 {
        estimator.predict(Some(&turn.sample(time(tick), 0)));
        estimator.observe_airspeed(Some(AIRSPEED), &NEUTRAL);
    }
    assert_eq!(estimator.trust().airspeed, Trust::Excluded);
    assert!(off(estimator.wind(), turn.wind) < 0.2);
    // Rates go on for a while without a sample, and then nobody knows the attitude.
    for _ in 0..22 {
        assert_eq!(estimator.predict(None), MeasurementStatus::Missing);
    }
    assert_eq!(estimator.trust().pitch, Trust::Excluded);
    assert!(off(estimator.position().unwrap(), turn.position(time(261))) < 0.1);
    assert!(estimator.motion().is_some());
    (0..20).for_each(|_| {
        estimator.predict(None);
    });
    assert_eq!(estimator.motion(), None);
}

#[test]
fn without_a_velocity_the_first_one_is_the_airspeed_and_fixes_correct_it() {
    let turn = Turn {
        bank: 0.0,
        wind: [1.0, -4.0, 0.0],
    };
    let mut estimator = estimator();
    assert_eq!(estimator.motion(), None);
    for tick in 10..310 {
        estimator.predict(Some(&turn.sample(time(tick), 0)));
        let airspeed = AIRSPEED + 1e-6 * f64::from(tick % 7);
        estimator.observe_airspeed(Some(airspeed), &NEUTRAL);
        let fix = SpaceFix {
            velocity: None,
            ..turn.fix(time(tick), 0)
        };
        estimator.observe_fix((tick % 10 == 0).then_some(&fix));
    }
    let velocity = estimator.ground_velocity().unwrap();
    assert!(off(velocity, turn.velocity(0.0)) < 0.1, "{velocity:?}");
    assert!(off(estimator.wind(), turn.wind) < 0.5);
}
