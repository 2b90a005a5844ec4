//! Tests the watch of the motor on an aircraft that the regulator holds in level flight.

use crate::common::draw::gaussian;
use crate::common::motion::air_after_tick;
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{MotorWatch, Progress, Trust};
use mpp_core::flight::FlightLoop;
use mpp_core::sense::{AirData, Measurement, Position, SensorFrame};
use mpp_core::settings::Settings;
use mpp_core::vehicle::{AirState, Airframe, Control, Trim};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

/// An aircraft with the sensors of the default flight, in gusts along the way.
struct Flight {
    flight: FlightLoop,
    airframe: Airframe,
    air: AirState,
    place: (f64, f64),
    /// Gust along the way [m/s] and its standard deviation.
    gust: f64,
    gusts: f64,
    random: Pcg64Mcg,
    tick: u32,
    command: Control,
}

impl Flight {
    /// `mass` is the aircraft's, as a share of that which the core knows.
    fn new(flight: FlightLoop, mass: f64, gusts: f64, seed: u64) -> Self {
        let known = Airframe::REFERENCE;
        let trim = Trim::of_authors(&known);
        Self {
            flight,
            airframe: Airframe {
                mass: mass * known.mass,
                ..known
            },
            air: trim.state,
            place: (0.0, 50.0),
            gust: 0.0,
            gusts,
            random: Pcg64Mcg::seed_from_u64(seed),
            tick: 0,
            command: trim.control,
        }
    }

    /// Flies for `seconds` with a motor that gives this share of its thrust, and tells the trust in it at each tick.
    fn fly(&mut self, seconds: f64, share: f64) -> Vec<Trust> {
        let ticks = (seconds / TICK_PERIOD) as usize;
        (0..ticks).map(|_| self.step(share)).collect()
    }

    fn step(&mut self, share: f64) -> Trust {
        let [airspeed, pitch, x, z] =
            [0.5, 0.004, 0.02, 0.02].map(|s| s * gaussian(&mut self.random));
        let frame = SensorFrame {
            air: Some(AirData {
                age: 0,
                measurement: Measurement {
                    airspeed: self.air.airspeed + airspeed,
                    pitch: self.air.pitch + pitch,
                },
            }),
            position: self.tick.is_multiple_of(10).then_some(Position {
                age: 0,
                x: self.place.0 + x,
                z: self.place.1 + z,
                sigma: 0.02,
                velocity: None,
            }),
        };
        let time = f64::from(self.tick) * TICK_PERIOD;
        self.command = self.flight.step(time, &frame).control;
        self.tick += 1;
        self.move_on(share);
        self.flight.sensors().motor
    }

    /// The motion of one tick. A gust changes the airspeed, not the speed over ground.
    fn move_on(&mut self, share: f64) {
        let thrust = share * self.command.thrust;
        let acting = Control {
            thrust,
            ..self.command
        };
        self.air = air_after_tick(&self.airframe, &self.air, acting);
        let kept = libm::exp(-TICK_PERIOD / 4.0);
        let before = self.gust;
        let drawn = gaussian(&mut self.random);
        self.gust = kept * before + self.gusts * (1.0 - kept * kept).sqrt() * drawn;
        self.air.airspeed += before - self.gust;
        let (along, up) = (
            libm::cos(self.air.flight_path),
            libm::sin(self.air.flight_path),
        );
        self.place.0 += TICK_PERIOD * (self.air.airspeed * along + self.gust);
        self.place.1 += TICK_PERIOD * self.air.airspeed * up;
    }
}

/// The time at which a trust is first told \[s\].
fn first(told: &[Trust], wanted: Trust) -> Option<f64> {
    let found = told.iter().position(|trust| *trust == wanted);
    found.map(|ticks| ticks as f64 * TICK_PERIOD)
}

#[test]
fn a_motor_that_stops_is_found_and_one_that_works_again_too() {
    let core = FlightLoop::new(&Settings::flight()).unwrap();
    for seed in 0..20 {
        let mut flight = Flight::new(core.clone(), 1.0, 0.0, seed);
        assert_eq!(
            first(&flight.fly(8.0, 1.0), Trust::Excluded),
            None,
            "{seed}"
        );
        let told = first(&flight.fly(3.0, 0.0), Trust::Excluded).unwrap();
        assert!(told < 1.3, "seed {seed}: after {told} s");
        let told = first(&flight.fly(3.0, 1.0), Trust::Healthy).unwrap();
        assert!(told < 1.5, "seed {seed}: back after {told} s");
    }
}

/// Without thrust the estimated airspeed follows the true one, the airspeed sensor stays trusted, and the aircraft glides.
#[test]
fn without_thrust_the_aircraft_glides_for_ten_seconds() {
    let core = FlightLoop::new(&Settings::flight()).unwrap();
    for seed in 0..10 {
        let mut flight = Flight::new(core.clone(), 1.0, 0.0, seed);
        flight.fly(8.0, 1.0);
        flight.fly(2.0, 0.0);
        for _ in 0..1000 {
            assert_eq!(flight.step(0.0), Trust::Excluded, "{seed}");
            assert_eq!(flight.flight.sensors().airspeed, Trust::Healthy, "{seed}");
            let off = flight.flight.estimate().airspeed - flight.air.airspeed;
            assert!(off.abs() < 0.5, "seed {seed}: {off} m/s");
            assert!(flight.air.pitch.abs() < 1.0 && flight.air.airspeed > 6.0);
        }
    }
}

#[test]
fn gusts_another_mass_and_a_weak_motor_are_no_stopped_motor() {
    let core = FlightLoop::new(&Settings::flight()).unwrap();
    for seed in 0..40 {
        for (mass, gusts, share) in [
            (1.0, 1.6, 1.0),
            (0.9, 1.0, 1.0),
            (1.1, 1.0, 1.0),
            (1.0, 0.0, 0.8),
        ] {
            let mut flight = Flight::new(core.clone(), mass, gusts, seed);
            let told = first(&flight.fly(20.0, share), Trust::Excluded);
            assert_eq!(
                told, None,
                "seed {seed}, mass {mass}, gusts {gusts}, share {share}"
            );
        }
    }
}

#[test]
fn what_is_not_a_number_is_no_speed() {
    let mut watch = MotorWatch::new(3.2, 4.4, 12.0);
    let level = Progress {
        x: 0.0,
        air: 12.0,
        corrected: 0.0,
        wind: 0.0,
    };
    for tick in 0..1000_u32 {
        let x = 12.0 * TICK_PERIOD * f64::from(tick);
        watch.update(&Progress { x, ..level }, 4.4, TICK_PERIOD);
        watch.update(
            &Progress {
                x: f64::NAN,
                ..level
            },
            4.4,
            TICK_PERIOD,
        );
        watch.update(&Progress { x, ..level }, f64::INFINITY, TICK_PERIOD);
        watch.update(&Progress { x, ..level }, 4.4, -1.0);
    }
    assert!(!watch.lost());
    assert_eq!(watch.trust(), Trust::Healthy);
    // The watch still sees a motor that stops.
    let (mut x, mut air, slower) = (119.88, 12.0, -4.4 / 3.2 * TICK_PERIOD);
    let told = (0..200).find(|_| {
        air += slower;
        x += TICK_PERIOD * air;
        let progress = Progress {
            x,
            air,
            corrected: slower,
            wind: 0.0,
        };
        watch.update(&progress, 4.4, TICK_PERIOD);
        watch.lost()
    });
    assert!(told.is_some());
}

/// The speed by positions is of no use when the position jumps, so the watch restarts.
#[test]
fn after_a_jump_of_the_position_the_watch_settles_again() {
    let told_after = |jump: f64| {
        let mut watch = MotorWatch::new(3.2, 4.4, 12.0);
        let (mut x, mut air) = (0.0, 12.0);
        let mut told = None;
        for tick in 0..3000_u32 {
            let slower = -4.4 / 3.2 * TICK_PERIOD;
            let corrected = if tick < 1000 { 0.0 } else { slower };
            air += corrected;
            x += TICK_PERIOD * air + if tick == 990 { jump } else { 0.0 };
            let progress = Progress {
                x,
                air,
                corrected,
                wind: 0.0,
            };
            watch.update(&progress, 4.4, TICK_PERIOD);
            told = told.or_else(|| watch.lost().then_some(tick));
        }
        told.unwrap()
    };
    assert!((1000..1200).contains(&told_after(0.0)));
    for jump in [-5.0, 5.0] {
        assert!(told_after(jump) > 1300, "{}", told_after(jump));
    }
}

/// An aircraft that is larger in the sense of Froude has a slower watch: all of its times scale alike.
#[test]
fn the_watch_keeps_the_time_of_the_aircraft() {
    let told_after = |scale: f64| {
        let mut watch = MotorWatch::new(3.2, 4.4, 12.0 * scale);
        let (mut x, mut air) = (0.0, 12.0 * scale);
        let stop = (10.0 * scale / TICK_PERIOD) as u32;
        let told = (0..stop + 1000).find(|tick| {
            let slower = -4.4 / 3.2 * TICK_PERIOD;
            let corrected = if *tick < stop { 0.0 } else { slower };
            air += corrected;
            x += TICK_PERIOD * air;
            let progress = Progress {
                x,
                air,
                corrected,
                wind: 0.0,
            };
            watch.update(&progress, 4.4, TICK_PERIOD);
            watch.lost()
        });
        f64::from(told.unwrap() - stop) * TICK_PERIOD
    };
    let [own, large] = [1.0, 2.0].map(told_after);
    assert!((large / own - 2.0).abs() < 0.2, "{own} s and {large} s");
}

/// A gap between two ticks, and estimates that jump and say so, are no lost speed. A motor without a thrust to give cannot be lost.
#[test]
fn gaps_and_jumps_of_the_estimates_are_no_lost_motor() {
    let mut watch = MotorWatch::new(3.2, 4.4, 12.0);
    let mut idle = MotorWatch::new(3.2, 0.0, 12.0);
    let (mut x, mut air, mut wind) = (0.0, 12.0, 0.0);
    for tick in 0..3000_u32 {
        let period = if tick % 100 == 99 { 0.5 } else { TICK_PERIOD };
        if tick % 500 == 499 {
            watch.interrupt();
            (air, wind) = (air + 3.0, wind - 3.0);
        }
        x += (air + wind) * period;
        if tick % 700 == 650 {
            // The first position after lost steps.
            x -= 12.0;
        }
        let corrected = if tick % 200 == 0 { -0.3 } else { 0.0 };
        air += corrected;
        wind -= corrected;
        let progress = Progress {
            x,
            air,
            corrected,
            wind,
        };
        watch.update(&progress, 4.4, period);
        assert!(!watch.lost(), "tick {tick}");
        let falling = Progress {
            wind: wind - 0.01 * f64::from(tick),
            ..progress
        };
        idle.update(&falling, 0.0, period);
        assert!(!idle.lost(), "tick {tick}");
    }
}
