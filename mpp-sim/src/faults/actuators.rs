//! The actuators. The motor and the elevator's servo turn a command into the control that acts.

use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{ActuatorLimits as Limits, Control};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Limits of the actuators; each may be absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ActuatorLimits {
    /// Greatest thrust \[N\]. With this limit the least thrust is 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thrust_max: Option<f64>,
    /// Time constant of the thrust's first-order lag \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thrust_lag: Option<f64>,
    /// Greatest distance of the elevator from its trim [-].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevator_range: Option<f64>,
    /// Greatest rate of the elevator [1/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevator_rate: Option<f64>,
    /// Dead time of the elevator \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevator_delay: Option<f64>,
    /// Dead time of the thrust \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thrust_delay: Option<f64>,
    /// Further dead time of both, of which the core is not told \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub untold_delay: Option<f64>,
}

impl ActuatorLimits {
    /// The limits in the core's form.
    #[must_use]
    pub fn limits(&self) -> Limits {
        Limits {
            thrust_max: self.thrust_max,
            thrust_lag: self.thrust_lag,
            elevator_below: self.elevator_range,
            elevator_above: self.elevator_range,
            elevator_rate: self.elevator_rate,
            elevator_delay: self.elevator_delay,
            thrust_delay: self.thrust_delay,
        }
    }
}

/// The actuators of one flight.
#[derive(Clone, Debug)]
pub struct Actuators {
    limits: Limits,
    /// Commands of elevator and thrust that do not act yet, the oldest first.
    waiting: [VecDeque<f64>; 2],
    trim: Control,
    /// The control that the actuators gave last.
    given: Control,
}

impl Actuators {
    /// Actuators that rest at a trim, with a dead time beyond that of their limits \[s\].
    #[must_use]
    pub fn new(limits: Limits, more: f64, trim: Control) -> Self {
        let line = |delay: Option<f64>, rest: f64| {
            let ticks = ((delay.unwrap_or(0.0) + more) / TICK_PERIOD).round();
            VecDeque::from(vec![rest; ticks as usize])
        };
        Self {
            limits,
            waiting: [
                line(limits.elevator_delay, trim.elevator),
                line(limits.thrust_delay, trim.thrust),
            ],
            trim,
            given: trim,
        }
    }

    /// The control that the actuators give over the next `dt` \[s\]. The lag is computed exactly
    /// for the end of this time. The aircraft flies with this end value for the whole time.
    pub fn give(&mut self, command: Control, dt: f64) -> Control {
        let limits = &self.limits;
        let [elevator, thrust] = &mut self.waiting;
        let mut given = Control {
            elevator: delayed(elevator, command.elevator),
            thrust: delayed(thrust, command.thrust),
        };
        if let Some(max) = limits.thrust_max {
            given.thrust = given.thrust.clamp(0.0, max);
        }
        if let Some(lag) = limits.thrust_lag {
            let share = 1.0 - libm::exp(-dt / lag);
            given.thrust = self.given.thrust + share * (given.thrust - self.given.thrust);
        }
        let trim = self.trim.elevator;
        if let Some(below) = limits.elevator_below {
            given.elevator = given.elevator.max(trim - below);
        }
        if let Some(above) = limits.elevator_above {
            given.elevator = given.elevator.min(trim + above);
        }
        if let Some(rate) = limits.elevator_rate {
            let (last, most) = (self.given.elevator, rate * dt);
            given.elevator = given.elevator.clamp(last - most, last + most);
        }
        self.given = given;
        given
    }
}

/// The command that acts when this one comes.
fn delayed(waiting: &mut VecDeque<f64>, command: f64) -> f64 {
    waiting.push_back(command);
    waiting.pop_front().unwrap_or(command)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIM: Control = Control {
        thrust: 4.0,
        elevator: 3.8,
    };

    fn control(thrust: f64, elevator: f64) -> Control {
        Control { thrust, elevator }
    }

    #[test]
    fn without_limits_a_command_is_what_is_given() {
        let mut actuators = Actuators::new(Limits::NONE, 0.0, TRIM);
        for command in [control(1e3, -1e3), control(0.1 + 0.2, 1.0 / 3.0)] {
            assert_eq!(actuators.give(command, 0.01), command);
        }
    }

    #[test]
    fn thrust_lags_with_its_time_constant_and_stays_within_its_limit() {
        let limits = ActuatorLimits {
            thrust_max: Some(15.0),
            thrust_lag: Some(0.2),
            ..ActuatorLimits::default()
        };
        let mut actuators = Actuators::new(limits.limits(), 0.0, TRIM);
        let step: Vec<f64> = (0..200)
            .map(|_| actuators.give(control(100.0, 3.8), 0.01).thrust)
            .collect();
        // After one time constant the thrust has covered 63.2 % of the way from trim to the limit.
        let expected = 15.0 - 11.0 * libm::exp(-1.0);
        assert!((step[19] - expected).abs() < 1e-9, "{}", step[19]);
        assert!(
            step.windows(2)
                .all(|pair| pair[0] < pair[1] && pair[1] < 15.0)
        );
        assert!(step[199] > 14.99);
        let fall = (0..1000).map(|_| actuators.give(control(-5.0, 3.8), 0.01).thrust);
        assert!(fall.fold(f64::INFINITY, f64::min) >= 0.0);
    }

    #[test]
    fn the_elevator_keeps_its_range_and_its_rate() {
        let limits = ActuatorLimits {
            elevator_range: Some(2.0),
            elevator_rate: Some(20.0),
            ..ActuatorLimits::default()
        };
        let mut actuators = Actuators::new(limits.limits(), 0.0, TRIM);
        let mut last = TRIM.elevator;
        for tick in 0..100 {
            let wanted = if tick < 50 { 100.0 } else { -100.0 };
            let given = actuators.give(control(4.0, wanted), 0.01).elevator;
            assert!((given - last).abs() <= 0.2 + 1e-12);
            assert!((given - TRIM.elevator).abs() <= 2.0 + 1e-12);
            match tick {
                8 => assert!(given < 5.8 - 0.1),
                10 => assert!((given - 5.8).abs() < 1e-12),
                99 => assert!((given - 1.8).abs() < 1e-12),
                _ => {}
            }
            last = given;
        }
    }

    #[test]
    fn a_command_acts_after_its_dead_time_and_the_lag_follows() {
        let limits = ActuatorLimits {
            elevator_delay: Some(0.03),
            thrust_delay: Some(0.01),
            thrust_lag: Some(0.2),
            ..ActuatorLimits::default()
        };
        let mut actuators = Actuators::new(limits.limits(), 0.02, TRIM);
        let given: Vec<Control> = (0..8)
            .map(|_| actuators.give(control(9.0, 2.0), 0.01))
            .collect();
        let moves = |of: fn(&Control) -> bool| given.iter().position(of);
        assert_eq!(moves(|it| it.elevator < 3.0), Some(5));
        assert_eq!(moves(|it| it.thrust > 4.0), Some(3));
        assert!(given[3].thrust < 4.5);
    }
}
