//! Simulated flights for the MPP flight core. The crate simulates everything around the aircraft's
//! computer.
//!
//! ```text
//!             +------------------------- control -------------------------+
//!             v                                                           |
//! field --> plant --+--> sensors --(airspeed, pitch; 100 Hz)--+           |
//!   |               |                                         +--> link --+--> core
//!   +---------------+--> lidar ----(ranges; each replan)------+
//!   |               |
//!   +---------------+--> outcome --> inquest --> log
//! ```
//!
//! These are the modules in the order in which data flows through them. Each module imports only
//! from those before it:
//!
//! ```text
//! names, random              named values; the only source of random numbers
//! field, generator, scene    the obstacles: shapes and files of them, generators, the challenge scenes
//! file_error, aircraft_file  an aircraft as TOML, and the numbers that core and plant take from it
//! disturbance                gusts, dropouts and a stuck elevator, switched in flight
//! lidar, sensors, navigation the sensors, with noise from seeded streams
//! plant, dynamics            the interface of an aircraft, and this crate's equations of motion
//! faults                     faults and disturbances
//! scenario                   the parameters of a flight, also as TOML
//! aircraft, world            plant, field and lidar of one flight, as a scenario describes them
//! space                      an aircraft that turns: six degrees of freedom, wind on three axes, worlds and lidars
//! outcome                    the success rule of the paper, and a strict one
//! entries, tick_record       the entries of the log, and the data of one tick
//! inspector                  map, candidates and corridor of each planning cycle, for pictures
//! inquest, orders            the cause of a failure; the orders from people
//! log                        one flight as JSON, and its hash
//! flight_observer            what a campaign notes beside the log
//! link, oracle, pipe         the link to a core, an all-knowing core, a core in this process
//! flight                     one flight in lockstep
//! ```
//!
//! * [`flight::fly`] flies a [`scenario::Scenario`] over a [`link::Link`], for instance a
//!   [`pipe::PipeLink`], and gives its [`log::FlightLog`]. [`flight::Flight`] flies tick by tick.
//! * [`flight::fly_in`] does the same in a [`world::World`] that the caller provides. Another
//!   [`plant::Plant`], [`field::Field`] or [`lidar::Lidar`] is a new type; it needs no change in
//!   this crate.
//! * The same seed gives the same log, byte for byte, on every machine.
//!
//! ```
//! use mpp_sim::{flight::fly, pipe::PipeLink, scenario::{Preset, Scenario}};
//!
//! let scenario = Scenario { ticks: 200, ..Scenario::new(Preset::Flight, 1) };
//! let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {})?;
//! assert!(log.summary.x_end > 20.0);
//! # Ok::<(), mpp_sim::flight::FlyError>(())
//! ```
//!
//! Frames and units: `x` downrange \[m\], `z` up \[m\], angles \[rad\] positive nose-up, speeds
//! [m/s], time \[s\]. Every transcendental function comes from `libm`, and every random number
//! comes from a seeded generator. This crate uses no file, no socket, no thread, no clock and no
//! command line. It also builds for `wasm32-unknown-unknown` (`cargo xtask wasm`).

pub mod names;

pub mod random;

mod toml_error;

pub mod field;

pub mod generator;

pub mod scene;

mod file_error;

pub mod aircraft_file;

pub mod disturbance;

pub mod lidar;

pub mod sensors;

pub mod navigation;

pub mod plant;

pub mod dynamics;

pub mod faults;

pub mod scenario;

pub mod aircraft;

pub mod space;

pub mod world;

pub mod outcome;

pub mod entries;

pub mod tick_record;

pub mod inspector;

pub mod inquest;

pub mod orders;

pub mod log;

pub mod flight_observer;

pub mod link;

pub mod oracle;

pub mod pipe;

pub mod flight;
