//! MAVLink 2 telemetry for ground stations, in messages of the common dialect.
//!
//! Each call gives the bytes of one datagram, to be sent as they are. Encoding only: what a ground
//! station says is not read here.
//!
//! The vehicle flies in the vertical plane and has no place on the map. In MAVLink's
//! north-east-down frame, downrange is north, east is always zero, and down is minus height; the
//! sign is turned here and nowhere else. Heading is north; roll and yaw are zero.
//!
//! The `mavlink` crate slices its frame buffer, which holds the longest frame there is, by lengths
//! that the compiler does not follow: the range checks stay in the image, but never fail.

use mavlink::dialects::common as dialect;
use mavlink::types::CharArray;
use mavlink::{MAVLinkV2MessageRaw, MavHeader, MessageData};

pub use mavlink::dialects::common::MavSeverity;

/// The vehicle's MAVLink system id.
pub const SYSTEM_ID: u8 = 1;

/// MAV_COMP_ID_AUTOPILOT1.
pub const COMPONENT_ID: u8 = 1;

/// The longest text of a [`Telemetry::status_text`] \[bytes\].
pub const STATUS_TEXT_MAX: usize = 50;

/// Ground stations name the mode of a generic fixed wing by ArduPlane's numbers: AUTO.
const MODE_AUTO: u32 = 10;

/// One MAVLink 2 frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Datagram(MAVLinkV2MessageRaw);

impl Datagram {
    /// The bytes to send.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        self.0.raw_bytes()
    }
}

/// The sender's side of a telemetry stream: numbers the frames, so that a receiver can count the
/// lost ones. One for each stream.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Telemetry {
    /// Number of the next frame.
    sequence: u8,
}

impl Telemetry {
    /// A stream that begins with frame 0.
    #[must_use]
    pub const fn new() -> Self {
        Self { sequence: 0 }
    }

    /// HEARTBEAT, to be sent once a second: a fixed wing in mode AUTO.
    ///
    /// `armed`: the motor may turn. `in_the_loop`: the plant is simulated, on whatever hardware
    /// the core runs.
    pub fn heartbeat(&mut self, armed: bool, in_the_loop: bool) -> Datagram {
        let mut base_mode = dialect::MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
            | dialect::MavModeFlag::MAV_MODE_FLAG_AUTO_ENABLED
            | dialect::MavModeFlag::MAV_MODE_FLAG_STABILIZE_ENABLED;
        base_mode.set(dialect::MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED, armed);
        base_mode.set(dialect::MavModeFlag::MAV_MODE_FLAG_HIL_ENABLED, in_the_loop);
        let system_status = if armed {
            dialect::MavState::MAV_STATE_ACTIVE
        } else {
            dialect::MavState::MAV_STATE_STANDBY
        };
        self.datagram(&dialect::HEARTBEAT_DATA {
            custom_mode: MODE_AUTO,
            mavtype: dialect::MavType::MAV_TYPE_FIXED_WING,
            autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_GENERIC,
            base_mode,
            system_status,
            mavlink_version: dialect::MINOR_MAVLINK_VERSION,
        })
    }

    /// ATTITUDE: pitch \[rad\] and pitch rate \[rad/s\], nose-up positive.
    ///
    /// `time_boot_ms`: time since the core started \[ms\].
    pub fn attitude(&mut self, time_boot_ms: u32, pitch: f64, pitch_rate: f64) -> Datagram {
        self.datagram(&dialect::ATTITUDE_DATA {
            time_boot_ms,
            roll: 0.0,
            pitch: pitch as f32,
            yaw: 0.0,
            rollspeed: 0.0,
            pitchspeed: pitch_rate as f32,
            yawspeed: 0.0,
        })
    }

    /// LOCAL_POSITION_NED: position downrange and height \[m\], and their rates \[m/s\], both
    /// heights positive up.
    ///
    /// `time_boot_ms`: time since the core started \[ms\].
    pub fn local_position_ned(
        &mut self,
        time_boot_ms: u32,
        x: f64,
        height: f64,
        vx: f64,
        vz_up: f64,
    ) -> Datagram {
        self.datagram(&dialect::LOCAL_POSITION_NED_DATA {
            time_boot_ms,
            x: x as f32,
            y: 0.0,
            z: -height as f32,
            vx: vx as f32,
            vy: 0.0,
            vz: -vz_up as f32,
        })
    }

    /// VFR_HUD: airspeed and groundspeed \[m/s\], height \[m\], climb rate, up positive \[m/s\],
    /// and throttle \[percent\].
    pub fn vfr_hud(
        &mut self,
        airspeed: f64,
        groundspeed: f64,
        altitude: f64,
        climb: f64,
        throttle_percent: u16,
    ) -> Datagram {
        self.datagram(&dialect::VFR_HUD_DATA {
            airspeed: airspeed as f32,
            groundspeed: groundspeed as f32,
            alt: altitude as f32,
            climb: climb as f32,
            heading: 0,
            throttle: throttle_percent,
        })
    }

    /// STATUSTEXT: a line for the operator.
    ///
    /// Of a text longer than [`STATUS_TEXT_MAX`] bytes, as many whole characters are sent as fit.
    /// Receivers end the text at a NUL, if it has one.
    pub fn status_text(&mut self, severity: MavSeverity, text: &str) -> Datagram {
        let end = text.floor_char_boundary(STATUS_TEXT_MAX);
        let text: CharArray<STATUS_TEXT_MAX> = text.get(..end).unwrap_or_default().into();
        self.datagram(&dialect::STATUSTEXT_DATA { severity, text })
    }

    /// One message as the next frame.
    fn datagram(&mut self, data: &impl MessageData) -> Datagram {
        let header = MavHeader {
            system_id: SYSTEM_ID.into(),
            component_id: COMPONENT_ID,
            sequence: self.sequence,
        };
        self.sequence = self.sequence.wrapping_add(1);
        // The typed message, not the dialect's enum: that one brings every message into flash.
        let mut frame = MAVLinkV2MessageRaw::new();
        frame.serialize_message_data(header, data);
        Datagram(frame)
    }
}
