//! One core: the step and the planner, and the order of calls that they ask for.

use crate::status::MppStatus;
use crate::types::{MPP_COUNTERS, MPP_KNOTS, MppConfig, MppOutput, MppPlan, MppSensors, MppState};
use core::mem::MaybeUninit;
use mpp_core::config::MAX_BEAMS;
use mpp_core::estimate::{PositionVerdict, Trust};
use mpp_core::flight::{Adoption, FlightLoop, Mode};
use mpp_core::planner::Planner;
use mpp_core::sense::LidarScan;
use mpp_node::parameters::Tuning;

/// A core. Its content is private.
pub struct MppCore {
    planner: Planner,
    scan: LidarScan,
    flight: Option<Flight>,
}

struct Flight {
    control: FlightLoop,
    tuning: Tuning,
    /// Time of the last step \[s\].
    last: Option<f64>,
    /// Whether a planning cycle is under way.
    planning: bool,
    /// Jumps of the positions' origin that the planner knows of.
    restarts: u32,
}

impl Flight {
    /// The time from which a new cycle plans \[s\].
    fn time_to_begin(&self) -> Result<f64, MppStatus> {
        if self.planning {
            return Err(MppStatus::Busy);
        }
        self.last.ok_or(MppStatus::Time)
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
        }
    }

    pub(crate) fn set_up(&mut self, config: &MppConfig) -> MppStatus {
        let made = Tuning::new(&config.configure())
            .map_err(MppStatus::of_configuration)
            .and_then(|tuning| {
                let control = FlightLoop::new(&tuning.settings).map_err(of_set_up)?;
                self.planner.set_up(&tuning.settings).map_err(of_set_up)?;
                Ok(Flight {
                    control,
                    tuning,
                    last: None,
                    planning: false,
                    restarts: 0,
                })
            });
        let status = made.as_ref().err().copied().unwrap_or(MppStatus::Ok);
        // The planner may hold a part of a refused configuration: the core does not fly with it.
        self.flight = made.ok();
        status
    }

    pub(crate) fn step(&mut self, time: f64, sensors: &MppSensors) -> Result<MppOutput, MppStatus> {
        let flight = self.flight.as_mut().ok_or(MppStatus::NotSetUp)?;
        if !time.is_finite() || flight.last.is_some_and(|last| time <= last) {
            return Err(MppStatus::Time);
        }
        flight.last = Some(time);
        let control = &mut flight.control;
        let output = control.step(time, &sensors.frame());
        if output.position == Some(PositionVerdict::Restarted) {
            // The plan under way counts from an origin that is no more.
            flight.planning = false;
        }
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
        let flight = self.flight.as_ref().ok_or(MppStatus::NotSetUp)?;
        flight.time_to_begin()?;
        let configure = &flight.tuning.configure;
        self.scan.ranges.clear();
        // A scan that is too long for the core is too long for every configuration.
        if ranges.len() > MAX_BEAMS || self.scan.ranges.extend_from_slice(ranges).is_err() {
            return Err(MppStatus::ScanLength);
        }
        [self.scan.angle_min, self.scan.angle_increment] = angles;
        let (beams, range) = (usize::from(configure.beams), f64::from(configure.range_max));
        self.scan.check(beams, range).map_err(MppStatus::of_scan)?;
        self.begin_from(age, true)
    }

    /// Begins a cycle without a scan: the plans are slow flight in the map that earlier scans have left.
    pub(crate) fn begin_blind(&mut self) -> Result<(), MppStatus> {
        self.begin_from(0, false)
    }

    fn begin_from(&mut self, age: u32, seen: bool) -> Result<(), MppStatus> {
        let flight = self.flight.as_mut().ok_or(MppStatus::NotSetUp)?;
        let time = flight.time_to_begin()?;
        let control = &flight.control;
        let pose = control.pose_at(age).ok_or(MppStatus::ScanAge)?;
        let restarts = control.health().positions_restarted;
        if restarts != flight.restarts {
            self.planner.forget();
            flight.restarts = restarts;
        }
        let (state, conditions) = (control.state(), control.conditions());
        let scan = seen.then_some(&self.scan);
        self.planner
            .begin_from(time, &pose, &state, &conditions, scan);
        flight.planning = true;
        Ok(())
    }

    /// Does a slice of the cycle. Gives whether there is more to do.
    pub(crate) fn advance(&mut self) -> Result<bool, MppStatus> {
        let flight = self.flight.as_ref().ok_or(MppStatus::NotSetUp)?;
        if !flight.planning {
            return Err(MppStatus::Idle);
        }
        Ok(self.planner.is_working() && self.planner.advance())
    }

    pub(crate) fn finish(&mut self, time: f64) -> Result<MppPlan, MppStatus> {
        let flight = self.flight.as_mut().ok_or(MppStatus::NotSetUp)?;
        if !flight.planning {
            return Err(MppStatus::Idle);
        }
        if !time.is_finite() || flight.last.is_some_and(|last| time < last) {
            return Err(MppStatus::Time);
        }
        flight.planning = false;
        let (verdict, best) = (self.planner.finish(), self.planner.best());
        let outcome = match flight.control.adopt(time, verdict, best) {
            Adoption::Feasible => 0,
            Adoption::LeastViolating => 1,
            Adoption::Kept => 2,
            Adoption::TrimHold => 3,
        };
        let summary = self.planner.summary();
        let mut knots = [MppState::default(); MPP_KNOTS];
        let (mut thrust, mut elevator) = ([0.0; MPP_KNOTS], [0.0; MPP_KNOTS]);
        if outcome < 2 {
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
        })
    }

    pub(crate) fn counters(&self) -> Result<[u32; MPP_COUNTERS], MppStatus> {
        let flight = self.flight.as_ref().ok_or(MppStatus::NotSetUp)?;
        Ok(flight.control.health().counters())
    }
}

fn of_set_up(error: mpp_core::planner::SetupError) -> MppStatus {
    use mpp_core::planner::SetupError as E;
    match error {
        E::Trim(_) => MppStatus::Trim,
        E::Regulator(_) | E::Unstable => MppStatus::Regulator,
        E::TooManyPaths | E::NoPaths => MppStatus::Paths,
        E::OutOfRange(_) => MppStatus::OutOfRange,
        E::ThrustTooLow => MppStatus::Thrust,
        E::Model(_) | E::Condense(_) | E::OtherMethod => MppStatus::Planner,
    }
}

fn code(trust: Trust) -> u8 {
    match trust {
        Trust::Healthy => 0,
        Trust::Suspected => 1,
        Trust::Excluded => 2,
        Trust::Recovering => 3,
    }
}
