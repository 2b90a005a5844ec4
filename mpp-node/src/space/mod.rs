//! The planner in space: bytes in, bytes out, as [`FlightNode`](crate::FlightNode) is for the vertical plane.
//!
//! ```text
//! ConfigureLateral, ConfigureSpace, Configure   each answered by a ConfigureReply
//!
//! [InertialFrame]     attitude, rates and specific force
//! [SpacePosition]     a fix
//! [PointPacket ..]    kept until the sensor frame
//! SensorFrame k       1. a plan that tick k - 1 has taken over is told -> PlanReport, and one tick later SpaceTrajectory
//!                     2. a plan that is due is taken over
//!                     3. estimate, reference, control -> SpaceReport, StepReport, SurfaceCommand, ActuatorCommand
//!                     4. the points go into the map, each by the pose of its time; a period after the last cycle the next
//!                        one begins
//!                     5. the planner runs its slices of this tick
//! ```
//!
//! | file | what it does |
//! |---|---|
//! | `node.rs` | the task with its memory in one value, for hosts |
//! | `set_up.rs` | checks a configuration, and makes models, regulator and planner from it |
//! | `input.rs` | takes measurements, or says why not |
//! | `tick.rs` | the step |
//! | `sweep.rs` | the points of a sensor frame, each placed by the pose of its time |
//! | `planning.rs`, `cycle.rs` | slices of map and planner, and the plan that is flown |

mod cycle;
mod input;
mod intake;
mod node;
mod planning;
mod set_up;
mod sweep;
mod tick;

use crate::greeting;
use cycle::{Cycle, Flown};
use hil_protocol::{
    Body, Configure, ConfigureLateral, ConfigureSpace, DecodeError, Decoder, Hello, InertialFrame,
    MAX_FRAME, PlanReport, Rejection, RejectionCause, Role, SpacePosition, encode_body, id,
};
use intake::Intake;
use mpp_core::control::SpaceRegulator;
use mpp_core::estimate::SpaceEstimator;
use mpp_core::map::VoxelGrid;
use mpp_core::planner::space::{SpacePlanner, SpaceStage};
use mpp_core::vehicle::{LateralControl, SpaceModel};
use sweep::Sweep;

pub use node::SpaceNode;
pub use sweep::MOST_POINTS;

/// A flight after its configuration.
struct Session {
    configure: Configure,
    /// Whether only plans with a way out are flown, as long as one is known.
    open: bool,
    /// The aircraft, with the wind of this tick.
    model: SpaceModel,
    /// The last command to the surfaces.
    surfaces: LateralControl,
    regulator: SpaceRegulator,
    /// Time by which the aircraft follows the commands \[s\].
    ahead: f64,
    estimator: SpaceEstimator,
    /// What was measured since the last sensor frame.
    inertial: Option<InertialFrame>,
    position: Option<SpacePosition>,
    last_tick: Option<u32>,
    last_cycle: Option<u32>,
    cycle: Option<Cycle>,
    /// The plan that is flown.
    flown: Flown,
    /// The report of a plan that the last tick has taken over.
    untold: Option<PlanReport>,
    /// Whether the trajectory of the plan is to be told.
    unshown: bool,
}

/// The core in space and its side of the link, without the memory of map and planner: a flight computer has no one memory that
/// holds all.
pub struct SpaceTask {
    decoder: Decoder,
    buffer: [u8; MAX_FRAME],
    lateral: Option<ConfigureLateral>,
    limits: Option<ConfigureSpace>,
    session: Option<Session>,
    sweep: Sweep,
    intake: Option<Intake>,
    /// Slices that the planner may still use in this tick.
    granted: u32,
}

/// What a slice between two ticks does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpaceSlice {
    /// Begins to take points into the map.
    Sweep,
    /// Takes some points into the map.
    Map,
    /// A slice of the planner.
    Planner(SpaceStage),
}

/// Map and planner of a [`SpaceTask`]. It is given the same ones in every call.
pub struct SpaceMemory<'a> {
    /// What the scans have shown.
    pub map: &'a mut VoxelGrid,
    /// The workspace of the planner.
    pub planner: &'a mut SpacePlanner,
}

// The memories of an STM32H743 hold them: D2, AXI, and DTCM beside 40 kB of stack.
const _: () = assert!(
    size_of::<VoxelGrid>() <= 288 << 10
        && size_of::<SpacePlanner>() <= 512 << 10
        && size_of::<SpaceTask>() <= 88 << 10
);

impl SpaceTask {
    /// A task that waits for a hello.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            decoder: Decoder::new(),
            buffer: [0; MAX_FRAME],
            lateral: None,
            limits: None,
            session: None,
            sweep: Sweep::new(),
            intake: None,
            granted: 0,
        }
    }

    /// Forgets session, points and map: also memory of zeros becomes a task that waits for a hello.
    pub fn reset(&mut self, memory: &mut SpaceMemory<'_>) {
        self.decoder = Decoder::new();
        self.forget();
        self.sweep.clear();
        memory.map.clear(0.0);
    }

    /// Takes a byte from the link. `send` gets each frame of the answer as a whole. The caller then calls
    /// [`advance`](Self::advance) until it returns false.
    pub fn take(&mut self, byte: u8, memory: &mut SpaceMemory<'_>, send: &mut impl FnMut(&[u8])) {
        let Some(taken) = self.decoder.take(byte) else {
            return;
        };
        if let Err(fault) = taken.and_then(|id| self.handle(id, memory, send)) {
            self.reject(RejectionCause::Frame(fault), send);
        }
    }

    /// The tick of the last sensor frame.
    #[must_use]
    pub fn last_tick(&self) -> Option<u32> {
        self.session.as_ref()?.last_tick
    }

    /// Whether a flight is configured.
    #[must_use]
    pub fn is_configured(&self) -> bool {
        self.session.is_some()
    }

    fn handle(
        &mut self,
        id: u8,
        memory: &mut SpaceMemory<'_>,
        send: &mut impl FnMut(&[u8]),
    ) -> Result<(), DecodeError> {
        match id {
            id::SENSOR_FRAME => self.sensor_frame(&self.decoder.body()?, memory, send),
            id::INERTIAL_FRAME => self.take_inertial(&self.decoder.body()?, send),
            id::SPACE_POSITION => self.take_position(&self.decoder.body()?, send),
            id::POINT_PACKET => self.take_points(send)?,
            id::HELLO => match self.decoder.body::<Hello>()?.role {
                Role::Harness => self.greet(send),
                Role::Core => self.reject(RejectionCause::UnexpectedMessage { id }, send),
            },
            id::CONFIGURE_LATERAL => self.take_lateral(&self.decoder.body()?, send),
            id::CONFIGURE_SPACE => self.take_limits(&self.decoder.body()?, send),
            id::CONFIGURE => self.configure(&self.decoder.body()?, memory, send),
            id if (id::HELLO..=id::LAST).contains(&id) => {
                self.reject(RejectionCause::UnexpectedMessage { id }, send);
            }
            _ => return Err(DecodeError::UnknownId { id }),
        }
        Ok(())
    }

    fn emit<T: Body>(&mut self, message: &T, send: &mut impl FnMut(&[u8])) {
        // The buffer holds the longest message, so this cannot fail.
        if let Ok(frame) = encode_body(message, &mut self.buffer) {
            send(frame);
        }
    }

    fn reject(&mut self, cause: RejectionCause, send: &mut impl FnMut(&[u8])) {
        let tick = self.last_tick().unwrap_or(0);
        self.emit(&Rejection { tick, cause }, send);
    }

    /// Answers a hello. It starts a new session, whatever the state of the last one.
    fn greet(&mut self, send: &mut impl FnMut(&[u8])) {
        self.forget();
        self.emit(&greeting(), send);
    }

    fn forget(&mut self) {
        (self.session, self.lateral, self.limits) = (None, None, None);
        (self.intake, self.granted) = (None, 0);
    }
}
