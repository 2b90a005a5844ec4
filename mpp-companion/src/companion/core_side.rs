//! The core's part of the companion: measurements to its ticks, its command to a setpoint.

use super::{Companion, Flown, LATEST, Told};
use crate::brain::Brain;
use crate::frames::{CourseFrame, over_ground, true_airspeed};
use crate::guard::State;
use crate::lidar::{Pose, Rotation};
use crate::setpoint::Setpoint;
use hil_protocol::{AirData, GroundVelocity, LidarScan, Position, SensorFrame};
use mavlink::dialects::common::{ATTITUDE_DATA, LOCAL_POSITION_NED_DATA};

/// Length of a tick \[ms\].
const TICK_MS: u32 = 10;
/// The most ticks that are made up for. A longer hole in the measurements is a new flight.
const MOST_TICKS: u32 = 50;
/// A core that nobody obeys learns a wrong lift, and then takes its sensors for wrong. While the companion listens it begins
/// anew after so many ticks.
const DISOBEYED: u32 = 100;

impl Companion {
    pub(super) fn hear_position(&mut self, position: &LOCAL_POSITION_NED_DATA) {
        self.heard.position = Some(position.clone());
        if let Some(flown) = &mut self.flown {
            flown.placed = flown.frame.place(position).or(flown.placed);
        }
    }

    pub(super) fn is_level(&self) -> bool {
        let (Some(attitude), Some(position), Some(airspeed)) =
            (&self.heard.attitude, &self.heard.position, self.airspeed())
        else {
            return false;
        };
        let cruise = self.config.model.file.cruise;
        let trim = self.config.model.trim.state.pitch;
        (f64::from(attitude.pitch) - trim).abs() < 0.12
            && attitude.roll.abs() < 0.1
            && position.vz.abs() < 1.5
            && (airspeed - cruise).abs() < 0.1 * cruise
    }

    pub(super) fn airspeed(&self) -> Option<f64> {
        let density = self.config.model.file.air_density;
        Some(true_airspeed(self.heard.airspeed?, density))
    }

    /// The airspeed that the core has not got yet, and for how many ticks it is old. Airspeed and attitude of one period of
    /// the stream count as measured at once.
    fn fresh_airspeed(&mut self, now: u64) -> Option<(u32, f64)> {
        let came = self.heard.fresh.take()?;
        let ticks = now.saturating_sub(came) / (1000 * u64::from(TICK_MS));
        Some((if ticks > 2 { ticks as u32 } else { 0 }, self.airspeed()?))
    }

    /// Begins a flight of the core at this attitude.
    fn begin(&mut self, attitude: &ATTITUDE_DATA) -> Option<Flown> {
        let position = self.heard.position.as_ref()?;
        let frame = match &self.held {
            Some((_, line)) => line.abreast(position)?,
            None => CourseFrame::at(position)?,
        };
        let height = -f64::from(position.z);
        match Brain::new(&self.config.configure(height)) {
            Ok(brain) => Some(Flown {
                brain,
                frame,
                start: attitude.time_boot_ms,
                height,
                placed: None,
                headed: None,
            }),
            Err(error) => {
                self.told.push(Told::Core(error.to_string()));
                None
            }
        }
    }

    /// Lets the core do all ticks up to this attitude.
    pub(super) fn think(&mut self, now: u64, attitude: &ATTITUDE_DATA) {
        if !matches!(
            self.guard.state,
            State::Listening | State::Flying | State::Climb
        ) {
            return;
        }
        let listens = self.guard.state == State::Listening;
        let old = |flown: &Flown| listens && flown.brain.next > DISOBEYED;
        if self.flown.as_ref().is_none_or(old) {
            let plans = self.flown.as_ref().map_or(0, |old| old.brain.plans);
            self.flown = self.begin(attitude);
            if let Some(flown) = &mut self.flown {
                flown.brain.plans = plans;
            }
        }
        let fresh = self.fresh_airspeed(now);
        let since =
            |sound: &ATTITUDE_DATA| attitude.time_boot_ms.saturating_sub(sound.time_boot_ms);
        let since = self.heard.sound.as_ref().map(since);
        let pose = since.and_then(|since| self.pose(1e-3 * f64::from(since)));
        let old = self.clock.age(now, attitude.time_boot_ms).unwrap_or(0.0);
        let at = now.saturating_sub((1e6 * old) as u64);
        let Some(flown) = &mut self.flown else {
            return;
        };
        let Some(since) = attitude.time_boot_ms.checked_sub(flown.start) else {
            return;
        };
        let tick = (since + TICK_MS / 2) / TICK_MS;
        if tick.saturating_sub(flown.brain.next) > MOST_TICKS {
            self.flown = None;
            return;
        }
        let first = flown.brain.next;
        let measured = fresh.map(|(ago, airspeed)| (tick.saturating_sub(ago).max(first), airspeed));
        while flown.brain.next <= tick {
            let next = flown.brain.next;
            let mut frame = SensorFrame {
                tick: next,
                air: None,
                position: None,
            };
            let mut scan: Option<LidarScan> = None;
            let airspeed = measured.filter(|(own, _)| *own == next);
            let pitch = Some(f64::from(attitude.pitch)).filter(|it| next == tick && it.is_finite());
            // A value that is not a number is none.
            frame.air = (airspeed.is_some() || pitch.is_some()).then(|| AirData {
                tick: next,
                airspeed: airspeed.map_or(f64::NAN, |(_, airspeed)| airspeed),
                pitch: pitch.unwrap_or(f64::NAN),
            });
            if next == tick {
                frame.position = position(flown, tick);
                let due = |scanned| next - scanned >= self.config.replan_ticks;
                if flown.brain.scanned.is_none_or(due) {
                    scan = self.lidar.take(now, at, pose.as_ref()).map(|(age, scan)| {
                        let ticks = (age / 1000) as u32 / TICK_MS;
                        let tick = tick.saturating_sub(ticks);
                        LidarScan { tick, ..scan }
                    });
                }
            }
            if let Err(error) = flown.brain.tick(frame, scan) {
                self.told.push(Told::Core(error.to_string()));
                self.flown = None;
                return;
            }
        }
    }

    /// Attitude and speed against the course, so long after the last sound attitude \[s\].
    pub(super) fn pose(&self, later: f64) -> Option<Pose> {
        let (attitude, position) = (self.heard.sound.as_ref()?, self.heard.position.as_ref()?);
        let (heading, speed) = over_ground(position);
        let course = self
            .flown
            .as_ref()
            .map_or(heading, |flown| flown.frame.course);
        let turn = later.max(0.0);
        let turned = |angle: f32, rate: f32| f64::from(angle) + turn * f64::from(rate);
        let pitch = turned(attitude.pitch, attitude.pitchspeed);
        let yaw = turned(attitude.yaw, attitude.yawspeed) - course;
        let angles = [turned(attitude.roll, attitude.rollspeed), pitch, yaw];
        let velocity = [speed * libm::cos(heading - course), -f64::from(position.vz)];
        let holds = later <= LATEST && velocity.iter().all(|it| it.is_finite());
        holds.then(|| Pose {
            attitude: Rotation::new(angles),
            pitch,
            velocity,
        })
    }

    /// The setpoint that the core wants.
    pub(super) fn wanted(&self) -> Option<Setpoint> {
        let thought = self.flown.as_ref()?.brain.last?;
        let [.., path] = thought.step.estimate;
        let [.., pitch_rate, _] = thought.step.reference;
        Some(Setpoint {
            pitch: thought.command.elevator + path + self.config.lead * pitch_rate,
            roll: 0.0,
            throttle: thought.command.thrust / self.thrust_max,
        })
    }
}

/// The position that came since the last tick.
fn position(flown: &mut Flown, tick: u32) -> Option<Position> {
    let placed = flown.placed?;
    let since = placed.time.checked_sub(flown.start)?;
    Some(Position {
        tick: ((since + TICK_MS / 2) / TICK_MS).min(tick),
        x: placed.x,
        z: placed.z,
        sigma: 0.1,
        velocity: Some(GroundVelocity {
            x: placed.speed as f32,
            z: placed.climb as f32,
            sigma: 0.3,
        }),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::companion::Config;
    use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};

    #[test]
    fn the_core_gets_an_airspeed_once_and_with_its_age() {
        let file = AircraftFile::parse("it", crate::stand_in::AIRCRAFT).unwrap();
        let config = Config::new(AircraftModel::new(file).unwrap().plane(), 70.0);
        let mut companion = Companion::new(config).unwrap();
        companion.heard.airspeed = Some(14.0);
        for (wait, age) in [(0, 0), (20_000, 0), (70_000, 7)] {
            companion.heard.fresh = Some(1_000_000);
            let fresh = companion.fresh_airspeed(1_000_000 + wait);
            assert_eq!(fresh, companion.airspeed().map(|airspeed| (age, airspeed)));
            assert_eq!(companion.fresh_airspeed(1_020_000 + wait), None);
        }
    }
}
