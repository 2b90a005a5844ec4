//! One flight in lockstep. In each tick the measurements go out, the command comes back and the
//! plant moves on.

mod error;
mod exchange;
mod judge;
pub(crate) mod noted;
mod receiver;
mod sensing;
mod session;
mod steering;

use crate::entries::Tick;
use crate::link::Link;
use crate::log::{FlightLog, Header, Summary};
use crate::orders::Ground;
use crate::outcome::Outcome;
use crate::plant::PlantError;
use crate::scenario::Scenario;
use crate::sensors::Measurement;
use crate::tick_record::TickRecord;
use crate::world::World;
pub use error::FlyError;
use exchange::Exchange;
use hil_protocol::{ControlMode, LidarScan, SensorStates};
use judge::Judge;
use mpp_core::vehicle::{VehicleState, Wind};
use noted::{control, counters, logged, plan_entry};
pub use sensing::Sensing;
use session::{Session, StepReply, Told};
pub(crate) use session::{check, entry, own_hello};
use steering::Steering;

/// A ground that watches the flight and gives no orders.
struct Onlooker<F>(F);

impl<F: FnMut(&TickRecord<'_>)> Ground for Onlooker<F> {
    fn watch(&mut self, record: &TickRecord<'_>) {
        (self.0)(record);
    }
}

/// Flies a scenario over a link; `watch` sees every tick.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly(
    scenario: &Scenario,
    link: &mut dyn Link,
    watch: impl FnMut(&TickRecord<'_>),
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
    Flight::begin(world, scenario, link, ground)?.ended(world, link, ground)
}

/// Flies a scenario as [`fly`] does, and keeps no ticks: the log has everything else. A campaign needs no more.
///
/// # Errors
/// [`FlyError`] when the flight has no outcome.
pub fn fly_in_brief(
    scenario: &Scenario,
    link: &mut dyn Link,
    watch: impl FnMut(&TickRecord<'_>),
) -> Result<FlightLog, FlyError> {
    let (mut world, ground) = (
        World::of(scenario).map_err(FlyError::Trim)?,
        &mut Onlooker(watch),
    );
    let mut flight = Flight::begin(&mut world, scenario, link, ground)?;
    flight.is_brief = true;
    flight.ended(&mut world, link, ground)
}

/// What the aircraft measured in a tick, and the core's reply.
struct Exchanged {
    /// The state before the tick.
    before: VehicleState,
    measured: Measurement,
    /// The scan of this tick, unless the link lost it.
    seen: Option<LidarScan>,
    reply: StepReply,
}

/// A flight that the caller flies tick by tick. World, link and ground are the same in each call.
pub struct Flight {
    told: Told,
    sensing: Sensing,
    exchange: Exchange,
    /// The core's trust in its sensors.
    trust: SensorStates,
    judge: Judge,
    steering: Steering,
    log: FlightLog,
    /// Planned length \[ticks\].
    ticks: u32,
    /// Whether the core gets advice of an [`crate::oracle`].
    advised: bool,
    /// Whether the log gets no ticks.
    is_brief: bool,
}

impl Flight {
    /// Configures the core, and carries out the ground's orders until the flight may begin.
    ///
    /// # Errors
    /// [`FlyError`] when the flight cannot begin.
    pub fn begin(
        world: &mut World,
        scenario: &Scenario,
        link: &mut dyn Link,
        ground: &mut dyn Ground,
    ) -> Result<Self, FlyError> {
        let log = FlightLog::begin(Header::of(scenario, world.field.as_ref()));
        let mut told = Told::nothing(scenario);
        let mut session = Session {
            told: &mut told,
            link,
        };
        session.open()?;
        let sensing = Sensing::new(scenario);
        let exchange = Exchange::new(scenario).map_err(FlyError::Trim)?;
        let judge = Judge::new(scenario);
        let mut steering = Steering::new(scenario)?;
        ground.begin(&steering.tuning, world.plant.state());
        steering.wait(&mut session, world, ground)?;
        Ok(Self {
            told,
            sensing,
            exchange,
            trust: SensorStates::default(),
            judge,
            steering,
            log,
            ticks: scenario.ticks,
            advised: scenario.is_advised(),
            is_brief: false,
        })
    }

    /// Flies one tick. Returns `false` without a tick when the flight has ended.
    ///
    /// # Errors
    /// [`FlyError`] when the flight has no outcome.
    pub fn tick(
        &mut self,
        world: &mut World,
        link: &mut dyn Link,
        ground: &mut dyn Ground,
    ) -> Result<bool, FlyError> {
        if self.has_ended() || !self.obey(world, link, ground)? {
            return Ok(false);
        }
        let exchanged = self.exchange(world, link)?;
        let (wind, reply) = (world.plant.wind(), &exchanged.reply);
        let applied = match world.plant.step(control(&reply.command)) {
            // At an airspeed of zero there is no flight path any more. The flight is lost, and has an outcome.
            Err(PlantError::NonFiniteState | PlantError::Departed) => {
                self.judge.end = Some(Outcome::FlightPathLimit);
                return Ok(false);
            }
            stepped => stepped.map_err(FlyError::Plant)?,
        };
        let tick = Tick {
            applied,
            wind,
            ..logged(self.flown(), &exchanged.before, exchanged.measured, reply)
        };
        self.watch(&tick, &exchanged, world, ground);
        Ok(true)
    }

    /// Before the tick: moves the field and carries out the ground's orders. Returns whether the tick is flown.
    fn obey(
        &mut self,
        world: &mut World,
        link: &mut dyn Link,
        ground: &mut dyn Ground,
    ) -> Result<bool, FlyError> {
        let flown = self.flown();
        self.told.tick = flown;
        let mut session = Session {
            told: &mut self.told,
            link,
        };
        world.field.move_to(Scenario::time(flown));
        self.steering.obey(&mut session, world, ground)?;
        if self.steering.terminated {
            self.judge.end = Some(Outcome::Terminated);
        } else if ground.interrupts(flown) {
            self.judge.end = Some(Outcome::Interrupted);
        }
        Ok(self.judge.end.is_none())
    }

    /// Measures, scans, and gets the core's command.
    fn exchange(&mut self, world: &mut World, link: &mut dyn Link) -> Result<Exchanged, FlyError> {
        let flown = self.flown();
        let mut session = Session {
            told: &mut self.told,
            link,
        };
        let World {
            plant,
            field,
            lidar,
        } = world;
        let before = *plant.state();
        let (x, z) = plant.wind();
        let air = Wind { x, z };
        if self.advised {
            session.reveal(&before, air)?;
        }
        let sensing = &mut self.sensing;
        let (measured, frame) = sensing.measure(flown, &before, air);
        let shown = self
            .steering
            .scans(flown)
            .then(|| lidar.scan(&sensing.lidar_state(flown, &before), field.as_ref()))
            .and_then(|ranges| sensing.show(flown, &ranges));
        let passage = self.exchange.passage(flown);
        let seen = shown.clone().filter(|_| passage.to_core);
        let scan = sensing.scan(flown, shown);
        let mut reply = self.exchange.tick(&mut session, passage, scan, frame)?;
        self.steering.limit(&mut reply.command);
        Ok(Exchanged {
            before,
            measured,
            seen,
            reply,
        })
    }

    /// After the tick: judge, ground and log take it.
    fn watch(
        &mut self,
        tick: &Tick,
        exchanged: &Exchanged,
        world: &World,
        ground: &mut dyn Ground,
    ) {
        let reply = &exchanged.reply;
        let plan = reply.plan.as_ref().map(plan_entry);
        let record = TickRecord {
            tick,
            scan: exchanged.seen.as_ref(),
            plan: plan.as_ref(),
            report: reply.plan.as_ref(),
            trajectory: reply.trajectory.as_ref(),
            sensors: reply.step.map_or(self.trust, |step| step.sensors),
            health: reply.health.as_ref(),
            rejections: &self.told.rejections,
        };
        let flown = self.judge.flown;
        let holds_trim = reply.command.mode == ControlMode::TrimHold;
        let (field, after) = (world.field.as_ref(), world.plant.state());
        self.judge.watch(&record, field, after, holds_trim);
        ground.watch(&record);
        self.log.note_sensors(&self.trust, &record.sensors, flown);
        self.trust = record.sensors;
        if let Some(health) = record.health {
            self.log.health = counters(health);
        }
        if !self.is_brief {
            self.log.ticks.push(tick);
        }
        self.log.plans.extend(plan);
    }

    /// Ticks flown.
    #[must_use]
    pub fn flown(&self) -> u32 {
        self.judge.flown
    }

    /// Whether the flight has ended.
    #[must_use]
    pub fn has_ended(&self) -> bool {
        self.judge.flown >= self.ticks || self.judge.end.is_some()
    }

    /// The flight's parameters.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.log.header
    }

    /// The log so far. Of a flight that goes on it is the log of a flight that is interrupted now.
    #[must_use]
    pub fn log(&self, world: &World) -> FlightLog {
        FlightLog {
            rejections: self.told.rejections.clone(),
            orders: self.steering.orders.clone(),
            summary: self.summary(world),
            ..self.log.clone()
        }
    }

    /// Flies what is left of the flight.
    fn ended(
        mut self,
        world: &mut World,
        link: &mut dyn Link,
        ground: &mut dyn Ground,
    ) -> Result<FlightLog, FlyError> {
        while self.tick(world, link, ground)? {}
        Ok(FlightLog {
            summary: self.summary(world),
            rejections: self.told.rejections,
            orders: self.steering.orders,
            ..self.log
        })
    }

    fn summary(&self, world: &World) -> Summary {
        let open = if self.judge.flown < self.ticks {
            Outcome::Interrupted
        } else {
            Outcome::Survived
        };
        let outcome = self.judge.end.unwrap_or(open);
        let x_end = world.plant.state().x;
        let plans = &self.log.plans;
        self.judge
            .conclude(outcome, plans, world.field.as_ref(), x_end)
    }
}
