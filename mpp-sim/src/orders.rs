//! Orders: everything that can change a flight from outside, and the interface of those who give
//! them.
//!
//! Orders take effect between two ticks. The flight's log holds them, so that a flight with orders
//! can be flown again.

use crate::disturbance::Disturbance;
use crate::field::FieldFile;
use crate::tick_record::TickRecord;
use hil_protocol::ParameterVerdict;
use mpp_core::vehicle::VehicleState;
use mpp_node::parameters::Tuning;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// An order that people may give to a flight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "order", rename_all = "kebab-case")]
pub enum Order {
    /// Sets another value for a parameter of the core.
    Parameter {
        /// Its name.
        name: String,
        /// Its value from now on.
        value: f64,
    },
    /// Sets another mode.
    Mode {
        /// The mode from now on.
        mode: Mode,
    },
    /// Turns the motor on or off; without it the aircraft glides.
    Motor {
        /// Whether the motor may turn from now on.
        on: bool,
    },
    /// Ends the flight at once.
    Terminate,
    /// Puts obstacles into the field. An oracle does not know them.
    Obstacles {
        /// The obstacles, as in a field file.
        field: FieldFile,
    },
    /// Plants a trunk in the world of a flight in space, higher than anything flies.
    Trunk {
        /// Axis, ahead \[m\].
        x: f64,
        /// Axis, to the right \[m\].
        y: f64,
        /// Radius \[m\].
        radius: f64,
    },
    /// Changes the disturbances.
    Disturb {
        /// The disturbances from now on.
        #[serde(flatten)]
        disturbance: Disturbance,
    },
}

impl Order {
    /// Whether the order changes the world, and not the vehicle.
    #[must_use]
    pub fn changes_world(&self) -> bool {
        matches!(
            self,
            Self::Obstacles { .. } | Self::Trunk { .. } | Self::Disturb { .. }
        )
    }
}

/// The vehicle's mode.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// The vehicle makes plans and flies them.
    #[default]
    Auto,
    /// The vehicle looks no more. It flies level and slowly in the map that it has; a method without a map flies its last plan
    /// to the end, then straight and level.
    Cruise,
}

/// An order that took effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrderEntry {
    /// First tick for which the order holds.
    pub tick: u64,
    /// The order itself.
    #[serde(flatten)]
    pub order: Order,
}

/// The reason why an order did not take effect. The flight goes on unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refused {
    /// The core does not know the parameter.
    #[error("no such parameter")]
    UnknownParameter,
    /// The core does not take the value.
    #[error("{}", short(.0))]
    Parameter(ParameterVerdict),
    /// The field or the disturbance has a value out of its range.
    #[error("out of range")]
    Range,
    /// The world of this flight cannot be changed so.
    #[error("this world cannot be changed so")]
    World,
}

/// The texts are short, because they go over the radio in 50 characters.
fn short(verdict: &ParameterVerdict) -> String {
    let text = match verdict {
        ParameterVerdict::Accepted => "accepted",
        ParameterVerdict::Unknown => "no such parameter",
        ParameterVerdict::NotInPreset => "not a parameter of this preset",
        ParameterVerdict::Range => "out of range",
        ParameterVerdict::NotWhole => "not a whole step",
        ParameterVerdict::InFlight => "not in flight",
        ParameterVerdict::PathsInFlight => "not to or from 0 in flight",
        ParameterVerdict::CruiseFixed => "to be set before ACT_ELEV_RANGE",
        ParameterVerdict::NotConfigured => "the core is not configured",
        ParameterVerdict::SetUp(why) => return format!("cannot fly: {why}"),
    };
    text.to_owned()
}

/// The ground follows a flight and may steer it.
pub trait Ground {
    /// Begins a flight: the core is configured and the aircraft is at its start.
    fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        let _ = (tuning, start);
    }

    /// Returns the orders that take effect before this tick is flown.
    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let _ = tick;
        Vec::new()
    }

    /// Takes the result of an order and the values in force. Results come in the order in which the
    /// orders were given.
    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        let _ = (order, result, tuning);
    }

    /// Whether the flight may begin. Until then the flight asks for orders again.
    fn ready(&mut self) -> bool {
        true
    }

    /// Whether the person who started the flight ends it before this tick is flown. This is not an
    /// order; the log holds it as the outcome, after everything that was flown until then.
    fn interrupts(&mut self, tick: u32) -> bool {
        let _ = tick;
        false
    }

    /// Watches one tick that was flown.
    fn watch(&mut self, record: &TickRecord<'_>) {
        let _ = record;
    }
}

/// A ground that can repeat the orders in the log of an earlier flight. It gives them at the same
/// ticks and asks nobody else for orders. Without such a log it passes on the orders of its inner
/// ground.
pub struct Again<G> {
    orders: Option<VecDeque<OrderEntry>>,
    until: Option<u32>,
    /// The ground that follows the flight.
    pub ground: G,
}

impl<G: Ground> Again<G> {
    /// Repeats the orders of a log, if there is one.
    #[must_use]
    pub fn new(orders: Option<Vec<OrderEntry>>, ground: G) -> Self {
        Self {
            orders: orders.map(VecDeque::from),
            until: None,
            ground,
        }
    }

    /// Interrupts the flight before this tick, if it comes so far.
    #[must_use]
    pub fn until(self, tick: Option<u32>) -> Self {
        Self {
            until: tick,
            ..self
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

    fn interrupts(&mut self, tick: u32) -> bool {
        self.until.is_some_and(|until| tick >= until) || self.ground.interrupts(tick)
    }

    fn watch(&mut self, record: &TickRecord<'_>) {
        self.ground.watch(record);
    }
}
