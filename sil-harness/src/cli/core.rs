//! `core`: runs the flight core as a process of its own.

use super::answer::{Failure, LINK, talk};
use crate::link::{PATIENCE, serve};
use std::net::TcpListener;
use std::time::Duration;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct CoreArgs {
    /// Address to listen on, HOST:PORT; port 0 takes a free one
    #[arg(long, default_value = "127.0.0.1:5790")]
    listen: String,
    /// End after the first harness that configured a flight
    #[arg(long)]
    once: bool,
    /// Seconds to wait for a silent harness, but at most 5 for its hello
    #[arg(long, default_value_t = PATIENCE.as_secs(), value_parser = clap::value_parser!(u64).range(1..))]
    patience: u64,
}

pub(super) fn run(args: &CoreArgs) -> Result<u8, Failure> {
    let listen = |error| Failure::new(LINK, format!("--listen {}: {error}", args.listen));
    let listener = TcpListener::bind(&args.listen).map_err(listen)?;
    let address = listener.local_addr().map_err(listen)?;
    talk(format_args!(
        "core listens on {address}; fly it with: sil-harness fly --link tcp:{address}"
    ));
    let patience = Duration::from_secs(args.patience);
    serve(&listener, args.once, patience, |line| talk(line))
        .map_err(|error| Failure::new(LINK, error))?;
    Ok(0)
}
