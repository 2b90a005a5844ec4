//! Orders from the ground, carried out between two ticks.

use super::FlyError;
use super::session::{rejection_entry, unexpected};
use crate::ground::{Ground, Mode, Order, OrderEntry, Refused};
use crate::link::{Link, LinkError};
use crate::log::RejectionEntry;
use crate::scenario::Scenario;
use flight_node::parameters::{PARAMETERS, Tuning};
use hil_protocol::{ActuatorCommand, Message, ParameterVerdict, SetParameter};

/// What the orders so far have come to.
pub(super) struct Steering {
    /// The values in force in the core.
    pub(super) tuning: Tuning,
    pub(super) terminated: bool,
    /// Orders that took effect.
    pub(super) orders: Vec<OrderEntry>,
    mode: Mode,
    motor: bool,
    next_scan: u32,
}

impl Steering {
    /// Before any order.
    pub(super) fn new(scenario: &Scenario) -> Result<Self, FlyError> {
        let tuning = Tuning::new(&scenario.configure()).map_err(LinkError::Refused)?;
        Ok(Self {
            tuning,
            terminated: false,
            orders: Vec::new(),
            mode: Mode::Auto,
            motor: true,
            next_scan: 0,
        })
    }

    /// Carries out what the ground orders before the flight, until it may begin.
    pub(super) fn wait(
        &mut self,
        link: &mut dyn Link,
        ground: &mut dyn Ground,
        rejections: &mut Vec<RejectionEntry>,
    ) -> Result<(), LinkError> {
        loop {
            self.obey(link, ground, 0, rejections)?;
            if ground.ready() {
                return Ok(());
            }
        }
    }

    /// Carries out what the ground orders before a tick.
    pub(super) fn obey(
        &mut self,
        link: &mut dyn Link,
        ground: &mut dyn Ground,
        tick: u32,
        rejections: &mut Vec<RejectionEntry>,
    ) -> Result<(), LinkError> {
        for order in ground.orders(tick) {
            let before = (self.tuning, self.mode, self.motor, self.terminated);
            let result = self.carry_out(link, &order, tick > 0, rejections)?;
            ground.settled(&order, result, &self.tuning);
            // What comes twice changes nothing the second time.
            if before != (self.tuning, self.mode, self.motor, self.terminated) {
                let tick = u64::from(tick);
                self.orders.push(OrderEntry { tick, order });
            }
        }
        Ok(())
    }

    /// Whether the lidar sweeps at this tick.
    pub(super) fn scans(&mut self, tick: u32) -> bool {
        if tick < self.next_scan {
            return false;
        }
        self.next_scan = tick.saturating_add(self.tuning.configure.replan_period_ticks);
        self.mode == Mode::Auto
    }

    /// What the motor makes of a command.
    pub(super) fn limit(&self, command: &mut ActuatorCommand) {
        if !self.motor {
            command.thrust = 0.0;
        }
    }

    fn carry_out(
        &mut self,
        link: &mut dyn Link,
        order: &Order,
        in_flight: bool,
        rejections: &mut Vec<RejectionEntry>,
    ) -> Result<Result<(), Refused>, LinkError> {
        match order {
            Order::Parameter { name, value } => {
                let Some(parameter) = number(name) else {
                    return Ok(Err(Refused::UnknownParameter));
                };
                let set = SetParameter {
                    parameter,
                    value: *value,
                };
                return self.set(link, set, in_flight, rejections);
            }
            Order::Mode { mode } => self.mode = *mode,
            Order::Motor { on } => self.motor = *on,
            Order::Terminate => self.terminated = true,
        }
        Ok(Ok(()))
    }

    fn set(
        &mut self,
        link: &mut dyn Link,
        set: SetParameter,
        in_flight: bool,
        rejections: &mut Vec<RejectionEntry>,
    ) -> Result<Result<(), Refused>, LinkError> {
        let verdict = exchange(link, set, rejections)?;
        if verdict != ParameterVerdict::Accepted {
            return Ok(Err(Refused::Parameter(verdict)));
        }
        let SetParameter { parameter, value } = set;
        match self.tuning.with(parameter, value, in_flight) {
            Ok(tuning) => {
                self.tuning = tuning;
                Ok(Ok(()))
            }
            // The core took it by a table that differs from ours.
            Err(_) => Err(LinkError::Peer(format!(
                "the core took {value} for parameter {parameter}, which this harness does not \
                 know: update the older side"
            ))),
        }
    }

    /// Tells a core that was configured anew every value that was ordered so far.
    pub(super) fn restore(
        &self,
        link: &mut dyn Link,
        rejections: &mut Vec<RejectionEntry>,
    ) -> Result<(), LinkError> {
        for entry in &self.orders {
            let Order::Parameter { name, value } = &entry.order else {
                continue;
            };
            let Some(parameter) = number(name) else {
                continue;
            };
            let value = *value;
            let verdict = exchange(link, SetParameter { parameter, value }, rejections)?;
            if verdict != ParameterVerdict::Accepted {
                return Err(LinkError::Peer(format!(
                    "the core restarted and now refuses {name} = {value}: {verdict:?}"
                )));
            }
        }
        Ok(())
    }
}

/// The number of a parameter's name.
fn number(name: &str) -> Option<u8> {
    let place = PARAMETERS
        .iter()
        .position(|parameter| parameter.name == name)?;
    u8::try_from(place).ok()
}

/// Asks the core for another value.
fn exchange(
    link: &mut dyn Link,
    set: SetParameter,
    rejections: &mut Vec<RejectionEntry>,
) -> Result<ParameterVerdict, LinkError> {
    const AWAITED: &str = "the reply to a parameter";
    link.send(&Message::SetParameter(set))?;
    loop {
        match link.receive(AWAITED)? {
            Message::ParameterReply(reply) => return Ok(reply.verdict),
            Message::Rejection(rejection) => rejections.push(rejection_entry(&rejection)),
            other => return Err(unexpected(AWAITED, &other)),
        }
    }
}
