//! `core`: runs the flight core as a process of its own.

use super::answer::{Failure, LINK, talk};
use super::values::{place, seconds};
use crate::files::read_field;
use crate::link::{PATIENCE, serve};
use mpp_sim::oracle::Oracle;
use std::net::TcpListener;
use std::path::PathBuf;
use std::time::Duration;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::CORE_EXAMPLES)]
pub(super) struct CoreArgs {
    /// Address to listen on, HOST:PORT; port 0 takes a free one
    #[arg(long, default_value = "127.0.0.1:5790", value_parser = place)]
    listen: String,
    /// End after the first harness that configured a flight
    #[arg(long)]
    once: bool,
    /// Seconds to wait for a silent harness, but at most 5 for its hello [default: 10]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    patience: Option<Duration>,
    /// Field of obstacles (TOML, as docs/fields.md) that the planner knows whole: the core is an oracle
    #[arg(long, value_name = "FIELD")]
    oracle: Option<PathBuf>,
}

pub(super) fn run(args: &CoreArgs) -> Result<u8, Failure> {
    let oracle = match &args.oracle {
        Some(path) => {
            let field = read_field(path)?;
            Some(Oracle::new(&field.obstacles()))
        }
        None => None,
    };
    let listen = |error| Failure::new(LINK, format!("--listen {}: {error}", args.listen));
    let listener = TcpListener::bind(&args.listen).map_err(listen)?;
    let address = listener.local_addr().map_err(listen)?;
    talk(format_args!(
        "core listens on {address}; fly it with: sil-harness fly --link tcp:{address}"
    ));
    let patience = args.patience.unwrap_or(PATIENCE);
    serve(&listener, args.once, patience, oracle.as_ref(), |line| {
        talk(line);
    })
    .map_err(|error| Failure::new(LINK, error))?;
    Ok(0)
}
