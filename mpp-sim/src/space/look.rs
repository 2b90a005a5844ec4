//! A flight in space as pictures need it: where it was, what each sweep hit, and what each cycle made of it.

use super::world::{Body, Terrain};
use super::{BaselineName, Pose, STACK, SpaceFile, SpaceFlight, SpacePipe, SpaceScenario};
use crate::file_error::{ScenarioError, ensure};
use crate::log::{FlightLog, Header};
use mpp_core::config::{KNOTS, STAGE_PERIOD};
use mpp_core::planner::space::SpacePlan;
use mpp_core::vehicle::SpaceModel;
use serde::Serialize;

/// Place \[m\], attitude, airspeed [m/s], and distance from the nearest thing \[m\], at most 5 m.
pub type Moment = ([f64; 3], [f64; 4], f64, f64);

/// The moment of a flight now.
#[must_use]
pub fn moment(flight: &SpaceFlight) -> Moment {
    let state = flight.state();
    let Pose { at, attitude } = Pose::of(state);
    (at, attitude.0, state.plane.air.airspeed, flight.gap())
}

/// A planning cycle: what the lidar showed, and what was made of it. Lengths are whole centimetres.
#[derive(Clone, Debug, Serialize)]
pub struct SpaceCycle {
    /// Ticks flown when it was done.
    pub tick: u32,
    /// Tick from which its plan is flown.
    pub due: u32,
    /// Tick of the first place of its paths.
    pub begins: u32,
    /// Where beams have ended: ahead, right, up, ahead, ..
    pub hits: Vec<i32>,
    /// The candidates, and last the plan: ahead, right, up each 0.25 s, and the bank [0.01 rad].
    pub paths: Vec<Vec<[i32; 4]>>,
}

impl SpaceCycle {
    /// The cycle of the last tick, if one began. A core in this process has done all of it by now.
    #[must_use]
    pub fn of(scenario: &SpaceScenario, flight: &SpaceFlight, link: &SpacePipe) -> Option<Self> {
        let hits = flight.returns()?;
        let tick = flight.flown();
        let mut paths = Vec::new();
        if let Some((planner, _)) = link.node().planner() {
            let best = planner.best().map(|(plan, _)| plan);
            let path = |plan| places(plan, planner.model());
            paths.extend(planner.candidates().chain(best).map(path));
        }
        let due = tick + scenario.plane.latency_ticks;
        Some(Self {
            tick,
            due,
            // Without a plan under way there are no paths.
            begins: link.node().begins().unwrap_or(due),
            hits: hits.iter().flatten().copied().map(hundredths).collect(),
            paths,
        })
    }
}

/// Knots of a plan are not evenly spaced, places are.
fn places(plan: &SpacePlan, model: &SpaceModel) -> Vec<[i32; 4]> {
    let places = (0..KNOTS).map(|at| {
        let (state, _) = plan.at(model, at as f64 * STAGE_PERIOD);
        let [x, y, z] = state.position;
        [x, y, z, state.bank].map(hundredths)
    });
    places.collect()
}

fn hundredths(value: f64) -> i32 {
    (100.0 * value).round() as i32
}

/// All that there is to see of a flight.
#[derive(Clone, Debug, Serialize)]
pub struct Look {
    /// What stood there at the start.
    pub bodies: Vec<Body>,
    /// The ground, if it is not level.
    pub terrain: Option<Terrain>,
    /// Span of the wing \[m\].
    pub span: f64,
    /// The start, and the moment after each tick.
    pub moments: Vec<Moment>,
    /// The planning cycles.
    pub cycles: Vec<SpaceCycle>,
}

impl Look {
    /// Flies a log again and looks. `None` if the flight does not come out the same to the last byte: another version, or a
    /// core that was not of this process.
    #[must_use]
    pub fn again(log: &FlightLog) -> Option<Self> {
        std::thread::scope(|scope| {
            let thread = std::thread::Builder::new().stack_size(STACK);
            let flown = thread.spawn_scoped(scope, || Self::flown(log)).ok()?;
            flown.join().ok()?
        })
    }

    fn flown(log: &FlightLog) -> Option<Self> {
        let scenario = scenario(&log.header).ok()?;
        let mut link = SpacePipe::of(&scenario);
        let mut flight = SpaceFlight::begin(&scenario, &mut link).ok()?;
        let mut look = Self {
            bodies: scenario.world.bodies().to_vec(),
            terrain: scenario.world.terrain().cloned(),
            span: (scenario.plane.aircraft.file.lateral.as_ref()).map_or(0.0, |it| it.span),
            moments: vec![moment(&flight)],
            cycles: Vec::new(),
        };
        let mut orders = log.orders.iter().peekable();
        // A flight that lasts longer than its log is not the same flight.
        for tick in 0..log.ticks.t.len() as u64 {
            while let Some(entry) = orders.next_if(|entry| entry.tick <= tick) {
                flight.obey(&scenario, &entry.order).ok()?;
            }
            flight.tick(&scenario, &mut link).ok()?;
            look.moments.push(moment(&flight));
            (look.cycles).extend(SpaceCycle::of(&scenario, &flight, &link));
        }
        (flight.log().hash().ok()? == log.hash().ok()?).then_some(look)
    }
}

/// The scenario of a log in space.
///
/// # Errors
/// [`ScenarioError`] if this build would write another header.
pub fn scenario(header: &Header) -> Result<SpaceScenario, ScenarioError> {
    let advice = "give the log of a flight in space";
    let no_space = || ScenarioError::Value("space", advice.to_owned());
    let space = header.space.clone().ok_or_else(no_space)?;
    let planner = space.baseline.is_none();
    let draws = space.baseline.as_deref() == Some(BaselineName::Paper.name());
    let trunk = |&(x, y, radius, height): &(f64, f64, f64, Option<f64>)| Body::Cylinder {
        x,
        y,
        radius,
        height: height.unwrap_or(f64::INFINITY),
    };
    let stems: Vec<Body> = space.stems.iter().map(trunk).collect();
    let file = SpaceFile {
        aircraft: Some(header.aircraft.clone()),
        candidates: u8::try_from(header.paths).ok().filter(|_| planner || draws),
        programs: Some(space.programs).filter(|_| planner),
        world: space.world,
        density: space.density,
        window: space.window,
        terrain: space.terrain,
        altitude: space.altitude,
        lidar: space.lidar,
        sight: Some(header.lidar.range_max),
        sphere: space.sphere,
        exact: Some(space.exact),
        see_through: Some(space.see_through),
        baseline: space.baseline,
        mode: space.mode,
        wind: space.wind,
        gusts: Some(header.faults.gusts.intensity),
        deskew: space.deskew,
        lidar_clock: space.lidar_clock,
        replan_hz: Some(header.replan_hz),
        latency_ms: Some((1000.0 * header.latency).round() as u32),
        seed: Some(header.seed),
        ..SpaceFile::default()
    };
    let scenario = file.build(Some(&*stems).filter(|stems| !stems.is_empty()))?;
    let same = scenario.header() == *header;
    ensure(same, "header", "give a log that this version has written")?;
    Ok(scenario)
}
