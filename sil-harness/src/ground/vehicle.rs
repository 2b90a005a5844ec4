//! The vehicle that a ground station sees: a fixed wing that answers as such vehicles do.
//!
//! Frames and moments of the flight go in, frames and orders come out. Time is the number of ticks, those before the flight too.

pub use super::channels::Outgoing;
use super::channels::{Channels, Turn};
use super::demands::{Address, Demand, Demands};
use super::doubts::Doubts;
use super::files::Files;
use super::heard::Heard;
use super::home::Home;
use super::last::Last;
use super::parameter_queue::ParameterQueue;
use super::security::Security;
use super::severity::Severity;
use super::stations::Stations;
use super::tails::Tails;
use hil_protocol::SensorStates;
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Frame, Framer, Key, Sender};
use mpp_core::vehicle::{AirState, Conditions, Control, VehicleState};
use mpp_node::parameters::{self, Tuning};
use mpp_sim::navigation::NavigationConfig;
use mpp_sim::orders::{Mode, Order, Refused};
use mpp_sim::scenario::{TICK_MS, TICK_US};
use mpp_sim::tick_record::TickRecord;
use std::collections::VecDeque;
use std::net::SocketAddr;

/// MAV_COMP_ID_AUTOPILOT1.
pub(super) const COMPONENT: u8 = 1;
/// MAV_TYPE_GCS.
const STATION: u8 = 6;

/// The configuration of a vehicle.
#[derive(Clone)]
pub struct VehicleConfig {
    /// Number of the vehicle: 0 is system 1, and so on.
    pub instance: u8,
    /// Ticks of silence after which a station is lost; `None` means never.
    pub patience: Option<u32>,
    /// Whether the vehicle waits at the start until somebody arms it.
    pub hold: bool,
    /// Key, and time of the first signature [10 us since 2015-01-01].
    pub key: Option<(Key, u64)>,
    /// The place of the start.
    pub home: Home,
    /// The navigation source, for the accuracy that it declares.
    pub navigation: NavigationConfig,
}

/// The receiver of an order's result.
pub(super) enum Waiting {
    /// The sender of a command.
    Command(u16, Address),
    /// Everybody waits for a parameter's value.
    Parameter(u8),
    Nobody,
}

/// The vehicle.
pub struct Vehicle {
    pub(super) system: u8,
    pub(super) channels: Channels,
    pub(super) security: Security,
    framer: Framer,
    tails: Tails,
    stations: Stations,
    pub(super) files: Files,
    demands: Demands<Demand>,
    pub(super) parameters: ParameterQueue,
    pub(super) tuning: Option<Tuning>,
    pub(super) notes: Vec<String>,
    orders: Vec<Order>,
    waiting: VecDeque<Waiting>,
    /// Ticks since the start.
    pub(super) now: u32,
    pub(super) armed: bool,
    pub(super) flying: bool,
    pub(super) mode: Mode,
    pub(super) state: VehicleState,
    estimate: AirState,
    pub(super) control: Control,
    /// Wind and lift by the core's estimate.
    pub(super) conditions: Conditions,
    rejections: usize,
    pub(super) sensors: SensorStates,
    pub(super) doubts: Doubts,
    /// The tick from which the lidar is watched: none in a mode that takes no scans.
    pub(super) lidar_from: u32,
    pub(super) home: Home,
    pub(super) navigation: NavigationConfig,
    /// The last of each event, for a station that asks for it.
    pub(super) last: Last,
    /// Whether another vehicle with this number, and a climb over a silent half of the lidar, were told of.
    pub(super) twin: bool,
    pub(super) climbs: bool,
}

impl Vehicle {
    /// A vehicle at its start.
    #[must_use]
    pub fn new(config: &VehicleConfig) -> Self {
        let system = config.instance.saturating_add(1);
        Self {
            system,
            channels: Channels::new(&Sender::new(system, COMPONENT)),
            security: Security::new(config.key.clone()),
            framer: Framer::new(),
            tails: Tails::default(),
            stations: Stations::new(config.patience),
            files: Files::new(),
            demands: Demands::new(),
            parameters: ParameterQueue::default(),
            tuning: None,
            notes: Vec::new(),
            orders: Vec::new(),
            waiting: VecDeque::new(),
            now: 0,
            armed: !config.hold,
            flying: false,
            mode: Mode::Auto,
            state: VehicleState::default(),
            estimate: AirState::default(),
            control: Control::default(),
            conditions: Conditions::STILL,
            rejections: 0,
            sensors: SensorStates::default(),
            doubts: Doubts::default(),
            lidar_from: 0,
            home: config.home,
            navigation: config.navigation,
            last: Last::default(),
            twin: false,
            climbs: false,
        }
    }

    /// Begins a flight: the core is configured and the aircraft is at its start.
    pub fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        self.tuning = Some(*tuning);
        self.state = *start;
        self.estimate = start.air;
    }

    /// Takes values that changed without a request from a station.
    pub fn tuned(&mut self, tuning: &Tuning) {
        self.tuning = Some(*tuning);
    }

    /// Whether the vehicle may fly.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.armed
    }

    /// Ticks since the start.
    #[must_use]
    pub fn now(&self) -> u32 {
        self.now
    }

    /// Number of commands and writes that were refused because they bear no good signature.
    #[must_use]
    pub fn refused_signatures(&self) -> u32 {
        self.security.refused
    }

    /// Commands and writes that were not carried out, because too many came at once.
    #[must_use]
    pub fn lost_demands(&self) -> u32 {
        self.demands.lost()
    }

    /// Believes no signature that is not newer than these.
    pub fn remember(&mut self, heard: &Heard) {
        self.security.remember(heard);
    }

    /// The newest times of signatures that were believed; none without a key.
    #[must_use]
    pub fn heard(&self) -> Option<&Heard> {
        self.security.heard()
    }

    /// Advances the time of signatures [10 us since 2015-01-01]. Without this call it stays that of
    /// the start.
    pub fn set_signing_time(&mut self, time: u64) {
        self.security.set_time(time);
    }

    /// Number of silent ticks after which a station is lost; `None` means never.
    #[must_use]
    pub fn patience(&self) -> Option<u32> {
        self.stations.patience()
    }

    /// Sets another number of ticks of silence, from now on, after which a station is lost.
    pub fn set_patience(&mut self, patience: Option<u32>) {
        self.stations.set_patience(patience, self.now);
    }

    /// Handles a datagram that came from an address. Returns the intact frames in it.
    pub fn receive(&mut self, peer: SocketAddr, datagram: &[u8]) -> Vec<Vec<u8>> {
        let mut frames = Vec::new();
        let bytes = self.tails.join(peer, datagram);
        let mut framer = std::mem::take(&mut self.framer);
        framer.receive_datagram(&bytes, |frame| {
            self.handle(frame, peer);
            frames.push(frame.bytes.to_vec());
        });
        self.framer = framer;
        self.tails.keep(peer, &bytes, &frames);
        frames
    }

    /// The orders that stations gave since the last time.
    pub fn take_orders(&mut self) -> Vec<Order> {
        std::mem::take(&mut self.orders)
    }

    /// Takes the frames that are to be sent.
    pub fn take_outgoing(&mut self) -> Vec<Outgoing> {
        self.channels.take_outgoing()
    }

    /// The key of an address in [`Outgoing::wire`].
    #[must_use]
    pub fn key(&self, peer: SocketAddr) -> Option<SocketAddr> {
        self.channels.key(peer)
    }

    /// Forgets what addresses asked for that are gone.
    pub fn keep(&mut self, is_there: impl Fn(&SocketAddr) -> bool) {
        self.channels.keep(is_there);
    }

    /// Takes the lines for the person who started the vehicle.
    pub fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Takes the result of the oldest order that is not settled, and the values in force.
    pub fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        self.tuning = Some(*tuning);
        if result.is_ok() {
            match order {
                Order::Mode { mode } => self.enter(*mode),
                Order::Motor { on } => self.armed = *on,
                Order::Parameter { .. }
                | Order::Terminate
                | Order::Obstacles { .. }
                | Order::Trunk { .. }
                | Order::Disturb { .. } => {}
            }
        }
        match self.waiting.pop_front() {
            Some(Waiting::Command(command, from)) => {
                if let Order::Parameter { name, .. } = order
                    && let Some(number) = parameters::number(name)
                {
                    self.answer_write(number, result);
                }
                self.acknowledge(command, from, result.is_ok());
            }
            Some(Waiting::Parameter(number)) => self.answer_write(number, result),
            Some(Waiting::Nobody) | None => {}
        }
    }

    /// Passes one tick at the start, before the flight.
    pub fn hold(&mut self) {
        self.pass();
    }

    /// Takes one tick of the flight.
    pub fn observe(&mut self, record: &TickRecord<'_>) {
        self.flying = true;
        // A station sees what the aircraft believes, as it would from a real one.
        self.state = record.tick.estimate;
        self.estimate = record.tick.estimate.air;
        self.control = record.tick.control;
        self.conditions = record.tick.conditions;
        for entry in record.rejections.iter().skip(self.rejections) {
            self.note_fault(&entry.cause);
        }
        self.rejections = record.rejections.len();
        self.report_sensors(&record.sensors);
        self.report_scan(record);
        if let Some(report) = record.report {
            self.report_plan(report);
        }
        if let Some(trajectory) = record.trajectory {
            self.send_trajectory(trajectory);
        }
        self.pass();
    }

    /// Ends the flight.
    pub fn end(&mut self, how: &str) {
        self.flying = false;
        self.armed = false;
        self.say(Severity::Notice, &format!("Flight ended: {how}"));
        self.send_heartbeat();
    }

    /// Ends a tick: sends what is due and advances the time.
    fn pass(&mut self) {
        for id in self.channels.due(self.now) {
            self.channels.set_turn(Turn::Stream(id, self.now));
            self.send_by_id(id);
        }
        self.channels.set_turn(Turn::All);
        for number in self.parameters.due() {
            self.send_parameter(number);
        }
        for (system, change) in self.stations.missing(self.now) {
            self.note_station(system, change);
        }
        if self.demands.is_news() {
            self.say(
                Severity::Warning,
                "Too many commands at once: some are lost",
            );
        }
        self.now += 1;
        for demand in self.demands.due() {
            self.meet(demand);
        }
    }

    fn handle(&mut self, frame: &Frame<'_>, peer: SocketAddr) {
        let trusted = self.security.trusts(frame);
        let from = Address {
            peer,
            system: frame.system,
            component: frame.component,
        };
        self.channels.hear(from);
        if let Some(heartbeat) = frame.decode::<HEARTBEAT_DATA>() {
            self.note_twin(frame);
            // A sender without the key must not count as a station.
            if trusted && heartbeat.mavtype == STATION {
                let change = self.stations.hear(frame.system, self.now);
                if let Some(change) = change {
                    self.note_station(frame.system, change);
                }
            }
        } else if let Some(demand) = self.demand(frame, from) {
            if trusted {
                if let Some(demand) = self.demands.admit(demand) {
                    self.meet(demand);
                }
            } else {
                self.security.refused = self.security.refused.saturating_add(1);
            }
        } else {
            self.handle_inquiry(frame, from);
        }
    }

    /// Whether a message is meant for this vehicle.
    pub(super) fn is_target(&self, system: u8, component: u8) -> bool {
        (system == 0 || system == self.system) && (component == 0 || component == COMPONENT)
    }

    /// Gives an order. `waiting` gets its result.
    pub(super) fn order(&mut self, order: Order, waiting: Waiting) {
        self.orders.push(order);
        self.waiting.push_back(waiting);
    }

    /// Time since the start \[ms\].
    pub(super) fn milliseconds(&self) -> u32 {
        self.now.saturating_mul(TICK_MS)
    }

    /// Time since the start \[us\].
    #[must_use]
    pub fn microseconds(&self) -> u64 {
        u64::from(self.now) * u64::from(TICK_US)
    }

    /// Estimated velocity over ground, downrange and up [m/s]. A vehicle that waits hangs in the air.
    pub(super) fn over_ground(&self) -> (f64, f64) {
        if self.flying {
            self.conditions.wind.ground_velocity(&self.estimate)
        } else {
            (0.0, 0.0)
        }
    }

    pub(super) fn motion(&self) -> (&AirState, f64, usize) {
        (&self.estimate, self.control.thrust, self.rejections)
    }

    pub(super) fn damaged_frames(&self) -> u32 {
        self.framer.counters().damaged
    }
}
