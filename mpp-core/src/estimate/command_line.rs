//! The dead time of the commands: a line of those that have been sent and do not act yet.

use crate::config::TICK_PERIOD;
use crate::vehicle::{ActuatorLimits, Control};
use mpp_data::Setting;

/// Number of ticks of which the commands are kept; a power of two.
const TICKS: usize = 32;

const _: () = assert!(
    Setting::ElevatorDelay.range()[1] < TICKS as f64 * TICK_PERIOD
        && Setting::ThrustDelay.range()[1] < TICKS as f64 * TICK_PERIOD
);

/// The commands of the last ticks, and the dead times of elevator and thrust.
#[derive(Clone, Copy, Debug)]
pub struct CommandLine {
    /// Each command, and the elevator command of the plan at its tick.
    sent: [(Control, f64); TICKS],
    /// Number of commands so far.
    count: u32,
    elevator: u32,
    thrust: u32,
}

impl CommandLine {
    /// A line with the dead times of these actuators, that was sent the command `trim` ever since.
    // Inlined, so that it is written where the loop will be.
    #[inline(always)]
    #[must_use]
    pub fn new(actuators: &ActuatorLimits, trim: Control) -> Self {
        let ticks = |delay: Option<f64>| {
            let ticks = libm::round(delay.unwrap_or(0.0) / TICK_PERIOD) as u32;
            ticks.min(TICKS as u32 - 1)
        };
        Self {
            sent: [(trim, trim.elevator); TICKS],
            count: 0,
            elevator: ticks(actuators.elevator_delay),
            thrust: ticks(actuators.thrust_delay),
        }
    }

    /// Dead time of the elevator \[ticks\].
    #[must_use]
    pub fn dead_time(&self) -> u32 {
        self.elevator
    }

    /// Takes the command of a tick, and the elevator command of its plan. Gives the command that acts in this tick, and the
    /// elevator command of the plan to which it belongs.
    pub fn send(&mut self, command: Control, planned: f64) -> (Control, f64) {
        if let Some(slot) = self.sent.get_mut(self.count as usize % TICKS) {
            *slot = (command, planned);
        }
        self.count = self.count.wrapping_add(1);
        (self.acting(0), self.sent_before(self.elevator).1)
    }

    /// The command that acts `ticks` after that of the last [`Self::send`]. What is not sent yet is taken to be the last
    /// command.
    #[must_use]
    pub fn acting(&self, ticks: u32) -> Control {
        let elevator = self.sent_before(self.elevator.saturating_sub(ticks));
        let thrust = self.sent_before(self.thrust.saturating_sub(ticks));
        Control {
            thrust: thrust.0.thrust,
            elevator: elevator.0.elevator,
        }
    }

    /// The command that was sent `before` ticks before the last one.
    fn sent_before(&self, before: u32) -> (Control, f64) {
        let slot = self.count.wrapping_sub(before.saturating_add(1)) as usize % TICKS;
        self.sent.get(slot).copied().unwrap_or_default()
    }
}
