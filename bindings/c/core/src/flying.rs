//! One core: the step and the planner, and the order of calls that they ask for.

use crate::refusal::MppRefusal;
use crate::status::MppStatus;
use crate::types::{MPP_COUNTERS, MPP_KNOTS, MppConfig, MppOutput, MppPlan, MppSensors, MppState};
use core::mem::MaybeUninit;
use mpp_core::config::{MAX_BEAMS, TICK_PERIOD};
use mpp_core::estimate::Trust;
use mpp_core::flight::{Adoption, FlightLoop, Mode};
use mpp_core::planner::{Planner, SetupError};
use mpp_core::sense::LidarScan;
use mpp_core::settings::Setting;
use mpp_core::vehicle::ScanPoses;
use mpp_node::parameters::Tuning;

/// By how much sums of ticks may differ [s]. A plan has no reference before its start.
const ROUNDING: f64 = 1e-8;

/// A core. Its content is private.
pub struct MppCore {
    planner: Planner,
    /// The last scan that began a cycle.
    scan: LidarScan,
    flight: Option<Flight>,
    /// The number for which the last set-up was refused.
    refused: Option<Setting>,
}

struct Flight {
    control: FlightLoop,
    tuning: Tuning,
    /// Time of the last step \[s\].
    last: Option<f64>,
    /// When the plan of the cycle under way starts \[s\].
    due: Option<f64>,
    /// When the last scan that began a cycle was taken \[s\].
    seen: Option<f64>,
    /// Whether the map of the planner no longer fits the estimates.
    forget: bool,
}

impl Flight {
    /// The time from which a new cycle plans \[s\].
    fn time_to_begin(&self) -> Result<f64, MppStatus> {
        if self.due.is_some() {
            return Err(MppStatus::Busy);
        }
        if self.control.is_lost() {
            return Err(MppStatus::Lost);
        }
        self.last.ok_or(MppStatus::Time)
    }

    /// The scan, if it fits the configuration.
    fn checked(&self, angles: [f64; 2], ranges: &[f32]) -> Result<LidarScan, MppStatus> {
        let mut scan = LidarScan::new();
        // A scan that is too long for the core is too long for every configuration.
        if ranges.len() > MAX_BEAMS || scan.ranges.extend_from_slice(ranges).is_err() {
            return Err(MppStatus::ScanLength);
        }
        [scan.angle_min, scan.angle_increment] = angles;
        let beams = usize::from(self.tuning.configure.beams);
        scan.check(beams).map_err(MppStatus::of_scan)?;
        Ok(scan)
    }

    /// Begins a cycle at a time \[s\]. Without a scan its plans are slow flight in the map that earlier scans have left.
    fn begin(
        &mut self,
        planner: &mut Planner,
        time: f64,
        poses: &ScanPoses,
        scan: Option<&LidarScan>,
    ) {
        if core::mem::take(&mut self.forget) {
            planner.forget();
        }
        let (state, conditions) = (self.control.planned_from(), self.control.conditions());
        planner.begin_from(time, poses, &state, &conditions, scan);
        let latency = f64::from(self.tuning.configure.latency_ticks) * TICK_PERIOD;
        self.due = Some(time + latency);
    }
}

// SAFETY: the compiler checks every constant, and refuses one whose bytes are no value of its type. So a planner
// of zeros is valid; `set_up` gives it its state.
const _: Planner = unsafe { MaybeUninit::zeroed().assume_init() };

impl MppCore {
    /// Writes a core without a configuration. It is made in its place: it is larger than the stack of a flight
    /// computer.
    ///
    /// # Safety
    /// `place` is valid to write a core to.
    pub(crate) unsafe fn write_to(place: *mut Self) {
        // SAFETY: the caller's promise. Nothing uses the planner before its `set_up`.
        unsafe {
            (&raw mut (*place).planner).write_bytes(0, 1);
            (&raw mut (*place).scan).write(LidarScan::new());
            (&raw mut (*place).flight).write(None);
            (&raw mut (*place).refused).write(None);
        }
    }

    pub(crate) fn set_up(&mut self, config: &MppConfig) -> MppStatus {
        let made = Tuning::new(&config.configure())
            .map_err(|verdict| (MppStatus::of_configuration(verdict), None))
            .and_then(|tuning| {
                let control = FlightLoop::new(&tuning.settings).map_err(of_set_up)?;
                self.planner.set_up(&tuning.settings).map_err(of_set_up)?;
                Ok(Flight {
                    control,
                    tuning,
                    last: None,
                    due: None,
                    seen: None,
                    forget: false,
                })
            });
        let fault = made.as_ref().err().copied();
        let (status, refused) = fault.unwrap_or((MppStatus::Ok, None));
        self.refused = refused;
        // The first scan of a flight repeats none.
        self.scan.ranges.clear();
        // The planner may hold a part of a refused configuration: the core does not fly with it.
        self.flight = made.ok();
        status
    }

    pub(crate) fn refused(&self) -> MppRefusal {
        self.refused.map_or(MppRefusal::NOTHING, MppRefusal::from)
    }

    pub(crate) fn step(&mut self, time: f64, sensors: &MppSensors) -> Result<MppOutput, MppStatus> {
        let flight = self.flight.as_mut().ok_or(MppStatus::NotSetUp)?;
        if !time.is_finite() || flight.last.is_some_and(|last| time <= last) {
            return Err(MppStatus::Time);
        }
        flight.last = Some(time);
        let control = &mut flight.control;
        let output = control.step(time, &sensors.frame());
        // A plan under way counts from estimates that are no more.
        let cycle_dropped = output.moved && flight.due.take().is_some();
        flight.forget |= output.moved;
        let (conditions, trust) = (control.conditions(), control.sensors());
        Ok(MppOutput {
            thrust: output.control.thrust,
            elevator: output.control.elevator,
            tracking: output.mode == Mode::Tracking,
            airspeed_trust: code(trust.airspeed),
            pitch_trust: code(trust.pitch),
            position_trust: code(trust.position),
            elevator_trust: code(trust.elevator),
            motor_trust: code(trust.motor),
            cycle_dropped,
            estimate: MppState::from(&control.state()),
            wind_x: conditions.wind.x,
            wind_z: conditions.wind.z,
            lift: conditions.lift,
            reference: MppState::from(&output.reference),
        })
    }

    pub(crate) fn begin(
        &mut self,
        age: u32,
        angles: [f64; 2],
        ranges: &[f32],
    ) -> Result<(), MppStatus> {
        let flight = self.flight.as_mut().ok_or(MppStatus::NotSetUp)?;
        let time = flight.time_to_begin()?;
        let poses = flight.control.poses_at(age).ok_or(MppStatus::ScanAge)?;
        let scan = flight.checked(angles, ranges)?;
        let taken = time - f64::from(age) * TICK_PERIOD;
        let is_newer = (flight.seen).is_none_or(|seen| taken - seen > 0.5 * TICK_PERIOD);
        if !is_newer || self.scan.is_repeated_by(&scan.ranges) {
            return Err(MppStatus::ScanRepeated);
        }
        flight.seen = Some(taken);
        self.scan = scan;
        flight.begin(&mut self.planner, time, &poses, Some(&self.scan));
        Ok(())
    }

    /// Begins a cycle without a scan.
    pub(crate) fn begin_blind(&mut self) -> Result<(), MppStatus> {
        let flight = self.flight.as_mut().ok_or(MppStatus::NotSetUp)?;
        let time = flight.time_to_begin()?;
        let poses = flight.control.poses_at(0).ok_or(MppStatus::ScanAge)?;
        flight.begin(&mut self.planner, time, &poses, None);
        Ok(())
    }

    /// Does a slice of the cycle. Gives whether there is more to do.
    pub(crate) fn advance(&mut self) -> Result<bool, MppStatus> {
        let flight = self.flight.as_ref().ok_or(MppStatus::NotSetUp)?;
        if flight.due.is_none() {
            return Err(MppStatus::Idle);
        }
        Ok(self.planner.is_working() && self.planner.advance())
    }

    pub(crate) fn finish(&mut self, time: f64) -> Result<MppPlan, MppStatus> {
        let flight = self.flight.as_mut().ok_or(MppStatus::NotSetUp)?;
        let start = flight.due.ok_or(MppStatus::Idle)?;
        if !time.is_finite() || flight.last.is_some_and(|last| time < last) {
            return Err(MppStatus::Time);
        }
        if time < start - ROUNDING {
            return Err(MppStatus::Early);
        }
        flight.due = None;
        let (verdict, best) = (self.planner.finish(), self.planner.best());
        let outcome = match flight.control.adopt(time, verdict, best) {
            Adoption::Feasible => 0,
            Adoption::LeastViolating => 1,
            Adoption::Kept => 2,
            Adoption::TrimHold => 3,
            Adoption::Pursuit => 4,
            Adoption::Reserve => 5,
            Adoption::Latest => 6,
        };
        let summary = self.planner.summary();
        flight.control.count_cycle(summary);
        let mut knots = [MppState::default(); MPP_KNOTS];
        let (mut thrust, mut elevator) = ([0.0; MPP_KNOTS], [0.0; MPP_KNOTS]);
        if !(2..=3).contains(&outcome) {
            let places = knots.iter_mut().zip(&mut thrust).zip(&mut elevator);
            for (((knot, thrust), elevator), reference) in places.zip(&best.knots) {
                *knot = MppState::from(reference);
                let command = flight.control.command_for(reference.feedforward);
                (*thrust, *elevator) = (command.thrust, command.elevator);
            }
        }
        Ok(MppPlan {
            outcome,
            complete: summary.complete,
            blind: summary.blind,
            candidates: summary.candidates as u32,
            feasible: summary.feasible as u32,
            trees: summary.tree_runs as u32,
            slices: summary.slices as u32,
            cost: summary.cost,
            violation: summary.violation,
            period: best.stage_period,
            knots,
            thrust,
            elevator,
            start,
        })
    }

    pub(crate) fn counters(&self) -> Result<[u32; MPP_COUNTERS], MppStatus> {
        let flight = self.flight.as_ref().ok_or(MppStatus::NotSetUp)?;
        Ok(flight.control.health().counters())
    }
}

/// The code of a failed set-up, and the number that is out of its range.
fn of_set_up(error: SetupError) -> (MppStatus, Option<Setting>) {
    let number = match error {
        SetupError::OutOfRange(setting) => Some(setting),
        _ => None,
    };
    (MppStatus::of_set_up(error), number)
}

fn code(trust: Trust) -> u8 {
    match trust {
        Trust::Healthy => 0,
        Trust::Suspected => 1,
        Trust::Excluded => 2,
        Trust::Recovering => 3,
    }
}
