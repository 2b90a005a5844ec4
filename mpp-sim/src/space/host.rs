//! One flight in space in lockstep: in each tick the measurements go out over the link, the commands come back, and the plant moves
//! on.

use super::instruments::{Instruments, Measured};
use super::judge::{Inquest, off_track};
use super::world::{Body, Vector, World};
use super::{SpaceAircraft, SpacePipe, SpaceScenario, SpaceState, true_path};
use crate::entries::{LateralTick, PlanEntry, Tick};
use crate::file_error::ScenarioError;
use crate::flight::noted::{conditions, control, estimate, plan_entry, reference};
use crate::flight::{FlyError, check, entry, own_hello};
use crate::inquest::Failure;
use crate::link::{Link, LinkError};
use crate::log::{FlightLog, Summary};
use crate::orders::{Order, OrderEntry, Refused};
use crate::outcome::{Class, Outcome};
use crate::scenario::Scenario;
use hil_protocol::{
    ActuatorCommand, ConfigureVerdict, ControlMode, Message, PlanReport, Rejection, RejectionCause,
    SpaceReport, StepReport, SurfaceCommand,
};
use mpp_core::vehicle::{AirState, Conditions, Control, LateralControl, VehicleState};

/// Clearance beyond which nobody asks \[m\].
const MOST: f64 = 5.0;

/// The answer of the core to a tick.
struct Reply {
    command: ActuatorCommand,
    surfaces: SurfaceCommand,
    step: Option<StepReport>,
    space: Option<SpaceReport>,
    plan: Option<PlanReport>,
}

/// Flies a scenario in space with the core in this process, on a stack of 32 MB.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly_space(scenario: &SpaceScenario) -> Result<FlightLog, FlyError> {
    fly_space_with(scenario, &mut SpacePipe::of(scenario), || false)
}

/// Flies a scenario in space over a link, until `stops` says so.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly_space_with(
    scenario: &SpaceScenario,
    link: &mut dyn Link,
    stops: impl Fn() -> bool,
) -> Result<FlightLog, FlyError> {
    fly_space_again(scenario, link, &[], stops)
}

/// Flies a scenario in space over a link with the orders of a log at their ticks, until `stops` says so. Orders that are
/// refused are left out.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly_space_again(
    scenario: &SpaceScenario,
    link: &mut dyn Link,
    orders: &[OrderEntry],
    stops: impl Fn() -> bool,
) -> Result<FlightLog, FlyError> {
    let mut flight = SpaceFlight::begin(scenario, link)?;
    let mut orders = orders.iter().peekable();
    while !flight.has_ended() && !stops() {
        let flown = u64::from(flight.flown());
        while let Some(entry) = orders.next_if(|entry| entry.tick <= flown) {
            let _ = flight.obey(scenario, &entry.order);
        }
        flight.tick(scenario, link)?;
    }
    Ok(flight.log())
}

/// A flight in space, tick by tick.
pub struct SpaceFlight {
    world: World,
    aircraft: SpaceAircraft,
    instruments: Instruments,
    log: FlightLog,
    flown: u32,
    end: Option<Outcome>,
    /// Distance from the nearest thing now, and the least one so far \[m\].
    gap: f64,
    clearance: f64,
    deviation: f64,
    inquest: Inquest,
    failure: Option<Failure>,
}

impl SpaceFlight {
    /// Configures the core.
    ///
    /// # Errors
    /// [`FlyError`] when the core takes no such flight, or it would begin in a body.
    pub fn begin(scenario: &SpaceScenario, link: &mut dyn Link) -> Result<Self, FlyError> {
        let failed = |error: ScenarioError| FlyError::Scenario(error);
        let mut aircraft = SpaceAircraft::new(&scenario.plane, scenario.wind).map_err(failed)?;
        aircraft.start_at(scenario.altitude());
        (scenario.hull())
            .check_start(&scenario.world, aircraft.state())
            .map_err(|error| failed(ScenarioError::Value("world", error.to_string())))?;
        let lateral = scenario.configure_lateral().ok_or_else(|| {
            let advice = "give this table: the aircraft must bank".to_owned();
            failed(ScenarioError::Value("aircraft.lateral", advice))
        })?;
        let mut log = FlightLog::begin(scenario.header());
        link.send(&Message::Hello(own_hello()))?;
        match link.receive("the hello")? {
            Message::Hello(peer) => check(&peer, 1)?,
            other => return Err(unexpected("the hello", &other)),
        }
        for question in [
            Message::ConfigureLateral(lateral),
            Message::ConfigureSpace(scenario.configure_space()),
            Message::Configure(scenario.configure()),
        ] {
            let awaited = "the reply to the configuration";
            link.send(&question)?;
            loop {
                match link.receive(awaited)? {
                    Message::ConfigureReply(reply) => match reply.verdict {
                        ConfigureVerdict::Accepted => break,
                        refused => return Err(LinkError::Refused(refused).into()),
                    },
                    // A core in the vertical plane takes no such message.
                    Message::Rejection(Rejection {
                        cause: RejectionCause::UnexpectedMessage { .. },
                        ..
                    }) => return Err(LinkError::Refused(ConfigureVerdict::NoSuchPlanner).into()),
                    Message::Rejection(told) => log.rejections.push(entry(&told)),
                    other => return Err(unexpected(awaited, &other)),
                }
            }
        }
        Ok(Self {
            world: scenario.world.clone(),
            aircraft,
            instruments: Instruments::new(scenario),
            log,
            flown: 0,
            end: None,
            gap: MOST,
            clearance: MOST,
            deviation: 0.0,
            inquest: Inquest::default(),
            failure: None,
        })
    }

    /// Carries out an order before the next tick. The log holds it.
    ///
    /// # Errors
    /// [`Refused`] of everything but a trunk, and of one that is unsound or where the aircraft is.
    pub fn obey(&mut self, scenario: &SpaceScenario, order: &Order) -> Result<(), Refused> {
        let Order::Trunk { x, y, radius } = *order else {
            return Err(Refused::World);
        };
        let trunk = Body::Cylinder {
            x,
            y,
            radius,
            height: f64::INFINITY,
        };
        let world = self.world.with(trunk).map_err(|_| Refused::Range)?;
        (scenario.hull())
            .check_start(&world, self.aircraft.state())
            .map_err(|_| Refused::Range)?;
        self.world = world;
        self.log.orders.push(OrderEntry {
            tick: u64::from(self.flown),
            order: order.clone(),
        });
        Ok(())
    }

    /// Ticks flown.
    #[must_use]
    pub fn flown(&self) -> u32 {
        self.flown
    }

    /// Whether the flight has come to its end.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.end.is_some()
    }

    /// The true state.
    #[must_use]
    pub fn state(&self) -> &SpaceState {
        self.aircraft.state()
    }

    /// Distance from the nearest body or the ground \[m\], at most 5 m.
    #[must_use]
    pub fn gap(&self) -> f64 {
        self.gap
    }

    /// Where the beams of the last sweep have ended, by true poses; `None` in a tick without a sweep.
    #[must_use]
    pub fn returns(&self) -> Option<Vec<Vector>> {
        self.instruments.returns()
    }

    /// Flies a tick.
    ///
    /// # Errors
    /// [`FlyError`] when the core does not answer as it must.
    pub fn tick(&mut self, scenario: &SpaceScenario, link: &mut dyn Link) -> Result<(), FlyError> {
        let before = *self.aircraft.state();
        let wind = self.aircraft.wind();
        let measured = self
            .instruments
            .measure(self.flown, &self.aircraft, &self.world);
        for message in &measured.messages {
            link.send(message)?;
        }
        if let Some(returns) = self.instruments.returns() {
            self.inquest.watch(Scenario::time(self.flown), &returns);
        }
        let reply = self.answer(link)?;
        let command = control(&reply.command);
        let lateral = LateralControl {
            aileron: reply.surfaces.aileron,
            rudder: reply.surfaces.rudder,
        };
        let way_out = reply.space.map(|told| f64::from(told.way_out));
        let plan = (reply.plan.as_ref()).map(|plan| PlanEntry {
            way_out,
            ..plan_entry(plan)
        });
        self.log.plans.extend(plan);
        let Ok((applied, surfaces)) = self.aircraft.step(command, lateral) else {
            self.end = Some(Outcome::FlightPathLimit);
            return Ok(());
        };
        self.note(&before, wind, &measured, &reply, applied, surfaces);
        self.flown += 1;
        self.judge(scenario, &before);
        Ok(())
    }

    /// Reads the answer to its end, which is the command.
    fn answer(&mut self, link: &mut dyn Link) -> Result<Reply, FlyError> {
        let awaited = format!("the actuator command of tick {}", self.flown);
        let (mut surfaces, mut step, mut space, mut plan) = (None, None, None, None);
        loop {
            match link.receive(&awaited)? {
                Message::ActuatorCommand(command) if command.tick == self.flown => {
                    let missing =
                        || unexpected("the surface command", &Message::ActuatorCommand(command));
                    return Ok(Reply {
                        command,
                        surfaces: surfaces.ok_or_else(missing)?,
                        step,
                        space,
                        plan,
                    });
                }
                Message::SurfaceCommand(told) => surfaces = Some(told),
                Message::StepReport(told) => step = Some(told),
                Message::SpaceReport(told) => space = Some(told),
                Message::PlanReport(told) => plan = Some(told),
                Message::SpaceTrajectory(_) => {}
                Message::Rejection(told) => self.log.rejections.push(entry(&told)),
                other => return Err(unexpected(&awaited, &other)),
            }
        }
    }

    /// Writes a tick to the log.
    fn note(
        &mut self,
        state: &SpaceState,
        wind: [f64; 3],
        measured: &Measured,
        reply: &Reply,
        applied: Control,
        surfaces: LateralControl,
    ) {
        let path = true_path(state);
        let [_, pitch, _] = state.attitude().angles();
        let side = &state.lateral;
        let plane = VehicleState {
            air: AirState {
                pitch,
                flight_path: path.flight_path,
                ..state.plane.air
            },
            ..state.plane
        };
        let tracks = reply.command.mode == ControlMode::Tracking;
        let step = reply.step.as_ref();
        let [x, y, z] = wind;
        self.log.ticks.push(&Tick {
            t: Scenario::time(self.flown),
            state: plane,
            measured: measured.air,
            estimate: step.map_or(plane, estimate),
            conditions: step.map_or(Conditions::STILL, conditions),
            reference: reference(&reply.command, step),
            control: control(&reply.command),
            applied,
            wind: (x, z),
        });
        let truth = [side.y, path.bank, path.course];
        let told = reply.space;
        self.log.lateral.push(&LateralTick {
            state: [
                side.y,
                path.bank,
                path.course,
                side.sideslip,
                side.roll_rate,
                side.yaw_rate,
            ],
            estimate: told.map_or([truth[0], truth[1], truth[2], 0.0], |told| {
                let [_, bank, _, _, course] = told.estimate;
                [told.y, bank, course, told.wind]
            }),
            reference: told.filter(|_| tracks).map(|told| told.reference),
            control: [reply.surfaces.aileron, reply.surfaces.rudder],
            applied: [surfaces.aileron, surfaces.rudder],
            wind: y,
        });
    }

    /// Whether the flight has ended.
    fn judge(&mut self, scenario: &SpaceScenario, before: &SpaceState) {
        let (world, state) = (&self.world, self.aircraft.state());
        self.gap = scenario.hull().clearance(world, state, MOST);
        self.clearance = self.clearance.min(self.gap);
        self.deviation = self
            .deviation
            .max((state.plane.z - scenario.altitude()).abs());
        self.end = scenario.judge(world, before, state, self.flown);
        if self.end == Some(Outcome::Collision) {
            self.clearance = self.clearance.min(0.0);
            let place = scenario.hull().nearest(world, before);
            let end = Scenario::time(self.flown);
            let off = off_track(&self.log, before);
            self.failure = Some(self.inquest.collision(&self.log.plans, place, off, end));
        }
    }

    /// The log of what was flown; until the end, of an interrupted flight.
    #[must_use]
    pub fn log(&self) -> FlightLog {
        let outcome = self.end.unwrap_or(Outcome::Interrupted);
        let strict = outcome == Outcome::Survived;
        let plans = &self.log.plans;
        let planless = plans.last().is_some_and(PlanEntry::had_nothing);
        let summary = Summary {
            outcome,
            strict,
            class: Class::of(outcome, strict, planless),
            failure: self.failure,
            t_end: Scenario::time(self.flown),
            x_end: self.aircraft.state().plane.x,
            min_clearance: Some(self.clearance).filter(|it| *it < MOST),
            max_altitude_deviation: self.deviation,
            replans: plans.len() as u32,
            candidates: plans.iter().map(|plan| plan.candidates).sum(),
            feasible: plans.iter().map(|plan| plan.feasible).sum(),
            slices: plans.iter().map(|plan| u64::from(plan.slices)).sum(),
        };
        FlightLog {
            summary,
            ..self.log.clone()
        }
    }
}

fn unexpected(awaited: &str, message: &Message) -> FlyError {
    FlyError::Link(LinkError::Unexpected {
        awaited: awaited.to_owned(),
        id: message.id(),
    })
}
