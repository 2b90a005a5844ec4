//! Model Predictive Planning: the flight core.
//!
//! Plans trajectories for low-agility, fixed-wing aircraft through dense obstacles, and flies them.
//! After Wallace, Streetman, Lessard, "Model Predictive Planning: Trajectory Planning in
//! Obstruction-Dense Environments for Low-Agility Aircraft"; "the paper" throughout.
//!
//! ```text
//! 100 Hz  SensorFrame -> Ekf -> AirState -> Lqr -> Control                       flight
//!                                | snapshot   ^ Trajectory::sample(t)
//!                                v            |
//! replan  LidarScan -> OccupancyGrid -> Path -> CollocationPoints -> Corridor -> Solution   planner
//!         sense        map              plan    plan                 corridor    qp
//! ```
//!
//! * No heap, no clock, no I/O, no panic: time is an argument, storage is the caller's, a seed gives
//!   the same bytes on every machine. Large values have a `const fn new()` and live in a `static` or a
//!   box.
//! * Every loop has a bound; [`config`] holds all sizes and rates.
//! * An `Err` is a broken contract or unusable input; the normal ends of a method are statuses.
//!   What the vehicle does about either stands at the variant, and [`health`] counts it.
//! * Units are SI and angles radians; world `x` downrange, `z` up; pitch and flight path positive
//!   nose-up. `docs/notation.md` maps the paper's letters to names.
//!
//! # Example
//!
//! ```
//! use mpp_core::estimate::Measurement;
//! use mpp_core::flight::FlightLoop;
//! use mpp_core::planner::{Planner, SetupError};
//! use mpp_core::sense::{LidarScan, SensorFrame};
//! use mpp_core::settings::Settings;
//!
//! # fn main() -> Result<(), SetupError> {
//! let settings = Settings::flight();
//! let mut flight = FlightLoop::new(&settings)?;
//! let mut planner = Box::new(Planner::new());
//! planner.set_up(&settings)?;
//!
//! // A scan without returns, taken as the flight starts.
//! let scan = LidarScan::new();
//! planner.begin(0.0, &flight.state(), &flight.conditions(), &scan);
//! let frame = SensorFrame {
//!     measurement: Measurement { airspeed: 12.0, pitch: 0.156 },
//!     x: 0.0,
//!     z: 50.0,
//! };
//! let first = flight.step(0.0, &frame);
//! // The step may run between any two slices.
//! while planner.advance() {}
//! let verdict = planner.finish();
//! flight.adopt(0.01, verdict, planner.best());
//! let second = flight.step(0.01, &frame);
//! assert!(second.control.thrust >= 0.0 && first.control.elevator.is_finite());
//! # Ok(())
//! # }
//! ```
#![no_std]
#![forbid(unsafe_code)]

pub mod config;
pub mod control;
pub mod corridor;
pub mod estimate;
pub mod flight;
pub mod health;
mod inverse;
pub mod map;
pub mod plan;
pub mod planner;
pub mod qp;
pub mod sense;
pub mod settings;
pub mod trajectory;
pub mod vehicle;

/// Whose rules the map, the path search and the raytracing follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rules {
    /// As the authors' code, faults included, to compare with it: edges of the tree are not
    /// checked, costs go stale when nodes are rewired, rays see a window that wraps around.
    Authors,
    /// As the paper's text means it.
    Corrected,
}
