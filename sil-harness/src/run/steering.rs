//! Orders from the ground, carried out between two ticks.

use super::FlyError;
use super::session::Session;
use crate::ground::{Ground, Mode, Order, OrderEntry, Refused};
use crate::link::LinkError;
use crate::scenario::Scenario;
use flight_node::parameters::{PARAMETERS, Tuning};
use hil_protocol::{ActuatorCommand, ParameterVerdict, SetParameter};

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
        session: &mut Session<'_>,
        ground: &mut dyn Ground,
    ) -> Result<(), LinkError> {
        loop {
            self.obey(session, ground)?;
            if ground.ready() {
                return Ok(());
            }
        }
    }

    /// Carries out what the ground orders before a tick.
    pub(super) fn obey(
        &mut self,
        session: &mut Session<'_>,
        ground: &mut dyn Ground,
    ) -> Result<(), LinkError> {
        for order in ground.orders(session.tick) {
            let before = (self.tuning, self.mode, self.motor, self.terminated);
            let result = self.carry_out(session, &order)?;
            ground.settled(&order, result, &self.tuning);
            // What comes twice changes nothing the second time.
            if before != (self.tuning, self.mode, self.motor, self.terminated) {
                let tick = u64::from(session.tick);
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
        session: &mut Session<'_>,
        order: &Order,
    ) -> Result<Result<(), Refused>, LinkError> {
        match order {
            Order::Parameter { name, value } => return self.set(session, name, *value),
            Order::Mode { mode } => self.mode = *mode,
            Order::Motor { on } => self.motor = *on,
            Order::Terminate => self.terminated = true,
        }
        Ok(Ok(()))
    }

    /// Looks at a value by the same table as the core, which then has the last word.
    fn set(
        &mut self,
        session: &mut Session<'_>,
        name: &str,
        value: f64,
    ) -> Result<Result<(), Refused>, LinkError> {
        let Some(parameter) = number(name) else {
            return Ok(Err(Refused::UnknownParameter));
        };
        let tuning = match self.tuning.with(parameter, value, session.tick > 0) {
            Ok(tuning) => tuning,
            Err(verdict) => return Ok(Err(Refused::Parameter(verdict))),
        };
        let verdict = session.set(SetParameter { parameter, value })?;
        if verdict != ParameterVerdict::Accepted {
            return Ok(Err(Refused::Parameter(verdict)));
        }
        self.tuning = tuning;
        Ok(Ok(()))
    }
}

/// The number of a parameter's name.
fn number(name: &str) -> Option<u8> {
    let place = PARAMETERS
        .iter()
        .position(|parameter| parameter.name == name)?;
    u8::try_from(place).ok()
}
