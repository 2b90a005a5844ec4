//! Sockets, and the recording of what goes over them.

use super::tlog::TlogWriter;
use super::vehicle::Vehicle;
use super::{Ground, Order, Refused};
use crate::run::Moment;
use flight_node::parameters::Tuning;
use mpp_core::vehicle::VehicleState;
use std::fs::File;
use std::io::{self, BufWriter};
use std::net::{Ipv4Addr, SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::{Duration, SystemTime};

/// Where ground stations listen by custom.
pub const STATION_PORT: u16 = 14550;
/// Where programs listen by custom, the first instance's.
pub const PROGRAM_PORT: u16 = 14540;
/// Addresses that are remembered beside those that were given.
const GUESTS: usize = 16;
/// Longest datagram that is read [bytes].
const DATAGRAM: usize = 2048;
/// Datagrams that are read in a tick: who sends more does not stop the flight.
const A_TICK: usize = 1000;
/// 2015-01-01T00:00:00Z, from which signatures count, since 1970.
const SIGNING_EPOCH: Duration = Duration::from_secs(1_420_070_400);

/// A vehicle with its sockets.
pub struct Transport {
    vehicle: Vehicle,
    socket: Option<UdpSocket>,
    peers: Vec<SocketAddr>,
    most_peers: usize,
    tlog: Option<TlogWriter<BufWriter<File>>>,
    tlog_error: Option<io::Error>,
    report: Box<dyn FnMut(&str)>,
}

/// The addresses of an instance: station and program on this machine. From the tenth on, instances
/// share a program's port.
#[must_use]
pub fn usual_addresses(instance: u8) -> Vec<SocketAddr> {
    let port = PROGRAM_PORT + u16::from(instance.min(9));
    [STATION_PORT, port]
        .map(|port| SocketAddr::from((Ipv4Addr::LOCALHOST, port)))
        .to_vec()
}

/// The time of signatures by this machine's clock [10 us since 2015-01-01].
#[must_use]
pub fn signing_time() -> u64 {
    let since_1970 = SystemTime::UNIX_EPOCH.elapsed().unwrap_or_default();
    let time = since_1970.saturating_sub(SIGNING_EPOCH).as_micros() / 10;
    u64::try_from(time).unwrap_or(u64::MAX)
}

/// The addresses of `HOST:PORT`.
///
/// # Errors
/// When it is not one, or no such host is known.
pub fn address(text: &str) -> io::Result<SocketAddr> {
    let mut found = text.to_socket_addrs()?;
    let none = || io::Error::new(io::ErrorKind::NotFound, "no such host");
    found.next().ok_or_else(none)
}

impl Transport {
    /// A vehicle that nobody hears; `report` gets what whoever started it should read.
    pub fn new(vehicle: Vehicle, report: impl FnMut(&str) + 'static) -> Self {
        Self {
            vehicle,
            socket: None,
            peers: Vec::new(),
            most_peers: 0,
            tlog: None,
            tlog_error: None,
            report: Box::new(report),
        }
    }

    /// Speaks to these addresses, and to everybody who answers. Others on the network can only
    /// reach it if one of the addresses is on the network.
    ///
    /// # Errors
    /// When no socket is to be had.
    pub fn connect(&mut self, peers: Vec<SocketAddr>) -> io::Result<()> {
        let local = peers.iter().all(|peer| peer.ip().is_loopback());
        let host = match (peers.first(), local) {
            (Some(SocketAddr::V6(_)), true) => "[::1]:0",
            (Some(SocketAddr::V6(_)), false) => "[::]:0",
            (_, true) => "127.0.0.1:0",
            (_, false) => "0.0.0.0:0",
        };
        let socket = UdpSocket::bind(host)?;
        socket.set_nonblocking(true)?;
        self.most_peers = peers.len() + GUESTS;
        self.socket = Some(socket);
        self.peers = peers;
        Ok(())
    }

    /// Records everything that is sent and received.
    pub fn record(&mut self, file: File) {
        self.tlog = Some(TlogWriter::new(BufWriter::new(file)));
    }

    /// Before the flight: one tick at the start.
    pub fn hold(&mut self) {
        let since_start = self.vehicle.microseconds();
        self.vehicle.hold();
        self.deliver(since_start);
    }

    /// Values changed that no station asked for.
    pub fn tuned(&mut self, tuning: &Tuning) {
        self.vehicle.tuned(tuning);
    }

    /// Another number of ticks of silence after which a station is lost; none: never.
    pub fn set_patience(&mut self, patience: Option<u32>) {
        self.vehicle.set_patience(patience);
    }

    /// The flight is over.
    ///
    /// # Errors
    /// What went wrong with the recording.
    pub fn end(mut self, how: &str) -> io::Result<Vehicle> {
        self.vehicle.end(how);
        self.deliver(self.vehicle.microseconds());
        if let Some(tlog) = self.tlog {
            tlog.finish()?;
        }
        self.tlog_error.map_or(Ok(self.vehicle), Err)
    }

    /// Takes in everything that has come.
    fn listen(&mut self) {
        let since_start = self.vehicle.microseconds();
        self.vehicle.set_signing_time(signing_time());
        let mut buffer = [0; DATAGRAM];
        // Whatever else a socket says, for instance that nobody listens yet, may be over at the
        // next tick.
        for _ in 0..A_TICK {
            let Some(Ok((length, from))) = self.socket.as_ref().map(|s| s.recv_from(&mut buffer))
            else {
                break;
            };
            let frames = self.vehicle.receive(&buffer[..length]);
            if !frames.is_empty()
                && !self.peers.contains(&from)
                && self.peers.len() < self.most_peers
            {
                self.peers.push(from);
            }
            for frame in frames {
                self.write(since_start, &frame);
            }
        }
        self.deliver(since_start);
    }

    fn deliver(&mut self, since_start: u64) {
        for frame in self.vehicle.take_outgoing() {
            if let Some(socket) = &self.socket {
                for peer in &self.peers {
                    // Nobody needs to be there.
                    let _ = socket.send_to(frame.wire.as_bytes(), peer);
                }
            }
            self.write(since_start, frame.plain.as_bytes());
        }
        for note in self.vehicle.take_notes() {
            (self.report)(&note);
        }
    }

    fn write(&mut self, since_start: u64, frame: &[u8]) {
        if let Some(tlog) = &mut self.tlog
            && let Err(error) = tlog.write(since_start, frame)
        {
            self.tlog_error = Some(error);
            self.tlog = None;
        }
    }
}

impl Ground for Transport {
    fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        self.vehicle.begin(tuning, start);
    }

    fn orders(&mut self, _: u32) -> Vec<Order> {
        self.listen();
        self.vehicle.take_orders()
    }

    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        self.vehicle.settled(order, result, tuning);
        self.deliver(self.vehicle.microseconds());
    }

    fn ready(&mut self) -> bool {
        self.vehicle.is_armed()
    }

    fn watch(&mut self, moment: &Moment<'_>) {
        let since_start = self.vehicle.microseconds();
        self.vehicle.observe(moment);
        self.deliver(since_start);
    }
}
