//! The controls that the actuators give, and their effect on the aircraft.

use super::{CommandLine, ElevatorEffect, MotorWatch, Progress};
use crate::settings::Settings;
use crate::units::Units;
use crate::vehicle::{ActuatorLimits, AirState, Control, Trim};

/// The actuators by their model, and the watches of their effect.
#[derive(Clone, Debug)]
pub struct Actuators {
    limits: ActuatorLimits,
    /// The controls that the actuators gave up to the last step, by the model of the actuators.
    given: Control,
    /// The watch of the elevator, in the units of the planner, so that its times are those of the aircraft.
    elevator: ElevatorEffect,
    units: Units,
    /// Elevator command of the plan since the last step, and the one that the aircraft has felt since then.
    planned: f64,
    felt: f64,
    /// The commands that have not acted yet.
    line: CommandLine,
    motor: MotorWatch,
}

impl Actuators {
    /// Actuators at level trim, with their known effects.
    // Inlined, so that it is written where the loop will be.
    #[inline(always)]
    #[must_use]
    pub fn new(settings: &Settings, trim: &Trim) -> Self {
        Self {
            limits: settings.actuators,
            given: trim.control,
            elevator: ElevatorEffect::new(
                &settings.units.own_airframe(&settings.airframe),
                &settings.units.own_trim(trim),
            ),
            units: settings.units,
            planned: trim.control.elevator,
            felt: trim.control.elevator,
            line: CommandLine::new(&settings.actuators, trim.control),
            motor: MotorWatch::new(
                settings.airframe.mass,
                trim.control.thrust,
                trim.state.airspeed,
            ),
        }
    }

    /// The limits of the actuators.
    #[must_use]
    pub fn limits(&self) -> &ActuatorLimits {
        &self.limits
    }

    /// The commands that have not acted yet.
    #[must_use]
    pub fn line(&self) -> &CommandLine {
        &self.line
    }

    /// The controls that the actuators gave up to the last step.
    #[must_use]
    pub fn given(&self) -> Control {
        self.given
    }

    /// The controls of the known aircraft that do what these actuators do.
    #[must_use]
    pub fn effective(&self) -> Control {
        self.effect_of(self.given)
    }

    /// The controls of the known aircraft that do what the actuators do when they give these.
    #[must_use]
    pub fn effect_of(&self, given: Control) -> Control {
        let effective = self.elevator.effective(given);
        if self.motor.lost() {
            return Control {
                thrust: 0.0,
                ..effective
            };
        }
        effective
    }

    /// The command that does what a control of the known aircraft does.
    #[must_use]
    pub fn command_for(&self, wanted: Control) -> Control {
        self.elevator.command_for(wanted)
    }

    /// The watch of the elevator.
    #[must_use]
    pub fn elevator(&self) -> &ElevatorEffect {
        &self.elevator
    }

    /// The watch of the motor.
    #[must_use]
    pub fn motor(&self) -> &MotorWatch {
        &self.motor
    }

    /// Notes the elevator command of the plan until the next step.
    pub fn expect_elevator(&mut self, planned: f64) {
        self.planned = planned;
    }

    /// Moves the actuators on by `period` \[s\], towards the command that acts after its dead time when this one is sent.
    pub fn follow(&mut self, command: Control, period: f64) {
        let (acts, felt) = self.line.send(command, self.planned);
        self.felt = felt;
        self.given = self.limits.given(acts, self.given, period);
    }

    /// Compares the measured pitch \[rad\] and altitude \[m\] with the commands; see [`ElevatorEffect::update`].
    pub fn see_turn(
        &mut self,
        (pitch, altitude): (f64, f64),
        air: &AirState,
        lift_offset: f64,
        period: f64,
    ) {
        let own = &self.units;
        let seen = (pitch, altitude / own.length);
        let effective = own.own_control(self.effective());
        let (air, period) = (own.own_air(air), period / own.time);
        (self.elevator).update(seen, &air, lift_offset, effective, self.felt, period);
    }

    /// Compares the gain of speed with the thrust; see [`MotorWatch::update`]. `None` if the estimates have
    /// jumped or cannot be judged.
    pub fn see_speed(&mut self, progress: Option<&Progress>, period: f64) {
        match progress {
            Some(progress) => self.motor.update(progress, self.given.thrust, period),
            None => self.motor.interrupt(),
        }
    }
}
