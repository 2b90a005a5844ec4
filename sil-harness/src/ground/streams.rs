//! The rates at which messages are sent.

use hil_protocol::mavlink::MessageData;
use hil_protocol::mavlink::messages::*;
use mpp_sim::scenario::{TICK_US, TICKS_PER_SECOND};

/// The rate of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rate {
    /// The message is sent once in this number of ticks.
    Every(u32),
    /// The message is sent when there is something new.
    Event,
    Never,
}

/// The messages with a rate: id and usual rate.
const USUAL: [(u32, Rate); 20] = [
    (HEARTBEAT_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (SYS_STATUS_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (EXTENDED_SYS_STATE_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (SYSTEM_TIME_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (HOME_POSITION_DATA::ID, Rate::Every(2 * TICKS_PER_SECOND)),
    (GPS_RAW_INT_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (WIND_COV_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    // pymavlink 2.4.50 does not know it, and counts every such frame as lost.
    (CURRENT_MODE_DATA::ID, Rate::Never),
    (ATTITUDE_DATA::ID, Rate::Every(TICKS_PER_SECOND / 10)),
    (
        LOCAL_POSITION_NED_DATA::ID,
        Rate::Every(TICKS_PER_SECOND / 10),
    ),
    (
        GLOBAL_POSITION_INT_DATA::ID,
        Rate::Every(TICKS_PER_SECOND / 5),
    ),
    (VFR_HUD_DATA::ID, Rate::Every(TICKS_PER_SECOND / 10)),
    // Once a second tells that they exist. Who works with them asks for more.
    (ALTITUDE_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (HIGHRES_IMU_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (ODOMETRY_DATA::ID, Rate::Every(TICKS_PER_SECOND)),
    (DISTANCE_SENSOR_DATA::ID, Rate::Event),
    (STATUSTEXT_DATA::ID, Rate::Event),
    // Stations that do not know them count every such frame as lost.
    (MPP_LIDAR_SCAN_DATA::ID, Rate::Never),
    (MPP_PLAN_STATUS_DATA::ID, Rate::Never),
    (MPP_TRAJECTORY_DATA::ID, Rate::Never),
];

/// The messages that tell of something new.
const EVENTS: [u32; 5] = [
    DISTANCE_SENSOR_DATA::ID,
    STATUSTEXT_DATA::ID,
    MPP_LIDAR_SCAN_DATA::ID,
    MPP_PLAN_STATUS_DATA::ID,
    MPP_TRAJECTORY_DATA::ID,
];

/// All messages with a rate, in the order in which those of a tick are sent.
pub(super) fn ids() -> impl Iterator<Item = u32> {
    USUAL.iter().map(|(id, _)| *id)
}

/// The rates in force at one channel.
#[derive(Clone)]
pub(super) struct Streams(Vec<(u32, Rate)>);

impl Streams {
    pub(super) fn new() -> Self {
        Self(USUAL.to_vec())
    }

    /// Whether a message is due at a tick.
    pub(super) fn is_due(&self, id: u32, tick: u32) -> bool {
        let due = |rate: &Rate| matches!(rate, Rate::Every(ticks) if tick.is_multiple_of(*ticks));
        self.0.iter().any(|(own, rate)| *own == id && due(rate))
    }

    /// Whether a message is sent when there is something new.
    pub(super) fn wants(&self, id: u32) -> bool {
        self.0.contains(&(id, Rate::Event))
    }

    /// Time between two messages \[us\] as MAVLink counts it: -1 means never, 0 means an unknown
    /// message.
    pub(super) fn interval(&self, id: u32) -> i32 {
        match self.0.iter().find(|(own, _)| *own == id) {
            Some((_, Rate::Every(ticks))) => ticks.saturating_mul(TICK_US).cast_signed(),
            // An interval of 1 us stands for each event.
            Some((_, Rate::Event)) => 1,
            Some((_, Rate::Never)) => -1,
            None => 0,
        }
    }

    /// Sets the time between two messages in microseconds, to the nearest tick. 0 means the usual
    /// rate; a value below 0 means never. Returns `false` if the message is unknown, if the time is
    /// not finite, or if the heartbeat would change.
    pub(super) fn set(&mut self, id: u32, interval: f32) -> bool {
        let usual = USUAL.iter().find(|(own, _)| *own == id);
        let stream = self.0.iter_mut().find(|(own, _)| *own == id);
        let (Some((_, usual)), Some((_, rate))) = (usual, stream) else {
            return false;
        };
        let heartbeat = id == HEARTBEAT_DATA::ID;
        if !interval.is_finite() || (heartbeat && interval != 0.0) {
            return false;
        }
        *rate = if interval == 0.0 {
            *usual
        } else if interval < 0.0 {
            Rate::Never
        } else if EVENTS.contains(&id) {
            Rate::Event
        } else {
            // A longer one would not fit the answer to a question for it.
            let most = i32::MAX.cast_unsigned() / TICK_US;
            Rate::Every(((interval / TICK_US as f32).round() as u32).clamp(1, most))
        };
        true
    }

    /// Sets the rate of a group of messages in Hz. This is the older kind of request.
    pub(super) fn set_group(&mut self, group: u8, hertz: u16, start: bool) {
        let periodic = USUAL.iter().filter_map(|(id, rate)| match rate {
            Rate::Every(_) => Some(*id),
            _ => None,
        });
        let ids: Vec<u32> = match group {
            0 => periodic.collect(),
            2 => vec![SYS_STATUS_DATA::ID, GPS_RAW_INT_DATA::ID],
            6 => vec![LOCAL_POSITION_NED_DATA::ID, GLOBAL_POSITION_INT_DATA::ID],
            10 => vec![ATTITUDE_DATA::ID],
            11 => vec![VFR_HUD_DATA::ID],
            _ => Vec::new(),
        };
        let interval = match (start, hertz) {
            (false, _) | (true, 0) => -1.0,
            (true, hertz) => 1e6 / f32::from(hertz),
        };
        for id in ids {
            self.set(id, interval);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_kept_to_the_tick() {
        let mut streams = Streams::new();
        assert_eq!(streams.interval(ATTITUDE_DATA::ID), 100_000);
        assert!(streams.set(ATTITUDE_DATA::ID, 20_000.0));
        assert_eq!(streams.interval(ATTITUDE_DATA::ID), 20_000);
        let due = |streams: &Streams| {
            let ticks = 0..100;
            ticks
                .filter(|tick| streams.is_due(ATTITUDE_DATA::ID, *tick))
                .count()
        };
        assert_eq!(due(&streams), 50);
        assert!(streams.set(ATTITUDE_DATA::ID, 1.0));
        assert_eq!(streams.interval(ATTITUDE_DATA::ID), 10_000);
        assert!(streams.set(ATTITUDE_DATA::ID, -1.0));
        assert_eq!(due(&streams), 0);
        assert!(streams.set(ATTITUDE_DATA::ID, 0.0));
        assert_eq!(streams.interval(ATTITUDE_DATA::ID), 100_000);
    }

    #[test]
    fn the_heartbeat_cannot_be_silenced_and_nonsense_is_refused() {
        let mut streams = Streams::new();
        assert!(!streams.set(HEARTBEAT_DATA::ID, -1.0));
        assert!(!streams.set(ATTITUDE_DATA::ID, f32::NAN));
        assert!(!streams.set(9999, 1e5));
        streams.set_group(0, 0, false);
        let due: Vec<_> = ids().filter(|id| streams.is_due(*id, 0)).collect();
        assert_eq!(due, [HEARTBEAT_DATA::ID]);
    }

    #[test]
    fn an_event_is_an_event_at_any_interval() {
        let mut streams = Streams::new();
        assert!(streams.set(MPP_LIDAR_SCAN_DATA::ID, -1.0));
        assert!(!streams.wants(MPP_LIDAR_SCAN_DATA::ID));
        assert!(streams.set(MPP_LIDAR_SCAN_DATA::ID, 5e5));
        assert!(streams.wants(MPP_LIDAR_SCAN_DATA::ID));
    }
}
