//! A flight of the planner in space: plant in six degrees of freedom, sensors, estimator, lidar, planner and regulator.

use super::lidar::Beam;
use super::navigator::{Deskew, Navigator};
use super::sensors::{SensorErrors, true_path};
use super::{Pose, SpaceAircraft, SpaceState, WindConfig, lateral, regulator};
use crate::file_error::ScenarioError;
use crate::scenario::Scenario;
use mpp_core::config::TICK_PERIOD;
use mpp_core::control::{SpaceMotion, SpaceRegulator};
use mpp_core::estimate::SpaceEstimator;
use mpp_core::map::VoxelGrid;
use mpp_core::planner::space::{Keep, SpacePlan, SpacePlanner};
use mpp_core::vehicle::{Control, LateralControl, SpaceControl, SpaceModel, SpacePath};

/// How a planner flies in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceConfig {
    /// Distances and heights that plans keep.
    pub keep: Keep,
    /// Greatest bank of plans \[rad\], and its rate [rad/s].
    pub bank: [f64; 2],
    /// Ticks from one plan to the next, and from the start of a cycle until its plan is flown.
    pub replan_ticks: u32,
    /// See [`Self::replan_ticks`].
    pub latency_ticks: u32,
    /// Candidates of a cycle, and whether programs improve them.
    pub candidates: usize,
    /// See [`Self::candidates`].
    pub programs: bool,
    /// Reach of the lidar \[m\], and duration of a sweep \[s\].
    pub sight: f64,
    /// See [`Self::sight`].
    pub sweep: f64,
    /// How beams find their poses.
    pub deskew: Deskew,
    /// Time by which bank and angle of attack follow their commands \[s\]: the plan is followed so much ahead.
    pub ahead: f64,
    /// Errors of the sensors; without them the flight knows its true motion.
    pub errors: Option<SensorErrors>,
    /// Motion of the air.
    pub wind: WindConfig,
}

/// A flight in progress.
pub struct SpaceFlight {
    config: SpaceConfig,
    aircraft: SpaceAircraft,
    navigator: Navigator,
    regulator: SpaceRegulator,
    map: Box<VoxelGrid>,
    planner: Box<SpacePlanner>,
    /// The plan that is flown, and the next one.
    plan: Option<Planned>,
    next: Option<Planned>,
    /// Tick of the first cycle.
    first_cycle: Option<i64>,
    /// Last command to the surfaces.
    surfaces: LateralControl,
    tick: i64,
}

/// A plan in its time and its wind.
#[derive(Clone, Debug)]
struct Planned {
    plan: SpacePlan,
    /// Tick of its first knot.
    first: i64,
    /// The model of the aircraft with the wind of the plan.
    model: SpaceModel,
}

impl Planned {
    /// Time from the first knot to a tick \[s\].
    fn age(&self, tick: i64) -> f64 {
        (tick - self.first) as f64 * TICK_PERIOD
    }
}

impl SpaceFlight {
    /// A flight at its start.
    ///
    /// # Errors
    /// [`ScenarioError`] when the aircraft has no lateral table, or no level flight.
    pub fn new(scenario: &Scenario, config: SpaceConfig) -> Result<Self, ScenarioError> {
        let mut aircraft = SpaceAircraft::new(scenario, config.wind)?;
        aircraft.start_at(config.keep.altitude);
        let known = &scenario.aircraft.known;
        let stall = scenario.aircraft.file.lift.stall.unwrap_or(f64::INFINITY);
        let thrust = scenario.aircraft.actuators.thrust_max;
        let model = SpaceModel::new(
            &known.airframe,
            known.cruise,
            stall,
            thrust.unwrap_or(f64::INFINITY),
            config.bank,
        )
        .map_err(|error| ScenarioError::Value("aircraft", error.to_string()))?;
        let mut map = Box::new(VoxelGrid::new());
        map.clear(aircraft.state().plane.x);
        let mut planner = Box::new(SpacePlanner::new(model, config.keep));
        planner.choose(config.candidates, config.programs);
        Ok(Self {
            navigator: Navigator::new(
                scenario.seed,
                config.errors,
                (&model, &lateral(scenario)?.airframe()),
                config.wind.steady,
                config.deskew,
            ),
            regulator: SpaceRegulator::new(&known.airframe, regulator(scenario)?, &model),
            config,
            aircraft,
            map,
            planner,
            plan: None,
            next: None,
            first_cycle: None,
            surfaces: LateralControl::default(),
            tick: 0,
        })
    }

    /// The true state.
    #[must_use]
    pub fn state(&self) -> &SpaceState {
        self.aircraft.state()
    }

    /// The plan that is flown.
    #[must_use]
    pub fn plan(&self) -> Option<&SpacePlan> {
        self.plan.as_ref().map(|it| &it.plan)
    }

    /// The planner, after its last cycle.
    #[must_use]
    pub fn planner(&self) -> &SpacePlanner {
        &self.planner
    }

    /// The estimator, unless the flight knows its true motion.
    #[must_use]
    pub fn estimator(&self) -> Option<&SpaceEstimator> {
        self.navigator.estimator()
    }

    /// Flies one tick. `sweep` gives the beams of the lidar for the true poses at times from the start of a sweep \[s\], when a
    /// cycle begins.
    ///
    /// # Errors
    /// [`crate::plant::PlantError`] when the plant cannot step: an extreme state.
    pub fn step(
        &mut self,
        sweep: impl FnOnce(&dyn Fn(f64) -> Pose) -> Vec<Beam>,
    ) -> Result<(), crate::plant::PlantError> {
        self.navigator.step(&self.aircraft, &self.surfaces);
        let wind = self.navigator.wind();
        self.planner.set_wind(wind);
        if self.next.as_ref().is_some_and(|it| it.first <= self.tick) {
            self.plan = self.next.take();
        }
        if self.first_cycle.is_none() && self.navigator.covers(self.config.sweep) {
            self.first_cycle = Some(self.tick);
        }
        let since = self.first_cycle.map(|first| self.tick - first);
        if since.is_some_and(|it| it % i64::from(self.config.replan_ticks) == 0)
            && let Some(motion) = self.navigator.motion_in(&wind)
        {
            let now = Pose::of(self.aircraft.state());
            let period = self.config.sweep;
            let beams = sweep(&|time| self.navigator.true_pose(period - time).unwrap_or(now));
            let beams = self.navigator.placed(&beams, period);
            self.map
                .insert(&motion.path.position, &beams, self.config.sight);
            self.cycle(&motion);
        }
        let (command, lateral) = self.commands();
        self.aircraft.step(command, lateral)?;
        (self.surfaces, self.tick) = (lateral, self.tick + 1);
        Ok(())
    }

    /// The commands of this tick. A plan is followed in the wind for which it was made, so that a change of the estimated wind is
    /// no error of the velocity. Level flight before the motion is known.
    fn commands(&self) -> (Control, LateralControl) {
        let model = self
            .plan
            .as_ref()
            .map_or(self.planner.model(), |it| &it.model);
        let Some(motion) = self.navigator.motion_in(&model.wind) else {
            return (model.trim.control, LateralControl::default());
        };
        let (now, ahead) = self.reference(&motion);
        self.regulator
            .step(model, &motion, &now, (&ahead.0, &ahead.1))
    }

    /// Plans from where the aircraft will be when the plan is taken over.
    fn cycle(&mut self, motion: &SpaceMotion) {
        let latency = f64::from(self.config.latency_ticks) * TICK_PERIOD;
        let model = *self.planner.model();
        let (start, shift) = match &self.plan {
            Some(flown) => {
                let age = flown.age(self.tick);
                let (then, _) = flown.plan.at(&flown.model, age + latency);
                let (now, _) = flown.plan.at(&flown.model, age);
                let (then, now, here) = (then.numbers(), now.numbers(), motion.path.numbers());
                let moved = core::array::from_fn(|at| here[at] + then[at] - now[at]);
                (SpacePath::of(moved), age + latency)
            }
            None => {
                let level = SpaceControl {
                    thrust: model.trim.control.thrust,
                    ..SpaceControl::default()
                };
                (motion.path.after(&model, &level, latency), 0.0)
            }
        };
        // The last plan of the planner is the next one to be flown; it may have begun later than the flown one.
        let next = self.next.as_ref();
        let shift = next.map_or(shift, |it| it.age(self.tick) + latency);
        self.planner.begin(&start, shift);
        while !self.planner.advance(&self.map) {}
        if let Some((plan, _)) = self.planner.best() {
            self.next = Some(Planned {
                plan: *plan,
                first: self.tick + i64::from(self.config.latency_ticks),
                model,
            });
        }
    }

    /// The plan's state now, and state and control ahead. Without a plan: straight and level.
    fn reference(&self, motion: &SpaceMotion) -> (SpacePath, (SpacePath, SpaceControl)) {
        if let Some(flown) = &self.plan {
            let (plan, age) = (&flown.plan, flown.age(self.tick));
            return (
                plan.at(&flown.model, age).0,
                plan.at(&flown.model, age + self.config.ahead),
            );
        }
        let model = self.planner.model();
        let level = SpacePath {
            position: [motion.path.position[0], 0.0, self.config.keep.altitude],
            airspeed: model.trim.state.airspeed,
            angle_of_attack: model.trim.state.angle_of_attack(),
            ..SpacePath::default()
        };
        let control = SpaceControl {
            thrust: model.trim.control.thrust,
            ..SpaceControl::default()
        };
        (level, (level, control))
    }

    /// Distance of the true position from that of the plan \[m\].
    #[must_use]
    pub fn tracking_error(&self) -> Option<f64> {
        let flown = self.plan.as_ref()?;
        let (wanted, _) = flown.plan.at(&flown.model, flown.age(self.tick));
        let here = self.true_path().position;
        let off: [f64; 3] = core::array::from_fn(|axis| wanted.position[axis] - here[axis]);
        Some(libm::sqrt(off.iter().map(|it| it * it).sum()))
    }

    /// The true motion as a point mass sees it.
    #[must_use]
    pub fn true_path(&self) -> SpacePath {
        true_path(self.aircraft.state())
    }
}
