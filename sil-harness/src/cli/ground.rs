//! Flags of a flight with people on the ground.

use super::{FAILURE, Failure, LINK, USAGE, talk};
use crate::ground::transport::{Transport, address, usual_addresses};
use crate::ground::vehicle::{Vehicle, VehicleConfig};
use crate::ground::{Again, Ground, Order, OrderEntry, Refused, param_file};
use crate::log::FlightLog;
use crate::picture::live::Live;
use crate::run::{FlyError, Moment, header};
use crate::scenario::{Scenario, TICKS_PER_SECOND};
use flight_node::parameters::{PARAMETERS, Tuning};
use hil_protocol::mavlink::Key;
use indicatif::ProgressBar;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::Planner;
use mpp_core::vehicle::VehicleState;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Simulated seconds of a station's silence after which it is lost, at the pace of real time.
const PATIENCE: u32 = 5;
/// 2015-01-01T00:00:00Z, from which signatures count [s since 1970].
const SIGNING_EPOCH: u64 = 1_420_070_400;

#[derive(Clone, Debug, clap::Args)]
pub(super) struct GroundArgs {
    /// Answer MAVLink ground stations at udp:HOST:PORT [default: udp:127.0.0.1:14550 and :14540]
    #[arg(long, num_args = 0..=1, default_missing_value = "usual", value_name = "UDP", value_delimiter = ',')]
    mavlink: Vec<String>,
    /// Which of several vehicles this is: system N + 1, program port 14540 + N
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u8).range(0..=253))]
    instance: u8,
    /// Wait at the start until a ground station arms the vehicle
    #[arg(long)]
    hold: bool,
    /// Obey only commands signed with the passphrase in this file's first line
    #[arg(long, value_name = "FILE")]
    mavlink_key: Option<PathBuf>,
    /// Record the telemetry in this file
    #[arg(long, value_name = "FILE")]
    tlog: Option<PathBuf>,
    /// Set parameters from a file of NAME,VALUE lines
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// Give the orders of this flight's log again, at the same ticks
    #[arg(long, value_name = "LOG", conflicts_with = "params")]
    orders: Option<PathBuf>,
    /// Show the flight as it happens on a page at this address, at the pace of real time and with
    /// --mavlink
    #[arg(long, num_args = 0..=1, default_missing_value = "127.0.0.1:8088", value_name = "HOST:PORT")]
    live: Option<String>,
    /// Speed against real time, for instance 1, or max [default: max, with --live 1]
    #[arg(long, value_parser = speed)]
    speed: Option<Speed>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Speed {
    Max,
    Times(f64),
}

fn speed(text: &str) -> Result<Speed, String> {
    match text.parse::<f64>() {
        _ if text == "max" => Ok(Speed::Max),
        Ok(times) if times.is_finite() && times > 0.0 => Ok(Speed::Times(times)),
        _ => Err("give a positive number, or max".to_owned()),
    }
}

impl GroundArgs {
    fn speed(&self) -> Speed {
        match (self.speed, &self.live) {
            (Some(speed), _) => speed,
            (None, Some(_)) => Speed::Times(1.0),
            (None, None) => Speed::Max,
        }
    }

    fn live(&self, scenario: &Scenario) -> Result<Option<Live>, Failure> {
        let Some(address) = &self.live else {
            return Ok(None);
        };
        let refused = |why: String| Failure::new(LINK, format!("--live {address}: {why}"));
        let header = header(scenario, &scenario.field());
        let live = Live::open(address, &header).map_err(|error| refused(error.to_string()))?;
        talk(format_args!("live at http://{}/", live.address()));
        Ok(Some(live))
    }

    /// Everybody who has a say in the flight.
    pub(super) fn open(
        &self,
        scenario: &Scenario,
        progress: ProgressBar,
    ) -> Result<Again<Crew>, Failure> {
        let crew = Crew {
            orders: self.first_orders(scenario)?,
            unsettled: 0,
            tuning: None,
            live: self.live(scenario)?,
            transport: self.transport()?,
            pacer: Pacer::new(self.speed()),
            progress,
        };
        Ok(match self.again()? {
            Some(orders) => Again::new(Some(orders), crew),
            None => Again::new(None, crew),
        })
    }

    fn transport(&self) -> Result<Option<Transport>, Failure> {
        let connected = !self.mavlink.is_empty() || self.live.is_some();
        if !connected && (self.hold || self.mavlink_key.is_some()) {
            let why = "--hold, --mavlink-key: nobody could arm or command without --mavlink";
            return Err(Failure::new(USAGE, why));
        }
        if !connected && self.tlog.is_none() {
            return Ok(None);
        }
        let vehicle = Vehicle::new(&VehicleConfig {
            instance: self.instance,
            patience: match self.speed() {
                // A station's second is any number of ours.
                Speed::Max => None,
                Speed::Times(times) => {
                    Some((f64::from(PATIENCE * TICKS_PER_SECOND) * times.max(1.0)) as u32)
                }
            },
            hold: self.hold,
            key: self.key()?,
        });
        let mut transport = Transport::new(vehicle, |note| talk(note));
        if connected {
            let peers = self.peers()?;
            for peer in &peers {
                talk(client_lines(self.instance, &peer.to_string()));
            }
            let refused = |error| Failure::new(LINK, format!("--mavlink: {error}"));
            transport.connect(peers).map_err(refused)?;
        }
        if let Some(path) = &self.tlog {
            let file = File::create(path).map_err(|error| unusable("--tlog", path, error))?;
            transport.record(file);
        }
        Ok(Some(transport))
    }

    fn peers(&self) -> Result<Vec<std::net::SocketAddr>, Failure> {
        if self.mavlink.is_empty() {
            return Ok(usual_addresses(self.instance));
        }
        let mut peers = Vec::new();
        for text in &self.mavlink {
            if text == "usual" {
                peers.extend(usual_addresses(self.instance));
                continue;
            }
            let Some(host) = text.strip_prefix("udp:") else {
                return Err(Failure::new(USAGE, "--mavlink: give udp:HOST:PORT"));
            };
            let unknown = |error| Failure::new(LINK, format!("--mavlink {text}: {error}"));
            peers.push(address(host).map_err(unknown)?);
        }
        Ok(peers)
    }

    fn key(&self) -> Result<Option<(Key, u64)>, Failure> {
        let Some(path) = &self.mavlink_key else {
            return Ok(None);
        };
        let text = std::fs::read_to_string(path)
            .map_err(|error| unusable("--mavlink-key", path, error))?;
        let passphrase = text.lines().next().unwrap_or_default();
        if passphrase.is_empty() {
            return Err(unusable(
                "--mavlink-key",
                path,
                "no passphrase in the first line",
            ));
        }
        let since_1970 = SystemTime::UNIX_EPOCH
            .elapsed()
            .unwrap_or_default()
            .as_secs();
        let time = since_1970.saturating_sub(SIGNING_EPOCH) * 100_000;
        Ok(Some((Key::of_passphrase(passphrase), time)))
    }

    /// The orders of a log.
    fn again(&self) -> Result<Option<Vec<OrderEntry>>, Failure> {
        let Some(path) = &self.orders else {
            return Ok(None);
        };
        let bytes = std::fs::read(path).map_err(|error| unusable("--orders", path, error))?;
        let log =
            FlightLog::from_json(&bytes).map_err(|error| unusable("--orders", path, error))?;
        Ok(Some(log.orders))
    }

    /// The orders of a parameter file: each is looked at here, so that a flight begins with all of
    /// them or not at all.
    fn first_orders(&self, scenario: &Scenario) -> Result<Vec<Order>, Failure> {
        let Some(path) = &self.params else {
            return Ok(Vec::new());
        };
        let usage = |why: String| unusable("--params", path, why);
        let text = std::fs::read_to_string(path).map_err(|error| usage(error.to_string()))?;
        let mut tuning =
            Tuning::new(&scenario.configure()).map_err(|why| usage(format!("{why:?}")))?;
        let mut orders = Vec::new();
        for (name, value) in param_file::parse(&text).map_err(|error| usage(error.to_string()))? {
            let number = PARAMETERS
                .iter()
                .position(|parameter| parameter.name == name);
            let refused = |refused: Refused| usage(format!("{name} {value}: {refused}"));
            let Some(number) = number.and_then(|number| u8::try_from(number).ok()) else {
                return Err(refused(Refused::UnknownParameter));
            };
            tuning = tuning
                .with(number, value, false)
                .map_err(|verdict| refused(Refused::Parameter(verdict)))?;
            orders.push(Order::Parameter { name, value });
        }
        let mut planner = Box::new(Planner::new());
        FlightLoop::new(&tuning.settings)
            .and_then(|_| planner.set_up(&tuning.settings))
            .map_err(|error| usage(format!("the core cannot fly with it: {error:?}")))?;
        Ok(orders)
    }
}

fn unusable(flag: &str, path: &Path, why: impl std::fmt::Display) -> Failure {
    Failure::new(USAGE, format!("{flag} {}: {why}", path.display()))
}

/// How each client connects.
fn client_lines(instance: u8, peer: &str) -> String {
    let system = u16::from(instance) + 1;
    format!(
        "MAVLink 2 to udp:{peer} as system {system}:\n\
         \x20 mavproxy.py --master=udp:{peer}\n\
         \x20 pymavlink: mavutil.mavlink_connection('udpin:{peer}')\n\
         \x20 mavsdk: add_any_connection('udpin://{peer}')\n\
         \x20 mpp-ground --connect udpin:{peer} monitor"
    )
}

/// Keeps a flight at its pace.
struct Pacer {
    /// As the command line has it.
    started: Speed,
    speed: Speed,
    begin: Instant,
    ticks: u32,
}

impl Pacer {
    fn new(speed: Speed) -> Self {
        Self {
            started: speed,
            speed,
            begin: Instant::now(),
            ticks: 0,
        }
    }

    /// Does what the pages of a live flight ask for: waits while they pause, and takes their speed.
    fn obey(&mut self, live: &Live) {
        let mut wish = live.wish();
        let paused = wish.pause;
        while wish.pause {
            std::thread::sleep(Duration::from_millis(20));
            wish = live.wish();
        }
        let speed = match wish.speed {
            None => self.started,
            Some(times) if times.is_finite() => Speed::Times(times),
            Some(_) => Speed::Max,
        };
        if paused || speed != self.speed {
            *self = Self {
                started: self.started,
                ..Self::new(speed)
            };
        }
    }

    /// Waits for the end of a tick; one at the start takes its time even if the flight takes none.
    fn wait(&mut self, at_start: bool) {
        let times = match self.speed {
            Speed::Max if !at_start => return,
            Speed::Max => 1.0,
            Speed::Times(times) => times,
        };
        self.ticks += 1;
        let due = f64::from(self.ticks) / f64::from(TICKS_PER_SECOND) / times;
        std::thread::sleep(Duration::from_secs_f64(due).saturating_sub(self.begin.elapsed()));
    }
}

/// Whoever the command line brings along.
pub(super) struct Crew {
    /// Orders for before the first tick.
    orders: Vec<Order>,
    /// How many orders of our own are given and not settled.
    unsettled: usize,
    /// The values in force.
    tuning: Option<Tuning>,
    live: Option<Live>,
    transport: Option<Transport>,
    pacer: Pacer,
    progress: ProgressBar,
}

impl Crew {
    /// The flight is over.
    pub(super) fn end(self, result: &Result<FlightLog, FlyError>) -> Result<(), Failure> {
        self.progress.finish_and_clear();
        let how = match result {
            Ok(log) => log.summary.outcome.to_string(),
            Err(error) => error.to_string(),
        };
        if let (Some(live), Ok(log)) = (self.live, result) {
            live.end(&log.summary);
        }
        let Some(transport) = self.transport else {
            return Ok(());
        };
        let vehicle = transport
            .end(&how)
            .map_err(|error| Failure::new(FAILURE, format!("--tlog: {error}")))?;
        if vehicle.refused_signatures() > 0 {
            talk(format_args!(
                "{} commands or writes were refused: no good signature",
                vehicle.refused_signatures()
            ));
        }
        Ok(())
    }
}

impl Ground for Crew {
    fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        self.tuning = Some(*tuning);
        if let Some(transport) = &mut self.transport {
            transport.begin(tuning, start);
        }
    }

    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let mut orders = std::mem::take(&mut self.orders);
        self.unsettled = orders.len();
        if let Some(transport) = &mut self.transport {
            orders.extend(transport.orders(tick));
        }
        orders
    }

    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        self.tuning = Some(*tuning);
        if self.unsettled > 0 {
            self.unsettled -= 1;
            if let Err(refused) = result {
                talk(format_args!("order {order:?}: {refused}"));
            }
            if let Some(transport) = &mut self.transport {
                transport.tuned(tuning);
            }
        } else if let Some(transport) = &mut self.transport {
            transport.settled(order, result, tuning);
        }
    }

    fn ready(&mut self) -> bool {
        let Some(transport) = &mut self.transport else {
            return true;
        };
        if transport.ready() {
            return true;
        }
        transport.hold();
        self.pacer.wait(true);
        false
    }

    fn watch(&mut self, moment: &Moment<'_>) {
        self.progress.inc(1);
        if let Some(transport) = &mut self.transport {
            transport.watch(moment);
        }
        if let (Some(live), Some(tuning)) = (&mut self.live, &self.tuning) {
            live.watch(moment, tuning);
            self.pacer.obey(live);
        }
        self.pacer.wait(false);
    }
}
