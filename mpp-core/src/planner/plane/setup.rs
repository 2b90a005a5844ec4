//! The set-up of the plane planner and the checks of its settings.

use super::super::error::{SetupError, check, check_planner};
use super::rungs::Ladder;
use super::workspace::Workspace;
use super::{Phase, PlanePlanner};
use crate::config::{STAGE_PERIOD, STAGES};
use crate::settings::{Method, PlaneSettings, PlannerSettings, Setting, Settings};
use crate::vehicle::{ThrustLag, VehicleState};

impl PlanePlanner {
    /// Sets the planner up; see [`crate::planner::Planner::set_up`].
    ///
    /// # Errors
    /// [`SetupError`]: the planner then plans nothing.
    // Not inlined, so that the deep stack of the set-up is not that of a cycle.
    #[inline(never)]
    pub fn set_up(&mut self, settings: &Settings, own: &PlaneSettings) -> Result<(), SetupError> {
        // If a check below fails, the planner is not set up completely and must plan nothing.
        self.ready = false;
        self.phase = Phase::Idle;
        let planner = &settings.planner;
        let trim = check(settings)?;
        let elevator = trim.control.elevator;
        if !(settings.airframe.angle_of_attack_for(elevator)).is_finite() {
            return Err(SetupError::NoSteadyState);
        }
        self.units = settings.units;
        self.si_airframe = settings.airframe.balanced();
        self.known = (
            self.units.own_airframe(&self.si_airframe),
            self.units.own_trim(&trim),
        );
        (self.airframe, self.trim) = self.known;
        self.actuators = self.units.own_actuators(&settings.actuators);
        self.lag = ThrustLag::new(&self.actuators, STAGE_PERIOD);
        self.weights = planner.weights;
        let level = trim.state.angle_of_attack();
        self.gate.set_up(settings, own, level, trim.state.airspeed);
        self.adopt(planner, own);
        self.try_program()?;
        // A flight computer hands over zeroed memory, so the code must not rely on the values of `new`.
        self.solver.problem.bounds.clear();
        self.ready = true;
        self.map.clear();
        self.lidar_distrusted = false;
        self.monitor.start();
        self.seen = f64::INFINITY;
        self.best.clear();
        self.ladder = Ladder::NEW;
        Ok(())
    }

    /// Takes over number of paths, altitude, penalty, attitude limits and latency.
    pub(in crate::planner) fn retune(
        &mut self,
        planner: &PlannerSettings,
        own: &PlaneSettings,
    ) -> Result<(), SetupError> {
        check_planner(&PlannerSettings {
            method: Method::Plane(*own),
            ..*planner
        })?;
        let horizon = STAGES as f64 * STAGE_PERIOD * self.units.time;
        if !(0.0..=horizon).contains(&own.latency) {
            return Err(SetupError::OutOfRange(Setting::Latency));
        }
        let kept = self.settings;
        self.adopt(planner, own);
        self.settings = PlaneSettings {
            penalty: self.settings.penalty,
            attitude: self.settings.attitude,
            latency: self.settings.latency,
            ..kept
        };
        Ok(())
    }

    fn adopt(&mut self, planner: &PlannerSettings, own: &PlaneSettings) {
        self.paths = planner.paths;
        self.destination = planner.altitude / self.units.length;
        self.settings = self.units.own_settings(own);
    }

    /// Checks that the program of level cruise has an optimum with this airframe and these weights.
    fn try_program(&mut self) -> Result<(), SetupError> {
        self.altitude = self.destination;
        self.state = VehicleState {
            x: 0.0,
            z: self.altitude,
            air: self.trim.state,
        };
        self.thrust = self.trim.control.thrust;
        let cruising = self.cruising();
        let frame = self.frame();
        self.workspace = Workspace::NEW;
        let Workspace::Program(shared) = &mut self.workspace else {
            return Ok(());
        };
        shared
            .condense_varying(&self.weights, |dynamics| {
                frame.linearise(&cruising, dynamics);
            })
            .map_err(SetupError::Condense)
    }
}
