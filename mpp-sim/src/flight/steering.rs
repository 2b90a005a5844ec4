//! Orders from the ground. They are carried out between two ticks.

use super::error::FlyError;
use super::session::Session;
use crate::disturbance::Disturbance;
use crate::field::FieldFile;
use crate::link::LinkError;
use crate::orders::{Ground, Mode, Order, OrderEntry, Refused};
use crate::scenario::Scenario;
use crate::world::World;
use hil_protocol::{ActuatorCommand, ParameterVerdict, SetParameter};
use mpp_node::parameters::{self, Tuning};

/// The state that results from the orders so far.
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
    /// The state before any order.
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

    /// Carries out the ground's orders before the flight, until the flight may begin.
    pub(super) fn wait(
        &mut self,
        session: &mut Session<'_>,
        world: &mut World,
        ground: &mut dyn Ground,
    ) -> Result<(), LinkError> {
        loop {
            self.obey(session, world, ground)?;
            if ground.ready() || ground.interrupts(session.told.tick) {
                return Ok(());
            }
        }
    }

    /// Carries out the ground's orders before a tick.
    pub(super) fn obey(
        &mut self,
        session: &mut Session<'_>,
        world: &mut World,
        ground: &mut dyn Ground,
    ) -> Result<(), LinkError> {
        for order in ground.orders(session.told.tick) {
            let before = (self.tuning, self.mode, self.motor, self.terminated);
            let result = self.carry_out(session, world, &order)?;
            ground.settled(&order, result, &self.tuning);
            // An order that comes twice changes nothing the second time.
            let changed = before != (self.tuning, self.mode, self.motor, self.terminated);
            if changed || (result.is_ok() && order.changes_world()) {
                let tick = u64::from(session.told.tick);
                self.orders.push(OrderEntry { tick, order });
            }
        }
        Ok(())
    }

    /// Whether the lidar scans at this tick.
    pub(super) fn scans(&mut self, tick: u32) -> bool {
        if tick < self.next_scan {
            return false;
        }
        self.next_scan = tick.saturating_add(self.tuning.configure.replan_period_ticks);
        self.mode == Mode::Auto
    }

    /// Sets the thrust to 0 if the motor is off.
    pub(super) fn limit(&self, command: &mut ActuatorCommand) {
        if !self.motor {
            command.thrust = 0.0;
        }
    }

    fn carry_out(
        &mut self,
        session: &mut Session<'_>,
        world: &mut World,
        order: &Order,
    ) -> Result<Result<(), Refused>, LinkError> {
        match order {
            Order::Parameter { name, value } => return self.set(session, name, *value),
            Order::Mode { mode } => self.mode = *mode,
            Order::Motor { on } => self.motor = *on,
            Order::Terminate => self.terminated = true,
            Order::Obstacles { field } => return Ok(place(world, field)),
            Order::Trunk { .. } => return Ok(Err(Refused::World)),
            Order::Disturb { disturbance } => return Ok(disturb(world, disturbance)),
        }
        Ok(Ok(()))
    }

    /// Checks a value against the same table as the core. The core then makes the final decision.
    fn set(
        &mut self,
        session: &mut Session<'_>,
        name: &str,
        value: f64,
    ) -> Result<Result<(), Refused>, LinkError> {
        let Some(parameter) = parameters::number(name) else {
            return Ok(Err(Refused::UnknownParameter));
        };
        let tuning = match self.tuning.with(parameter, value, session.told.tick > 0) {
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

/// Puts obstacles into the field, all or none.
fn place(world: &mut World, field: &FieldFile) -> Result<(), Refused> {
    field.check().map_err(|_| Refused::Range)?;
    let taken = world.field.add(field.obstacles());
    taken.then_some(()).ok_or(Refused::World)
}

/// Changes the disturbances, all or none.
fn disturb(world: &mut World, disturbance: &Disturbance) -> Result<(), Refused> {
    if !disturbance.is_sound() {
        return Err(Refused::Range);
    }
    let of_plant = disturbance.gusts.is_some() || disturbance.elevator_stuck.is_some();
    let of_lidar = disturbance.dropouts.is_some();
    // Both are asked with nothing to change first: what one refuses must not change the other.
    let nothing = Disturbance::default();
    let (plant, lidar) = (&mut world.plant, &mut world.lidar);
    if (of_plant && !plant.disturb(&nothing)) || (of_lidar && !lidar.disturb(&nothing)) {
        return Err(Refused::World);
    }
    if of_plant {
        plant.disturb(disturbance);
    }
    if of_lidar {
        lidar.disturb(disturbance);
    }
    Ok(())
}
