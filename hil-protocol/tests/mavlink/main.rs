//! Tests the MAVLink side of the link: frames in any noise, messages, signatures.

#![expect(clippy::unwrap_used, reason = "the helpers of tests fail as tests do")]

mod framer;
mod messages;
mod oracle;
mod signing;
mod streams;
