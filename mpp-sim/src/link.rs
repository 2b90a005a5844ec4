//! The link to a core, independent of what carries the messages.

use crate::scenario::TICK_US;
use hil_protocol::{ConfigureVerdict, DecodeError, EncodeError, Message, ParameterVerdict};
use mpp_core::vehicle::{VehicleState, Wind};
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
#[derive(Debug, thiserror::Error)]
pub enum LinkError {
    /// The other side sent nothing for too long.
    #[error("the {waiting} waits for {awaited}{}", silence(.patience))]
    Silent {
        /// Side that waits.
        waiting: &'static str,
        /// Message that is awaited, and its sender.
        awaited: String,
        /// Time waited; `None` if no more messages can come.
        patience: Option<Duration>,
    },
    /// The other side closed the link.
    #[error("the link was closed by the other side while waiting for {awaited}")]
    Closed {
        /// Message that was awaited.
        awaited: String,
    },
    /// The received bytes are no valid frame.
    #[error("damaged frame from the other side: {0}")]
    Frame(#[source] DecodeError),
    /// A message does not fit a frame.
    #[error("cannot send: {0}")]
    Encode(#[from] EncodeError),
    /// A message came that must not come here.
    #[error("message {id} came while waiting for {awaited}")]
    Unexpected {
        /// Message that was awaited.
        awaited: String,
        /// Number of the message that came.
        id: u8,
    },
    /// The other side is a harness too.
    #[error("the other side is a harness too: give the address of a core")]
    NoCore,
    /// The core ticks at another rate, or takes fewer beams than the flight has.
    #[error(
        "the core ticks every {tick_us} us and takes {beams_max} beams; this harness needs {TICK_US} us and \
         {beams} beams"
    )]
    Unfit {
        /// The core's ticks \[us\].
        tick_us: u32,
        /// The most beams that it takes.
        beams_max: u16,
        /// The beams of the flight.
        beams: usize,
    },
    /// The core restarts again and again at this tick.
    #[error("the core restarts again and again at tick {0}")]
    Restless(u32),
    /// The core restarted, and refuses a parameter's value that it had before.
    #[error("the core restarted and now refuses {0} = {1}: {2}")]
    Relapsed(&'static str, f64, ParameterVerdict),
    /// The flight needs an oracle, but the core at the other end is no oracle.
    #[error("an oracle flies in this process only: leave out the link")]
    NoOracle,
    /// The core refused the configuration.
    #[error("the core refuses this configuration: {0}")]
    Refused(ConfigureVerdict),
    /// The operating system reports an error. The text names the action that failed.
    #[error("{0}: {1}")]
    Io(String, #[source] std::io::Error),
}

fn silence(patience: &Option<Duration>) -> String {
    match patience {
        Some(patience) => format!(
            "; nothing came for {} s: is the other side still running?",
            patience.as_secs_f64()
        ),
        None => ", but no answer was given".to_owned(),
    }
}
