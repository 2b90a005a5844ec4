//! Flags for people on the ground, who follow and steer a flight.

mod crew;
mod pacer;

use super::answer::{Failure, LINK, USAGE, talk};
use super::signals::Signals;
use super::values::{datagrams, place, within};
use crate::files::{MOST_WRITTEN, read_log, read_text};
use crate::ground::home::Home;
use crate::ground::param_file;
use crate::ground::transport::{Transport, address, signing_time, usual_addresses};
use crate::ground::vehicle::{Vehicle, VehicleConfig};
use crate::live::Live;
use crate::pace::{Speed, speed};
use crew::Crew;
use hil_protocol::mavlink::Key;
use indicatif::ProgressBar;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::Planner;
use mpp_node::parameters::{self, Tuning};
use mpp_sim::log::{FlightLog, Header};
use mpp_sim::orders::{Again, Order, Refused};
use mpp_sim::outcome::Outcome;
use mpp_sim::scenario::Scenario;
use pacer::{Pacer, patience};
use std::fs::File;
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, clap::Args)]
#[command(next_help_heading = super::help::GROUND)]
pub(super) struct GroundArgs {
    /// Answer MAVLink ground stations at udp:HOST:PORT [default: udp:127.0.0.1:14550 and :14540].
    /// Without --mavlink-key whoever reaches the socket may command, even end the flight: every
    /// program on this machine, and everybody on the network if HOST is another machine
    #[arg(long, num_args = 0..=1, default_missing_value = "usual", value_name = "UDP", value_delimiter = ',', value_parser = datagrams)]
    mavlink: Vec<String>,
    /// Number N of this vehicle among several: system N + 1, program port 14540 + N
    #[arg(long, default_value_t = 0, value_parser = within(0_u8, 253))]
    instance: u8,
    /// Place below the start, metres above the sea, and heading [default: 47.397742,8.545594,488,0, where PX4 starts]
    #[arg(long, value_name = "LAT,LON,ALT,HEADING", allow_hyphen_values = true)]
    home: Option<Home>,
    /// Wait at the start until a ground station arms the vehicle
    #[arg(long)]
    hold: bool,
    /// Obey only commands signed with the passphrase in this file's first line, without blanks at its end; FILE.state
    /// beside it keeps the newest signed times, so that nothing recorded is obeyed again
    #[arg(long, value_name = "FILE")]
    mavlink_key: Option<PathBuf>,
    /// Record the telemetry in this file as it comes, in place of what the file holds. A flight that
    /// is cut short leaves what came until then
    #[arg(long, value_name = "FILE")]
    tlog: Option<PathBuf>,
    /// Set parameters from a file of NAME,VALUE lines
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// Repeat the flight of this log, with its orders at the same ticks
    #[arg(long, value_name = "LOG", conflicts_with = "params")]
    orders: Option<PathBuf>,
    /// Show the flight live on a page at this address; the default speed is then real time, and
    /// --mavlink is on
    #[arg(long, num_args = 0..=1, default_missing_value = "127.0.0.1:8088", value_name = "HOST:PORT", value_parser = place)]
    live: Option<String>,
    /// Speed relative to real time, 0.01 to 1000, or max [default: max; 1 with --mavlink or --live]
    #[arg(long, value_parser = speed)]
    speed: Option<Speed>,
}

impl GroundArgs {
    /// Whether ground stations or pages may follow the flight.
    fn connected(&self) -> bool {
        !self.mavlink.is_empty() || self.live.is_some()
    }

    fn speed(&self) -> Speed {
        match self.speed {
            Some(speed) => speed,
            // People cannot follow anything faster.
            None if self.connected() => Speed::Times(1.0),
            None => Speed::Max,
        }
    }

    fn live(&self, scenario: &Scenario) -> Result<Option<Live>, Failure> {
        let Some(address) = &self.live else {
            return Ok(None);
        };
        let refused = |why: String| Failure::new(LINK, format!("--live {address}: {why}"));
        let header = Header::of(scenario, &scenario.field());
        let live = Live::open(address, &header, self.speed());
        let live = live.map_err(|error| refused(error.to_string()))?;
        talk(format_args!("live at http://{}/", live.address()));
        Ok(Some(live))
    }

    /// Opens the ground: everybody who may follow or steer the flight.
    pub(super) fn open(
        &self,
        scenario: &Scenario,
        recorded: Option<FlightLog>,
        progress: ProgressBar,
        signals: Signals,
    ) -> Result<Again<Crew>, Failure> {
        let crew = Crew {
            orders: self.first_orders(scenario)?,
            unsettled: 0,
            tuning: None,
            live: self.live(scenario)?,
            transport: self.transport(scenario)?,
            pacer: Pacer::new(self.speed()),
            progress,
            signals,
        };
        let interrupted = recorded
            .as_ref()
            .filter(|log| log.summary.outcome == Outcome::Interrupted)
            .and_then(|log| u32::try_from(log.ticks.t.len()).ok());
        let orders = recorded.map(|log| log.orders);
        Ok(Again::new(orders, crew).until(interrupted))
    }

    fn transport(&self, scenario: &Scenario) -> Result<Option<Transport>, Failure> {
        let connected = self.connected();
        if !connected && (self.hold || self.mavlink_key.is_some()) {
            let why = "--hold, --mavlink-key: nobody could arm or command without --mavlink";
            return Err(Failure::new(USAGE, why));
        }
        if !connected && self.tlog.is_none() {
            if self.instance != 0 || self.home.is_some() {
                let why =
                    "--instance, --home: nobody would see it without --mavlink, --live or --tlog";
                return Err(Failure::new(USAGE, why));
            }
            return Ok(None);
        }
        let vehicle = Vehicle::new(&VehicleConfig {
            instance: self.instance,
            patience: patience(self.speed()),
            hold: self.hold,
            key: self.key()?,
            home: self.home.unwrap_or(Home::ZURICH),
            navigation: scenario.navigation,
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
        if let Some(path) = &self.mavlink_key {
            let mut state = path.clone().into_os_string();
            state.push(".state");
            let refused = |why| Failure::new(USAGE, format!("--mavlink-key: {why}"));
            transport.remember(Path::new(&state)).map_err(refused)?;
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
        for text in self.mavlink.iter().map(|text| text.trim()) {
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
        let text = read_text(path, MOST_WRITTEN)
            .map_err(|error| unusable("--mavlink-key", path, error))?;
        // Editors and shells leave blanks at the end, which nobody sees.
        let passphrase = text.lines().next().unwrap_or_default().trim_end();
        if passphrase.is_empty() {
            return Err(unusable(
                "--mavlink-key",
                path,
                "no passphrase in the first line",
            ));
        }
        if is_open_to_others(path) {
            talk(format_args!(
                "--mavlink-key: others on this machine can read {0}: chmod 600 {0}",
                path.display()
            ));
        }
        Ok(Some((Key::of_passphrase(passphrase), signing_time())))
    }

    /// Reads the log whose flight is repeated, if there is one.
    pub(super) fn recorded(&self) -> Result<Option<FlightLog>, Failure> {
        let refused = |error| Failure::new(USAGE, format!("--orders: {error}"));
        let log = self.orders.as_deref().map(read_log).transpose();
        log.map_err(refused)
    }

    /// Reads the orders of a parameter file. Each order is checked here, so that a flight begins
    /// with all of them or not at all.
    fn first_orders(&self, scenario: &Scenario) -> Result<Vec<Order>, Failure> {
        let Some(path) = &self.params else {
            return Ok(Vec::new());
        };
        let usage = |why: String| unusable("--params", path, why);
        let text = read_text(path, MOST_WRITTEN)
            .map_err(|error| usage(format!("{error}: give a file of NAME,VALUE lines")))?;
        let mut tuning =
            Tuning::new(&scenario.configure()).map_err(|why| usage(why.to_string()))?;
        let mut orders = Vec::new();
        for (name, value) in param_file::parse(&text).map_err(|error| usage(error.to_string()))? {
            let refused = |refused: Refused| usage(format!("{name} {value}: {refused}"));
            let Some(number) = parameters::number(&name) else {
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
            .map_err(|error| usage(format!("the core cannot fly with it: {error}")))?;
        Ok(orders)
    }
}

fn unusable(flag: &str, path: &Path, why: impl std::fmt::Display) -> Failure {
    Failure::new(USAGE, format!("{flag} {}: {why}", path.display()))
}

/// Whether others than its owner may read a file.
fn is_open_to_others(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = path.metadata().map(|found| found.permissions().mode());
        mode.is_ok_and(|mode| mode & 0o044 != 0)
    }
    #[cfg(not(unix))]
    {
        let _ = path;
        false
    }
}

/// The lines that tell how each client connects.
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

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        ground: GroundArgs,
    }

    /// Editors leave a mark before the text and blanks behind it, which nobody sees.
    #[test]
    fn a_passphrase_is_what_is_seen_of_it() {
        let file = std::env::temp_dir().join(format!("mpp-passphrase-{}", std::process::id()));
        let key = |text: &str| {
            std::fs::write(&file, text).unwrap();
            let line = ["fly", "--mavlink-key", file.to_str().unwrap()];
            let read = Line::parse_from(line).ground.key();
            read.map_err(|failure| failure.message)
                .unwrap()
                .unwrap()
                .0
                .0
        };
        let plain = key("correct horse");
        for text in [
            "correct horse\n",
            "correct horse \t\r\nmore",
            "\u{feff}correct horse\n",
        ] {
            assert!(key(text) == plain, "{text:?}");
        }
        assert!(key(" correct horse") != plain && key("correct  horse") != plain);
        std::fs::remove_file(&file).unwrap();
    }

    #[test]
    fn who_can_be_followed_flies_at_the_pace_of_the_clock() {
        let speed = |line: &str| Line::parse_from(line.split(' ')).ground.speed();
        assert_eq!(speed("fly"), Speed::Max);
        assert_eq!(speed("fly --tlog a.tlog"), Speed::Max);
        assert_eq!(speed("fly --mavlink"), Speed::Times(1.0));
        assert_eq!(speed("fly --live"), Speed::Times(1.0));
        assert_eq!(speed("fly --mavlink --speed max"), Speed::Max);
        assert_eq!(speed("fly --live --speed 4"), Speed::Times(4.0));
    }
}
