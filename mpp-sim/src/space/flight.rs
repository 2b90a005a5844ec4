//! A flight of the planner in space: plant in six degrees of freedom, lidar, estimate with errors, planner and regulator.

use super::errors::{EstimateErrors, SpaceEstimator, true_path};
use super::{SpaceAircraft, SpaceState, WindConfig, regulator};
use crate::file_error::ScenarioError;
use crate::scenario::Scenario;
use mpp_core::config::TICK_PERIOD;
use mpp_core::control::{SpaceMotion, SpaceRegulator};
use mpp_core::map::{SpaceBeam, VoxelGrid};
use mpp_core::planner::space::{Keep, SpacePlan, SpacePlanner};
use mpp_core::vehicle::{SpaceControl, SpaceModel, SpacePath};

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
    /// Reach of the lidar \[m\].
    pub sight: f64,
    /// Time by which bank and angle of attack follow their commands \[s\]: the plan is followed so much ahead.
    pub ahead: f64,
    /// Errors of the estimate.
    pub errors: EstimateErrors,
    /// Motion of the air.
    pub wind: WindConfig,
}

/// A flight in progress.
pub struct SpaceFlight {
    config: SpaceConfig,
    aircraft: SpaceAircraft,
    estimator: SpaceEstimator,
    regulator: SpaceRegulator,
    map: Box<VoxelGrid>,
    planner: Box<SpacePlanner>,
    /// The plan that is flown, and the tick of its first knot; the same for the next one.
    plan: Option<(SpacePlan, i64)>,
    next: Option<(SpacePlan, i64)>,
    tick: i64,
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
            estimator: SpaceEstimator::new(scenario.seed, config.errors, config.wind.steady),
            regulator: SpaceRegulator::new(&known.airframe, regulator(scenario)?, &model),
            config,
            aircraft,
            map,
            planner,
            plan: None,
            next: None,
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
        self.plan.as_ref().map(|(plan, _)| plan)
    }

    /// The planner, after its last cycle.
    #[must_use]
    pub fn planner(&self) -> &SpacePlanner {
        &self.planner
    }

    /// Flies one tick. `sweep` gives the beams of the lidar as the estimate places them, when a cycle begins.
    ///
    /// # Errors
    /// [`crate::plant::PlantError`] when the plant cannot step: an extreme state.
    pub fn step(
        &mut self,
        sweep: impl FnOnce(&SpaceState, [f64; 3]) -> Vec<SpaceBeam>,
    ) -> Result<(), crate::plant::PlantError> {
        let motion = self.estimator.step(&self.aircraft);
        self.planner.set_wind(self.estimator.wind());
        if self
            .next
            .as_ref()
            .is_some_and(|(_, start)| *start <= self.tick)
        {
            self.plan = self.next.take();
        }
        if self.tick % i64::from(self.config.replan_ticks) == 0 {
            let errors = self.estimator.attitude_errors();
            let beams = sweep(self.aircraft.state(), errors);
            self.map
                .insert(&motion.path.position, &beams, self.config.sight);
            self.cycle(&motion);
        }
        let (now, ahead) = self.reference(&motion);
        let model = *self.planner.model();
        let (command, lateral) = self
            .regulator
            .step(&model, &motion, &now, (&ahead.0, &ahead.1));
        self.aircraft.step(command, lateral)?;
        self.tick += 1;
        Ok(())
    }

    /// Plans from where the aircraft will be when the plan is taken over.
    fn cycle(&mut self, motion: &SpaceMotion) {
        let latency = f64::from(self.config.latency_ticks) * TICK_PERIOD;
        let model = *self.planner.model();
        let (start, shift) = match &self.plan {
            Some((plan, first)) => {
                let age = (self.tick - first) as f64 * TICK_PERIOD;
                let (then, _) = plan.at(&model, age + latency);
                let (now, _) = plan.at(&model, age);
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
        let shift = self.next.as_ref().map_or(shift, |(_, first)| {
            (self.tick - first) as f64 * TICK_PERIOD + latency
        });
        self.planner.begin(&start, shift);
        while !self.planner.advance(&self.map) {}
        if let Some((plan, _)) = self.planner.best() {
            self.next = Some((*plan, self.tick + i64::from(self.config.latency_ticks)));
        }
    }

    /// The plan's state now, and state and control ahead. Without a plan: straight and level.
    fn reference(&self, motion: &SpaceMotion) -> (SpacePath, (SpacePath, SpaceControl)) {
        let model = self.planner.model();
        if let Some((plan, first)) = &self.plan {
            let age = (self.tick - first) as f64 * TICK_PERIOD;
            return (
                plan.at(model, age).0,
                plan.at(model, age + self.config.ahead),
            );
        }
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
        let (plan, first) = self.plan.as_ref()?;
        let age = (self.tick - first) as f64 * TICK_PERIOD;
        let (wanted, _) = plan.at(self.planner.model(), age);
        let flown = self.true_path().position;
        let off: [f64; 3] = core::array::from_fn(|axis| wanted.position[axis] - flown[axis]);
        Some(libm::sqrt(off.iter().map(|it| it * it).sum()))
    }

    /// The true motion as a point mass sees it.
    #[must_use]
    pub fn true_path(&self) -> SpacePath {
        true_path(self.aircraft.state())
    }
}
