//! Whole flights through worlds: the lidar sees the world, and the flight ends where it ends.

use super::flight::{SpaceConfig, SpaceFlight};
use super::world::World;
use super::{Hull, Quaternion, SpaceState};
use crate::file_error::ScenarioError;
use crate::random::{Draws, Stream, gaussian, generator};
use crate::scenario::Scenario;
use core::fmt;
use mpp_core::config::TICK_PERIOD;
use mpp_core::map::SpaceBeam;

/// How a flight through a world ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpaceEnd {
    /// It reached the far end.
    Arrived,
    /// It touched a body or the ground.
    Hit,
    /// It left the band to the side or upwards.
    Left,
    /// Stall, spin or a speed for which the model does not hold.
    Extreme,
    /// The time is over.
    Time,
}

impl fmt::Display for SpaceEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Arrived => "arrived",
            Self::Hit => "hit",
            Self::Left => "left the band",
            Self::Extreme => "extreme state",
            Self::Time => "time over",
        })
    }
}

/// Figures of a flight through a world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceOutcome {
    /// Its end.
    pub end: SpaceEnd,
    /// Time \[s\] and way ahead \[m\] at the end.
    pub time: f64,
    /// See [`Self::time`].
    pub way: f64,
    /// Least clearance of the hull \[m\].
    pub clearance: f64,
    /// Mean distance from the plan \[m\].
    pub tracking: f64,
}

/// Longest flight \[ticks\].
const MOST_TICKS: u32 = 4000;
/// How far beyond the band a flight may stray \[m\].
const STRAY: f64 = 0.5;
/// Clearance beyond which nobody asks \[m\].
const MOST: f64 = 5.0;

/// A lidar of 90 x 16 beams over 90 x 30 deg, with 45 m of reach and 0.5 % of noise. Its rings are moved from sweep to sweep.
struct Fan {
    draws: Draws,
    sweeps: u32,
}

impl Fan {
    const COLUMNS: u32 = 90;
    const RINGS: u32 = 16;
    const REACH: f64 = 45.0;
    const NOISE: f64 = 0.005;

    /// The beams as an estimate with these errors of bank, pitch and heading \[rad\] places them.
    fn sweep(&mut self, world: &World, state: &SpaceState, errors: [f64; 3]) -> Vec<SpaceBeam> {
        let place = [state.plane.x, state.lateral.y, state.plane.z];
        let [bank, pitch, heading] = errors;
        let truth = state.attitude();
        let told = truth
            .times(Quaternion::roll(bank))
            .times(Quaternion::pitch(pitch));
        let (sin, cos) = libm::sincos(heading);
        let mut beams = Vec::with_capacity((Self::COLUMNS * Self::RINGS) as usize);
        for ring in 0..Self::RINGS {
            let up = ((f64::from(ring) + 0.5) / f64::from(Self::RINGS) - 0.5) * 30.0;
            let offset = f64::from((ring * 7 + self.sweeps * 3) % 16) / 16.0;
            for column in 0..Self::COLUMNS {
                let side = ((f64::from(column) + offset) / f64::from(Self::COLUMNS) - 0.5) * 90.0;
                let (sin_up, cos_up) = libm::sincos(up.to_radians());
                let (sin_side, cos_side) = libm::sincos(side.to_radians());
                let body = [cos_up * cos_side, cos_up * sin_side, -sin_up];
                let range = world.ray(place, upright(truth, body), Self::REACH);
                let range = range.map(|range| {
                    (range * (1.0 + Self::NOISE * gaussian(&mut self.draws))).max(0.1)
                });
                let [x, y, z] = upright(told, body);
                beams.push(SpaceBeam {
                    direction: [cos * x - sin * y, sin * x + cos * y, z],
                    range,
                });
            }
        }
        self.sweeps += 1;
        beams
    }
}

/// A direction of the body in the world's axes, z up.
fn upright(attitude: Quaternion, body: [f64; 3]) -> [f64; 3] {
    let [x, y, down] = attitude.in_world(body);
    [x, y, -down]
}

/// Flies through a world to its end.
///
/// # Errors
/// [`ScenarioError`] when the aircraft has no lateral table or no level flight, or would start in a body.
pub fn fly_through(
    world: &World,
    hull: &Hull,
    scenario: &Scenario,
    config: SpaceConfig,
) -> Result<SpaceOutcome, ScenarioError> {
    let mut flight = SpaceFlight::new(scenario, config)?;
    hull.check_start(world, flight.state())
        .map_err(|error| ScenarioError::Value("world", error.to_string()))?;
    let mut fan = Fan {
        draws: generator(scenario.seed, Stream::SpaceLidar),
        sweeps: 0,
    };
    let extent = *world.extent();
    let (mut clearance, mut off, mut ticks) = (MOST, 0.0, 0);
    let mut end = SpaceEnd::Time;
    while ticks < MOST_TICKS {
        let before = *flight.state();
        let stepped = flight.step(|state, errors| fan.sweep(world, state, errors));
        ticks += 1;
        if stepped.is_err() {
            end = SpaceEnd::Extreme;
            break;
        }
        let state = flight.state();
        off += flight.tracking_error().unwrap_or(0.0);
        clearance = clearance.min(hull.clearance(world, state, MOST));
        let sideways = state.lateral.y.abs() > extent.half_width + STRAY;
        if hull.first_contact(world, &before, state).is_some() {
            clearance = clearance.min(0.0);
            end = SpaceEnd::Hit;
        } else if sideways || state.plane.z > extent.ceiling + STRAY {
            end = SpaceEnd::Left;
        } else if state.plane.x >= extent.length {
            end = SpaceEnd::Arrived;
        } else {
            continue;
        }
        break;
    }
    Ok(SpaceOutcome {
        end,
        time: f64::from(ticks) * TICK_PERIOD,
        way: flight.state().plane.x,
        clearance,
        tracking: off / f64::from(ticks.max(1)),
    })
}
