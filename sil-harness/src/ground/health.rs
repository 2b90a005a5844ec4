//! The health of the vehicle as stations see it: bits of `SYS_STATUS`, and a text for each change.

use super::doubts::Doubts;
use super::severity::Severity;
use super::vehicle::Vehicle;
use hil_protocol::mavlink::messages::SYS_STATUS_DATA;
use hil_protocol::{SensorState, SensorStates};
use mpp_core::tuning::sensors::RECOVERED_AFTER;
use mpp_sim::orders::Mode;

/// MAV_SYS_STATUS_SENSOR: airspeed is differential pressure, pitch is the attitude reference, the position is
/// that of satellite navigation, the lidar is a laser position.
const AIRSPEED: u32 = 0x10;
const POSITION: u32 = 0x20;
const LIDAR: u32 = 0x100;
const MOTORS: u32 = 0x8000;
/// The attitude reference, and what it is made of: gyroscope, accelerometer, magnetometer.
const PITCH: u32 = 0x20_0000 | 7;
const SENSORS: u32 = AIRSPEED | POSITION | LIDAR | MOTORS | PITCH;
/// A fence that does not exist is not broken. Some stations look at this bit alone.
const GEOFENCE: u32 = 0x10_0000;
/// Voltage of the battery \[mV\], which the simulation does not have: as much as PX4's simulation tells of a full one. mavsdk
/// makes 65.5 V or 0 V of the values that stand for none.
const SUPPLY: u16 = 16_200;
/// The vehicle would fly if it were armed.
const PREARM: u32 = 0x1000_0000;

impl Vehicle {
    /// Takes over a mode. In `CRUISE` no scan is due, so that the core takes the lidar for silent. After that the core needs
    /// scans for a while before it trusts the lidar again.
    pub(super) fn enter(&mut self, mode: Mode) {
        let last = core::mem::replace(&mut self.mode, mode);
        match (last, mode) {
            (Mode::Auto, Mode::Cruise) => {
                self.lidar_from = u32::MAX;
                let line = "CRUISE: it does not look for obstacles";
                self.say(Severity::Warning, line);
            }
            (Mode::Cruise, Mode::Auto) => {
                let configure = self.tuning.map(|tuning| tuning.configure);
                let cycle = configure.map_or(0, |configure| {
                    configure.replan_period_ticks + configure.latency_ticks
                });
                let trusted = u32::from(RECOVERED_AFTER) + 3 * cycle;
                self.lidar_from = self.now.saturating_add(trusted);
            }
            _ => {}
        }
    }

    /// Tells the stations of each sensor and actuator that the core trusts otherwise than before.
    pub(super) fn report_sensors(&mut self, now: &SensorStates) {
        let mut now = *now;
        if self.now < self.lidar_from {
            now.lidar = SensorState::Healthy;
        }
        let now = &now;
        let last = core::mem::replace(&mut self.sensors, *now);
        for sensor in self.doubts.take(now) {
            self.say(Severity::Warning, &format!("Sensor {sensor} is doubtful"));
        }
        self.report_actuators(&last, now);
        for ((sensor, before), (_, now)) in last.sensors().into_iter().zip(now.sensors()) {
            let (severity, what) = match now {
                SensorState::Excluded if before != now => (Severity::Critical, "failed"),
                SensorState::Healthy if before == SensorState::Recovering => {
                    (Severity::Notice, "is back")
                }
                _ => continue,
            };
            self.say(severity, &format!("Sensor {sensor} {what}"));
        }
    }

    fn report_actuators(&mut self, last: &SensorStates, now: &SensorStates) {
        if last.elevator != now.elevator {
            let (severity, text) = match now.elevator {
                SensorState::Excluded => (Severity::Critical, "Elevator does not answer"),
                SensorState::Suspected => (Severity::Warning, "Elevator is weak, commands grow"),
                SensorState::Healthy | SensorState::Recovering => {
                    (Severity::Notice, "Elevator works again")
                }
            };
            self.say(severity, text);
        }
        // The core does not know that a station has taken the thrust away.
        if last.motor != now.motor && self.armed {
            let (severity, text) = match now.motor {
                SensorState::Excluded => (Severity::Critical, "Motor gives no thrust"),
                _ => (Severity::Notice, "Motor works again"),
            };
            self.say(severity, text);
        }
    }

    pub(super) fn send_system_status(&mut self) {
        let (_, _, rejections) = self.motion();
        let count = |count: usize| u16::try_from(count).unwrap_or(u16::MAX);
        let idle = if self.mode == Mode::Cruise { LIDAR } else { 0 };
        self.send(&SYS_STATUS_DATA {
            onboard_control_sensors_present: SENSORS | PREARM,
            onboard_control_sensors_enabled: (SENSORS | PREARM) & !idle,
            onboard_control_sensors_health: healthy(&self.sensors, &self.doubts, self.armed),
            voltage_battery: SUPPLY,
            current_battery: -1,
            battery_remaining: 100,
            errors_comm: count(self.damaged_frames() as usize),
            errors_count1: count(rejections),
            errors_count2: count(self.security.refused as usize),
            ..SYS_STATUS_DATA::DEFAULT
        });
    }
}

/// The bits of the sensors that the core uses and does not doubt, and of what depends on them.
fn healthy(sensors: &SensorStates, doubts: &Doubts, armed: bool) -> u32 {
    let uses = |state| matches!(state, SensorState::Healthy | SensorState::Suspected);
    let bits = [AIRSPEED, PITCH, POSITION, LIDAR];
    let states = sensors.sensors().into_iter().zip(doubts.doubtful());
    let states = states.zip(bits);
    let used = states.filter(|(((_, state), doubtful), _)| uses(*state) && !doubtful);
    let driven = uses(sensors.elevator) && (uses(sensors.motor) || !armed);
    let sound = used.fold(if driven { MOTORS } else { 0 }, |all, (_, bit)| all | bit);
    let ready = if sound == SENSORS { PREARM } else { 0 };
    sound | ready | GEOFENCE
}
