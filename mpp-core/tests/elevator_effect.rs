//! Tests the estimate of the elevator's effect on an aircraft that flies a plan under a regulator.

use crate::common::draw::gaussian;
use crate::common::motion::air_after_tick;
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{ElevatorEffect, Trust};
use mpp_core::vehicle::{AirState, Airframe, Control, Trim};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

/// A flight of an aircraft whose elevator has `effect` times the known one, beside that of the known aircraft.
struct Flight {
    airframe: Airframe,
    trim: Trim,
    watch: ElevatorEffect,
    actual: AirState,
    known: AirState,
    /// Vertical gust \[m/s\] and its standard deviation.
    gust: f64,
    gusts: f64,
    random: Pcg64Mcg,
    time: f64,
    /// Noise of the positions, which leaves that of the pitch as it is.
    positions: Pcg64Mcg,
    altitude: f64,
    /// Pitch at which the sensor sticks \[rad\].
    stuck: Option<f64>,
}

impl Flight {
    fn new(gusts: f64, seed: u64) -> Self {
        let airframe = Airframe::REFERENCE;
        let trim = Trim::of_authors(&airframe);
        Self {
            watch: ElevatorEffect::new(&airframe, &trim),
            actual: trim.state,
            known: trim.state,
            airframe,
            trim,
            gust: 0.0,
            gusts,
            random: Pcg64Mcg::seed_from_u64(seed),
            time: 0.0,
            positions: Pcg64Mcg::seed_from_u64(seed + 1000),
            altitude: 50.0,
            stuck: None,
        }
    }

    /// Flies for `seconds` by a plan that moves the elevator to and fro by `turns`, and gives the trust at each tick.
    fn fly(&mut self, seconds: f64, effect: f64, turns: f64) -> Vec<Trust> {
        let ticks = (seconds / TICK_PERIOD) as usize;
        (0..ticks).map(|_| self.tick(effect, turns)).collect()
    }

    fn tick(&mut self, effect: f64, turns: f64) -> Trust {
        self.time += TICK_PERIOD;
        let trim = self.trim.control;
        let elevator = trim.elevator + turns * libm::sin(4.0 * self.time);
        let planned = Control { elevator, ..trim };
        // The regulator answers every difference of the pitch, whatever caused it.
        let answer = 8.0 * (self.actual.pitch - self.known.pitch);
        let answer = answer / self.airframe.moment_elevator.signum();
        let wanted = Control {
            elevator: elevator - answer.clamp(-2.0, 2.0),
            ..trim
        };
        let command = self.watch.command_for(wanted);
        let acting = Control {
            elevator: trim.elevator + effect * (command.elevator - trim.elevator),
            ..trim
        };
        let gust = self.gust;
        let kept = libm::exp(-TICK_PERIOD / 2.0);
        self.gust =
            kept * gust + self.gusts * (1.0 - kept * kept).sqrt() * gaussian(&mut self.random);
        let shift = (gust - self.gust) / self.actual.airspeed;
        self.known = after_tick(&self.airframe, &self.known, planned, 0.0);
        self.actual = after_tick(&self.airframe, &self.actual, acting, shift);
        let climb = self.actual.airspeed * libm::sin(self.actual.flight_path) + self.gust;
        self.altitude += TICK_PERIOD * climb;
        let pitch = self.stuck.unwrap_or(self.actual.pitch) + 0.002 * gaussian(&mut self.random);
        let effective = self.watch.effective(command);
        let air = self.actual;
        let altitude = self.altitude + 0.02 * gaussian(&mut self.positions);
        self.watch.update(
            (pitch, altitude),
            &air,
            0.0,
            effective,
            elevator,
            TICK_PERIOD,
        );
        self.watch.trust()
    }
}

/// The motion after a tick in which a gust turns the flow by `shift` \[rad\].
fn after_tick(airframe: &Airframe, state: &AirState, control: Control, shift: f64) -> AirState {
    let after = air_after_tick(airframe, state, control);
    AirState {
        flight_path: after.flight_path + shift,
        ..after
    }
}

#[test]
fn a_weak_elevator_is_found_by_the_turns_of_the_plan_and_made_up_for() {
    for (seed, effect) in [(1, 0.25), (2, 0.3), (3, 0.35)] {
        let mut flight = Flight::new(0.3, seed);
        let seen = flight.fly(2.0, effect, 4.0);
        let found = seen.iter().position(|trust| *trust == Trust::Suspected);
        let found = found.unwrap() as f64 * TICK_PERIOD;
        assert!(found < 1.5, "{effect} after {found} s");
        let estimate = flight.watch.effect();
        assert!((estimate - effect).abs() < 0.1, "{effect}: {estimate}");
        // The elevator works again.
        let last = flight.fly(4.0, 1.0, 4.0).pop();
        assert_eq!(last, Some(Trust::Healthy));
        assert!(flight.watch.effect() > 0.75);
    }
}

/// The regulator moves the elevator against gusts, so that command and turn have nothing to do with each other.
#[test]
fn gusts_and_moderate_errors_of_the_effect_are_no_weak_elevator() {
    for seed in 0..40 {
        for (effect, gusts) in [(0.7, 0.3), (1.0, 1.0), (1.3, 1.0)] {
            let mut flight = Flight::new(gusts, seed);
            let seen = flight.fly(10.0, effect, 4.0);
            assert!(seen.iter().all(|trust| *trust == Trust::Healthy), "{seed}");
            assert!(flight.watch.effect() >= 1.0);
        }
    }
}

#[test]
fn without_turns_the_elevator_shows_nothing() {
    let mut flight = Flight::new(1.0, 5);
    let seen = flight.fly(20.0, 0.25, 0.0);
    assert!(seen.iter().all(|trust| *trust == Trust::Healthy));
}

/// An elevator that was seen to answer is not corrected for a weakness that is soon over.
#[test]
fn a_proven_elevator_must_look_weak_for_longer() {
    for seed in 0..5 {
        let found_after = |proven: f64| {
            let mut flight = Flight::new(0.3, seed);
            let seen = flight.fly(proven, 1.0, 4.0);
            assert!(seen.iter().all(|trust| *trust == Trust::Healthy), "{seed}");
            let weak = flight.fly(6.0, 0.25, 4.0);
            let found = weak.iter().position(|trust| *trust == Trust::Suspected);
            found.unwrap() as f64 * TICK_PERIOD
        };
        // The regression needs about 2.2 s to forget what the elevator did before.
        let [new, proven] = [0.0, 3.0].map(found_after);
        assert!(new < 1.5 && proven > 2.7, "{new} s and {proven} s");
    }
}

/// A share of the effect that is next to nothing cannot be made up for.
#[test]
fn an_elevator_that_does_not_answer_is_told_and_not_corrected() {
    let mut flight = Flight::new(0.0, 6);
    assert!(
        flight
            .fly(3.0, 1.0, 4.0)
            .iter()
            .all(|trust| *trust == Trust::Healthy)
    );
    let stuck = flight.fly(3.0, 0.0, 4.0);
    assert!(stuck.contains(&Trust::Excluded) && !stuck.contains(&Trust::Suspected));
    assert!(flight.watch.effect() >= 1.0);
    let free = flight.fly(3.0, 1.0, 4.0);
    assert!(!free.contains(&Trust::Suspected));
    assert_eq!(free.last(), Some(&Trust::Healthy));
}

#[test]
fn values_that_no_aircraft_gives_are_no_weak_elevator() {
    let mut flight = Flight::new(0.0, 7);
    for wild in [f64::NAN, f64::INFINITY, 1e300, -40.0, 3.0] {
        let (air, control) = (flight.actual, flight.trim.control);
        let watch = &mut flight.watch;
        watch.update(
            (wild, 50.0),
            &air,
            0.0,
            control,
            control.elevator,
            TICK_PERIOD,
        );
        watch.update((air.pitch, wild), &air, 0.0, control, f64::NAN, TICK_PERIOD);
        watch.update(
            (air.pitch, 50.0),
            &air,
            wild,
            control,
            control.elevator,
            TICK_PERIOD,
        );
        assert!(
            flight
                .fly(2.0, 1.0, 4.0)
                .iter()
                .all(|trust| *trust == Trust::Healthy)
        );
    }
    assert!(flight.watch.effect() >= 1.0);
    // It still finds what it looks for.
    assert!(flight.fly(4.0, 0.25, 4.0).contains(&Trust::Suspected));
}

/// A sensor that sticks misses the turns that the altitude shows. The elevator is not to blame, and the sensor is believed
/// again once it shows turns.
#[test]
fn a_pitch_sensor_that_sticks_is_found_by_the_altitude_and_not_the_elevator() {
    for seed in 0..20 {
        let mut flight = Flight::new(0.0, seed);
        flight.fly(3.0, 1.0, 4.0);
        flight.stuck = Some(flight.actual.pitch);
        let mut after = 0.0;
        while !flight.watch.pitch_fails() && after < 5.0 {
            assert_eq!(flight.tick(1.0, 4.0), Trust::Healthy, "{seed}");
            after += TICK_PERIOD;
        }
        assert!(after < 1.2, "{seed}: {after} s");
        flight.stuck = None;
        flight.fly(4.0, 1.0, 4.0);
        assert!(!flight.watch.pitch_fails());
    }
}

#[test]
fn a_stuck_or_weak_elevator_and_gusts_are_no_failure_of_the_pitch_sensor() {
    for seed in 0..40 {
        for (effect, gusts) in [(0.0, 0.0), (0.0, 0.5), (0.25, 0.3), (1.0, 1.0), (1.3, 1.0)] {
            let mut flight = Flight::new(gusts, seed);
            flight.fly(3.0, 1.0, 4.0);
            for _ in 0..700 {
                flight.tick(effect, 4.0);
                assert!(!flight.watch.pitch_fails(), "{seed}: {effect}, {gusts}");
            }
        }
    }
}
