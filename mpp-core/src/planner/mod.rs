//! The interface of the planner, a receding-horizon planner that can stop at any time. A cycle begins with a scan, or without one if the lidar
//! is silent, and advances in bounded slices. After each slice the best trajectory so far is available.
//!
//! ```text
//! set_up --> begin --> advance, advance, .. --> finish --> best
//!              ^                                  |
//!              +----------- next cycle -----------+
//! ```
//!
//! There are two planning methods, each with its own state and settings: the [`plane`] planner for flight in the
//! vertical plane, and with the feature `paper` the paper's method for comparison (module `paper`). The flight loop may
//! run between any two slices.

mod error;
pub mod plane;
mod shared;
pub mod space;
mod summary;

use crate::config::KNOTS;
#[cfg(feature = "paper")]
use crate::paper::{self, PaperPlanner};
use crate::qp::Problem;
use crate::sense::LidarScan;
use crate::settings::{Method, PlannerSettings, Settings};
use crate::trajectory::Trajectory;
use crate::tuning::scan_match::AGES;
use crate::vehicle::{Conditions, Pose, ScanPoses, Trim, VehicleState};
pub use error::SetupError;
pub(crate) use error::check;
use plane::PlanePlanner;
pub use summary::{PlanSummary, Verdict};
#[cfg(feature = "paper")]
pub(crate) use {error::check_planner, shared::STEPS_PER_SLICE, summary::FEASIBLE};

/// The work of the next slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// A slice of the planner in the vertical plane.
    Plane(plane::Phase),
    /// A slice of the paper's method.
    #[cfg(feature = "paper")]
    Paper(paper::Phase),
}

/// The planner that was set up last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Chosen {
    Plane,
    #[cfg(feature = "paper")]
    Paper,
}

/// The planners of this build, of which one is set up. The value is large: place it in a `static` or a
/// box, and never on a stack.
///
/// # Example
///
/// One cycle on a scan that shows one obstacle, a disc of 1 m radius 25 m ahead.
///
/// ```
/// use mpp_core::vehicle::Conditions;
/// use mpp_core::planner::{Planner, Verdict};
/// use mpp_core::sense::LidarScan;
/// use mpp_core::settings::Settings;
/// use mpp_core::vehicle::VehicleState;
///
/// let mut planner = Box::new(Planner::new());
/// planner.set_up(&Settings::flight())?;
/// let state = VehicleState { x: 0.0, z: 50.0, air: planner.trim().state };
///
/// let mut scan = LidarScan::new();
/// (scan.angle_min, scan.angle_increment) = (-0.5, 0.01);
/// for beam in 0..100 {
///     let (up, ahead) = libm::sincos(state.air.pitch + scan.beam_angle(beam));
///     let missed_by = 25.0 * up;
///     let half_chord = libm::sqrt(1.0 - missed_by * missed_by);
///     // Not a number where the beam passes: nothing comes back.
///     let range = if half_chord.is_nan() { 0.0 } else { 25.0 * ahead - half_chord };
///     scan.ranges.push(range as f32).expect("there is room for 128 beams");
/// }
///
/// planner.begin(0.0, &state, &Conditions::STILL, &scan);
/// while planner.advance() {}
/// assert_eq!(planner.finish(), Verdict::Feasible);
/// let plan = planner.best();
/// for tick in 0..450 {
///     let at = plan.sample(0.01 * f64::from(tick)).expect("a plan lasts 4.5 s").state;
///     assert!(libm::hypot(at.x - 25.0, at.z - 50.0) > 1.0, "it hits the obstacle");
/// }
/// # Ok::<(), mpp_core::planner::SetupError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Planner {
    chosen: Chosen,
    plane: PlanePlanner,
    #[cfg(feature = "paper")]
    paper: PaperPlanner,
}

/// A field, or the value of a method, of the planner that is set up.
macro_rules! of_chosen {
    (&$planner:ident.$field:ident) => {
        match $planner.chosen {
            Chosen::Plane => &$planner.plane.$field,
            #[cfg(feature = "paper")]
            Chosen::Paper => &$planner.paper.$field,
        }
    };
    ($planner:expr, $method:ident()) => {
        match $planner.chosen {
            Chosen::Plane => $planner.plane.$method(),
            #[cfg(feature = "paper")]
            Chosen::Paper => $planner.paper.$method(),
        }
    };
}

impl Planner {
    /// An idle planner that is not set up.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            chosen: Chosen::Plane,
            plane: PlanePlanner::new(),
            #[cfg(feature = "paper")]
            paper: PaperPlanner::new(),
        }
    }

    /// Sets up the planner that the settings ask for. It replaces any earlier set-up.
    ///
    /// # Errors
    /// [`SetupError`]: the planner then plans nothing.
    pub fn set_up(&mut self, settings: &Settings) -> Result<(), SetupError> {
        match &settings.planner.method {
            Method::Plane(own) => {
                self.chosen = Chosen::Plane;
                self.plane.set_up(settings, own)
            }
            #[cfg(feature = "paper")]
            Method::Paper(own) => {
                self.chosen = Chosen::Paper;
                self.paper.set_up(settings, own)
            }
        }
    }

    /// Takes over the settings that can change in flight, for the cycles to come: number of paths and
    /// altitude; padding (the paper's method); penalty, attitude limits and latency (the plane planner).
    ///
    /// # Errors
    /// [`SetupError`]: the settings stay as they were.
    pub fn retune(&mut self, settings: &PlannerSettings) -> Result<(), SetupError> {
        match (self.chosen, &settings.method) {
            (Chosen::Plane, Method::Plane(own)) => self.plane.retune(settings, own),
            #[cfg(feature = "paper")]
            (Chosen::Paper, Method::Paper(own)) => self.paper.retune(settings, own),
            #[cfg(feature = "paper")]
            _ => Err(SetupError::OtherMethod),
        }
    }

    /// Starts a cycle at a time \[s\] from a state and a checked scan, and drops a cycle that is under way.
    /// The plane planner uses these conditions; the paper's method assumes still air and the known airframe.
    pub fn begin(
        &mut self,
        time: f64,
        state: &VehicleState,
        conditions: &Conditions,
        scan: &LidarScan,
    ) {
        self.begin_from(
            time,
            &[Pose::of(state); AGES],
            state,
            conditions,
            Some(scan),
        );
    }

    /// Starts a cycle as [`Self::begin`] does, with a scan that was taken earlier from one of these poses, or without a scan
    /// because the lidar shows nothing. The plane planner then plans slow flight in the map that it has. The
    /// paper's method has no map and knows only the present pose: without a scan it plans nothing.
    pub fn begin_from(
        &mut self,
        time: f64,
        poses: &ScanPoses,
        state: &VehicleState,
        conditions: &Conditions,
        scan: Option<&LidarScan>,
    ) {
        match self.chosen {
            Chosen::Plane => self.plane.begin(time, poses, state, conditions, scan),
            #[cfg(feature = "paper")]
            Chosen::Paper => self.paper.begin(time, state, scan),
        }
    }

    /// The work of the next slice.
    #[must_use]
    pub fn phase(&self) -> Phase {
        match self.chosen {
            Chosen::Plane => Phase::Plane(self.plane.phase()),
            #[cfg(feature = "paper")]
            Chosen::Paper => Phase::Paper(self.paper.phase()),
        }
    }

    /// Whether a cycle is under way.
    #[must_use]
    pub fn is_working(&self) -> bool {
        of_chosen!(self, is_working())
    }

    /// Does one bounded slice of work. Returns true until the cycle ends.
    pub fn advance(&mut self) -> bool {
        of_chosen!(self, advance())
    }

    /// Forgets the map and the last plan, because positions are now counted from another origin. The paper's
    /// method remembers neither.
    pub fn forget(&mut self) {
        self.plane.forget();
    }

    /// Ends the cycle and returns its verdict; [`Planner::best`] gives the trajectory.
    pub fn finish(&mut self) -> Verdict {
        of_chosen!(self, finish())
    }

    /// The best trajectory of the cycle, if its verdict is not [`Verdict::Nothing`].
    #[must_use]
    pub fn best(&self) -> &Trajectory {
        of_chosen!(&self.best)
    }

    /// The [seal](Trajectory::seal) of [`Self::best`] when the gate let it through. The paper's method has no gate: it is
    /// that of the trajectory as it is.
    #[must_use]
    pub fn seal(&self) -> u64 {
        (self.plane()).map_or_else(|| self.best().seal(), PlanePlanner::seal)
    }

    /// The results of the cycle so far.
    #[must_use]
    pub fn summary(&self) -> &PlanSummary {
        of_chosen!(&self.summary)
    }

    /// Level trim. Plans are deviations from it.
    #[must_use]
    pub fn trim(&self) -> &Trim {
        of_chosen!(&self.trim)
    }

    /// The path of the present candidate, `(x, z)` at the stage boundaries in the world \[m\], and its
    /// program. They exist only while the solver works on the program.
    #[must_use]
    pub fn candidate(&self) -> Option<([(f64, f64); KNOTS], Problem)> {
        of_chosen!(self, candidate())
    }

    /// The plane planner, if it is set up.
    #[must_use]
    pub fn plane(&self) -> Option<&PlanePlanner> {
        (self.chosen == Chosen::Plane).then_some(&self.plane)
    }

    /// The plane planner, if it is set up, for example to change its map.
    pub fn plane_mut(&mut self) -> Option<&mut PlanePlanner> {
        (self.chosen == Chosen::Plane).then_some(&mut self.plane)
    }

    /// The paper's method, if it is set up.
    #[cfg(feature = "paper")]
    #[must_use]
    pub fn paper(&self) -> Option<&PaperPlanner> {
        (self.chosen == Chosen::Paper).then_some(&self.paper)
    }
}
