//! The vehicle's side of the MAVLink link to ground stations.
//!
//! ```text
//!  stations <-- UDP --> transport <-- frames --> vehicle <-- orders, moments --> flight
//!                          |
//!                          +--> tlog
//! ```
//!
//! * [`vehicle`]: the vehicle that a ground station sees. It turns requests into orders. It reads
//!   no clock and no socket.
//! * [`transport`]: sockets, pace, and the recording.
//! * [`heard`]: the newest signed time of each sender, kept from flight to flight.
//! * [`param_file`]: parameter files in the format of ground stations.
//!
//! A station changes a flight only by its requests. Messages that it receives, misses or damages
//! change nothing.

mod channels;
mod commands;
mod demands;
mod doubts;
mod files;
mod guests;
mod health;
pub mod heard;
pub mod home;
mod inquiries;
mod last;
mod metadata;
mod missions;
mod motion;
mod notes;
pub mod param_file;
mod parameter_queue;
mod parameters;
mod security;
mod sending;
mod severity;
mod stations;
mod status;
mod stores;
mod streams;
mod tails;
pub mod tlog;
pub mod transport;
pub mod vehicle;
