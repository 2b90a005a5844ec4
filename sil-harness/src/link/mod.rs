//! Links to a core in another process, and the core's server.

mod fifo;
mod server;
mod tcp;

pub use fifo::FifoLink;
pub use server::serve;
use std::time::Duration;
pub use tcp::TcpLink;

/// The time that either side waits for the other before it gives up.
pub const PATIENCE: Duration = Duration::from_secs(10);
