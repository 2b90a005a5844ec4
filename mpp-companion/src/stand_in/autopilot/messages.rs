//! What the stand-in says by itself.

use super::{ORIGIN, StandIn};
use crate::autopilot::Kind;
use crate::stand_in::rules;
use crate::wire::Mav;
use mavlink::dialects::common::{
    ATTITUDE_DATA, CURRENT_MODE_DATA, GLOBAL_POSITION_INT_DATA, HEARTBEAT_DATA,
    LOCAL_POSITION_NED_DATA, MavModeFlag, MavType, VFR_HUD_DATA,
};
use mpp_sim::plant::Plant;

impl StandIn {
    /// What tells the mode: the heartbeat each second, and at once when the mode changes. PX4's heartbeat does not come at
    /// once; `CURRENT_MODE` does.
    pub(crate) fn says(&mut self) -> Option<Vec<u8>> {
        let changed = self.said != self.mode;
        self.said = self.mode;
        let second = self.tick.is_multiple_of(100);
        match self.kind {
            Kind::Px4 if self.tells && (changed || self.tick % 100 == 50) => {
                let told = CURRENT_MODE_DATA {
                    custom_mode: self.mode,
                    ..CURRENT_MODE_DATA::DEFAULT
                };
                Some(self.sender.frame(&Mav::CURRENT_MODE(told)))
            }
            Kind::ArduPlane if changed => Some(self.heartbeat()),
            _ => second.then(|| self.heartbeat()),
        }
    }

    fn heartbeat(&mut self) -> Vec<u8> {
        let flags = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
            | MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED;
        self.sender.frame(&Mav::HEARTBEAT(HEARTBEAT_DATA {
            custom_mode: self.mode,
            mavtype: MavType::MAV_TYPE_FIXED_WING,
            autopilot: rules::of(self.kind).autopilot,
            base_mode: flags,
            ..HEARTBEAT_DATA::DEFAULT
        }))
    }

    /// The messages of the streams: airspeed, position, attitude, height above home.
    pub(crate) fn stream(&mut self, noise: [f64; 4]) -> [Vec<u8>; 4] {
        let (state, wind) = (self.state(), self.plant.wind());
        let [bank, course, aside] = self.lateral;
        let (sin, cos) = libm::sincos(self.course);
        let forward = state.air.airspeed * libm::cos(state.air.flight_path) + self.wind + wind.0;
        let time_boot_ms = self.boot_ms();
        let [speed, pitch, dx, dz] = noise;
        let x = state.x + dx;
        let equivalent = (state.air.airspeed + speed) * (self.density / 1.225).sqrt();
        let [north, east] = [x * cos - aside * sin, x * sin + aside * cos];
        [
            self.sender.frame(&Mav::VFR_HUD(VFR_HUD_DATA {
                airspeed: equivalent as f32,
                ..VFR_HUD_DATA::DEFAULT
            })),
            self.sender
                .frame(&Mav::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA {
                    time_boot_ms,
                    x: north as f32 + self.jumped[0],
                    y: east as f32 + self.jumped[1],
                    z: -(state.z + dz) as f32 + self.jumped[2],
                    vx: (forward * libm::cos(course)) as f32,
                    vy: (forward * libm::sin(course)) as f32,
                    vz: -(state.air.airspeed * libm::sin(state.air.flight_path) + wind.1) as f32,
                })),
            self.sender.frame(&Mav::ATTITUDE(ATTITUDE_DATA {
                time_boot_ms,
                roll: bank as f32,
                pitch: (state.air.pitch + pitch) as f32,
                yaw: course as f32,
                pitchspeed: state.air.pitch_rate as f32,
                ..ATTITUDE_DATA::DEFAULT
            })),
            self.sender
                .frame(&Mav::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
                    time_boot_ms,
                    relative_alt: (1000.0 * (state.z + dz + ORIGIN)) as i32,
                    ..GLOBAL_POSITION_INT_DATA::DEFAULT
                })),
        ]
    }
}
