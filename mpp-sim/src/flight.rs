//! One flight in lockstep. In each tick the measurements go out, the command comes back and the
//! plant moves on.

mod error;
mod exchange;
mod judge;
mod sensing;
mod session;
mod steering;

use crate::entries::{PlanEntry, Tick, finite};
use crate::link::Link;
use crate::log::{FlightLog, Header};
use crate::moment::Moment;
use crate::orders::Ground;
use crate::outcome::Outcome;
use crate::scenario::Scenario;
use crate::sensors::Measurement;
use crate::world::World;
pub use error::FlyError;
use exchange::Exchange;
use hil_protocol::{ControlMode, HealthReport, PlanReport, SensorStates};
use judge::Judge;
use mpp_core::estimate::Conditions;
use mpp_core::vehicle::{AirState, Control, VehicleState, Wind};
use nalgebra::Vector4;
pub use sensing::Sensing;
use session::{Answer, Session};
use std::collections::BTreeMap;
use steering::Steering;

/// A ground that watches the flight and gives no orders.
struct Onlooker<F>(F);

impl<F: FnMut(&Moment<'_>)> Ground for Onlooker<F> {
    fn watch(&mut self, moment: &Moment<'_>) {
        (self.0)(moment);
    }
}

/// Flies a scenario over a link; `watch` sees every tick.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly(
    scenario: &Scenario,
    link: &mut dyn Link,
    watch: impl FnMut(&Moment<'_>),
) -> Result<FlightLog, FlyError> {
    fly_with(scenario, link, &mut Onlooker(watch))
}

/// Flies a scenario over a link, with a ground that may give orders.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly_with(
    scenario: &Scenario,
    link: &mut dyn Link,
    ground: &mut dyn Ground,
) -> Result<FlightLog, FlyError> {
    let mut world = World::of(scenario).map_err(FlyError::Trim)?;
    fly_in(&mut world, scenario, link, ground)
}

/// Flies a scenario over a link in a world that the caller provides, with a ground that may give
/// orders. The function takes the core's configuration, the duration of the flight and the noise of
/// the sensors from the scenario. The world provides the obstacles and the faults.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly_in(
    world: &mut World,
    scenario: &Scenario,
    link: &mut dyn Link,
    ground: &mut dyn Ground,
) -> Result<FlightLog, FlyError> {
    let World {
        plant,
        field,
        lidar,
    } = world;
    let mut log = FlightLog::begin(Header::of(scenario, field.as_ref()));
    let mut session = Session::open(scenario, link)?;
    let mut sensing = Sensing::new(scenario);
    let mut exchange = Exchange::new(scenario).map_err(FlyError::Trim)?;
    let mut trust = SensorStates::default();
    let mut judge = Judge::new(scenario);
    let mut steering = Steering::new(scenario)?;
    ground.begin(&steering.tuning, plant.state());
    steering.wait(&mut session, ground)?;
    while judge.flown < scenario.ticks && judge.end.is_none() {
        let flown = judge.flown;
        session.tick = flown;
        field.move_to(Scenario::time(flown));
        steering.obey(&mut session, ground)?;
        if steering.terminated {
            judge.end = Some(Outcome::Terminated);
            break;
        }
        if ground.interrupts(flown) {
            judge.end = Some(Outcome::Interrupted);
            break;
        }
        let before = *plant.state();
        let (x, z) = plant.wind();
        let air = Wind { x, z };
        if scenario.oracle {
            session.reveal(&before, air)?;
        }
        let (measured, frame) = sensing.measure(flown, &before, air);
        let shown = steering
            .scans(flown)
            .then(|| lidar.scan(&sensing.lidar_state(flown, &before), field.as_ref()))
            .and_then(|ranges| sensing.show(flown, &ranges));
        let passage = exchange.passage(flown);
        let seen = shown.clone().filter(|_| passage.to_core);
        let scan = sensing.scan(flown, shown);
        let mut answer = exchange.tick(&mut session, passage, scan, frame)?;
        steering.limit(&mut answer.command);
        let wind = plant.wind();
        let applied = plant.step(control(&answer)).map_err(FlyError::Plant)?;
        let tick = Tick {
            applied,
            wind,
            ..logged(flown, &before, measured, &answer)
        };
        let plan = answer.plan.as_ref().map(plan_entry);
        let moment = Moment {
            tick: &tick,
            scan: seen.as_ref(),
            plan: plan.as_ref(),
            report: answer.plan.as_ref(),
            trajectory: answer.trajectory.as_ref(),
            sensors: answer.step.map_or(trust, |step| step.sensors),
            health: answer.health.as_ref(),
            rejections: &session.rejections,
        };
        let holds_trim = answer.command.mode == ControlMode::TrimHold;
        judge.watch(&moment, field.as_ref(), plant.state(), holds_trim);
        ground.watch(&moment);
        log.note_sensors(&trust, &moment.sensors, flown);
        trust = moment.sensors;
        if let Some(health) = moment.health {
            log.health = counters(health);
        }
        log.ticks.push(&tick);
        log.plans.extend(plan);
    }
    log.rejections = session.rejections;
    log.orders = std::mem::take(&mut steering.orders);
    log.summary = judge.conclude(&log.plans, field.as_ref(), plant.state().x);
    Ok(log)
}

/// The counters that are not zero, by name.
fn counters(report: &HealthReport) -> BTreeMap<String, u32> {
    let named = HealthReport::NAMES.iter().zip(report.counters);
    named
        .filter(|(_, count)| *count > 0)
        .map(|(name, count)| ((*name).to_owned(), count))
        .collect()
}

fn plan_entry(report: &PlanReport) -> PlanEntry {
    PlanEntry {
        tick: u64::from(report.scan_tick),
        used_from_tick: Some(u64::from(report.used_from_tick)),
        outcome: format!("{:?}", report.outcome),
        candidates: u32::from(report.candidates),
        feasible: u32::from(report.feasible),
        tree_runs: u32::from(report.tree_runs),
        slices: report.slices,
        cost: finite(Some(report.cost)),
        violation: finite(Some(report.violation)),
    }
}

fn logged(number: u32, state: &VehicleState, measured: Measurement, answer: &Answer) -> Tick {
    let air = |values: [f64; 4]| AirState::from_vector(&Vector4::from(values));
    let tracking = answer.command.mode == ControlMode::Tracking;
    let reference = answer.step.filter(|_| tracking).map(|step| {
        let [x, z, rest @ ..] = step.reference;
        VehicleState {
            x,
            z,
            air: air(rest),
        }
    });
    Tick {
        t: Scenario::time(number),
        state: *state,
        measured,
        estimate: answer.step.map_or(*state, |step| VehicleState {
            x: step.position[0],
            z: step.position[1],
            air: air(step.estimate),
        }),
        conditions: answer.step.map_or(Conditions::STILL, |step| Conditions {
            wind: Wind {
                x: step.wind[0],
                z: step.wind[1],
            },
            lift: step.lift,
        }),
        reference,
        control: control(answer),
        applied: control(answer),
        wind: (0.0, 0.0),
    }
}

/// The control that the core commands.
fn control(answer: &Answer) -> Control {
    Control {
        thrust: answer.command.thrust,
        elevator: answer.command.elevator,
    }
}
