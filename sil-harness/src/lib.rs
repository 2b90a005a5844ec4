//! Software in the loop for the MPP flight core: everything around the aircraft's computer.
//!
//! ```text
//!             +------------------------- control -------------------------+
//!             v                                                           |
//! world --> plant --+--> sensors --(airspeed, pitch; 100 Hz)--+           |
//!   |               |                                         +--> link --+--> core
//!   +---------------+--> lidar ----(ranges; each replan)------+
//!   |               |
//!   +---------------+--> outcome --> log --> figure
//! ```
//!
//! * [`world`]: the obstacle field of the paper, from a seed.
//! * [`plant`]: the true aircraft; integrates the core's own equations of motion.
//! * [`aircraft`]: the plant behind its actuators, in moving air; [`faults`]: what may go wrong.
//! * [`sensors`], [`lidar`]: what the aircraft measures, with noise from seeded streams.
//! * [`outcome`]: the success rule of the paper, and a strict one.
//! * [`inquest`]: why a flight failed.
//! * [`log`]: one flight as JSON, and its hash: the same seed gives the same bytes everywhere.
//! * [`figure`]: one flight as a picture, like Figure 7 of the paper.
//! * [`picture`]: one flight as a page for a browser, recorded or live.
//! * [`scenario`]: what is flown, as a TOML file; [`scene`]: the challenge scenes; [`run`]: one flight in lockstep; [`link`]: where the core is.
//! * [`oracle`]: the core as it would fly if it knew everything.
//! * [`cycles`]: the planning cycles of a flight, to plan them again.
//! * [`campaign`]: many flights over a grid, with intervals.
//! * [`ground`]: what people see of a flight and tell it; MAVLink 2.
//! * [`check_reference`]: core and plant against data recorded from the authors' code.
//! * [`bench`]: our parts beside others.
//! * [`cli`]: the command line.
//! * [`random`]: the only source of random numbers.
//!
//! Frames and units: `x` downrange [m], `z` up [m], angles [rad] positive nose-up, speeds [m/s],
//! time [s]. Every transcendental goes through `libm`, every random number through a seeded
//! generator; only the command line reads a clock, to pace a flight for human eyes and to date
//! signatures.

pub mod aircraft;
pub mod bench;
pub mod campaign;
pub mod check_reference;
pub mod cli;
pub mod cycles;
pub mod faults;
pub mod figure;
pub mod ground;
pub mod inquest;
pub mod lidar;
pub mod link;
pub mod log;
pub mod oracle;
pub mod outcome;
pub mod picture;
pub mod plant;
pub mod random;
pub mod run;
pub mod scenario;
pub mod scene;
pub mod sensors;
pub mod world;
