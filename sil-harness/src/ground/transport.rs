//! Sockets, and the recording of the frames that go over them.

use super::guests::Guests;
use super::heard::Heard;
use super::tlog::TlogWriter;
use super::vehicle::Vehicle;
use crate::files::{MOST_WRITTEN, read_text, write_soon};
use mpp_core::vehicle::VehicleState;
use mpp_node::parameters::Tuning;
use mpp_sim::orders::{Ground, Order, Refused};
use mpp_sim::tick_record::TickRecord;
use std::fs::File;
use std::io::{self, BufWriter};
use std::net::{Ipv4Addr, SocketAddr, ToSocketAddrs, UdpSocket};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// The port on which ground stations usually listen.
pub const STATION_PORT: u16 = 14550;
/// The port on which programs usually listen. It is the port of the first instance.
pub const PROGRAM_PORT: u16 = 14540;
/// Longest datagram that is read \[bytes\].
const DATAGRAM: usize = 2048;
/// Number of datagrams that are read in a tick. A station that sends more does not stop the flight.
const DATAGRAMS_PER_TICK: usize = 1000;
/// The start of the time of signatures, 2015-01-01T00:00:00Z, since 1970.
const SIGNING_EPOCH: Duration = Duration::from_secs(1_420_070_400);

/// A vehicle with its sockets.
pub struct Transport {
    vehicle: Vehicle,
    socket: Option<UdpSocket>,
    peers: Vec<SocketAddr>,
    guests: Guests,
    /// Where signed times are kept, and those that are.
    memory: Option<(PathBuf, Heard)>,
    tlog: Option<TlogWriter<BufWriter<File>>>,
    tlog_error: Option<io::Error>,
    report: Box<dyn FnMut(&str)>,
}

/// The addresses of an instance: station and program on this machine. From the tenth instance on,
/// the instances share one program port.
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

/// The address of `HOST:PORT`.
///
/// # Errors
/// An error when the text is no such address, or when no such host is known.
pub fn address(text: &str) -> io::Result<SocketAddr> {
    let mut found = text.to_socket_addrs()?;
    let none = || io::Error::new(io::ErrorKind::NotFound, "no such host");
    found.next().ok_or_else(none)
}

impl Transport {
    /// A vehicle without a connection. `report` gets the lines for the person who started it.
    pub fn new(vehicle: Vehicle, report: impl FnMut(&str) + 'static) -> Self {
        Self {
            guests: Guests::new(vehicle.patience()),
            vehicle,
            socket: None,
            peers: Vec::new(),
            memory: None,
            tlog: None,
            tlog_error: None,
            report: Box::new(report),
        }
    }

    /// Speaks to these addresses, and to everybody who answers. Other machines on the network can
    /// only reach the vehicle if one of the addresses is on the network.
    ///
    /// # Errors
    /// An error when no socket can be opened.
    pub fn connect(&mut self, peers: Vec<SocketAddr>) -> io::Result<()> {
        if peers.iter().any(|peer| peer.is_ipv4()) && peers.iter().any(|peer| peer.is_ipv6()) {
            let why = "one socket serves either IPv4 or IPv6: give addresses of one kind";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        let local = peers.iter().all(|peer| peer.ip().is_loopback());
        let host = match (peers.first(), local) {
            (Some(SocketAddr::V6(_)), true) => "[::1]:0",
            (Some(SocketAddr::V6(_)), false) => "[::]:0",
            (_, true) => "127.0.0.1:0",
            (_, false) => "0.0.0.0:0",
        };
        let socket = UdpSocket::bind(host)?;
        socket.set_nonblocking(true)?;
        self.socket = Some(socket);
        self.peers = peers;
        Ok(())
    }

    /// Keeps the times of signatures in this file, for the next flight, and believes none that is not
    /// newer than those in it.
    ///
    /// # Errors
    /// A sentence: the file cannot be read or written, or holds something else.
    pub fn remember(&mut self, path: &Path) -> Result<(), String> {
        let mut heard = kept(path)?;
        heard.forget(signing_time());
        write_soon(path, heard.format().as_bytes()).map_err(|error| error.to_string())?;
        self.vehicle.remember(&heard);
        self.memory = Some((path.to_owned(), heard));
        Ok(())
    }

    /// Writes the times of signatures down if there are newer ones: before what was signed is done.
    fn memorise(&mut self) {
        let (Some((path, known)), Some(heard)) = (&mut self.memory, self.vehicle.heard()) else {
            return;
        };
        if known == heard {
            return;
        }
        known.merge(heard);
        // Another vehicle with the same key may have written, too.
        let mut all = known.clone();
        let others = kept(path).map(|others| all.merge(&others));
        let written = others.and_then(|()| {
            write_soon(path, all.format().as_bytes()).map_err(|error| error.to_string())
        });
        if let Err(why) = written {
            let line = format!("{why}: what was signed in this flight may be obeyed in the next");
            (self.report)(&line);
            self.memory = None;
        }
    }

    /// Records everything that is sent and received.
    pub fn record(&mut self, file: File) {
        self.tlog = Some(TlogWriter::new(BufWriter::new(file)));
    }

    /// Passes one tick at the start, before the flight.
    pub fn hold(&mut self) {
        let since_start = self.vehicle.microseconds();
        self.vehicle.hold();
        self.deliver(since_start);
    }

    /// Takes values that changed without a request from a station.
    pub fn tuned(&mut self, tuning: &Tuning) {
        self.vehicle.tuned(tuning);
    }

    /// Sets another number of ticks of silence after which a station is lost; `None` means never.
    pub fn set_patience(&mut self, patience: Option<u32>) {
        self.guests.set_patience(patience);
        self.vehicle.set_patience(patience);
    }

    /// Ends the link after the flight.
    ///
    /// # Errors
    /// The error of the recording.
    pub fn end(mut self, how: &str) -> io::Result<Vehicle> {
        self.vehicle.end(how);
        self.memorise();
        self.deliver(self.vehicle.microseconds());
        if let Some(tlog) = self.tlog {
            tlog.finish()?;
        }
        self.tlog_error.map_or(Ok(self.vehicle), Err)
    }

    /// Reads everything that has arrived.
    fn listen(&mut self) {
        let since_start = self.vehicle.microseconds();
        self.vehicle.set_signing_time(signing_time());
        self.guests.expire(since_start);
        let Self {
            vehicle,
            peers,
            guests,
            ..
        } = self;
        vehicle.keep(|peer| peers.contains(peer) || guests.addresses().any(|guest| guest == peer));
        let mut buffer = [0; DATAGRAM];
        // Any other answer of the socket ends the loop, for instance that nobody listens yet. The
        // cause may be gone at the next tick.
        for _ in 0..DATAGRAMS_PER_TICK {
            let Some(Ok((length, from))) = self.socket.as_ref().map(|s| s.recv_from(&mut buffer))
            else {
                break;
            };
            let frames = self.vehicle.receive(from, &buffer[..length]);
            if !frames.is_empty() && !self.peers.contains(&from) {
                self.guests.hear(from, since_start);
            }
            for frame in frames {
                self.write(since_start, &frame);
            }
        }
        // Before a station hears that its signed command was obeyed.
        self.memorise();
        self.deliver(since_start);
    }

    fn deliver(&mut self, since_start: u64) {
        for frame in self.vehicle.take_outgoing() {
            if let Some(socket) = &self.socket {
                for peer in self.peers.iter().chain(self.guests.addresses()) {
                    let key = self.vehicle.key(*peer);
                    for (_, datagram) in frame.wire.iter().filter(|(to, _)| *to == key) {
                        // A failed send is no error, because no station needs to be there.
                        let _ = socket.send_to(datagram.as_bytes(), peer);
                    }
                }
            }
            if let Some(plain) = frame.plain {
                self.write(since_start, plain.as_bytes());
            }
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

/// The signed times in a file; none if there is none.
fn kept(path: &Path) -> Result<Heard, String> {
    let named = |why: String| format!("{}: {why}", path.display());
    match read_text(path, MOST_WRITTEN) {
        Ok(text) => Heard::parse(&text).map_err(named),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Heard::default()),
        Err(error) => Err(named(error.to_string())),
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

    fn watch(&mut self, record: &TickRecord<'_>) {
        let since_start = self.vehicle.microseconds();
        self.vehicle.observe(record);
        self.deliver(since_start);
    }
}
