//! The autopilot and the aircraft: dead time, pitch loop, altitude hold and course hold, and GUIDED's rules.

use crate::companion::{AUTOPILOT, GUIDED, MASK, SYSTEM};
use crate::wire::{Framer, Mav, Sender};
use mavlink::dialects::common::{
    ATTITUDE_DATA, COMMAND_INT_DATA, GLOBAL_POSITION_INT_DATA, HEARTBEAT_DATA,
    LOCAL_POSITION_NED_DATA, MavAutopilot, MavCmd, MavModeFlag, MavType, PARAM_VALUE_DATA,
    SET_ATTITUDE_TARGET_DATA, TIMESYNC_DATA, VFR_HUD_DATA,
};
use mpp_core::vehicle::{Control, GRAVITY, VehicleState};
use mpp_sim::aircraft::Aircraft;
use mpp_sim::plant::{Plant, PlantError};
use mpp_sim::scenario::Scenario;
use std::collections::{BTreeMap, VecDeque};

/// Time constant of the roll loop \[s\].
const ROLL: f64 = 0.3;
/// Height of the estimator's origin above home \[m\].
const ORIGIN: f64 = 12.0;
/// LOITER, for a take-over.
pub(crate) const LOITER: u32 = 12;

/// A setpoint that the autopilot obeys.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Obeyed {
    pub(crate) at: u32,
    pub(crate) pitch: f64,
    pub(crate) throttle: f64,
}

/// An autopilot in its aircraft. A tick is 10 ms.
pub struct StandIn {
    plant: Aircraft,
    trim: VehicleState,
    trim_thrust: f64,
    thrust_max: f64,
    density: f64,
    /// Weight \[N\].
    weight: f64,
    /// Ticks since power was switched on.
    pub(crate) tick: u32,
    /// Ticks at which the clock starts.
    pub(crate) booted: u32,
    /// The mode.
    pub(crate) mode: u32,
    /// Bank, course and distance to the right of the first course.
    lateral: [f64; 3],
    /// The first course \[rad\].
    course: f64,
    heading: f64,
    /// Ticks of dead time of the pitch.
    dead: usize,
    demands: VecDeque<f64>,
    pub(crate) obeyed: Option<Obeyed>,
    /// Height that it holds by itself \[m\].
    pub(crate) height: f64,
    /// Wind along the course [m/s], and how far it has carried the aircraft \[m\].
    wind: f64,
    carried: f64,
    parameters: BTreeMap<&'static str, f32>,
    /// What the estimate has jumped: north, east, down \[m\].
    pub(crate) jumped: [f32; 3],
    framer: Framer,
    sender: Sender,
    /// Setpoints that GUIDED refused.
    pub(crate) refused: u32,
}

impl StandIn {
    /// An aircraft in level flight, in LOITER.
    ///
    /// # Errors
    /// When the aircraft has no level flight.
    pub fn new(
        scenario: &Scenario,
        wind: f64,
        dead: usize,
    ) -> Result<Self, mpp_core::vehicle::TrimError> {
        let plant = Aircraft::new(scenario)?;
        let trim = scenario.trim()?;
        let state = *plant.state();
        let parameters = [
            ("GUIDED_TIMEOUT", 0.5),
            ("SCHED_LOOP_RATE", 200.0),
            ("TRIM_THROTTLE", 30.0),
            ("PTCH_LIM_MAX_DEG", 35.0),
            ("PTCH_LIM_MIN_DEG", -35.0),
            ("THR_MAX", 100.0),
        ];
        Ok(Self {
            trim: VehicleState {
                air: trim.state,
                ..state
            },
            trim_thrust: trim.control.thrust,
            thrust_max: scenario.aircraft.file.thrust.max.unwrap_or(f64::MAX),
            density: scenario.aircraft.file.air_density,
            weight: GRAVITY * scenario.aircraft.known.airframe.mass,
            plant,
            tick: 0,
            booted: 0,
            mode: LOITER,
            lateral: [0.0, 0.7, 0.0],
            course: 0.7,
            heading: 0.7,
            dead,
            demands: VecDeque::new(),
            obeyed: None,
            height: state.z,
            wind,
            carried: 0.0,
            parameters: BTreeMap::from(parameters),
            jumped: [0.0; 3],
            framer: Framer::default(),
            sender: Sender::new(SYSTEM, AUTOPILOT),
            refused: 0,
        })
    }

    /// Sets a parameter.
    pub fn set(&mut self, name: &'static str, value: f32) {
        self.parameters.insert(name, value);
    }

    /// The true state over ground.
    #[must_use]
    pub fn state(&self) -> VehicleState {
        let state = *self.plant.state();
        VehicleState {
            x: state.x + self.carried,
            ..state
        }
    }

    /// Milliseconds since the autopilot started.
    fn boot_ms(&self) -> u32 {
        10 * (self.tick - self.booted)
    }

    /// Takes bytes of the companion. `send` gets each answer.
    pub(crate) fn receive(&mut self, bytes: &[u8], send: &mut dyn FnMut(Vec<u8>)) {
        let mut messages = Vec::new();
        self.framer
            .receive(bytes, |_, _, message| messages.push(message));
        for message in messages {
            match message {
                Mav::TIMESYNC(sync) if sync.tc1 == 0 => {
                    let tc1 = i64::from(self.boot_ms()) * 1_000_000 + 1;
                    let answer = TIMESYNC_DATA { tc1, ..sync };
                    send(self.sender.frame(&Mav::TIMESYNC(answer)));
                }
                Mav::PARAM_REQUEST_READ(request) => {
                    let name = request.param_id.to_str().unwrap_or_default();
                    if let Some(value) = self.parameters.get(name) {
                        let answer = PARAM_VALUE_DATA {
                            param_value: *value,
                            param_id: request.param_id,
                            ..PARAM_VALUE_DATA::DEFAULT
                        };
                        send(self.sender.frame(&Mav::PARAM_VALUE(answer)));
                    }
                }
                Mav::SET_ATTITUDE_TARGET(target) => self.obey(&target),
                Mav::COMMAND_INT(command) if self.mode == GUIDED => self.command(&command),
                _ => {}
            }
        }
    }

    fn obey(&mut self, target: &SET_ATTITUDE_TARGET_DATA) {
        let [w, x, y, z] = target.q.map(f64::from);
        if self.mode != GUIDED || target.type_mask != MASK {
            self.refused += 1;
            return;
        }
        self.obeyed = Some(Obeyed {
            at: self.tick,
            pitch: libm::asin((2.0 * (w * y - z * x)).clamp(-1.0, 1.0)),
            throttle: f64::from(target.thrust),
        });
    }

    fn command(&mut self, command: &COMMAND_INT_DATA) {
        match command.command {
            MavCmd::MAV_CMD_GUIDED_CHANGE_HEADING => {
                self.heading = f64::from(command.param2).to_radians();
            }
            MavCmd::MAV_CMD_GUIDED_CHANGE_ALTITUDE => {
                self.height = f64::from(command.z) - ORIGIN;
            }
            _ => {}
        }
    }

    /// Flies a tick.
    pub(crate) fn step(&mut self) -> Result<(), PlantError> {
        let state = *self.plant.state();
        let timeout = self
            .parameters
            .get("GUIDED_TIMEOUT")
            .copied()
            .unwrap_or(3.0);
        let kept = (100.0 * timeout) as u32;
        let guided = self.mode == GUIDED;
        self.obeyed = self
            .obeyed
            .filter(|last| guided && self.tick - last.at <= kept);
        let (pitch, thrust) = match self.obeyed {
            Some(obeyed) => (obeyed.pitch, obeyed.throttle * self.thrust_max),
            None => self.hold(&state),
        };
        let limit = |name| {
            self.parameters
                .get(name)
                .map_or(0.0, |deg| f64::from(*deg).to_radians())
        };
        let pitch = pitch.clamp(limit("PTCH_LIM_MIN_DEG"), limit("PTCH_LIM_MAX_DEG"));
        self.demands.push_back(pitch);
        let acting = if self.demands.len() > self.dead {
            self.demands.pop_front().unwrap_or(pitch)
        } else {
            self.trim.air.pitch
        };
        // The loop takes the demanded pitch; the plant's elevator is an angle of attack.
        let elevator = acting - state.air.flight_path;
        self.plant.step(Control {
            thrust: thrust.clamp(0.0, self.thrust_max),
            elevator,
        })?;
        self.turn(state.air.airspeed);
        self.carried += 0.01 * self.wind;
        self.tick += 1;
        Ok(())
    }

    /// Pitch and thrust that hold height and airspeed.
    fn hold(&self, state: &VehicleState) -> (f64, f64) {
        let cruise = self.trim.air.airspeed;
        let climb = (0.5 * (self.height - state.z) / cruise).clamp(-0.25, 0.25);
        let pitch = self.trim.air.pitch + climb + 0.5 * (climb - state.air.flight_path);
        let thrust = self.trim_thrust + self.weight * climb + 3.0 * (cruise - state.air.airspeed);
        (pitch, thrust)
    }

    /// Roll loop and course hold.
    fn turn(&mut self, airspeed: f64) {
        let [bank, course, aside] = self.lateral;
        let error = (self.heading - course + 3.0).rem_euclid(2.0 * std::f64::consts::PI) - 3.0;
        let wanted = (1.2 * error).clamp(-0.5, 0.5);
        self.lateral = [
            bank + 0.01 * (wanted - bank) / ROLL,
            course + 0.01 * GRAVITY * libm::tan(bank) / airspeed.max(1.0),
            aside + 0.01 * airspeed * libm::sin(course - self.course),
        ];
    }

    /// A heartbeat.
    pub(crate) fn heartbeat(&mut self) -> Vec<u8> {
        let flags = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
            | MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED;
        self.sender.frame(&Mav::HEARTBEAT(HEARTBEAT_DATA {
            custom_mode: self.mode,
            mavtype: MavType::MAV_TYPE_FIXED_WING,
            autopilot: MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA,
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
