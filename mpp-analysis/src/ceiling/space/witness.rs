//! The witness: the simulated aircraft flies along a way by the core's regulator, with its true state, again and again. From each
//! flight the track learns how far the next one has to be aimed to the other side (iterative learning control).

use super::envelope::SpaceEnvelope;
use super::trunks::Place;
use super::way::Way;
use mpp_core::config::TICK_PERIOD;
use mpp_core::control::{SpaceMotion, SpaceRegulator};
use mpp_core::vehicle::{GRAVITY, SpaceControl, SpaceModel, SpacePath};
use mpp_sim::outcome::Outcome;
use mpp_sim::space::{SpaceAircraft, SpaceScenario, true_path};

/// Time by which bank and angle of attack follow their commands \[ticks\], as the core's step has it.
const AHEAD: usize = 12;
/// Flights along a way.
const FLIGHTS: usize = 5;
/// Time between moments at which another way may begin \[ticks\].
const MOMENTS: u32 = 20;
/// Half of the time over which errors are averaged, twice \[ticks\]. Source: chosen, the time in which the aircraft rolls.
const SMOOTH: usize = 12;
/// Share of an error by which the next flight aims to the other side [-]. Source: chosen.
const LEARNT: f64 = 0.8;

/// What flies along ways.
pub(super) struct Pilot<'a> {
    pub(super) scenario: &'a SpaceScenario,
    pub(super) envelope: &'a SpaceEnvelope,
    pub(super) model: &'a SpaceModel,
    pub(super) regulator: &'a SpaceRegulator,
}

/// A place of the track, the rate of its bank [rad/s], and how far the flight is aimed to its right \[m\].
#[derive(Clone, Copy)]
struct Aim {
    place: Place,
    rate: f64,
    aside: f64,
}

/// A flight up to a tick.
#[derive(Clone)]
pub(super) struct Moment {
    pub(super) aircraft: SpaceAircraft,
    pub(super) flown: u32,
}

impl Moment {
    /// How far ahead it is \[m\].
    pub(super) fn ahead(&self) -> f64 {
        self.aircraft.state().plane.x
    }
}

/// A flight along a way.
pub(super) struct Flight {
    /// How it ended; `None` if it left the envelope.
    pub(super) outcome: Option<Outcome>,
    /// What it was at some of its ticks, in order.
    pub(super) moments: Vec<Moment>,
    /// How far to the right of the track it flew \[m\].
    errors: Vec<f64>,
}

impl Pilot<'_> {
    /// The flight along a way at an airspeed [m/s] that passes all trunks, or else the one that comes farthest.
    pub(super) fn fly(&self, from: &Moment, way: &Way, airspeed: f64) -> Flight {
        let mut track = track(way, airspeed);
        let mut best = self.fly_once(from, &track, airspeed);
        let mut errors = best.errors.clone();
        for _ in 1..FLIGHTS {
            if best.outcome == Some(Outcome::Survived) {
                break;
            }
            let smoothed = smooth(&smooth(&errors));
            for (aim, error) in track.iter_mut().zip(smoothed) {
                aim.aside -= LEARNT * error;
            }
            let flight = self.fly_once(from, &track, airspeed);
            errors.clone_from(&flight.errors);
            if flight.errors.len() > best.errors.len() {
                best = flight;
            }
        }
        best
    }

    fn fly_once(&self, from: &Moment, track: &[Aim], airspeed: f64) -> Flight {
        let Moment {
            mut aircraft,
            mut flown,
        } = from.clone();
        let (mut errors, mut moments) = (Vec::new(), Vec::new());
        let outcome = loop {
            let before = *aircraft.state();
            let path = true_path(&before);
            // The first place of the track that is not behind the aircraft.
            while let Some((ahead, right)) = track.get(errors.len()).map(|aim| seen(aim, &path)) {
                if ahead <= 0.0 {
                    break;
                }
                errors.push(right);
            }
            let Some(last) = track.len().checked_sub(1) else {
                break None;
            };
            let at = |early: usize| (errors.len() + early).min(last);
            let now = self.reference(track, at(0), airspeed, airspeed);
            let ahead = self.reference(track, at(AHEAD), airspeed, path.airspeed);
            let motion = SpaceMotion {
                path,
                rates: [
                    before.lateral.roll_rate,
                    before.plane.air.pitch_rate,
                    before.lateral.yaw_rate,
                ],
                sideslip: before.lateral.sideslip,
            };
            let (command, surfaces) =
                (self.regulator).step(self.model, &motion, &now.0, (&ahead.0, &ahead.1));
            if aircraft.step(command, surfaces).is_err() {
                break None;
            }
            if !self.envelope.holds(&before, aircraft.state()) {
                break None;
            }
            flown += 1;
            let (scenario, state) = (self.scenario, aircraft.state());
            let outcome = scenario.judge(&scenario.world, &before, state, flown);
            if outcome.is_some() {
                break outcome;
            }
            if flown.is_multiple_of(MOMENTS) {
                let aircraft = aircraft.clone();
                moments.push(Moment { aircraft, flown });
            }
        };
        Flight {
            outcome,
            moments,
            errors,
        }
    }

    /// What the regulator follows at a place of the track: a level turn on the track as it is aimed.
    fn reference(
        &self,
        track: &[Aim],
        at: usize,
        wanted: f64,
        airspeed: f64,
    ) -> (SpacePath, SpaceControl) {
        let aim = &track[at];
        let aside = |by: isize| {
            let at = (at as isize + by * SMOOTH as isize).clamp(0, track.len() as isize - 1);
            track[at as usize].aside
        };
        let step = SMOOTH as f64 * TICK_PERIOD * wanted;
        let slope = (aside(1) - aside(-1)) / (2.0 * step);
        let bend = (aside(1) + aside(-1) - 2.0 * aside(0)) / (step * step);
        let bend = GRAVITY * libm::tan(aim.place.bank) / (wanted * wanted) + bend;
        let turn = bend * airspeed * airspeed / GRAVITY;
        let bank = libm::atan(turn).clamp(-self.model.bank, self.model.bank);
        let (sin, cos) = libm::sincos(aim.place.course);
        let [x, y] = aim.place.at;
        let attack = (self.model).angle_for(airspeed, GRAVITY / libm::cos(bank));
        let path = SpacePath {
            position: [
                x - sin * aim.aside,
                y + cos * aim.aside,
                self.scenario.altitude(),
            ],
            airspeed,
            angle_of_attack: attack,
            bank,
            flight_path: 0.0,
            course: aim.place.course + slope,
        };
        let control = SpaceControl {
            bank_rate: aim.rate,
            angle_of_attack_rate: 0.0,
            thrust: self.model.thrust_for(airspeed, attack, 0.0),
        };
        (path, control)
    }
}

/// A way, tick by tick.
fn track(way: &Way, airspeed: f64) -> Vec<Aim> {
    let mut track = Vec::new();
    let Some(mut place) = way.places.first().copied() else {
        return track;
    };
    for (stage, pair) in way.places.windows(2).enumerate() {
        let (begin, end) = (stage as f64 * way.period, (stage + 1) as f64 * way.period);
        let rate = (pair[1].bank - pair[0].bank) / way.period;
        loop {
            let time = track.len() as f64 * TICK_PERIOD;
            if time >= end {
                break;
            }
            place.bank = pair[0].bank + rate * (time - begin);
            track.push(Aim {
                place,
                rate,
                aside: 0.0,
            });
            place = place.after(rate, airspeed, TICK_PERIOD);
        }
    }
    track
}

/// How far a place of the track the aircraft is: ahead, and to the right \[m\].
fn seen(aim: &Aim, path: &SpacePath) -> (f64, f64) {
    let (sin, cos) = libm::sincos(aim.place.course);
    let [x, y] = [0, 1].map(|axis| path.position[axis] - aim.place.at[axis]);
    (cos * x + sin * y, cos * y - sin * x)
}

/// Means over the neighbours.
fn smooth(values: &[f64]) -> Vec<f64> {
    (0..values.len())
        .map(|at| {
            let near = &values[at.saturating_sub(SMOOTH)..(at + SMOOTH + 1).min(values.len())];
            near.iter().sum::<f64>() / near.len() as f64
        })
        .collect()
}
