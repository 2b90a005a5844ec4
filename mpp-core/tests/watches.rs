//! Tests the watches of the sensors: biases of pitch and airspeed, and sensors that freeze or fall silent.

use crate::common::draw::gaussian;
use crate::common::sensors::frame;
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{
    AirspeedBias, Before, BiasMonitor, CalmFlight, PitchBias, Seen, SensorMonitor, Trust,
};
use mpp_core::flight::FlightLoop;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{AirState, Airframe, GRAVITY, Trim, VehicleState};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

/// A pitch that reads too much tilts the estimated motion: the wind and the airspeed show the same tilt. Winds that
/// change as much as they last are gusts, and what only one of the two shows is no bias.
#[test]
fn a_tilt_that_wind_and_airspeed_show_is_a_bias_of_the_pitch() {
    let mut random = Pcg64Mcg::seed_from_u64(5);
    for bias in [-0.09, -0.06, 0.06, 0.09] {
        let mut watch = PitchBias::new();
        for _ in 0..300 {
            let noise = 0.004 * gaussian(&mut random);
            watch.update(bias + noise, 1.1 * bias - 2.0 * noise, TICK_PERIOD);
        }
        assert!(watch.found() && (watch.angle() - bias).abs() < 0.005);
        // The bias ends.
        for _ in 0..2500 {
            let noise = 0.004 * gaussian(&mut random);
            watch.update(noise, noise, TICK_PERIOD);
        }
        assert!(!watch.found() && watch.angle().abs() < 1e-12);
        watch.update(f64::NAN, bias, TICK_PERIOD);
        watch.update(bias, f64::NAN, TICK_PERIOD);
        watch.update(1.0, 1.0, -1.0);
        assert!(!watch.found());

        // A steady wind alone, and a wrong drag alone.
        let [mut wind, mut drag] = [PitchBias::new(); 2];
        for _ in 0..1000 {
            wind.update(bias, 0.3 * bias, TICK_PERIOD);
            drag.update(0.3 * bias, bias, TICK_PERIOD);
            assert!(!wind.found() && !drag.found());
        }
    }
    // Gusts of 1 m/s with a correlation time of 4 s along and across, 20 s each.
    let (mut ticks, mut taken) = (0, 0);
    for _ in 0..200 {
        let mut watch = PitchBias::new();
        let mut gust = [0.0; 2].map(|_: f64| gaussian(&mut random) / 12.0);
        let kept = libm::exp(-TICK_PERIOD / 4.0);
        for _ in 0..2000 {
            for part in &mut gust {
                *part = kept * *part + (1.0 - kept * kept).sqrt() * gaussian(&mut random) / 12.0;
            }
            watch.update(gust[0], gust[1], TICK_PERIOD);
            ticks += 1;
            taken += u32::from(watch.found());
        }
    }
    let share = f64::from(taken) / f64::from(ticks);
    assert!(share < 0.03, "gusts count as a bias in {share} of the time");
}

/// An airspeed that reads too much by a growing error shows as less wind along the way and as less lift. The watch gives the
/// estimates of before, and believes the sensor again after it has agreed for some time.
#[test]
fn a_growing_error_of_the_airspeed_is_found_by_wind_and_lift_together() {
    let level_lift = 1.4;
    for sign in [-1.0, 1.0] {
        let shown = |wind: f64, lift: f64| {
            let mut watch = AirspeedBias::new(level_lift);
            (0..2000_u32).find_map(|tick| {
                // Half a metre a second more in each second, from 3 s on.
                let error = sign * 0.005 * f64::from(tick.saturating_sub(300));
                let offset = -2.0 * level_lift * error / 12.0;
                let before =
                    watch.update(1.0 - wind * error, 0.1 + lift * offset, 12.0, TICK_PERIOD);
                before.map(|before| (error, before, watch))
            })
        };
        // The estimate of the lift shows half of it, because it averages.
        let (error, before, mut watch) = shown(1.0, 0.5).unwrap();
        assert!((1.3..2.2).contains(&(sign * error)), "{error}");
        assert!((before.wind - 1.0).abs() < 0.3 && (before.lift - 0.1).abs() < 0.03);
        assert!(shown(1.0, 0.0).is_none() && shown(0.0, 1.0).is_none());
        assert!(shown(1.0, -0.5).is_none());

        let agrees_after = |watch: &mut AirspeedBias, measured: f64, ticks: u32| {
            (0..ticks).find(|_| {
                watch.compare(measured, 12.0, TICK_PERIOD);
                !watch.found()
            })
        };
        assert_eq!(agrees_after(&mut watch, 12.0 + error, 2000), None);
        let agreed = agrees_after(&mut watch, 12.1, 2000).unwrap();
        // Its mean comes back to a few percent before the 3 s begin.
        assert!((340..600).contains(&agreed), "{agreed}");
    }
}

/// An airspeed that was wrong from the first tick on never changes wind and lift. They are then further from calm air and the
/// known airframe than both can be, and the pitch, which seems tilted by it, is not blamed.
#[test]
fn an_airspeed_that_is_wrong_from_the_start_is_found_and_the_pitch_is_not_blamed() {
    let level_lift = Airframe::REFERENCE.level_lift(12.0);
    let found = |wind: f64, lift: f64| {
        let mut biases = BiasMonitor::new(&Airframe::REFERENCE, 12.0);
        let before = (0..500).find_map(|_| {
            biases.see_tilt(0.09, 0.1, TICK_PERIOD);
            biases.see_wind(wind, lift * level_lift, 12.0, TICK_PERIOD)
        });
        (before, biases)
    };
    for sign in [-1.0, 1.0] {
        let (before, mut biases) = found(2.0 * sign, 0.4 * sign);
        let calm = Before {
            wind: 0.0,
            lift: 0.0,
        };
        assert_eq!(before, Some(calm));
        assert!(biases.airspeed().found() && !biases.pitch().found());
        for _ in 0..500 {
            biases.see_tilt(0.09, 0.1, TICK_PERIOD);
        }
        assert!(!biases.pitch().found());

        // Wind alone, an airframe that lifts more alone, both less than that, and what no error of the airspeed shows.
        for (wind, lift) in [(4.0, 0.0), (0.0, 0.6), (2.0, 0.2), (1.0, 0.4), (2.0, -0.4)] {
            let (before, biases) = found(sign * wind, sign * lift);
            assert_eq!(before, None, "{wind}, {lift}");
            assert!(biases.pitch().found(), "{wind}, {lift}");
        }
    }
}

/// While commands and forces explain the motion over ground, an airspeed and a pitch that are both off are both wrong, whatever
/// their signs. One of them alone is left to its own watch. A wind along the way, a downdraught, or another weight leave
/// something unexplained.
#[test]
fn an_airspeed_and_a_pitch_that_are_both_wrong_are_found_by_the_motion_over_ground() {
    let known = Airframe::REFERENCE;
    let trim = Trim::at_speed(&known, 12.0, 0.0).unwrap();
    let found = |airspeed: f64, pitch: f64, wind: (f64, f64), push: (f64, f64)| {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        let mut watch = CalmFlight::new(&known);
        let mut velocity = (12.0 + wind.0, wind.1);
        (0..600).find_map(|tick| {
            (velocity.0, velocity.1) = (
                velocity.0 + push.0 * TICK_PERIOD,
                velocity.1 + push.1 * TICK_PERIOD,
            );
            let seen = Seen {
                velocity,
                airspeed: 12.0 + airspeed + 0.5 * gaussian(&mut random),
                pitch: trim.state.pitch + pitch + 0.004 * gaussian(&mut random),
                angle_of_attack: trim.state.pitch,
                thrust: trim.control.thrust,
            };
            let angle = watch.update(&seen, TICK_PERIOD)?;
            Some((tick, angle))
        })
    };
    let still = (0.0, 0.0);
    for (airspeed, pitch) in [(-3.0, 0.09), (3.0, -0.09), (3.0, 0.09), (-3.0, -0.09)] {
        let (tick, angle) = found(airspeed, pitch, still, still).unwrap();
        assert!(
            tick < 150 && (angle - pitch).abs() < 0.005,
            "{tick} {angle}"
        );
        assert_eq!(found(airspeed, 0.0, still, still), None);
        assert_eq!(found(0.0, pitch, still, still), None);
        // What the sensors then say is right: the air moves, or something pushes.
        assert_eq!(found(0.0, pitch, (airspeed, 0.0), still), None);
        assert_eq!(found(0.0, 0.0, (airspeed, -12.0 * pitch), still), None);
        let lift = (0.0, 0.2 * GRAVITY);
        assert_eq!(found(airspeed, pitch, still, lift), None);
    }
    let mut watch = CalmFlight::new(&known);
    for value in [f64::NAN, f64::INFINITY, -1e300, 0.0] {
        let seen = Seen {
            velocity: (value, value),
            airspeed: value,
            pitch: value,
            angle_of_attack: value,
            thrust: value,
        };
        assert_eq!(watch.update(&seen, TICK_PERIOD), None);
        assert_eq!(watch.update(&seen, value), None);
    }
}

/// A sensor that freezes is left out within half a second, and is used again only after it has delivered good
/// values for half a second.
#[test]
fn a_frozen_sensor_is_excluded_and_recovers_by_rule() {
    let mut flight = FlightLoop::new(&Settings::flight()).unwrap();
    let level = flight.state().air;
    let mut seen = Vec::new();
    for tick in 0..400 {
        let time = f64::from(tick) * TICK_PERIOD;
        let last_digits = 1e-9 * f64::from(tick % 2);
        let frozen = (100..200).contains(&tick);
        let air = AirState {
            airspeed: level.airspeed + if frozen { 0.25 } else { last_digits },
            pitch: level.pitch + last_digits,
            ..level
        };
        flight.step(
            time,
            &frame(&VehicleState {
                x: level.airspeed * time,
                z: 50.0,
                air,
            }),
        );
        assert_eq!(flight.sensors().pitch, Trust::Healthy);
        if seen
            .last()
            .is_none_or(|(_, trust)| *trust != flight.sensors().airspeed)
        {
            seen.push((tick, flight.sensors().airspeed));
        }
    }
    let [
        (_, Trust::Healthy),
        (suspected, Trust::Suspected),
        (excluded, Trust::Excluded),
        (recovering, Trust::Recovering),
        (healthy, Trust::Healthy),
    ] = seen[..]
    else {
        panic!("{seen:?}");
    };
    assert!(suspected < 115 && excluded < 150, "{seen:?}");
    assert!(
        recovering == 200 && (245..260).contains(&healthy),
        "{seen:?}"
    );
}

/// A sensor that falls silent while it recovers is excluded again, however long it is silent.
#[test]
fn a_sensor_must_deliver_good_values_all_through_its_recovery() {
    let mut watch = SensorMonitor::new(10);
    for _ in 0..60 {
        watch.tick(None);
    }
    assert_eq!(watch.trust(), Trust::Excluded);
    watch.tick(Some(true));
    assert_eq!(watch.trust(), Trust::Recovering);
    for _ in 0..30 {
        watch.tick(None);
    }
    assert_eq!(watch.trust(), Trust::Excluded);
    watch.tick(Some(true));
    assert_eq!(watch.trust(), Trust::Recovering);
    // Good values at the sensor's own period.
    let mut ticks = 0;
    while watch.trust() == Trust::Recovering && ticks < 200 {
        ticks += 1;
        watch.tick((ticks % 10 == 0).then_some(true));
    }
    assert_eq!(watch.trust(), Trust::Healthy);
    assert_eq!(ticks, 50);
}

/// The elevator sticks while the core believes that it moves. The filter refuses the pitch at first, then follows it. A
/// sensor that jumps to and fro is not followed.
#[test]
fn a_pitch_on_a_steady_course_is_believed_against_the_model() {
    for fails in [false, true] {
        let mut flight = FlightLoop::new(&Settings::flight()).unwrap();
        let level = flight.state().air;
        let (mut truth, mut worst, mut excluded) = (level.pitch, 0.0_f64, false);
        for tick in 0..300 {
            let time = f64::from(tick) * TICK_PERIOD;
            // From 1 s on the aircraft turns up by 20 degrees in a second, and stays there.
            if (100..200).contains(&tick) && !fails {
                truth += 0.0035;
            }
            let jump = match fails && tick >= 100 {
                true => 0.3 - 0.6 * f64::from(tick % 2),
                false => 0.0,
            };
            let air = AirState {
                airspeed: level.airspeed + 1e-9 * f64::from(tick % 2),
                pitch: truth + jump + 1e-9 * f64::from(tick % 2),
                ..level
            };
            let (x, z) = (level.airspeed * time, 50.0);
            flight.step(time, &frame(&VehicleState { x, z, air }));
            excluded |= flight.sensors().pitch == Trust::Excluded;
            if tick > 110 {
                worst = worst.max((flight.state().air.pitch - truth).abs());
            }
        }
        assert!(worst < 0.2, "{worst} rad");
        assert_eq!(excluded, fails);
    }
}
