//! The ground: what people may tell a flight, and the vehicle's side of the MAVLink link.
//!
//! ```text
//!  stations <-- UDP --> transport <-- frames --> vehicle <-- orders, moments --> run
//!                          |
//!                          +--> tlog
//! ```
//!
//! * [`Order`]: everything that can change a flight from outside. Orders take effect between two
//!   ticks and stand in the flight's log, so that a flight with people in it can be flown again.
//! * [`vehicle`]: what a ground station sees of a flight, and how its wishes become orders. It
//!   reads no clock and no socket.
//! * [`transport`]: sockets, pace, and the recording.
//!
//! What a station receives, misses or garbles changes nothing but what it asks for.

mod commands;
mod inquiries;
pub mod param_file;
mod parameters;
mod security;
mod stations;
mod streams;
pub mod tlog;
pub mod transport;
pub mod vehicle;

use crate::run::Moment;
use flight_node::parameters::Tuning;
use hil_protocol::ParameterVerdict;
use mpp_core::vehicle::VehicleState;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::fmt;

/// What people may tell a flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "order", rename_all = "kebab-case")]
pub enum Order {
    /// Another value for a parameter of the core.
    Parameter {
        /// Its name.
        name: String,
        /// Its value from now on.
        value: f64,
    },
    /// Another mode.
    Mode {
        /// The mode from now on.
        mode: Mode,
    },
    /// Motor on or off; without it the aircraft glides.
    Motor {
        /// Whether it may turn from now on.
        on: bool,
    },
    /// The end of the flight, here and now.
    Terminate,
}

/// What the vehicle does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Plans and flies its plans.
    #[default]
    Auto,
    /// Plans no more: the last plan is flown to its end, then straight and level.
    Cruise,
}

/// An order that took effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrderEntry {
    /// The first tick that it holds for.
    pub tick: u64,
    /// What was ordered.
    #[serde(flatten)]
    pub order: Order,
}

/// Why an order did not take effect. The flight goes on as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// The core does not know the parameter.
    UnknownParameter,
    /// The core does not take the value.
    Parameter(ParameterVerdict),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownParameter | Self::Parameter(ParameterVerdict::Unknown) => {
                write!(f, "not a parameter of this preset")
            }
            Self::Parameter(ParameterVerdict::Range) => write!(f, "out of range"),
            Self::Parameter(ParameterVerdict::NotWhole) => write!(f, "not a whole step"),
            Self::Parameter(ParameterVerdict::InFlight) => write!(f, "not in flight"),
            Self::Parameter(ParameterVerdict::SetUp(why)) => write!(f, "cannot fly: {why:?}"),
            Self::Parameter(other) => write!(f, "{other:?}"),
        }
    }
}

/// Who follows a flight and may steer it.
pub trait Ground {
    /// The core is configured, the aircraft is at its start.
    fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        let _ = (tuning, start);
    }

    /// Orders that take effect before this tick is flown.
    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let _ = tick;
        Vec::new()
    }

    /// What became of an order, in the order in which they were given, and the values in force.
    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        let _ = (order, result, tuning);
    }

    /// Whether the flight may begin; until then it is asked for orders again.
    fn ready(&mut self) -> bool {
        true
    }

    /// One tick was flown.
    fn watch(&mut self, moment: &Moment<'_>) {
        let _ = moment;
    }
}

/// A flight whose orders may stand in the log of one before: then they are given again, at the
/// same ticks, and nobody else is asked for any.
pub struct Again<G> {
    orders: Option<VecDeque<OrderEntry>>,
    /// Who follows the flight.
    pub ground: G,
}

impl<G: Ground> Again<G> {
    /// The orders of a log, if there is one.
    #[must_use]
    pub fn new(orders: Option<Vec<OrderEntry>>, ground: G) -> Self {
        Self {
            orders: orders.map(VecDeque::from),
            ground,
        }
    }
}

impl<G: Ground> Ground for Again<G> {
    fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        self.ground.begin(tuning, start);
    }

    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let Some(orders) = &mut self.orders else {
            return self.ground.orders(tick);
        };
        let mut due = Vec::new();
        while let Some(entry) = orders.pop_front_if(|entry| entry.tick <= u64::from(tick)) {
            due.push(entry.order);
        }
        due
    }

    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        self.ground.settled(order, result, tuning);
    }

    fn ready(&mut self) -> bool {
        self.orders.is_some() || self.ground.ready()
    }

    fn watch(&mut self, moment: &Moment<'_>) {
        self.ground.watch(moment);
    }
}
