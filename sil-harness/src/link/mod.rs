//! The harness's side of the link to the core, and the core's server.

mod fifo;
mod pipe;
mod server;
mod tcp;

pub use fifo::FifoLink;
use hil_protocol::{ConfigureVerdict, DecodeError, EncodeError, Message};
use mpp_core::vehicle::{VehicleState, Wind};
pub use pipe::PipeLink;
pub use server::serve;
use std::fmt;
use std::time::Duration;
pub use tcp::TcpLink;

/// How long either side waits for the other before it gives up.
pub const PATIENCE: Duration = Duration::from_secs(10);

/// A link to a core: whole messages, in order.
pub trait Link {
    /// Sends one message.
    ///
    /// # Errors
    /// [`LinkError`]: the flight cannot go on.
    fn send(&mut self, message: &Message) -> Result<(), LinkError>;

    /// The next message; `awaited` says what it is hoped to be, for the error.
    ///
    /// # Errors
    /// [`LinkError`]: the flight cannot go on.
    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError>;

    /// Shows the true state to an oracle, before it gets a tick's measurements.
    ///
    /// # Errors
    /// [`LinkError::Peer`]: the core at the other end is none.
    fn reveal(&mut self, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
        let _ = (truth, wind);
        Err(LinkError::no_oracle())
    }
}

/// Why a flight over a link cannot go on.
#[derive(Debug)]
pub enum LinkError {
    /// The other side said nothing for so long.
    Silent {
        /// Who waits.
        waiting: &'static str,
        /// For what, from whom.
        awaited: String,
        /// How long; none where no more can come.
        patience: Option<Duration>,
    },
    /// The other side closed the link.
    Closed {
        /// What was awaited.
        awaited: String,
    },
    /// What came is no frame of ours.
    Frame(DecodeError),
    /// A message does not fit a frame.
    Encode(EncodeError),
    /// A message that has no place here.
    Unexpected {
        /// What was awaited.
        awaited: String,
        /// The number of what came.
        id: u8,
    },
    /// The other side is no core, or ticks at another rate.
    Peer(String),
    /// The core refused the configuration.
    Refused(ConfigureVerdict),
    /// The operating system's word.
    Io(String, std::io::Error),
}

impl LinkError {
    fn no_oracle() -> Self {
        Self::Peer("an oracle flies in this process only: leave out the link".to_owned())
    }
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
            Self::Peer(why) => write!(f, "{why}"),
            Self::Refused(verdict) => {
                write!(f, "the core refuses this configuration: {verdict:?}")
            }
            Self::Io(doing, error) => write!(f, "{doing}: {error}"),
        }
    }
}

impl std::error::Error for LinkError {}

impl From<EncodeError> for LinkError {
    fn from(error: EncodeError) -> Self {
        Self::Encode(error)
    }
}
