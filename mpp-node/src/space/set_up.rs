//! The set-up of a flight in space: what comes before the configuration, the configuration, and what follows from it.

use super::cycle::Flown;
use super::{Session, SpaceMemory, SpaceTask};
use crate::convert::{check, trim_verdict};
use hil_protocol::{
    Configure, ConfigureLateral, ConfigureReply, ConfigureSpace, ConfigureVerdict, Preset,
};
use mpp_core::control::{LateralRegulator, SpaceRegulator};
use mpp_core::estimate::SpaceEstimator;
use mpp_core::planner::space::Keep;
use mpp_core::vehicle::{
    Derivatives, LateralAirframe, LateralControl, Nose, SpaceModel, linearize_lateral,
};

/// Room that floor and ceiling must leave, and the sides \[m\]: some voxels.
const LEAST_ROOM: f64 = 1.0;
/// Greatest bank of plans \[rad\]: the lift of a steeper turn is beyond that of any wing.
const MOST_BANK: f64 = 1.4;
/// Time by which bank and angle of attack follow their commands \[s\]: the plan is followed so much ahead. More cuts corners, less
/// follows late. Source: decision 46; behind an autopilot, beside its dead time, decision 68.
const AHEAD: f64 = 0.12;
const AHEAD_OF_LOOPS: f64 = 0.05;
/// Greatest dead time of a roll loop \[s\]; that of the elevator.
const MOST_DEAD_TIME: f64 = 0.3;

impl SpaceTask {
    pub(super) fn take_lateral(&mut self, told: &ConfigureLateral, send: &mut impl FnMut(&[u8])) {
        let of_loop = |delay: f64| {
            (0.0..=MOST_DEAD_TIME).contains(&delay) && told.airframe.roll.aileron > 0.0
        };
        let sound = is_sound(&told.airframe)
            && told.roll_loop.is_none_or(of_loop)
            && (told.surfaces_max.iter().flatten()).all(|most| *most >= 0.0 && most.is_finite())
            && told
                .surface_rate
                .is_none_or(|rate| rate > 0.0 && rate.is_finite());
        let verdict = if self.session.is_some() {
            ConfigureVerdict::AlreadyConfigured
        } else if sound {
            self.lateral = Some(*told);
            ConfigureVerdict::Accepted
        } else {
            ConfigureVerdict::LateralAircraft
        };
        self.emit(&ConfigureReply { verdict }, send);
    }

    pub(super) fn take_limits(&mut self, told: &ConfigureSpace, send: &mut impl FnMut(&[u8])) {
        let verdict = if self.session.is_some() {
            ConfigureVerdict::AlreadyConfigured
        } else if leaves_room(told) {
            self.limits = Some(*told);
            ConfigureVerdict::Accepted
        } else {
            ConfigureVerdict::SpaceLimits
        };
        self.emit(&ConfigureReply { verdict }, send);
    }

    pub(super) fn configure(
        &mut self,
        told: &Configure,
        memory: &mut SpaceMemory<'_>,
        send: &mut impl FnMut(&[u8]),
    ) {
        let verdict = match self.prepare(told, memory) {
            Ok(()) => ConfigureVerdict::Accepted,
            Err(verdict) => verdict,
        };
        self.emit(&ConfigureReply { verdict }, send);
    }

    // Not inlined, so that a new flight is not on the stack of each tick.
    #[inline(never)]
    fn prepare(
        &mut self,
        told: &Configure,
        memory: &mut SpaceMemory<'_>,
    ) -> Result<(), ConfigureVerdict> {
        if self.session.is_some() {
            return Err(ConfigureVerdict::AlreadyConfigured);
        }
        if told.preset != Preset::Space {
            return Err(ConfigureVerdict::NoSuchPlanner);
        }
        check(told)?;
        if told.paths == 0 {
            return Err(ConfigureVerdict::PathsZero);
        }
        let (Some(lateral), Some(limits)) = (self.lateral, self.limits) else {
            return Err(ConfigureVerdict::LateralMissing);
        };
        let [low, high] = limits.heights;
        if !(low..=high).contains(&told.altitude) {
            return Err(ConfigureVerdict::SpaceLimits);
        }
        let mut model = model(told, &limits)?;
        let most = lateral.surfaces_max.map(|most| most.unwrap_or(f64::MAX));
        let airframe = &told.aircraft.airframe;
        let linear = linearize_lateral(airframe, &lateral.airframe, &model.trim);
        let [_, rudder] = most;
        model.nose = Nose::of(&linear).filter(|_| rudder <= 0.0);
        let (regulator, ahead) = match lateral.roll_loop {
            None => {
                let holds =
                    LateralRegulator::design(airframe, &lateral.airframe, &model.trim, most)
                        .map_err(|_| ConfigureVerdict::LateralGain)?;
                (SpaceRegulator::new(airframe, holds, &model), AHEAD)
            }
            Some(delay) => {
                let delay = delay.max(told.actuators.elevator_delay.unwrap_or(0.0));
                within_commands(&mut model, told);
                let regulator =
                    SpaceRegulator::behind_autopilot(airframe, &lateral.airframe, &model);
                (regulator, delay + AHEAD_OF_LOOPS)
            }
        };
        let keep = Keep {
            margin: limits.margin,
            half_span: limits.half_span,
            heights: limits.heights,
            half_width: limits.half_width,
            altitude: told.altitude,
        };
        memory.planner.set_up(model, keep);
        memory
            .planner
            .choose(usize::from(told.paths), limits.programs);
        self.sweep.clear();
        memory.map.clear(0.0);
        memory.map.cover(&limits.heights, told.altitude);
        self.session = Some(Session {
            configure: *told,
            open: limits.open,
            model,
            regulator,
            ahead,
            estimator: SpaceEstimator::new(&model, &lateral.airframe),
            surfaces: LateralControl::default(),
            inertial: None,
            position: None,
            last_tick: None,
            last_cycle: None,
            cycle: None,
            flown: Flown::none(&model),
            untold: None,
            unshown: false,
        });
        Ok(())
    }
}

/// Keeps the angles of attack of plans within those that the autopilot takes as commands.
fn within_commands(model: &mut SpaceModel, told: &Configure) {
    let level = model.trim.state.angle_of_attack();
    let [below, above] = told.actuators.angle_of_attack(&told.aircraft.airframe);
    let [low, high] = model.angle_of_attack;
    model.angle_of_attack = [low.max(level - below), high.min(level + above)];
}

fn model(told: &Configure, limits: &ConfigureSpace) -> Result<SpaceModel, ConfigureVerdict> {
    let aircraft = &told.aircraft;
    let thrust = told.actuators.thrust_max.unwrap_or(f64::INFINITY);
    let of = |stall| {
        SpaceModel::new(
            &aircraft.airframe,
            aircraft.cruise,
            stall,
            thrust,
            limits.bank,
        )
        .map_err(trim_verdict)
    };
    let model = of(f64::INFINITY)?;
    if model.trim.control.thrust > thrust {
        return Err(ConfigureVerdict::ThrustTooLow);
    }
    // The stall is told from level flight on.
    let level = model.trim.state.angle_of_attack();
    aircraft
        .stall
        .map_or(Ok(model), |beyond| of(level + beyond))
}

fn is_sound(told: &LateralAirframe) -> bool {
    let LateralAirframe {
        span,
        roll_inertia,
        yaw_inertia,
        product_inertia,
        side,
        roll,
        yaw,
    } = told;
    let finite = |it: &Derivatives| {
        [
            it.sideslip,
            it.roll_rate,
            it.yaw_rate,
            it.aileron,
            it.rudder,
        ]
        .iter()
        .all(|number| number.is_finite())
    };
    let positive = [*span, *roll_inertia, *yaw_inertia]
        .iter()
        .all(|number| *number > 0.0 && number.is_finite());
    // Without this the inertia is that of no body.
    let body = product_inertia * product_inertia < roll_inertia * yaw_inertia;
    positive && body && [side, roll, yaw].into_iter().all(finite)
}

fn leaves_room(told: &ConfigureSpace) -> bool {
    let [bank, bank_rate] = told.bank;
    let [low, high] = told.heights;
    let limits = bank > 0.0 && bank <= MOST_BANK && bank_rate > 0.0 && bank_rate.is_finite();
    let kept = told.margin >= 0.0 && told.half_span >= 0.0;
    // Comparisons with what is no number are false.
    let upright = low.is_finite() && high.is_finite() && high - low >= LEAST_ROOM;
    let aside = told.half_width.is_finite() && told.half_width - told.half_span >= LEAST_ROOM;
    limits && kept && told.margin.is_finite() && upright && aside
}
