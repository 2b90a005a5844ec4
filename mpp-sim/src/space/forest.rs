//! Whole flights through worlds: the lidar sees the world, and the flight ends where it ends.

use super::Hull;
use super::flight::{SpaceConfig, SpaceFlight};
use super::lidar::{LidarName, SpaceLidar};
use super::world::World;
use crate::file_error::ScenarioError;
use crate::scenario::Scenario;
use core::fmt;
use mpp_core::config::TICK_PERIOD;

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

/// Flies through a world to its end.
///
/// # Errors
/// [`ScenarioError`] when the aircraft has no lateral table or no level flight, or would start in a body.
pub fn fly_through(
    world: &World,
    hull: &Hull,
    lidar: LidarName,
    scenario: &Scenario,
    config: SpaceConfig,
) -> Result<SpaceOutcome, ScenarioError> {
    let mut flight = SpaceFlight::new(scenario, config)?;
    hull.check_start(world, flight.state())
        .map_err(|error| ScenarioError::Value("world", error.to_string()))?;
    let mut lidar = SpaceLidar::new(scenario.seed, lidar.config());
    let extent = *world.extent();
    let (mut clearance, mut off, mut ticks) = (MOST, 0.0, 0);
    let mut end = SpaceEnd::Time;
    while ticks < MOST_TICKS {
        let before = *flight.state();
        let stepped = flight.step(|pose| lidar.sweep(world, pose, 0.0));
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
