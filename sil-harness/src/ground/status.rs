//! What a station asks of a healthy vehicle beside its motion: whether it flies, where it is by its navigation, the
//! wind, and its modes.

use super::commands::mode_number;
use super::last::Last;
use super::metadata::GENERAL_URI;
use super::vehicle::Vehicle;
use hil_protocol::SensorState;
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{MessageData, text};
use mpp_sim::orders::Mode;

/// MAV_LANDED_STATE_IN_AIR. A vehicle that waits hangs in the air at its start.
const IN_AIR: u8 = 2;
/// GPS_FIX_TYPE: no satellites, no position, position, position with fixed carrier phases.
const NO_GPS: u8 = 0;
const NO_FIX: u8 = 1;
const FIX_3D: u8 = 3;
const RTK_FIXED: u8 = 6;
/// Greatest declared error of a position with fixed carrier phases \[m\].
const RTK_ERROR: f64 = 0.05;
/// Error that the core takes for the least one \[m\].
const LEAST_ERROR: f64 = 1e-3;
/// Satellites in view, of which the simulation has none: as many as PX4's simulation tells.
const SATELLITES: u8 = 10;
/// MAV_STANDARD_MODE_CRUISE. Flying by one's own plan is no standard mode.
const STANDARD_CRUISE: u8 = 3;
/// MAV_MODE_PROPERTY_AUTO_MODE.
const AUTO_MODE: u32 = 4;
/// The modes in the order in which they are listed, with their names.
const MODES: [(Mode, &str); 2] = [(Mode::Auto, "AUTO"), (Mode::Cruise, "CRUISE")];

impl Vehicle {
    /// Sends the last message of an event again. Returns `false` if there was none.
    pub(super) fn repeat(&mut self, id: u32) -> bool {
        let Last {
            scan,
            plan,
            trajectory,
        } = self.last.clone();
        match id {
            MPP_LIDAR_SCAN_DATA::ID => scan.map(|message| self.send(&message)),
            MPP_PLAN_STATUS_DATA::ID => plan.map(|message| self.send(&message)),
            MPP_TRAJECTORY_DATA::ID => trajectory.map(|message| self.send(&message)),
            _ => None,
        }
        .is_some()
    }

    /// Sends a message about the state. Returns `false` if it is none of these.
    pub(super) fn send_status(&mut self, id: u32) -> bool {
        match id {
            EXTENDED_SYS_STATE_DATA::ID => self.send(&EXTENDED_SYS_STATE_DATA {
                vtol_state: 0,
                landed_state: IN_AIR,
            }),
            GPS_RAW_INT_DATA::ID => self.send_fix(),
            WIND_COV_DATA::ID => self.send_wind(),
            CURRENT_MODE_DATA::ID => self.send(&CURRENT_MODE_DATA {
                standard_mode: standard(self.mode),
                custom_mode: mode_number(self.mode),
                intended_custom_mode: mode_number(self.mode),
            }),
            COMPONENT_METADATA_DATA::ID => self.send(&COMPONENT_METADATA_DATA {
                time_boot_ms: self.milliseconds(),
                file_crc: self.files.general_sum(),
                uri: text(GENERAL_URI),
            }),
            _ => return false,
        }
        true
    }

    /// The position by navigation, with the error that its source declares. Odometry, whose error grows with the way, has
    /// no satellites.
    fn send_fix(&mut self) {
        let source = self.navigation;
        let error = source.sigma.max(LEAST_ERROR);
        let (fix_type, satellites_visible) = if source.drift > 0.0 {
            (NO_GPS, 0)
        } else if self.sensors.position == SensorState::Excluded {
            (NO_FIX, SATELLITES)
        } else if error <= RTK_ERROR {
            (RTK_FIXED, SATELLITES)
        } else {
            (FIX_3D, SATELLITES)
        };
        let [lat, lon] = self.home.place(self.state.x);
        // The dilution is that of ranges with an error of 1 m.
        let dilution = (error * 1e2).round().max(1.0) as u16;
        let millimetres = |error: f64| (error * 1e3).round() as u32;
        self.send(&GPS_RAW_INT_DATA {
            time_usec: self.microseconds(),
            fix_type,
            lat,
            lon,
            alt: self.home.millimetres(self.state.z),
            eph: dilution,
            epv: dilution,
            vel: (self.over_ground().0.abs() * 1e2).round() as u16,
            cog: self.centidegrees(),
            satellites_visible,
            h_acc: millimetres(error),
            v_acc: millimetres(error),
            vel_acc: source.velocity_sigma.map_or(0, millimetres),
            ..GPS_RAW_INT_DATA::DEFAULT
        });
    }

    fn send_wind(&mut self) {
        let wind = self.conditions.wind;
        let [wind_x, wind_y] = self.home.north_east(wind.x).map(|part| part as f32);
        self.send(&WIND_COV_DATA {
            time_usec: self.microseconds(),
            wind_x,
            wind_y,
            wind_z: -wind.z as f32,
            var_horiz: f32::NAN,
            var_vert: f32::NAN,
            wind_alt: (self.home.altitude + self.state.z) as f32,
            horiz_accuracy: f32::NAN,
            vert_accuracy: f32::NAN,
        });
    }

    /// Lists one mode by its number in the list from 1 on, or all of them for 0. Returns `false` if there is no such
    /// mode.
    pub(super) fn list_modes(&mut self, number: u32) -> bool {
        let mut listed = false;
        for (index, (mode, name)) in (1..).zip(MODES) {
            if number == 0 || number == u32::from(index) {
                listed = true;
                self.send(&AVAILABLE_MODES_DATA {
                    number_modes: MODES.len() as u8,
                    mode_index: index,
                    standard_mode: standard(mode),
                    custom_mode: mode_number(mode),
                    properties: if mode == Mode::Auto { AUTO_MODE } else { 0 },
                    mode_name: text(name),
                });
            }
        }
        listed
    }
}

fn standard(mode: Mode) -> u8 {
    match mode {
        Mode::Auto => 0,
        Mode::Cruise => STANDARD_CRUISE,
    }
}
