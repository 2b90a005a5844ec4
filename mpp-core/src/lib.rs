//! Model Predictive Planning: the flight core.
//!
//! The crate plans trajectories for low-agility, fixed-wing aircraft through dense obstacles, and flies
//! them. It follows Wallace, Streetman, Lessard, "Model Predictive Planning: Trajectory Planning in
//! Obstruction-Dense Environments for Low-Agility Aircraft". The documentation calls it "the paper".
//!
//! In the field's terms, [`planner::plane`] is a receding-horizon planner (model predictive control, MPC). Each cycle
//! refines candidate trajectories by sequential quadratic programming (SQP): every iteration solves a quadratic program
//! with soft constraints and an exact penalty ([`qp`]). The previous plan is the warm start; the other candidates come
//! from a state lattice, whose dynamic programming also gives the cost-to-go beyond the refined part ([`lattice`]). The
//! map is a rolling grid of occupancy log-odds with a truncated distance field, ESDF ([`map`]). At 100 Hz the flight loop
//! estimates by an extended Kalman filter (EKF), detects and isolates faults of sensors and actuators (FDI, [`estimate`]),
//! and tracks the plan by a linear quadratic regulator (LQR, [`control`]).
//!
//! ```text
//! 100 Hz  SensorFrame -> Ekf -> AirState -> Lqr -> Control                       flight
//!                                | snapshot   ^ Trajectory::sample(t)
//!                                v            |
//! cycle   LidarScan -> RollingGrid -> LatticePath -> Corridor -> Solution -> roll-out   planner::plane
//!         sense        map            lattice        corridor    qp
//! ```
//!
//! * The crate has no heap, no clock, no I/O and no panic. Time is an argument, the caller owns the
//!   storage, and a seed gives the same bytes on every machine. Large values have a `const fn new()` and
//!   live in a `static` or a box.
//! * Every loop has a bound. [`config`] holds all sizes and rates.
//! * An `Err` means a broken contract or an unusable input. The normal results of a method are statuses.
//!   The documentation of each variant says how the vehicle reacts, and [`health`] counts the events.
//! * Units are SI, and angles are in radians. In the world `x` points downrange and `z` up. Pitch and
//!   flight path angle are positive nose-up. `docs/notation.md` maps the paper's letters to names.
//!
//! # Example
//!
//! ```
//! use mpp_core::sense::Measurement;
//! use mpp_core::flight::FlightLoop;
//! use mpp_core::planner::{Planner, SetupError};
//! use mpp_core::sense::{AirData, LidarScan, SensorFrame};
//! use mpp_core::settings::Settings;
//!
//! # fn main() -> Result<(), SetupError> {
//! let mut settings = Settings::flight();
//! if let Some(own) = settings.planner.plane_mut() {
//!     // The loop takes a plan over one tick after its cycle has begun.
//!     own.latency = 0.01;
//! }
//! let mut flight = FlightLoop::new(&settings)?;
//! let mut planner = Box::new(Planner::new());
//! planner.set_up(&settings)?;
//!
//! let measurement = Measurement { airspeed: 12.0, pitch: 0.156 };
//! let frame = SensorFrame {
//!     air: Some(AirData { age: 0, measurement }),
//!     position: None,
//! };
//! let first = flight.step(0.0, &frame);
//!
//! // A scan of a lidar with 100 beams and a range of 45 m. No beam came back.
//! let mut scan = LidarScan::new();
//! (scan.angle_min, scan.angle_increment) = (-0.5, 0.01);
//! let fits = scan.ranges.resize(100, 0.0).is_ok();
//! // The planner takes only checked scans.
//! if fits && scan.check(100).is_ok() {
//!     planner.begin(0.0, &flight.state(), &flight.conditions(), &scan);
//! }
//! // The flight step may run between any two slices.
//! while planner.advance() {}
//! flight.adopt(0.01, planner.finish(), planner.best());
//! flight.count_cycle(planner.summary());
//! let second = flight.step(0.01, &frame);
//! assert!(second.control.thrust >= 0.0 && first.control.elevator.is_finite());
//! # Ok(())
//! # }
//! ```
//!
//! A real loop also uses two results of a step. After [`moved`](flight::StepOutput::moved) it drops the cycle
//! and calls [`planner::Planner::forget`]. While [`is_lost`](flight::FlightLoop::is_lost) holds it begins no cycle.
#![no_std]
#![expect(
    clippy::duplicate_mod,
    reason = "`qp::kernel` is compiled once for each shape of programs"
)]
#![forbid(unsafe_code)]

pub mod config;
pub mod control;
pub mod corridor;
pub mod estimate;
pub mod flight;
pub mod gate;
pub mod health;
mod inverse;
pub mod lattice;
pub mod map;
#[cfg(feature = "paper")]
pub mod paper;
pub mod planner;
pub mod qp;
pub mod sense;
pub mod settings;
pub mod trajectory;
pub mod tuning;
pub mod units;
pub mod vehicle;
