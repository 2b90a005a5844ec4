//! Flags of a flight with people on the ground.

mod crew;
mod pacer;

use super::{Failure, LINK, USAGE, talk};
use crate::ground::transport::{Transport, address, signing_time, usual_addresses};
use crate::ground::vehicle::{Vehicle, VehicleConfig};
use crate::ground::{Again, Order, OrderEntry, Refused, param_file};
use crate::log::FlightLog;
use crate::picture::live::Live;
use crate::run::header;
use crate::scenario::Scenario;
use crew::Crew;
use flight_node::parameters::{PARAMETERS, Tuning};
use hil_protocol::mavlink::Key;
use indicatif::ProgressBar;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::Planner;
use pacer::{Pacer, Speed, speed};
use std::fs::File;
use std::path::{Path, PathBuf};

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
        Ok(Again::new(self.again()?, crew))
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
            patience: self.speed().patience(),
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
        Ok(Some((Key::of_passphrase(passphrase), signing_time())))
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
