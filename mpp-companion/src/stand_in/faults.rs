//! Faults of the exchange between autopilot and companion.

use super::autopilot::StandIn;

/// A fault. It begins at the 8th second of the companion's flight, or in the middle of what it names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// All messages of the autopilot come so many ticks late.
    Late(usize),
    /// Setpoints come so many ticks late.
    SetpointsLate(usize),
    /// One in so many messages is lost, both ways.
    Lost(u32),
    /// Each message comes twice.
    Doubled,
    /// Two messages in a row change places.
    Reordered,
    /// The autopilot's clock is fast by so many parts in 10,000.
    Drift(i64),
    /// The estimate jumps: north, east, down \[m\].
    Jump([i8; 3]),
    /// The pilot takes over.
    TakeOver,
    /// The pilot takes over and gives back at once.
    TakeOverBriefly,
    /// The autopilot is silent for so many ticks.
    Silent(u32),
    /// The lidar repeats a scan.
    LidarFrozen,
    /// The lidar is silent.
    LidarSilent,
    /// The autopilot restarts.
    Reboot,
    /// Bytes are damaged.
    Damaged,
    /// Numbers of the attitude are not finite.
    NotFinite,
}

impl Fault {
    /// The kinds that are flown.
    pub const ALL: [Self; 20] = [
        Self::Late(3),
        Self::Late(20),
        Self::SetpointsLate(5),
        Self::Lost(10),
        Self::Lost(2),
        Self::Doubled,
        Self::Reordered,
        Self::Drift(2),
        Self::Drift(-50),
        Self::Jump([5, 0, 0]),
        Self::Jump([3, -4, 8]),
        Self::TakeOver,
        Self::TakeOverBriefly,
        Self::Silent(15),
        Self::Silent(300),
        Self::LidarFrozen,
        Self::LidarSilent,
        Self::Reboot,
        Self::Damaged,
        Self::NotFinite,
    ];

    /// Changes the autopilot, `since` ticks after the fault began.
    pub(super) fn act(self, autopilot: &mut StandIn, since: u32) {
        match (self, since) {
            (Self::Jump(by), 0) => autopilot.jumped = by.map(f32::from),
            (Self::TakeOver | Self::TakeOverBriefly, 0) => autopilot.take(),
            (Self::TakeOverBriefly, 50) => autopilot.give(),
            (Self::Reboot, 0) => {
                autopilot.booted = autopilot.tick;
                autopilot.take();
            }
            _ => {}
        }
    }
}
