//! The plane planner flies in the vertical plane: a rolling occupancy grid, few but distinct candidates, and SQP
//! iterations about the motion that the aircraft would really fly. Preset `flight` uses it; `docs/planner.md` explains
//! it in full.
//!
//! ```text
//!                               +--------- next candidate ---------+
//!                               v                                  |
//! begin --> Map --> Lattice --> Faces --> Linearise --> Improve ---+--> Done
//!           map     paths       corridor  program       solved, flown out, judged
//! ```
//!
//! The planner improves every candidate once, and then the best few in further SQP iterations. It judges the
//! nonlinear roll-out of the controls against the map itself, and the vehicle flies this roll-out.
//!
//! | file | content |
//! |---|---|
//! | `setup` | the set-up of the planner and the checks of its settings |
//! | `limits` | the limits of the plans of a cycle |
//! | `perceive` | Map, Lattice: from the scan to the lattice's paths |
//! | `propose` | the candidates: the previous plan as warm start, and the paths of the lattice |
//! | `refine` | Faces, Linearise, Improve |
//! | `candidate` | roll-out and linearisation of a candidate |
//! | `judge` | the price of a roll-out |
//! | `ladder`, `rungs` | what the gate lets through, rung by rung |
//! | `pursuit` | roll-outs without a program |
//! | `inspect` | access to map, candidates and programs of a cycle |
//! | `workspace` | the memory that the phases use one after the other |

mod candidate;
mod inspect;
mod judge;
mod ladder;
mod limits;
mod perceive;
mod propose;
mod pursuit;
mod refine;
mod rungs;
mod setup;
mod workspace;

use super::summary::PlanSummary;
use crate::gate::Gate;
use crate::lattice::{CLIMB, CostToGo, MAX_LATTICE_PATHS};
use crate::map::{DistanceField, RollingGrid, ScanMonitor};
use crate::qp::{Solver, Weights};
use crate::sense::LidarScan;
use crate::settings::PlaneSettings;
use crate::trajectory::Trajectory;
use crate::tuning::scan_match::AGES;
use crate::units::Units;
use crate::vehicle::{
    ActuatorLimits, AirState, Airframe, Conditions, PathControl, PathState, Pose, ScanPoses,
    ThrustLag, Trim, VehicleState, Wind,
};
use candidate::{Candidate, Frame};
pub use judge::PriceParts;
use limits::Limits;
use rungs::Ladder;
use workspace::{Intake, Workspace};

/// Greatest number of candidates in a cycle: the previous plan and the paths of the lattice.
pub const MAX_CANDIDATES: usize = 1 + MAX_LATTICE_PATHS;

/// Steps of integration over the latency of a plan when no earlier one is flown.
const FLOWN_ON_STEPS: u8 = 4;

/// The work of the next slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// The slice does nothing, because no cycle is under way.
    Idle,
    /// Takes some beams of the scan into the grid. The last slice builds the distance field.
    Map,
    /// Searches one station of the lattice.
    Lattice,
    /// Sets the faces between a candidate and the obstacles around it.
    Faces,
    /// Sets up a candidate's program.
    Linearise,
    /// Solves the program, and at the end computes and judges its roll-out.
    Improve,
    /// Offers a trajectory to the gate.
    Gate,
    /// The slice does nothing, because the cycle has ended.
    Done,
}

/// The plane planner and all its workspaces. Large: place it in a `static` or a box.
///
/// It computes in its [own units](Units): scan, state and settings are converted when they come in, and the
/// best trajectory when it is kept. Times of trajectories stay in seconds.
#[derive(Clone, Debug)]
pub struct PlanePlanner {
    // Values of the set-up.
    settings: PlaneSettings,
    paths: usize,
    /// The height that the settings ask for, and the height to which this cycle plans \[m\].
    destination: f64,
    altitude: f64,
    /// Middle of the altitude band of this cycle, and its reach to either side \[m\].
    band: [f64; 2],
    /// Time of the last cycle with a lidar that was believed, or that saw something beneath \[s\].
    seen: f64,
    weights: Weights,
    units: Units,
    /// Airframe and trim of the set-up in own units, and the airframe in SI units.
    known: (Airframe, Trim),
    si_airframe: Airframe,
    actuators: ActuatorLimits,
    lag: ThrustLag,
    /// Whether the planner is set up.
    ready: bool,

    // Values of the present cycle.
    phase: Phase,
    /// The estimated wind and lift in SI units.
    conditions: Conditions,
    /// Where the scan was made, by its stamp and by each age that the stamp may hide.
    poses: ScanPoses,
    /// When the plan is taken over \[s\], and the state and the thrust that the aircraft will have then.
    time: f64,
    state: VehicleState,
    thrust: f64,
    wind: Wind,
    airframe: Airframe,
    /// Level trim of this airframe.
    pub(super) trim: Trim,
    limits: Limits,
    workspace: Workspace,

    // From the scan to paths. The map outlives the cycle.
    map: RollingGrid,
    /// Whether a scan without a return has contradicted the map, and no beam has returned since.
    lidar_distrusted: bool,
    monitor: ScanMonitor,
    field: DistanceField,
    cost_to_go: CostToGo,

    // From paths to trajectories.
    candidates: heapless::Vec<Candidate, MAX_CANDIDATES>,
    /// Number of improvements so far.
    improvements: usize,
    /// Indices of the candidates, ordered by their price after the first improvement.
    order: [usize; MAX_CANDIDATES],
    /// Index of the candidate that the planner improves now.
    at_hand: usize,
    solver: Solver,

    // Results of the cycle. The best trajectory outlives the cycle; then it is the previous one.
    pub(super) best: Trajectory,
    previous: Trajectory,
    gate: Gate,
    ladder: Ladder,
    best_price: f64,
    pub(super) summary: PlanSummary,
}

impl PlanePlanner {
    /// An idle planner that is not set up.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            settings: PlaneSettings::PRESET,
            paths: 0,
            destination: 0.0,
            altitude: 0.0,
            band: [0.0; 2],
            seen: f64::INFINITY,
            weights: Weights::PAPER,
            units: Units::SI,
            known: (Airframe::REFERENCE, Trim::NONE),
            si_airframe: Airframe::REFERENCE,
            actuators: ActuatorLimits::NONE,
            lag: ThrustLag::NONE,
            ready: false,
            phase: Phase::Idle,
            conditions: Conditions::STILL,
            poses: [Pose {
                x: 0.0,
                z: 0.0,
                pitch: 0.0,
            }; AGES],
            time: 0.0,
            thrust: 0.0,
            state: VehicleState {
                x: 0.0,
                z: 0.0,
                air: AirState::NONE,
            },
            wind: Wind::STILL,
            airframe: Airframe::REFERENCE,
            trim: Trim::NONE,
            limits: Limits::NONE,
            workspace: Workspace::NEW,
            map: RollingGrid::new(),
            lidar_distrusted: false,
            monitor: ScanMonitor::new(),
            field: DistanceField::new(),
            cost_to_go: CostToGo::new(),
            candidates: heapless::Vec::new(),
            improvements: 0,
            order: [0; MAX_CANDIDATES],
            at_hand: 0,
            solver: Solver::new(),
            best: Trajectory::new(),
            previous: Trajectory::new(),
            gate: Gate::new(),
            ladder: Ladder::NEW,
            best_price: f64::INFINITY,
            summary: PlanSummary::NOTHING,
        }
    }

    /// Starts a cycle; see [`super::Planner::begin_from`].
    // Not inlined, so that the scan does not lie on the stack beneath the set-up.
    #[inline(never)]
    pub fn begin(
        &mut self,
        time: f64,
        poses: &ScanPoses,
        state: &VehicleState,
        conditions: &Conditions,
        scan: Option<&LidarScan>,
    ) {
        self.take_conditions(conditions);
        for (own, pose) in self.poses.iter_mut().zip(poses) {
            *own = self.units.own_pose(pose);
        }
        self.state = self.taken_over(time, &self.units.own_state(state));
        self.time = time + self.settings.latency * self.units.time;
        let thrust = self.best.thrust(self.time);
        self.thrust = thrust.map_or(self.trim.control.thrust, |it| it / self.units.force());
        let blind = scan.is_none();
        let mut scan = scan.cloned().unwrap_or_else(LidarScan::new);
        for range in &mut scan.ranges {
            *range = (f64::from(*range) / self.units.length) as f32;
        }
        self.workspace = Workspace::Scan(Intake::new(scan));
        // A height beyond the reach of paths is approached in parts. Programs would climb too steeply.
        self.altitude = (self.destination)
            .max(self.state.z - CLIMB)
            .min(self.state.z + CLIMB);
        self.band = [self.altitude, self.settings.band];
        self.solver.problem.target = [0.0, self.altitude - self.state.z, 0.0, 0.0, 0.0, 0.0];
        self.solver.problem.penalty = Some(self.settings.penalty);
        self.bound_thrust();
        let latency = self.settings.latency * self.units.time;
        (self.gate).begin(self.time, latency, state, conditions, self.altitude);
        self.previous.clone_from(&self.best);
        self.ladder = Ladder::NEW;
        self.candidates.clear();
        self.improvements = 0;
        self.best_price = f64::INFINITY;
        self.summary = PlanSummary {
            blind,
            ..PlanSummary::NOTHING
        };
        // No plan starts from a state that is not finite; the map stays as it is.
        let starts = self.ready && state.is_finite() && self.state.is_finite();
        self.phase = if starts { Phase::Map } else { Phase::Done };
    }

    /// Takes over the estimated wind and airframe. Cruise keeps the angle of attack of the set-up, so that
    /// the elevator keeps the same range to either side; the airspeed of cruise changes instead.
    fn take_conditions(&mut self, conditions: &Conditions) {
        let (airframe, trim) = &self.known;
        self.conditions = *conditions;
        let own = self.units.own_conditions(conditions);
        self.wind = own.wind;
        self.airframe = own.airframe(airframe);
        let alpha = trim.state.angle_of_attack();
        self.trim = Trim::at_angle_of_attack(&self.airframe, alpha).unwrap_or(*trim);
        self.limits = Limits::new(&self.settings, &self.actuators, &self.airframe);
    }

    fn bound_thrust(&mut self) {
        let reserve = self.trim.control.thrust;
        let rise = self.limits.thrust_max - reserve;
        self.solver.problem.bounds.set_thrust([rise, reserve]);
    }

    /// The state, in own units, in which the step takes over the plan of a scan at this time \[s\]. The aircraft flies its
    /// last plan until then, and keeps its present distance from it. Without a last plan it flies on at its
    /// present angle of attack.
    fn taken_over(&self, time: f64, state: &VehicleState) -> VehicleState {
        let latency = self.settings.latency;
        let later = time + latency * self.units.time;
        if let (Some(now), Some(then)) = (self.last_plan(time), self.last_plan(later)) {
            let air = then.air.to_vector() + state.air.to_vector() - now.air.to_vector();
            return VehicleState {
                x: then.x + state.x - now.x,
                z: then.z + state.z - now.z,
                air: AirState::from_vector(&air),
            };
        }
        let control = PathControl {
            angle_of_attack_rate: 0.0,
            thrust: self.trim.control.thrust,
        };
        let flown = PathState::of(state).after_in(
            &self.wind,
            &self.airframe,
            &control,
            latency,
            FLOWN_ON_STEPS,
        );
        flown.reference(&self.airframe, &control).0
    }

    /// The state, in own units, that the last plan has at a time \[s\].
    fn last_plan(&self, time: f64) -> Option<VehicleState> {
        let reference = self.best.sample(time)?;
        Some(self.units.own_state(&reference.state))
    }

    /// The work of the next slice.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// The units in which this planner computes. Trim, clearance, map and candidate are in these units.
    #[must_use]
    pub fn units(&self) -> &Units {
        &self.units
    }

    /// Whether a cycle is under way.
    #[must_use]
    pub fn is_working(&self) -> bool {
        !matches!(self.phase, Phase::Idle | Phase::Done)
    }

    /// Does one bounded slice of work. Returns true until the cycle ends.
    // The phases that need much stack are never inlined. Otherwise this function would need the sum of
    // their stacks.
    pub fn advance(&mut self) -> bool {
        if self.is_working() && self.phase != Phase::Gate {
            self.summary.slices += 1;
        }
        match self.phase {
            Phase::Idle | Phase::Done => {}
            Phase::Map => self.remember(),
            Phase::Lattice => self.search_lattice(),
            Phase::Faces => self.separate(),
            Phase::Linearise => self.linearise(),
            Phase::Improve => self.improve(),
            Phase::Gate => self.offer_next(),
        }
        self.is_working()
    }

    /// Forgets the map and the last plan; see [`super::Planner::forget`].
    pub fn forget(&mut self) {
        self.map.clear();
        self.lidar_distrusted = false;
        self.monitor.clear();
        self.seen = f64::INFINITY;
        self.best.clear();
    }

    /// Ends a cycle whose phase and workspace do not belong together. The best trajectory so far stays.
    fn end_inconsistent(&mut self) {
        self.summary.inconsistent = true;
        self.climb_down();
    }

    fn frame(&self) -> Frame {
        Frame {
            airframe: self.airframe,
            trim: self.trim,
            wind: self.wind,
            start: PathState::of(&self.state),
            lag: self.lag,
        }
    }
}
