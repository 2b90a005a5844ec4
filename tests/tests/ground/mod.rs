//! Tests flights with ground stations: what stations see, what they can change, and what they
//! cannot change.

#![expect(clippy::float_cmp, reason = "what is told is what is, to the last bit")]

mod addresses;
mod commands;
mod cruise;
mod files;
mod inquiries;
mod link;
mod parameters;
mod radio;
mod status;
mod telemetry;
mod unasked;
