//! The link to a core, independent of what carries the messages.

use crate::scenario::TICK_US;
use hil_protocol::{ConfigureVerdict, DecodeError, EncodeError, Message, ParameterVerdict};
use mpp_core::vehicle::{VehicleState, Wind};
use std::fmt;
use std::time::Duration;

/// A link to a core. It carries whole messages in order.
pub trait Link {
    /// Sends one message.
    ///
    /// # Errors
    /// [`LinkError`] when the flight cannot go on.
    fn send(&mut self, message: &Message) -> Result<(), LinkError>;

    /// Receives the next message. `awaited` names the expected message for the error.
    ///
    /// # Errors
    /// [`LinkError`] when the flight cannot go on.
    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError>;

    /// Shows the true state to an oracle, before it gets a tick's measurements.
    ///
    /// # Errors
    /// [`LinkError::NoOracle`] when the core at the other end is no oracle.
    fn reveal(&mut self, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
        let _ = (truth, wind);
        Err(LinkError::NoOracle)
    }
}

/// The reason why a flight over a link cannot go on.
#[derive(Debug)]
pub enum LinkError {
    /// The other side sent nothing for too long.
    Silent {
        /// Side that waits.
        waiting: &'static str,
        /// Message that is awaited, and its sender.
        awaited: String,
        /// Time waited; `None` if no more messages can come.
        patience: Option<Duration>,
    },
    /// The other side closed the link.
    Closed {
        /// Message that was awaited.
        awaited: String,
    },
    /// The received bytes are no valid frame.
    Frame(DecodeError),
    /// A message does not fit a frame.
    Encode(EncodeError),
    /// A message came that must not come here.
    Unexpected {
        /// Message that was awaited.
        awaited: String,
        /// Number of the message that came.
        id: u8,
    },
    /// The other side is a harness too.
    NoCore,
    /// The core ticks at another rate, or takes fewer beams than the flight has.
    Unfit {
        /// The core's ticks \[us\].
        tick_us: u32,
        /// The most beams that it takes.
        beams_max: u16,
        /// The beams of the flight.
        beams: usize,
    },
    /// The core restarts again and again at this tick.
    Restless(u32),
    /// The core restarted, and refuses a parameter's value that it had before.
    Relapsed(&'static str, f64, ParameterVerdict),
    /// The flight needs an oracle, but the core at the other end is no oracle.
    NoOracle,
    /// The core refused the configuration.
    Refused(ConfigureVerdict),
    /// The operating system reports an error. The text names the action that failed.
    Io(String, std::io::Error),
}

impl fmt::Display for LinkError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Silent {
                waiting,
                awaited,
                patience: Some(patience),
            } => write!(
                f,
                "the {waiting} waits for {awaited}; nothing came for {} s: is the other side still \
                 running?",
                patience.as_secs_f64()
            ),
            Self::Silent {
                waiting, awaited, ..
            } => write!(
                f,
                "the {waiting} waits for {awaited}, but no answer was given"
            ),
            Self::Closed { awaited } => {
                write!(
                    f,
                    "the link was closed by the other side while waiting for {awaited}"
                )
            }
            Self::Frame(error) => write!(f, "damaged frame from the other side: {error}"),
            Self::Encode(error) => write!(f, "cannot send: {error}"),
            Self::Unexpected { awaited, id } => {
                write!(f, "message {id} came while waiting for {awaited}")
            }
            Self::NoCore => {
                f.write_str("the other side is a harness too: give the address of a core")
            }
            Self::Unfit {
                tick_us,
                beams_max,
                beams,
            } => write!(
                f,
                "the core ticks every {tick_us} us and takes {beams_max} beams; this harness needs \
                 {TICK_US} us and {beams} beams"
            ),
            Self::Restless(tick) => {
                write!(f, "the core restarts again and again at tick {tick}")
            }
            Self::Relapsed(name, value, verdict) => write!(
                f,
                "the core restarted and now refuses {name} = {value}: {verdict}"
            ),
            Self::NoOracle => {
                f.write_str("an oracle flies in this process only: leave out the link")
            }
            Self::Refused(verdict) => {
                write!(f, "the core refuses this configuration: {verdict}")
            }
            Self::Io(doing, error) => write!(f, "{doing}: {error}"),
        }
    }
}

impl core::error::Error for LinkError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Frame(error) => Some(error),
            Self::Encode(error) => Some(error),
            Self::Io(_, error) => Some(error),
            Self::Silent { .. }
            | Self::Closed { .. }
            | Self::Unexpected { .. }
            | Self::NoCore
            | Self::Unfit { .. }
            | Self::Restless(_)
            | Self::Relapsed(..)
            | Self::NoOracle
            | Self::Refused(_) => None,
        }
    }
}

impl From<EncodeError> for LinkError {
    fn from(error: EncodeError) -> Self {
        Self::Encode(error)
    }
}
