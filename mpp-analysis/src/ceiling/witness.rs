//! The proof that a field can be passed: a flight of the simulated aircraft, found by a search that knows the field.
//!
//! The search flies the plant itself. From each state it tries some angles of attack for a short time, and keeps the states from
//! which the [`Guide`] promises the best way on. What it returns is a list of commands; whoever doubts it flies them again.

use super::envelope::Envelope;
use super::free::Interval;
use super::guide::Guide;
use mpp_core::config::TICK_PERIOD;
use mpp_core::units::Units;
use mpp_core::vehicle::{Airframe, Control, GRAVITY, VehicleState};
use mpp_sim::aircraft::Aircraft;
use mpp_sim::field::{Obstacle, ObstacleField};
use mpp_sim::outcome::Score;
use mpp_sim::plant::Plant;
use std::collections::HashSet;

/// Angles of attack that are tried from each state.
const TRIED: usize = 9;
/// Part of the envelope's angles of attack that is tried [-]. The rest is for swings.
const TRIED_SHARE: f64 = 0.85;
/// States that are alike: their heights \[m\], sines and angles of attack \[rad\] differ by less than this.
const ALIKE: (f64, f64, f64) = (0.15, 0.04, 0.08);
/// Thrust answers a lack of airspeed [N s/m], in the aircraft's units.
const SPEED_GAIN: f64 = 8.0;

/// What the search needs.
pub(super) struct Search<'a> {
    pub(super) start: &'a Aircraft,
    pub(super) airframe: &'a Airframe,
    pub(super) field: &'a ObstacleField,
    pub(super) envelope: &'a Envelope,
    pub(super) guide: &'a Guide,
    pub(super) trim: Control,
    pub(super) cruise: f64,
    pub(super) band: Interval,
    pub(super) margin: f64,
    pub(super) end: f64,
    pub(super) units: Units,
    /// Duration of a command \[s\], in the aircraft's units.
    pub(super) hold: f64,
    /// States that are kept at a time.
    pub(super) width: usize,
}

/// How a state was reached: the index of the state before it, and the command.
type Leg = (usize, f64);

/// A state, and how it was reached.
struct Node {
    aircraft: Aircraft,
    leg: Leg,
}

/// The commands of a flight that passes the field: angles of attack \[rad\], each for the duration of a command.
pub(super) type Commands = Vec<f64>;

impl Search<'_> {
    /// Looks for a flight to the end.
    pub(super) fn run(&self) -> Option<Commands> {
        let mut layer = vec![Node {
            aircraft: self.start.clone(),
            leg: (0, 0.0),
        }];
        let mut legs: Vec<Vec<Leg>> = Vec::new();
        let way = self.end - self.start.state().x;
        let longest = 3.0 * way / (self.cruise * self.hold * self.units.time);
        for _ in 0..longest as usize {
            let near = self.near(&layer);
            let mut next = Vec::new();
            for (before, node) in layer.iter().enumerate() {
                for angle_of_attack in self.tried() {
                    let mut aircraft = node.aircraft.clone();
                    if !self.fly(&mut aircraft, angle_of_attack, &near) {
                        continue;
                    }
                    let leg = (before, angle_of_attack);
                    if aircraft.state().x >= self.end {
                        return Some(commands(&legs, leg));
                    }
                    let node = Node { aircraft, leg };
                    next.push((self.price(&node), node));
                }
            }
            layer = self.best(next);
            if layer.is_empty() {
                return None;
            }
            legs.push(layer.iter().map(|node| node.leg).collect());
        }
        None
    }

    /// The obstacles that flights from these states may meet within a command.
    fn near(&self, layer: &[Node]) -> ObstacleField {
        let places = || layer.iter().map(|node| node.aircraft.state().x);
        let first = places().fold(f64::INFINITY, f64::min);
        let last = places().fold(f64::NEG_INFINITY, f64::max);
        let ahead = last - first + self.envelope.airspeed[1] * self.hold * self.units.time;
        let middle = (first + 0.5 * ahead, 0.5 * (self.band.0 + self.band.1));
        let reach = 0.5 * ahead + 0.5 * (self.band.1 - self.band.0) + self.margin;
        let near = |one: &&Obstacle| one.clearance(middle, 0.0) <= reach;
        ObstacleField::new(self.field.obstacles.iter().filter(near).cloned().collect())
    }

    /// Angles of attack to try \[rad\].
    fn tried(&self) -> impl Iterator<Item = f64> {
        let [low, high] = self.envelope.angle_of_attack;
        let (middle, half) = (0.5 * (low + high), 0.5 * TRIED_SHARE * (high - low));
        (0..TRIED).map(move |index| middle + half * (2.0 * index as f64 / (TRIED - 1) as f64 - 1.0))
    }

    /// Flies one command. Returns whether the flight stayed in the envelope, in the band and clear of obstacles.
    fn fly(&self, aircraft: &mut Aircraft, angle_of_attack: f64, near: &ObstacleField) -> bool {
        let middle = 0.5 * (self.band.0 + self.band.1);
        let mut score = Score::new(middle, self.band.1 - middle, self.margin);
        let ticks = (self.hold * self.units.time / TICK_PERIOD).round().max(1.0) as usize;
        for _ in 0..ticks {
            let before = *aircraft.state();
            let command = self.command(&before, angle_of_attack);
            if aircraft.step(command).is_err() {
                return false;
            }
            let after = aircraft.state();
            let ended = score.update(near, &before, after).is_some();
            if ended || !score.in_band() || !self.envelope.holds(&after.air) {
                return false;
            }
        }
        true
    }

    /// The elevator that balances an angle of attack, and thrust that holds the airspeed along the path.
    pub(super) fn command(&self, state: &VehicleState, angle_of_attack: f64) -> Control {
        let air = &state.air;
        let weight = self.airframe.mass * GRAVITY;
        let lack = (self.cruise - air.airspeed) * self.units.time / self.units.length;
        let thrust = self.trim.thrust
            + weight * libm::sin(air.flight_path)
            + SPEED_GAIN * self.units.force() * lack;
        Control {
            thrust: thrust.clamp(0.0, self.envelope.thrust),
            elevator: self.airframe.elevator_for(angle_of_attack),
        }
    }

    /// The price of the way on.
    fn price(&self, node: &Node) -> f32 {
        let state = node.aircraft.state();
        self.guide
            .price((state.x, state.z), libm::sin(state.air.flight_path))
    }

    /// The states with the best way on, one of those that are alike.
    fn best(&self, mut next: Vec<(f32, Node)>) -> Vec<Node> {
        next.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut seen = HashSet::new();
        let length = self.units.length;
        let key = |state: &VehicleState| {
            let cell = |value: f64, size: f64| (value / size).floor() as i32;
            let (height, sine, alpha) = ALIKE;
            (
                cell(state.z, height * length),
                cell(libm::sin(state.air.flight_path), sine),
                cell(state.air.angle_of_attack(), alpha),
            )
        };
        let mut kept = Vec::new();
        for (_, node) in next {
            if seen.insert(key(node.aircraft.state())) {
                kept.push(node);
                if kept.len() == self.width {
                    break;
                }
            }
        }
        kept
    }
}

/// The commands up to a last one.
fn commands(legs: &[Vec<Leg>], last: Leg) -> Commands {
    let (mut index, angle_of_attack) = last;
    let mut commands = vec![angle_of_attack];
    for layer in legs.iter().rev() {
        let (before, angle_of_attack) = layer[index];
        commands.push(angle_of_attack);
        index = before;
    }
    commands.reverse();
    commands
}
