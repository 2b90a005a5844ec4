//! What a station asks of a healthy vehicle beside its motion: whether it flies, where it is by its navigation, the
//! wind, its modes, and its battery, of which there is none.

use super::commands::mode_number;
use super::inquiries::{HOME, north};
use super::metadata::GENERAL_URI;
use super::vehicle::{Last, Vehicle};
use hil_protocol::SensorState;
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{MessageData, text};
use mpp_sim::orders::Mode;

/// MAV_LANDED_STATE_ON_GROUND and MAV_LANDED_STATE_IN_AIR.
const LANDED: [u8; 2] = [1, 2];
/// GPS_FIX_TYPE_NO_FIX and GPS_FIX_TYPE_3D_FIX.
const FIXES: [u8; 2] = [1, 3];
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
                landed_state: LANDED[usize::from(self.flying)],
            }),
            GPS_RAW_INT_DATA::ID => self.send_fix(),
            GPS_GLOBAL_ORIGIN_DATA::ID => self.send(&GPS_GLOBAL_ORIGIN_DATA {
                latitude: (HOME.0 * 1e7).round() as i32,
                longitude: (HOME.1 * 1e7).round() as i32,
                altitude: 0,
                time_usec: self.microseconds(),
            }),
            BATTERY_STATUS_DATA::ID => self.send(&BATTERY_STATUS_DATA {
                temperature: i16::MAX,
                voltages: [u16::MAX; 10],
                current_battery: -1,
                current_consumed: -1,
                energy_consumed: -1,
                battery_remaining: -1,
                ..BATTERY_STATUS_DATA::DEFAULT
            }),
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

    /// The position by navigation. It has a fix unless the core has excluded the positions.
    fn send_fix(&mut self) {
        let fix = self.sensors.position != SensorState::Excluded;
        let speed = (self.over_ground().0.abs() * 1e2).round() as u16;
        self.send(&GPS_RAW_INT_DATA {
            time_usec: self.microseconds(),
            fix_type: FIXES[usize::from(fix)],
            lat: north(self.state.x),
            lon: (HOME.1 * 1e7).round() as i32,
            alt: (self.state.z * 1e3).round() as i32,
            eph: u16::MAX,
            epv: u16::MAX,
            vel: speed,
            cog: 0,
            satellites_visible: u8::MAX,
            ..GPS_RAW_INT_DATA::DEFAULT
        });
    }

    fn send_wind(&mut self) {
        let wind = self.wind;
        self.send(&WIND_COV_DATA {
            time_usec: self.microseconds(),
            wind_x: wind.x as f32,
            wind_y: 0.0,
            wind_z: -wind.z as f32,
            var_horiz: f32::NAN,
            var_vert: f32::NAN,
            wind_alt: self.state.z as f32,
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
