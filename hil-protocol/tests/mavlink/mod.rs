//! Tests the MAVLink side of the link: frames in any noise, messages, signatures.

mod framer;
mod messages;
mod oracle;
mod signing;
mod streams;
