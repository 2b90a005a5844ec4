//! The companion's command line: MAVLink over UDP to the autopilot, scans over UDP from the lidar.

use clap::{Parser, Subcommand};
use mpp_companion::{Companion, CompanionError, Config, LogWriter, Side, Told, replay, stand_in};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::net::UdpSocket;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The flight core beside an autopilot.
#[derive(Parser)]
#[command(version)]
struct Options {
    #[command(subcommand)]
    command: Order,
}

#[derive(Subcommand)]
enum Order {
    /// Flies an aircraft whose autopilot is ArduPlane.
    Fly {
        /// Aircraft file with a `pitch_loop`.
        #[arg(long)]
        aircraft: PathBuf,
        /// Address of the autopilot: udp:HOST:PORT; the companion speaks first.
        #[arg(long)]
        autopilot: String,
        /// Port for scans of the lidar: udp:PORT.
        #[arg(long)]
        lidar: String,
        /// Longest range of the lidar [m].
        #[arg(long)]
        range: f32,
        /// Beams of a scan.
        #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u16).range(2..=128))]
        beams: u16,
        /// Planning work in a tick [slices].
        #[arg(long, default_value_t = u32::MAX, value_parser = clap::value_parser!(u32).range(1..))]
        slices: u32,
        /// Log of both sides; it replays to the last bit.
        #[arg(long)]
        log: Option<PathBuf>,
        /// Replays a log instead of flying.
        #[arg(long)]
        replay: Option<PathBuf>,
    },
    /// Flies a stand-in of an autopilot in simulated time, and prints the figures of the documentation.
    StandIn {
        /// Flights of each set; a fault gets an eighth of them.
        #[arg(long, default_value_t = 40, value_parser = clap::value_parser!(u64).range(1..))]
        flights: u64,
        /// First seed.
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
}

fn main() -> ExitCode {
    match run(Options::parse().command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(order: Order) -> Result<(), CompanionError> {
    match order {
        Order::StandIn { flights, seed } => {
            println!("{}", stand_in::figures(flights, seed)?);
            Ok(())
        }
        Order::Fly {
            aircraft,
            autopilot,
            lidar,
            range,
            beams,
            slices,
            log,
            replay: recorded,
        } => {
            let text = std::fs::read_to_string(&aircraft).map_err(io("read the aircraft file"))?;
            let file = AircraftFile::parse(&aircraft.display().to_string(), &text)?;
            let config = Config {
                beams,
                slices,
                ..Config::new(AircraftModel::new(file)?.plane(), range)
            };
            let mut companion = Companion::new(config)?;
            if let Some(path) = recorded {
                let file = File::open(path).map_err(io("open the log"))?;
                let same = replay(&mut companion, BufReader::new(file))?;
                println!("{same} frames are the same to the last bit");
                return Ok(());
            }
            let inputs = inputs(&autopilot, &lidar)?;
            let log = log
                .map(File::create)
                .transpose()
                .map_err(io("create the log"))?;
            fly(&mut companion, &inputs, log)
        }
    }
}

fn io(action: &'static str) -> impl Fn(std::io::Error) -> CompanionError {
    move |error| CompanionError::Io(action.to_owned(), error)
}

/// The socket to the autopilot, and what comes.
struct Inputs {
    socket: UdpSocket,
    come: mpsc::Receiver<(Side, Vec<u8>)>,
}

fn inputs(autopilot: &str, lidar: &str) -> Result<Inputs, CompanionError> {
    let rest = |address: &str, form| {
        let rest = address.strip_prefix("udp:").map(str::to_owned);
        rest.ok_or_else(|| CompanionError::Address(address.to_owned(), form))
    };
    let peer = rest(autopilot, "udp:HOST:PORT")?;
    let form = "udp:PORT";
    let port = rest(lidar, form)?;
    let port: u16 = port
        .parse()
        .map_err(|_| CompanionError::Address(lidar.to_owned(), form))?;
    let socket = UdpSocket::bind("0.0.0.0:0").map_err(io("open a socket"))?;
    socket.connect(&peer).map_err(io("reach the autopilot"))?;
    let scans = UdpSocket::bind(("0.0.0.0", port)).map_err(io("open the lidar's port"))?;
    let (send, come) = mpsc::channel();
    let own = socket.try_clone().map_err(io("share the socket"))?;
    for (side, socket) in [(Side::Autopilot, own), (Side::Lidar, scans)] {
        let send = send.clone();
        std::thread::spawn(move || {
            let mut buffer = [0; 4096];
            loop {
                match socket.recv(&mut buffer) {
                    Ok(size) => {
                        let bytes = buffer.get(..size).unwrap_or_default().to_vec();
                        if send.send((side, bytes)).is_err() {
                            return;
                        }
                    }
                    // The autopilot is not there yet.
                    Err(_) => std::thread::sleep(Duration::from_millis(20)),
                }
            }
        });
    }
    Ok(Inputs { socket, come })
}

fn fly(
    companion: &mut Companion,
    inputs: &Inputs,
    log: Option<File>,
) -> Result<(), CompanionError> {
    let begun = Instant::now();
    let period = Duration::from_millis(20);
    let mut log = log.map(|file| LogWriter(BufWriter::new(file)));
    let mut due = begun;
    loop {
        let wait = due.saturating_duration_since(Instant::now());
        let input = inputs.come.recv_timeout(wait).ok();
        let (side, bytes) = input.unwrap_or((Side::Time, Vec::new()));
        if side == Side::Time {
            due = Instant::now() + period;
        }
        let now = u64::try_from(begun.elapsed().as_micros()).unwrap_or(u64::MAX);
        let mut sent = Vec::new();
        companion.receive(now, side, &bytes, &mut |frame| sent.push(frame.to_vec()));
        for frame in &sent {
            // A frame that does not go out is lost, as on any link.
            let _ = inputs.socket.send(frame);
        }
        if let Some(log) = &mut log {
            let mut note = |side, bytes: &[u8]| log.write(now, side, bytes);
            note(Some(side), &bytes).map_err(io("write the log"))?;
            for frame in &sent {
                note(None, frame).map_err(io("write the log"))?;
            }
            if side == Side::Time {
                // The process ends by a signal, which must not cost the last seconds.
                log.0.flush().map_err(io("write the log"))?;
            }
        }
        for told in companion.told() {
            match told {
                Told::State(state, reason) => println!("{state:?}: {reason:?}"),
                Told::Verified(text) | Told::Core(text) => println!("{text}"),
            }
        }
    }
}
