//! The motion and the place of the vehicle, as stations see them.
//!
//! The vehicle flies in the vertical plane of its heading: roll is zero, and yaw is the heading.

use super::vehicle::Vehicle;
use hil_protocol::mavlink::MessageData;
use hil_protocol::mavlink::messages::*;
use mpp_core::vehicle::{GRAVITY, air_rate};
use mpp_node::parameters::Tuning;

/// MAV_FRAME_LOCAL_NED and MAV_FRAME_BODY_FRD.
const LOCAL_NED: u8 = 1;
const BODY_FRD: u8 = 12;
/// MAV_ESTIMATOR_TYPE_AUTOPILOT.
const AUTOPILOT: u8 = 8;
/// The accelerations and turn rates among HIGHRES_IMU_UPDATED_FLAGS.
const INERTIAL: u16 = 0x3f;

impl Vehicle {
    /// Sends a message about the motion or the place. Returns `false` if it is none of these.
    pub(super) fn send_motion(&mut self, id: u32) -> bool {
        match id {
            ATTITUDE_DATA::ID => self.send_attitude(),
            LOCAL_POSITION_NED_DATA::ID => self.send_local_position(),
            GLOBAL_POSITION_INT_DATA::ID => self.send_global_position(),
            VFR_HUD_DATA::ID => self.send_display(),
            ALTITUDE_DATA::ID => self.send_altitude(),
            ODOMETRY_DATA::ID => self.send_odometry(),
            HIGHRES_IMU_DATA::ID => self.send_inertial(),
            HOME_POSITION_DATA::ID => self.send_home(),
            GPS_GLOBAL_ORIGIN_DATA::ID => {
                let [latitude, longitude] = self.home.place(0.0);
                self.send(&GPS_GLOBAL_ORIGIN_DATA {
                    latitude,
                    longitude,
                    altitude: self.home.millimetres(0.0),
                    time_usec: self.microseconds(),
                });
            }
            _ => return false,
        }
        true
    }

    fn send_attitude(&mut self) {
        let (air, ..) = self.motion();
        let (pitch, pitchspeed) = (air.pitch as f32, air.pitch_rate as f32);
        self.send(&ATTITUDE_DATA {
            time_boot_ms: self.milliseconds(),
            pitch,
            pitchspeed,
            yaw: self.home.yaw() as f32,
            ..ATTITUDE_DATA::DEFAULT
        });
    }

    fn send_local_position(&mut self) {
        let (forward, climb) = self.over_ground();
        let [x, y] = self.home.north_east(self.state.x).map(|part| part as f32);
        let [vx, vy] = self.home.north_east(forward).map(|part| part as f32);
        self.send(&LOCAL_POSITION_NED_DATA {
            time_boot_ms: self.milliseconds(),
            x,
            y,
            z: -self.state.z as f32,
            vx,
            vy,
            vz: -climb as f32,
        });
    }

    fn send_global_position(&mut self) {
        let (forward, climb) = self.over_ground();
        let [lat, lon] = self.home.place(self.state.x);
        let centimetres = |speed: f64| (speed * 1e2).round() as i16;
        let [vx, vy] = self.home.north_east(forward).map(centimetres);
        self.send(&GLOBAL_POSITION_INT_DATA {
            time_boot_ms: self.milliseconds(),
            lat,
            lon,
            alt: self.home.millimetres(self.state.z),
            relative_alt: (self.state.z * 1e3).round() as i32,
            vx,
            vy,
            vz: centimetres(-climb),
            hdg: self.centidegrees(),
        });
    }

    fn send_display(&mut self) {
        let (forward, climb) = self.over_ground();
        let (air, thrust, _) = self.motion();
        let full = self.tuning.as_ref().map_or(f64::INFINITY, full_thrust);
        let message = VFR_HUD_DATA {
            airspeed: air.airspeed as f32,
            groundspeed: forward as f32,
            heading: self.home.heading.round() as i16 % 360,
            throttle: (thrust / full * 100.0).clamp(0.0, 100.0).round() as u16,
            alt: (self.home.altitude + self.state.z) as f32,
            climb: climb as f32,
        };
        self.send(&message);
    }

    fn send_altitude(&mut self) {
        let height = self.state.z as f32;
        let above_sea = (self.home.altitude + self.state.z) as f32;
        self.send(&ALTITUDE_DATA {
            time_usec: self.microseconds(),
            altitude_monotonic: above_sea,
            altitude_amsl: above_sea,
            altitude_local: height,
            altitude_relative: height,
            // Below -1000 m and below 0 m they count as unknown.
            altitude_terrain: -1e4,
            bottom_clearance: -1.0,
        });
    }

    fn send_odometry(&mut self) {
        let (air, ..) = self.motion();
        let (pitch, pitchspeed) = (air.pitch, air.pitch_rate as f32);
        let (forward, climb) = self.over_ground();
        let [x, y] = self.home.north_east(self.state.x).map(|part| part as f32);
        let (up, ahead) = libm::sincos(pitch);
        // Body axes: forward, right, down.
        let along = forward * ahead + climb * up;
        let across = forward * up - climb * ahead;
        let mut unknown = [0.0; 21];
        unknown[0] = f32::NAN;
        self.send(&ODOMETRY_DATA {
            time_usec: self.microseconds(),
            frame_id: LOCAL_NED,
            child_frame_id: BODY_FRD,
            x,
            y,
            z: -self.state.z as f32,
            q: quaternion(self.home.yaw(), pitch),
            vx: along as f32,
            vz: across as f32,
            pitchspeed,
            pose_covariance: unknown,
            velocity_covariance: unknown,
            estimator_type: AUTOPILOT,
            ..ODOMETRY_DATA::DEFAULT
        });
    }

    /// The accelerations that an accelerometer in the body axes would show, forward and down [m/s^2]: by the core's equations of
    /// motion, from its estimate and its commands, without those of the wind.
    fn acceleration(&self) -> [f64; 2] {
        let air = self.motion().0;
        let (along, turn) = match &self.tuning {
            Some(tuning) if self.flying => {
                let airframe = self.conditions.airframe(&tuning.settings.airframe);
                let rate = air_rate(&airframe, air, self.control);
                (rate.airspeed, air.airspeed * rate.flight_path)
            }
            _ => (0.0, 0.0),
        };
        let (climbing, level) = libm::sincos(air.flight_path);
        let (along, across) = (along + GRAVITY * climbing, turn + GRAVITY * level);
        let (sin, cos) = libm::sincos(air.angle_of_attack());
        [along * cos + across * sin, along * sin - across * cos]
    }

    /// Accelerations and turn rate are the core's. The simulation has no accelerometer, magnetometer, barometer or thermometer.
    fn send_inertial(&mut self) {
        let ygyro = self.motion().0.pitch_rate as f32;
        let [xacc, zacc] = self.acceleration().map(|part| part as f32);
        let none = f32::NAN;
        self.send(&HIGHRES_IMU_DATA {
            time_usec: self.microseconds(),
            xacc,
            zacc,
            ygyro,
            xmag: none,
            ymag: none,
            zmag: none,
            abs_pressure: none,
            diff_pressure: none,
            pressure_alt: none,
            temperature: none,
            fields_updated: INERTIAL,
            ..HIGHRES_IMU_DATA::DEFAULT
        });
    }

    fn send_home(&mut self) {
        let [latitude, longitude] = self.home.place(0.0);
        self.send(&HOME_POSITION_DATA {
            latitude,
            longitude,
            altitude: self.home.millimetres(0.0),
            q: quaternion(self.home.yaw(), 0.0),
            time_usec: self.microseconds(),
            ..HOME_POSITION_DATA::DEFAULT
        });
    }

    /// The heading \[cdeg\].
    pub(super) fn centidegrees(&self) -> u16 {
        (self.home.heading * 1e2).round() as u16 % 36_000
    }
}

/// The thrust that counts as full throttle \[N\]: the greatest one of the aircraft; without a limit that which carries its
/// weight.
fn full_thrust(tuning: &Tuning) -> f64 {
    let settings = &tuning.settings;
    let weight = settings.airframe.mass * GRAVITY;
    settings.actuators.thrust_max.unwrap_or(weight)
}

/// The attitude without roll.
fn quaternion(yaw: f64, pitch: f64) -> [f32; 4] {
    let (sin_yaw, cos_yaw) = libm::sincos(yaw / 2.0);
    let (sin, cos) = libm::sincos(pitch / 2.0);
    [cos_yaw * cos, -sin_yaw * sin, cos_yaw * sin, sin_yaw * cos].map(|part| part as f32)
}
