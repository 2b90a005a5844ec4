//! The numbers of the modes. Stations disagree on them: MAVProxy and pymavlink look up ArduPlane's table for every fixed
//! wing, mavsdk PX4's for every vehicle that is no ArduPilot.

use super::vehicle::Vehicle;
use hil_protocol::mavlink::MessageData;
use mpp_sim::orders::Mode;

/// A mode's number in ArduPlane's table.
pub(super) fn arduplane(mode: Mode) -> u32 {
    match mode {
        Mode::Auto => 10,
        Mode::Cruise => 7,
    }
}

/// A mode's number in PX4's table: `AUTO.MISSION` flies by plans, `POSCTL` straight on.
fn px4(mode: Mode) -> u32 {
    match mode {
        Mode::Auto => 0x0404_0000,
        Mode::Cruise => 0x0003_0000,
    }
}

/// The mode with a number of either table.
pub(super) fn mode_of(number: u32) -> Option<Mode> {
    [Mode::Auto, Mode::Cruise]
        .into_iter()
        .find(|mode| arduplane(*mode) == number || px4(*mode) == number)
}

impl Vehicle {
    /// Sends a message with numbers of modes. Who asked for the version, as mavsdk does, gets those of PX4.
    pub(super) fn send_modes<M: MessageData>(&mut self, message: impl Fn(fn(Mode) -> u32) -> M) {
        self.send_where(&message(arduplane), true, |channel| !channel.typed);
        self.send_where(&message(px4), false, |channel| channel.typed);
    }
}
