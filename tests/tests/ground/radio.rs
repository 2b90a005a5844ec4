//! A radio: a station that speaks at chosen ticks, over a link that may be bad.

use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Framer, Key, MessageData, Sender, Signer, text};
use mpp_core::vehicle::VehicleState;
use mpp_node::parameters::Tuning;
use mpp_sim::flight::fly_with;
use mpp_sim::log::FlightLog;
use mpp_sim::navigation::NavigationConfig;
use mpp_sim::orders::{Ground, Order, Refused};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::tick_record::TickRecord;
use sil_harness::ground::home::Home;
use sil_harness::ground::tlog::TlogWriter;
use sil_harness::ground::vehicle::{Outgoing, Vehicle, VehicleConfig};
use std::net::{IpAddr, Ipv4Addr, SocketAddr};

pub(crate) const CONFIG: VehicleConfig = VehicleConfig {
    instance: 0,
    patience: Some(500),
    hold: false,
    key: None,
    home: Home::ZURICH,
    navigation: NavigationConfig::RTK,
};

/// The address of the station.
pub(crate) const HERE: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 14_550);
/// The address of another station.
pub(crate) const THERE: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 14_540);

pub(crate) fn scenario() -> Scenario {
    Scenario {
        ticks: 1200,
        ..Scenario::new(Preset::Flight, 1)
    }
}

/// Its first three seconds.
pub(crate) fn short() -> Scenario {
    Scenario {
        ticks: 300,
        ..scenario()
    }
}

/// The change that a link makes to the datagrams of one direction.
pub(crate) type Channel = Box<dyn FnMut(Vec<Vec<u8>>) -> Vec<Vec<u8>>>;

/// A vehicle, a station that sends at given ticks, and everything that the station hears.
pub(crate) struct Radio {
    pub(crate) vehicle: Vehicle,
    /// Tick of the flight, datagram and address; -1 means before the flight.
    script: Vec<(i64, Vec<u8>, SocketAddr)>,
    pub(crate) up: Channel,
    pub(crate) down: Channel,
    framer: Framer,
    /// Ticks since the start, and message.
    pub(crate) heard: Vec<(u32, MavMessage)>,
    /// The same at the other address, with the number of the frame.
    pub(crate) heard_there: Vec<(u32, u8, MavMessage)>,
    pub(crate) tlog: TlogWriter<Vec<u8>>,
    pub(crate) notes: Vec<String>,
    held: u32,
}

/// Every message of a kind that a radio heard: its time, and what is picked of it.
macro_rules! heard {
    ($radio:expr, $kind:ident, |$message:ident| $picked:expr) => {
        $radio.all(|message| match message {
            hil_protocol::mavlink::messages::MavMessage::$kind($message) => Some($picked),
            _ => None,
        })
    };
}
pub(crate) use heard;

impl Radio {
    pub(crate) fn new(config: &VehicleConfig) -> Self {
        Self {
            vehicle: Vehicle::new(config),
            script: Vec::new(),
            up: Box::new(|datagrams| datagrams),
            down: Box::new(|datagrams| datagrams),
            framer: Framer::new(),
            heard: Vec::new(),
            heard_there: Vec::new(),
            tlog: TlogWriter::new(Vec::new()),
            notes: Vec::new(),
            held: 0,
        }
    }

    /// Sends a message before a tick is flown.
    pub(crate) fn at<M: MessageData>(&mut self, tick: i64, message: &M) -> &mut Self {
        let frame = Sender::new(255, 190).frame(message);
        self.bytes_at(tick, frame.as_bytes());
        self
    }

    /// Sends a message from the other address.
    pub(crate) fn there_at<M: MessageData>(&mut self, tick: i64, message: &M) -> &mut Self {
        let frame = Sender::new(245, 190).frame(message);
        self.there_bytes_at(tick, frame.as_bytes());
        self
    }

    /// Sends bytes from the other address.
    pub(crate) fn there_bytes_at(&mut self, tick: i64, bytes: &[u8]) {
        self.script.push((tick, bytes.to_vec(), THERE));
    }

    /// Sends bytes before a tick is flown.
    pub(crate) fn bytes_at(&mut self, tick: i64, bytes: &[u8]) {
        self.script.push((tick, bytes.to_vec(), HERE));
    }

    /// Sends a message before a tick is flown, signed at a time.
    pub(crate) fn signed_at<M: MessageData>(
        &mut self,
        tick: i64,
        message: &M,
        key: Key,
        time: u64,
    ) {
        let frame = Sender::new(255, 190).signed_frame(message, &mut Signer::new(key, 1, time));
        self.bytes_at(tick, frame.as_bytes());
    }

    /// Flies and returns the log.
    pub(crate) fn fly(&mut self, scenario: &Scenario) -> FlightLog {
        self.script.sort_by_key(|(tick, ..)| *tick);
        fly_with(scenario, &mut PipeLink::new(), self).unwrap()
    }

    /// Every message of a kind, with its time.
    pub(crate) fn all<T>(&self, pick: impl Fn(&MavMessage) -> Option<T>) -> Vec<(u32, T)> {
        let heard = self.heard.iter();
        heard
            .filter_map(|(tick, message)| Some((*tick, pick(message)?)))
            .collect()
    }

    /// Command and result of every acknowledgement.
    pub(crate) fn acks(&self) -> Vec<(u16, u8)> {
        heard!(self, COMMAND_ACK, |ack| (ack.command, ack.result))
            .into_iter()
            .map(|(_, ack)| ack)
            .collect()
    }

    /// Every text.
    pub(crate) fn texts(&self) -> Vec<(u32, String)> {
        heard!(self, STATUSTEXT, |status| status
            .text
            .to_str()
            .unwrap()
            .to_owned())
    }

    /// Name and value of every parameter that was sent.
    pub(crate) fn values(&self) -> Vec<(String, f32)> {
        heard!(self, PARAM_VALUE, |value| (
            value.param_id.to_str().unwrap().to_owned(),
            value.param_value,
        ))
        .into_iter()
        .map(|(_, value)| value)
        .collect()
    }

    fn speak(&mut self, tick: i64) {
        let due = self
            .script
            .iter()
            .take_while(|(at, ..)| *at <= tick)
            .count();
        let due: Vec<_> = self.script.drain(..due).collect();
        let (here, there): (Vec<_>, Vec<_>) = due.into_iter().partition(|(.., from)| *from == HERE);
        let here = here.into_iter().map(|(_, datagram, _)| datagram).collect();
        for datagram in (self.up)(here) {
            self.vehicle.receive(HERE, &datagram);
        }
        for (_, datagram, from) in there {
            self.vehicle.receive(from, &datagram);
        }
    }

    /// What an address gets.
    fn datagrams(&self, at: SocketAddr, outgoing: &[Outgoing]) -> Vec<Vec<u8>> {
        let key = self.vehicle.key(at);
        let frames = outgoing.iter().flat_map(|frame| &frame.wire);
        let own = frames.filter(|(to, _)| *to == key);
        own.map(|(_, datagram)| datagram.as_bytes().to_vec())
            .collect()
    }

    fn listen(&mut self, now: u32, since_start: u64) {
        let outgoing = self.vehicle.take_outgoing();
        for plain in outgoing.iter().filter_map(|frame| frame.plain.as_ref()) {
            self.tlog.write(since_start, plain.as_bytes()).unwrap();
        }
        for datagram in self.datagrams(THERE, &outgoing) {
            let heard = &mut self.heard_there;
            Framer::new().receive_datagram(&datagram, |frame| {
                heard.push((
                    now,
                    frame.bytes[4],
                    MavMessage::parse(frame.id, frame.payload).unwrap(),
                ));
            });
        }
        let datagrams = self.datagrams(HERE, &outgoing);
        for datagram in (self.down)(datagrams) {
            let heard = &mut self.heard;
            self.framer.receive_datagram(&datagram, |frame| {
                heard.push((now, MavMessage::parse(frame.id, frame.payload).unwrap()));
            });
        }
        self.notes.extend(self.vehicle.take_notes());
    }
}

impl Ground for Radio {
    fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        self.vehicle.begin(tuning, start);
    }

    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let at_start = !self.vehicle.is_armed() && tick == 0;
        self.speak(if at_start { -1 } else { i64::from(tick) });
        self.vehicle.take_orders()
    }

    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        self.vehicle.settled(order, result, tuning);
    }

    fn ready(&mut self) -> bool {
        self.held += 1;
        assert!(self.held < 1000, "nobody arms the vehicle");
        if self.vehicle.is_armed() {
            return true;
        }
        let (now, since_start) = (self.vehicle.now(), self.vehicle.microseconds());
        self.vehicle.hold();
        self.listen(now, since_start);
        false
    }

    fn watch(&mut self, record: &TickRecord<'_>) {
        let (now, since_start) = (self.vehicle.now(), self.vehicle.microseconds());
        self.vehicle.observe(record);
        self.listen(now, since_start);
    }
}

pub(crate) fn command(number: u16, first: f32, second: f32) -> COMMAND_LONG_DATA {
    COMMAND_LONG_DATA {
        command: number,
        param1: first,
        param2: second,
        target_system: 1,
        target_component: 1,
        ..COMMAND_LONG_DATA::DEFAULT
    }
}

pub(crate) fn write(name: &str, value: f32) -> PARAM_SET_DATA {
    PARAM_SET_DATA {
        param_id: text(name),
        param_value: value,
        param_type: 9,
        target_system: 1,
        target_component: 1,
    }
}

pub(crate) fn heartbeat() -> HEARTBEAT_DATA {
    HEARTBEAT_DATA {
        mavtype: 6,
        autopilot: 8,
        ..HEARTBEAT_DATA::DEFAULT
    }
}
