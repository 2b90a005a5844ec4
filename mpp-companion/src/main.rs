//! The companion's command line: MAVLink to the autopilot, scans over UDP from the lidar.

mod port;
mod stream;

use clap::{Parser, Subcommand};
use mpp_companion::{
    Companion, CompanionError, Config, Kind, LogWriter, Mounting, ScanSource, Side, Told, replay,
    stand_in,
};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use port::Port;
use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::net::UdpSocket;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The forms of `--lidar`.
const LIDARS: &str = "udp:PORT, livox:PORT, obstacles:PORT or obstacles:autopilot";
/// The usual slice of a Mid-360 \[deg\].
const SLICE: f64 = 2.0;

/// The flight core beside an autopilot.
#[derive(Parser)]
#[command(version)]
struct Options {
    #[command(subcommand)]
    command: Order,
}

#[derive(Subcommand)]
enum Order {
    /// Flies an aircraft whose autopilot is ArduPlane or PX4.
    Fly {
        /// Kind of the autopilot; without it the heartbeat says it.
        #[arg(long)]
        kind: Option<Kind>,
        /// Aircraft file with a `pitch_loop`.
        #[arg(long)]
        aircraft: PathBuf,
        /// Address of the autopilot: udp:HOST:PORT (the companion speaks first), udpin:HOST:PORT (the autopilot does),
        /// tcp:HOST:PORT or serial:DEVICE:BAUD.
        #[arg(long)]
        autopilot: String,
        /// Where scans come from: udp:PORT (frames of our link), livox:PORT (point data of a Mid-360), obstacles:PORT or
        /// obstacles:autopilot (OBSTACLE_DISTANCE).
        #[arg(long)]
        lidar: String,
        /// Roll, pitch and yaw of a Mid-360, or of the sensor of OBSTACLE_DISTANCE, against the aircraft [deg].
        #[arg(long, default_value = "90,0,0", allow_hyphen_values = true)]
        mounting: Mounting,
        /// Points of a Mid-360 count that lie so near to the vertical plane of the course [deg].
        #[arg(long, default_value_t = SLICE)]
        slice: f64,
        /// Longest range of the lidar [m].
        #[arg(long)]
        range: f32,
        /// Beams of a scan.
        #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u16).range(2..=128))]
        beams: u16,
        /// Replanning [Hz].
        #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=10))]
        replan_hz: u32,
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
        /// Kind of the autopilot.
        #[arg(long, default_value = "arduplane")]
        kind: Kind,
        /// Source of the scans: udp, livox or obstacles.
        #[arg(long, default_value = "udp")]
        lidar: String,
        /// Flights of each set; a fault gets an eighth of them.
        #[arg(long, default_value_t = 40, value_parser = clap::value_parser!(u64).range(1..))]
        flights: u64,
        /// First seed.
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// Replays an exchange with the stand-in past 40 obstacles at 4 Hz, and prints the time to a setpoint on this machine.
    Latency,
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
        Order::StandIn {
            kind,
            lidar,
            flights,
            seed,
        } => {
            let source = source(&lidar, Mounting::SIDE, SLICE)?;
            println!("{}", stand_in::figures(kind, source, flights, seed)?);
            Ok(())
        }
        Order::Latency => {
            let (flight, mut log) = (stand_in::Flight::forty(1), Vec::new());
            flight.fly(Some(&mut log))?;
            println!("{}", flight.replay(&log)?);
            Ok(())
        }
        Order::Fly {
            kind,
            aircraft,
            autopilot,
            lidar,
            mounting,
            slice,
            range,
            beams,
            replan_hz,
            slices,
            log,
            replay: recorded,
        } => {
            let text = std::fs::read_to_string(&aircraft).map_err(io("read the aircraft file"))?;
            let file = AircraftFile::parse(&aircraft.display().to_string(), &text)?;
            let (name, port) = lidar.split_once(':').unwrap_or((&lidar, ""));
            let config = Config {
                kind,
                source: source(name, mounting, slice)?,
                beams,
                replan_ticks: 100 / replan_hz,
                slices,
                ..Config::new(AircraftModel::new(file)?.plane(), range)
            };
            let mut companion = Companion::new(config)?;
            if let Some(path) = recorded {
                let file = File::open(path).map_err(io("open the log"))?;
                println!("{}", replay(&mut companion, BufReader::new(file))?);
                return Ok(());
            }
            let mut inputs = inputs(&autopilot, &lidar, port)?;
            let log = log
                .map(File::create)
                .transpose()
                .map_err(io("create the log"))?;
            fly(&mut companion, &mut inputs, log)
        }
    }
}

fn io(action: &'static str) -> impl Fn(std::io::Error) -> CompanionError {
    move |error| CompanionError::Io(action.to_owned(), error)
}

/// What came from a side, or why nothing comes any more.
type Input = Result<(Side, Vec<u8>), CompanionError>;

/// The way to the autopilot, and what comes.
struct Inputs {
    write: port::Writer,
    come: mpsc::Receiver<Input>,
}

/// The source of this name.
fn source(name: &str, mounting: Mounting, slice: f64) -> Result<ScanSource, CompanionError> {
    match name {
        "udp" => Ok(ScanSource::Frames),
        "livox" => Ok(ScanSource::Livox(mounting, slice)),
        "obstacles" => Ok(ScanSource::Obstacles(mounting)),
        _ => Err(CompanionError::Address(name.to_owned(), LIDARS)),
    }
}

fn inputs(autopilot: &str, lidar: &str, port: &str) -> Result<Inputs, CompanionError> {
    let scans = match port.parse::<u16>() {
        Ok(port) => Some(UdpSocket::bind(("0.0.0.0", port)).map_err(io("open the lidar's port"))?),
        Err(_) if lidar == "obstacles:autopilot" => None,
        Err(_) => return Err(CompanionError::Address(lidar.to_owned(), LIDARS)),
    };
    let Port { mut read, write } = Port::open(autopilot, stream::USUAL)?;
    let (send, come) = mpsc::channel();
    let hears = send.clone();
    std::thread::spawn(move || hear(Side::Autopilot, &hears, &mut *read));
    if let Some(scans) = scans {
        let mut listens = move |buffer: &mut [u8]| Ok(scans.recv(buffer).unwrap_or(0));
        std::thread::spawn(move || hear(Side::Lidar, &send, &mut listens));
    }
    Ok(Inputs { write, come })
}

/// Hands on what comes from a side.
fn hear(
    side: Side,
    send: &mpsc::Sender<Input>,
    read: &mut dyn FnMut(&mut [u8]) -> std::io::Result<usize>,
) {
    let mut buffer = [0; 4096];
    loop {
        match read(&mut buffer) {
            Ok(size) if size > 0 => {
                let bytes = buffer.get(..size).unwrap_or_default().to_vec();
                if send.send(Ok((side, bytes))).is_err() {
                    return;
                }
            }
            Ok(_) => std::thread::sleep(Duration::from_millis(20)),
            Err(error) => {
                // Nobody listens once the companion has ended.
                let _ = send.send(Err(io("reach the autopilot; start anew")(error)));
                return;
            }
        }
    }
}

fn fly(
    companion: &mut Companion,
    inputs: &mut Inputs,
    log: Option<File>,
) -> Result<(), CompanionError> {
    let begun = Instant::now();
    let period = Duration::from_millis(20);
    let mut log = log.map(|file| LogWriter(BufWriter::new(file)));
    let mut due = begun;
    loop {
        let wait = due.saturating_duration_since(Instant::now());
        let input = inputs.come.recv_timeout(wait).ok().transpose()?;
        let (side, bytes) = input.unwrap_or((Side::Time, Vec::new()));
        if side == Side::Time {
            due = Instant::now() + period;
        }
        let now = u64::try_from(begun.elapsed().as_micros()).unwrap_or(u64::MAX);
        let mut sent = Vec::new();
        companion.receive(now, side, &bytes, &mut |frame| sent.push(frame.to_vec()));
        for frame in &sent {
            // A frame that does not go out is lost, as on any link.
            let _ = (inputs.write)(frame);
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
                Told::Verified(text) | Told::Lidar(text) | Told::Core(text) => println!("{text}"),
            }
        }
    }
}
