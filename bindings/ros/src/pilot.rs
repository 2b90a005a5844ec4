//! The node without its topics: messages in, messages out. It has no clock: odometry drives it, by its stamps.

use crate::flight::{Answer, Flight};
use crate::frames::{Placed, Track};
use crate::messages::{
    DiagnosticArray, Header, JointState, LaserScan, MarkerArray, MultiDofTrajectory, OccupancyGrid,
    Odometry, Path, PointCloud, PoseStamped, TwistStamped,
};
use crate::scans::{ScanError, Sweep};
use crate::settings::{AirspeedFrom, Settings};
use crate::told::Told;
use crate::{outputs, report};
use hil_protocol::{AirData, GroundVelocity, LidarScan, Position, SensorFrame};
use mpp_node::parameters::number;

/// The most ticks that are made up for. A longer hole in the odometry is a new flight.
const MOST_TICKS: u32 = 50;
/// The most ticks between an airspeed and the odometry with which it counts as measured.
const AIRSPEED_TICKS: u32 = 2;
/// A scan that is older than the odometry by more ticks is not used.
const OLDEST_SCAN: u32 = 20;
/// Distance from the track from which on it is told \[m\].
const ASIDE: f64 = 15.0;
/// Angle between nose and track from which on it is told \[rad\].
const ASKEW: f64 = 0.5;
/// Ticks from one diagnostics message to the next.
const REPORT_NANOS: i64 = 1_000_000_000;
/// A stamp that is so much older than the last one is a clock that was set back \[ns\].
const SET_BACK: i64 = 1_000_000_000;

/// A message that goes out.
#[derive(Debug)]
pub(crate) enum Output {
    /// To `setpoint`.
    Setpoint(JointState),
    /// To `plan`.
    Plan(Path),
    /// To `trajectory`.
    Trajectory(MultiDofTrajectory),
    /// To `candidates`.
    Candidates(MarkerArray),
    /// To `map`.
    Map(OccupancyGrid),
    /// To `diagnostics`.
    Diagnostics(DiagnosticArray),
}

/// The node without its topics.
pub(crate) struct Pilot {
    name: String,
    /// The settings, which may change in flight.
    pub(crate) settings: Settings,
    /// What was wrong.
    pub(crate) told: Told,
    track: Option<Track>,
    sweep: Option<Sweep>,
    airspeed: Option<(i64, f64)>,
    flight: Option<Flight>,
    /// Time of the last odometry, and of the last diagnostics \[ns\].
    last: Option<i64>,
    reported: Option<i64>,
}

impl Pilot {
    /// A node that has heard nothing.
    pub(crate) fn new(name: &str, settings: Settings) -> Self {
        Self {
            name: name.to_owned(),
            settings,
            told: Told::default(),
            track: None,
            sweep: None,
            airspeed: None,
            flight: None,
            last: None,
            reported: None,
        }
    }

    /// Takes a scan. The newest one counts.
    pub(crate) fn hear_scan(&mut self, scan: &LaserScan) {
        self.hear_sweep(Sweep::of(scan, &self.settings.scan_frame));
    }

    /// Takes a point cloud in place of a scan.
    pub(crate) fn hear_cloud(&mut self, cloud: &PointCloud) {
        let (frame, range) = (&self.settings.cloud_frame, self.settings.cloud_range);
        self.hear_sweep(Sweep::of_cloud(cloud, frame, range));
    }

    fn hear_sweep(&mut self, sweep: Result<Sweep, ScanError>) {
        match sweep {
            Ok(sweep) => {
                if sweep.not_numbers > 0 {
                    let text = format!("{} ranges are no numbers", sweep.not_numbers);
                    self.told.tell("scan numbers", text);
                }
                self.sweep = Some(sweep);
            }
            Err(error) => self.told.tell(error.kind(), error.to_string()),
        }
    }

    /// Takes an airspeed.
    pub(crate) fn hear_airspeed(&mut self, airspeed: &TwistStamped) {
        let speed = airspeed.twist.linear.x;
        if self.settings.airspeed_from == AirspeedFrom::Odometry {
            let text = "it is not used: set airspeed_from:=topic".to_owned();
            self.told.tell("airspeed unused", text);
        } else if speed.is_finite() {
            self.airspeed = Some((airspeed.header.stamp.nanos(), speed));
        } else {
            self.told
                .tell("airspeed numbers", format!("{speed} is no speed"));
        }
    }

    /// Takes a goal. Another line begins a new flight, another height does not.
    pub(crate) fn hear_goal(&mut self, goal: &PoseStamped) {
        let Some(track) = Track::of(goal) else {
            let text = "a number is not finite, or the orientation is no quaternion".to_owned();
            return self.told.tell("goal numbers", text);
        };
        let same_line = self
            .track
            .as_ref()
            .is_some_and(|old| old.is_line_of(&track));
        if !same_line {
            self.flight = None;
        }
        let altitude = number(crate::settings::ALTITUDE);
        if let (Some(flight), Some(number)) = (&mut self.flight, altitude)
            && let Err(error) = flight.set(number, track.altitude)
        {
            return self.told.tell("goal height", error.to_string());
        }
        self.track = Some(track);
    }

    /// Takes a new value of a parameter of the core in flight.
    pub(crate) fn hear_parameter(&mut self, parameter: u8, value: f64) {
        if let Err(verdict) = self.settings.take(parameter, value) {
            return self.told.tell("parameter", verdict.to_string());
        }
        let set = |flight: &mut Flight| flight.set(parameter, value);
        if let Some(Err(error)) = self.flight.as_mut().map(set) {
            self.told.tell("parameter", error.to_string());
        }
    }

    /// Takes an odometry and does all ticks up to its stamp. Gives what goes out.
    pub(crate) fn hear_odometry(&mut self, odometry: &Odometry) -> Vec<Output> {
        let now = odometry.header.stamp.nanos();
        let mut out = Vec::new();
        match self.last {
            Some(last) if now <= last && last - now < SET_BACK => {
                let late = (last - now) as f64 * 1e-9;
                let text = format!("its stamp is {late:.3} s before the last one, it is too old");
                self.told.tell("odometry stamp", text);
                return out;
            }
            Some(last) if now < last => {
                self.told.tell(
                    "odometry clock",
                    "the clock was set back: the flight begins anew".into(),
                );
                self.flight = None;
                self.reported = None;
            }
            _ => {}
        }
        self.last = Some(now);
        self.fly(now, odometry, &mut out);
        if self.reported.is_none_or(|last| now - last >= REPORT_NANOS) {
            self.reported = Some(now);
            let header = Header::of(now, "");
            let flight = self.flight.as_ref();
            let report = report::diagnostics(header, &self.name, flight, &mut self.told);
            out.push(Output::Diagnostics(report));
        }
        out
    }

    fn fly(&mut self, now: i64, odometry: &Odometry, out: &mut Vec<Output>) {
        let Some(track) = self.track.clone() else {
            return self.told.tell("goal missing", "none has come".to_owned());
        };
        if odometry.header.frame_id != track.frame {
            let (own, other) = (&track.frame, &odometry.header.frame_id);
            let text = format!("its frame is `{own}`: give it in the odometry's, `{other}`");
            return self.told.tell("goal frame", text);
        }
        let Some(placed) = track.place(odometry) else {
            let text = "a number is not finite, or the orientation is no quaternion".to_owned();
            return self.told.tell("odometry numbers", text);
        };
        if placed.aside.abs() > ASIDE || placed.askew > ASKEW {
            let (aside, askew) = (placed.aside, placed.askew);
            let text =
                format!("it is {aside:.1} m and {askew:.2} rad off the track: steer back to it");
            self.told.tell("odometry track", text);
        }
        if !self.is_ready(now, &track) {
            return;
        }
        if let Err(text) = self.do_ticks(now, odometry, &placed, &track, out) {
            self.told.tell("core", text);
            self.flight = None;
        }
    }

    /// Whether there is a flight, perhaps a new one.
    fn is_ready(&mut self, now: i64, track: &Track) -> bool {
        let hole = |flight: &Flight| {
            let tick = flight.tick_of(now);
            tick.is_none_or(|tick| tick.saturating_sub(flight.next) > MOST_TICKS)
        };
        if self.flight.as_ref().is_some_and(hole) {
            let text = "it was silent for more than 0.5 s: the flight begins anew".to_owned();
            self.told.tell("odometry hole", text);
            self.flight = None;
        }
        if self.flight.is_none() {
            let Some(sweep) = &self.sweep else {
                self.told
                    .tell("scan missing", "none has come that can be used".to_owned());
                return false;
            };
            let lidar = (sweep.scan.ranges.len(), sweep.range_max);
            match Flight::begin(&self.settings, track.altitude, now, lidar) {
                Ok(flight) => self.flight = Some(flight),
                Err(error) => self.told.tell("core", error.to_string()),
            }
        }
        self.flight.is_some()
    }

    fn do_ticks(
        &mut self,
        now: i64,
        odometry: &Odometry,
        placed: &Placed,
        track: &Track,
        out: &mut Vec<Output>,
    ) -> Result<(), String> {
        let Some(mut flight) = self.flight.take() else {
            return Ok(());
        };
        let tick = flight.tick_of(now).unwrap_or(flight.next);
        while flight.next < tick {
            let empty = SensorFrame {
                tick: flight.next,
                air: None,
                position: None,
            };
            let answer = flight
                .tick(empty, None)
                .map_err(|error| error.to_string())?;
            self.tell_answer(&flight, answer, track, out);
        }
        // Odometry that is faster than the core has one message for a tick.
        if flight.next == tick {
            let frame = SensorFrame {
                tick,
                air: Some(AirData {
                    tick,
                    airspeed: self.airspeed(&flight, tick, placed),
                    pitch: placed.pitch,
                }),
                position: Some(position(tick, odometry, placed)),
            };
            let scan = self.due_scan(&flight, tick);
            let answer = flight
                .tick(frame, scan)
                .map_err(|error| error.to_string())?;
            self.tell_answer(&flight, answer, track, out);
            if let Some(last) = &flight.last {
                let header = Header::of(now, &odometry.child_frame_id);
                let setpoint = outputs::setpoint(header, &self.settings.configure, last);
                out.push(Output::Setpoint(setpoint));
            }
        }
        self.flight = Some(flight);
        Ok(())
    }

    /// The airspeed of a tick; no number if there is none.
    fn airspeed(&mut self, flight: &Flight, tick: u32, placed: &Placed) -> f64 {
        if self.settings.airspeed_from == AirspeedFrom::Odometry {
            return placed.speed;
        }
        let newest = self.airspeed.take();
        let is_fresh = |at: i64| {
            flight
                .tick_of(at)
                .is_some_and(|at| at.abs_diff(tick) <= AIRSPEED_TICKS)
        };
        let fresh = newest
            .filter(|(at, _)| is_fresh(*at))
            .map(|(_, speed)| speed);
        if fresh.is_none() {
            self.told
                .tell("airspeed missing", "none came with the odometry".to_owned());
        }
        fresh.unwrap_or(f64::NAN)
    }

    /// The scan that the core gets in this tick.
    fn due_scan(&mut self, flight: &Flight, tick: u32) -> Option<LidarScan> {
        let is_due = |scanned| tick - scanned >= self.settings.replan_ticks();
        if !flight.scanned.is_none_or(is_due) {
            return None;
        }
        let sweep = self.sweep.take()?;
        let taken = flight
            .tick_of(sweep.nanos)
            .filter(|taken| taken + OLDEST_SCAN >= tick);
        let (kind, text) = match taken {
            None => (
                "scan stamp",
                "it is more than 0.2 s older than that of the odometry".to_owned(),
            ),
            Some(taken) if taken > tick + OLDEST_SCAN => (
                "scan stamp",
                "it is more than 0.2 s newer than that of the odometry".to_owned(),
            ),
            Some(_) if sweep.scan.ranges.len() != flight.beams => {
                let (now, first) = (sweep.scan.ranges.len(), flight.beams);
                let text = format!("{now} look ahead, and {first} did in the first scan");
                ("scan size", text)
            }
            Some(taken) => {
                return Some(LidarScan {
                    tick: taken.min(tick),
                    ..sweep.scan
                });
            }
        };
        self.told.tell(kind, text);
        None
    }

    fn tell_answer(
        &mut self,
        flight: &Flight,
        answer: Answer,
        track: &Track,
        out: &mut Vec<Output>,
    ) {
        for cause in answer.refused {
            let name = format!("{cause:?}");
            let name = name.split(|c: char| !c.is_alphanumeric()).next();
            let kind = format!("core {}", name.unwrap_or_default());
            self.told.tell(&kind, cause.to_string());
        }
        let Some((report, plan)) = answer.trajectory else {
            return;
        };
        let header = Header::of(flight.time_of(report.used_from_tick), &track.frame);
        let (path, trajectory) = outputs::plan(&header, track, &plan);
        out.push(Output::Plan(path));
        out.push(Output::Trajectory(trajectory));
        out.push(Output::Candidates(outputs::candidates(
            &header, track, flight,
        )));
        out.extend(outputs::map(&header, track, flight).map(Output::Map));
    }
}

/// The position of an odometry. A covariance of 0 is none: it stands for 0.1 m and 0.3 m/s.
fn position(tick: u32, odometry: &Odometry, placed: &Placed) -> Position {
    let sigma = |variance: f64, usual: f32| {
        let is_known = variance > 0.0 && variance.is_finite();
        if is_known {
            variance.sqrt() as f32
        } else {
            usual
        }
    };
    let [along, up] = placed.velocity.map(|speed| speed as f32);
    Position {
        tick,
        x: placed.x,
        z: placed.z,
        sigma: sigma(odometry.pose.covariance[0][0], 0.1),
        velocity: Some(GroundVelocity {
            x: along,
            z: up,
            sigma: sigma(odometry.twist.covariance[0][0], 0.3),
        }),
    }
}

#[cfg(test)]
mod tests;
