//! The harness: simulated flights of [`mpp_sim`], with files, sockets, threads and a clock.
//!
//! These are the modules in the order in which data flows through them:
//!
//! ```text
//!   scenarios, logs --> files ----+
//!                                 |
//!   core elsewhere <--> link -----+
//!                                 |
//!   ground stations <-> ground ---+--> cli <--> people
//!                                 |
//!   browsers <--------> live -----+
//!                                 |
//!   row files <---> campaign -----+
//! ```
//!
//! * [`files`]: reads and writes scenarios, logs, programs and recorded data.
//! * [`link`]: a core in another process, over TCP or FIFOs, and its server.
//! * [`ground`]: a MAVLink 2 vehicle for ground stations.
//! * [`pace`]: the speed of a flight relative to real time.
//! * [`live`]: a live page of a flight.
//! * [`campaign`]: many flights on all cores, and their row files.
//! * [`cli`]: the command line.
//!
//! [`mpp_sim`] flies the flights, and [`mpp_analysis`] evaluates them. The harness reads a clock
//! only to pace a flight for human eyes, to date signatures, to limit its waiting times, and to
//! measure how long the core works in a campaign.

pub mod files;

pub mod link;

pub mod ground;

pub mod pace;

pub mod live;

pub mod campaign;

pub mod cli;
