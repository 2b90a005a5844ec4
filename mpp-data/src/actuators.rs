//! The commands to motor and elevator, and their limits.

use crate::Airframe;
use core::fmt;
use serde::de::{SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The command to the actuators.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Control {
    /// Thrust `T` along the body axis \[N\].
    pub thrust: f64,
    /// Elevator command `delta_e` [-].
    pub elevator: f64,
}

/// Limits of the actuators. `None` means no limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ActuatorLimits {
    /// Greatest thrust \[N\]. The least thrust is always 0.
    pub thrust_max: Option<f64>,
    /// Time constant of the thrust's first-order lag \[s\].
    pub thrust_lag: Option<f64>,
    /// Greatest distance of the elevator below its trim, in units of the command.
    pub elevator_below: Option<f64>,
    /// Greatest distance of the elevator above its trim, in units of the command.
    pub elevator_above: Option<f64>,
    /// Greatest rate of the elevator [1/s].
    pub elevator_rate: Option<f64>,
    /// Dead time from a command of the elevator to its effect \[s\].
    pub elevator_delay: Option<f64>,
    /// Dead time from a command of the thrust to its effect \[s\]; the lag follows it.
    pub thrust_delay: Option<f64>,
}

impl ActuatorLimits {
    /// No limits except the least thrust 0, because a propeller does not brake.
    pub const NONE: Self = Self {
        thrust_max: None,
        thrust_lag: None,
        elevator_below: None,
        elevator_above: None,
        elevator_rate: None,
        elevator_delay: None,
        thrust_delay: None,
    };

    /// Whether every limit is a positive, finite number.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let limits = [
            self.thrust_max,
            self.thrust_lag,
            self.elevator_below,
            self.elevator_above,
            self.elevator_rate,
            self.elevator_delay,
            self.thrust_delay,
        ];
        limits
            .iter()
            .flatten()
            .all(|limit| *limit > 0.0 && limit.is_finite())
    }

    /// The nearest command within the limits, `dt` \[s\] after the actuators gave `last`.
    #[must_use]
    pub fn within(&self, command: Control, trim: Control, last: Control, dt: f64) -> Control {
        let mut within = command;
        within.thrust = within
            .thrust
            .min(self.thrust_max.unwrap_or(f64::INFINITY))
            .max(0.0);
        let turn = self.elevator_rate.map(|rate| rate * dt);
        for (middle, above, below) in [
            (trim.elevator, self.elevator_above, self.elevator_below),
            (last.elevator, turn, turn),
        ] {
            if let Some(above) = above {
                within.elevator = within.elevator.min(middle + above);
            }
            if let Some(below) = below {
                within.elevator = within.elevator.max(middle - below);
            }
        }
        within
    }

    /// The controls that the actuators give `dt` \[s\] after `last`, under a command within the limits.
    #[must_use]
    pub fn given(&self, within: Control, last: Control, dt: f64) -> Control {
        let mut given = within;
        if let Some(lag) = self.thrust_lag {
            let share = 1.0 - libm::exp(-dt / lag);
            given.thrust = last.thrust + share * (within.thrust - last.thrust);
        }
        given
    }

    /// Greatest distances of the angle of attack below and above its trim that the elevator balances \[rad\].
    #[must_use]
    pub fn angle_of_attack(&self, airframe: &Airframe) -> [f64; 2] {
        // A command above trim raises the angle of attack if the elevator's effectiveness is positive.
        let [down, up] = if airframe.moment_elevator >= 0.0 {
            [self.elevator_below, self.elevator_above]
        } else {
            [self.elevator_above, self.elevator_below]
        };
        [down, up].map(|most| most.map_or(f64::INFINITY, |most| most * per_unit(airframe)))
    }

    /// Greatest rate of the angle of attack [rad/s] that the elevator follows in balance.
    #[must_use]
    pub fn angle_of_attack_rate(&self, airframe: &Airframe) -> f64 {
        let rate = self.elevator_rate;
        rate.map_or(f64::INFINITY, |rate| rate * per_unit(airframe))
    }
}

/// Number of limits that each peer of the link sends.
const ALWAYS: usize = 5;

/// On the link the dead times are a tail of up to two plain numbers, without which a peer may end: 0 is none.
impl Serialize for ActuatorLimits {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let tail = [self.elevator_delay, self.thrust_delay];
        let told = tail.iter().rposition(Option::is_some);
        let told = told.map_or(0, |last| last + 1);
        let mut fields = serializer.serialize_tuple(ALWAYS + told)?;
        for limit in [
            self.thrust_max,
            self.thrust_lag,
            self.elevator_below,
            self.elevator_above,
            self.elevator_rate,
        ] {
            fields.serialize_element(&limit)?;
        }
        for delay in tail.iter().take(told) {
            fields.serialize_element(&delay.unwrap_or(0.0))?;
        }
        fields.end()
    }
}

impl<'de> Deserialize<'de> for ActuatorLimits {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_tuple(ALWAYS + 2, Fields)
    }
}

/// Reads the limits field by field.
struct Fields;

impl<'de> Visitor<'de> for Fields {
    type Value = ActuatorLimits;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("five limits of actuators and up to two dead times")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut fields: A) -> Result<Self::Value, A::Error> {
        let mut limits = [None; ALWAYS];
        for limit in &mut limits {
            *limit = fields.next_element()?.flatten();
        }
        // What ends within a number leaves bytes behind, which the frame's reader refuses.
        let mut delay = || {
            let told = fields.next_element::<f64>();
            told.ok().flatten().filter(|delay| *delay != 0.0)
        };
        let [
            thrust_max,
            thrust_lag,
            elevator_below,
            elevator_above,
            elevator_rate,
        ] = limits;
        Ok(ActuatorLimits {
            thrust_max,
            thrust_lag,
            elevator_below,
            elevator_above,
            elevator_rate,
            elevator_delay: delay(),
            thrust_delay: delay(),
        })
    }
}

/// Angle of attack that a unit of the elevator's command balances \[rad\].
fn per_unit(airframe: &Airframe) -> f64 {
    libm::fabs(airframe.moment_elevator / airframe.moment_alpha)
}
