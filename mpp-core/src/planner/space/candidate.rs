//! Trajectories in space: as the pursuit of a path flies them, and as the controls of a program do.

use crate::config::{KNOTS, STAGE_PERIOD, STAGES};
use crate::control::follow;
use crate::tuning::space_limits;
use crate::tuning::space_take_over::TRUST;
use crate::vehicle::{
    GRAVITY, Loiter, SPACE_STATES, SpaceControl, SpaceModel, SpacePath, between, within,
};

/// Numbers of a state that no regulator holds to the plan's time.
const ALONG: usize = 0;
const AIRSPEED: usize = 3;
/// Least squared distance of the aim \[m^2\].
const LEAST_AIM: f64 = 9.0;
/// Least upward pull that the pursuit asks for [m/s^2]: the direction of the lift needs it.
const LEAST_UP: f64 = 0.5;
/// Shares of the greatest bank and of its rate that a roll-out may use [-]. Programs break soft rows by a little.
const BANK_BEYOND: f64 = 0.97;
const RATE_BEYOND: f64 = 0.95;
/// Least length of the first stage \[s\]. A shorter one is a part of the next.
const LEAST_STAGE: f64 = 0.03;
/// What sums of times may lack at a knot, in stages [-].
const ROUNDED: f64 = 1e-9;

/// When the knots of a plan are: 0.25 s apart, but for the first stage. A cycle keeps the knots of the plan before, so that its
/// controls stay what they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// Length of the first stage \[s\].
    first: f64,
}

impl Grid {
    /// All stages are as long.
    pub(super) const EVEN: Self = Self {
        first: STAGE_PERIOD,
    };

    /// The grid of a plan that begins a time \[s\] after the first knot of this one.
    pub(super) fn later(&self, time: f64) -> Self {
        let into = (time - self.first) / STAGE_PERIOD;
        let left = STAGE_PERIOD * (libm::ceil(into) - into);
        let more = if left < LEAST_STAGE {
            STAGE_PERIOD
        } else {
            0.0
        };
        Self { first: left + more }
    }

    /// Length of a stage \[s\].
    pub(super) fn period(&self, stage: usize) -> f64 {
        if stage == 0 { self.first } else { STAGE_PERIOD }
    }

    /// Time of a knot since the first one \[s\].
    pub(super) fn time(&self, knot: usize) -> f64 {
        match knot.checked_sub(1) {
            Some(more) => self.first + STAGE_PERIOD * more as f64,
            None => 0.0,
        }
    }

    /// The stage of a time since the first knot \[s\].
    fn stage(&self, time: f64) -> usize {
        ((time - self.first) / STAGE_PERIOD + (1.0 + ROUNDED)).max(0.0) as usize
    }
}

/// A trajectory in space: knots 0.25 s apart, but for the first stage, and the controls between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpacePlan {
    pub(super) grid: Grid,
    /// States at the knots.
    pub knots: [SpacePath; KNOTS],
    /// Controls of the stages.
    pub controls: [SpaceControl; STAGES],
}

impl SpacePlan {
    /// A plan of zeros with even stages, to be filled.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            grid: Grid::EVEN,
            knots: [SpacePath::ORIGIN; KNOTS],
            controls: [SpaceControl {
                bank_rate: 0.0,
                angle_of_attack_rate: 0.0,
                thrust: 0.0,
            }; STAGES],
        }
    }

    /// The plan that begins at a state, with a control that is chosen at the start of each stage.
    pub fn fly(
        &mut self,
        model: &SpaceModel,
        start: &SpacePath,
        mut choose: impl FnMut(usize, &SpacePath) -> SpaceControl,
    ) {
        let [first, ..] = &mut self.knots;
        *first = *start;
        for stage in 0..STAGES {
            self.fly_stage(stage, model, |state| choose(stage, state));
        }
    }

    /// Flies a stage from the knot at its beginning.
    pub(super) fn fly_stage(
        &mut self,
        stage: usize,
        model: &SpaceModel,
        choose: impl FnOnce(&SpacePath) -> SpaceControl,
    ) {
        let period = self.grid.period(stage);
        let control = self.controls.get_mut(stage);
        let knots = self.knots.get_mut(stage..);
        if let (Some([from, to, ..]), Some(control)) = (knots, control) {
            *control = choose(from);
            *to = from.after(model, control, period);
        }
    }

    /// Time from the first knot to the last one \[s\].
    #[must_use]
    pub fn length(&self) -> f64 {
        self.grid.time(STAGES)
    }

    /// State and control at a time \[s\] after the first knot. Beyond the last knot the flight is straight and level.
    #[must_use]
    pub fn at(&self, model: &SpaceModel, time: f64) -> (SpacePath, SpaceControl) {
        let time = time.max(0.0);
        let stage = self.grid.stage(time);
        let [.., last] = &self.knots;
        match (self.knots.get(stage), self.controls.get(stage)) {
            (Some(knot), Some(control)) => {
                let within = (time - self.grid.time(stage)).max(0.0);
                (knot.after(model, control, within), *control)
            }
            _ => {
                let beyond = time - self.grid.time(STAGES);
                let level = SpacePath {
                    angle_of_attack: model.trim.state.angle_of_attack(),
                    bank: 0.0,
                    flight_path: 0.0,
                    ..*last
                };
                let velocity = level.ground_velocity(&model.wind);
                let position =
                    core::array::from_fn(|axis| last.position[axis] + velocity[axis] * beyond);
                let thrust = model.trim.control.thrust;
                let control = SpaceControl {
                    thrust,
                    ..SpaceControl::default()
                };
                (SpacePath { position, ..level }, control)
            }
        }
    }
}

/// The state in which the next plan begins, if the aircraft deviates from what it follows: `planned`, moved by a
/// [share](TRUST) of the deviation; the regulator takes care of the rest. Along the track it is moved by all of it, because no
/// regulator holds the time of a plan.
#[must_use]
pub fn next_start(planned: &SpacePath, deviation: &[f64; SPACE_STATES]) -> SpacePath {
    let planned = planned.numbers();
    SpacePath::of(core::array::from_fn(|number| {
        let share = match number {
            ALONG | AIRSPEED => 1.0,
            _ => TRUST,
        };
        planned[number] + share * deviation[number]
    }))
}

/// As [`next_start`], on a circle: it is moved around the centre alone. A share across would move each plan before it has come back
/// to the circle, until the aircraft is some times its deviation off. Source: decision 76.
#[must_use]
pub fn next_start_on_circle(
    planned: &SpacePath,
    deviation: &[f64; SPACE_STATES],
    loiter: &Loiter,
) -> SpacePath {
    let [x, y, ..] = *deviation;
    let moved = loiter.moved(planned, [x, y]);
    SpacePath {
        airspeed: planned.airspeed + TRUST * deviation[AIRSPEED],
        ..moved
    }
}

impl Default for SpacePlan {
    fn default() -> Self {
        Self::new()
    }
}

/// Controls within the limits of roll-outs, of a stage of some length \[s\].
pub(super) fn limited(
    model: &SpaceModel,
    state: &SpacePath,
    wanted: &SpaceControl,
    period: f64,
) -> SpaceControl {
    let rate = within(wanted.bank_rate, RATE_BEYOND * model.bank_rate);
    let bank = within(state.bank + rate * period, BANK_BEYOND * model.bank);
    let rate = within(wanted.angle_of_attack_rate, model.angle_of_attack_rate);
    let aimed = state.angle_of_attack + rate * period;
    let reached = between(aimed, model.reachable_angles());
    SpaceControl {
        bank_rate: (bank - state.bank) / period,
        angle_of_attack_rate: (reached - state.angle_of_attack) / period,
        thrust: wanted.thrust.max(0.0).min(model.thrust_max),
    }
}

/// The control of a stage of some length \[s\] that tracks a plan: `now` is the plan's state at its beginning, `next` the one at
/// its end with the control between them. A deviation changes bank and angle of attack as it does by the regulator.
pub(super) fn tracking(
    model: &SpaceModel,
    state: &SpacePath,
    now: &SpacePath,
    (next, control): (&SpacePath, &SpaceControl),
    period: f64,
) -> SpaceControl {
    let [from, to] = [now, state].map(|it| follow(model, it, now, (next, control)));
    let [bank, attack] = core::array::from_fn(|at| to[at] - from[at]);
    let wanted = SpaceControl {
        bank_rate: (next.bank + bank - state.bank) / period,
        angle_of_attack_rate: (next.angle_of_attack + attack - state.angle_of_attack) / period,
        thrust: control.thrust,
    };
    limited(model, state, &wanted, period)
}

/// Flies along points that lie ahead of each other.
pub(super) struct Pursuit<'a> {
    points: &'a [[f64; 3]],
    /// The segment in which the aim lies.
    segment: usize,
    /// Distance ahead of the aim, in seconds of cruise \[s\].
    aim: f64,
}

impl<'a> Pursuit<'a> {
    pub(super) fn new(points: &'a [[f64; 3]], aim: f64) -> Self {
        Self {
            points,
            segment: 0,
            aim,
        }
    }

    /// The control of the next stage, of some length \[s\]: towards the point of the path some distance ahead, on a circle.
    pub(super) fn control(
        &mut self,
        model: &SpaceModel,
        state: &SpacePath,
        period: f64,
    ) -> SpaceControl {
        let at = state.position;
        let aim = self.point(at[0] + self.aim * model.trim.state.airspeed);
        let way: [f64; 3] = core::array::from_fn(|axis| aim[axis] - at[axis]);
        let square = dot(&way, &way).max(LEAST_AIM);
        let velocity = state.ground_velocity(&model.wind);
        let speed_squared = dot(&velocity, &velocity).max(1.0);
        let climb = between(velocity[2] / libm::sqrt(speed_squared), [-1.0, 1.0]);
        let course = libm::atan2(velocity[1], velocity[0]);
        let [_, up, right] = crate::vehicle::path_axes(libm::asin(climb), course);
        let turn = 2.0 * speed_squared / square;
        let up = turn * dot(&way, &up) + GRAVITY * libm::cos(state.flight_path);
        towards(model, state, [up, turn * dot(&way, &right)], period)
    }

    /// The point of the path at an x; beyond the end its last point, moved to this x.
    fn point(&mut self, x: f64) -> [f64; 3] {
        let last = self.points.len().saturating_sub(2);
        // The number of points bounds the loop.
        for _ in 0..self.points.len() {
            let next = self.points.get(self.segment + 1);
            if self.segment >= last || next.is_none_or(|next| next[0] >= x) {
                break;
            }
            self.segment += 1;
        }
        let from = self
            .points
            .get(self.segment)
            .copied()
            .unwrap_or([x, 0.0, 0.0]);
        let to = self.points.get(self.segment + 1).copied().unwrap_or(from);
        let share = between((x - from[0]) / (to[0] - from[0]).max(1e-3), [0.0, 1.0]);
        [
            x.max(from[0]),
            from[1] + share * (to[1] - from[1]),
            from[2] + share * (to[2] - from[2]),
        ]
    }
}

/// Rates that reach, within `dt` \[s\] and the limits, the bank and the angle of attack of a wanted acceleration across the
/// flight path, up and to the right [m/s^2].
#[must_use]
pub fn towards(
    model: &SpaceModel,
    state: &SpacePath,
    [up, right]: [f64; 2],
    dt: f64,
) -> SpaceControl {
    let most_bank = space_limits::BANK * model.bank;
    let [low, high] = model.angle_of_attack;
    let most = model.pull(state.airspeed, high, model.trim.control.thrust);
    let (mut upwards, mut sideways) = (up, right);
    if libm::hypot(up.max(0.0), right) > most {
        // The height is kept, and the turn is as tight as it can be.
        upwards = up.max(0.0).min(0.98 * most);
        let left = libm::sqrt((most * most - upwards * upwards).max(0.0));
        sideways = within(right, left);
    }
    let bank = within(libm::atan2(sideways, upwards.max(LEAST_UP)), most_bank);
    let pull = (up / libm::cos(bank).max(0.4)).max(0.0).min(most);
    let attack = model.angle_for(state.airspeed, pull).max(low).min(high);
    SpaceControl {
        bank_rate: within(
            (bank - state.bank) / dt,
            space_limits::RATE * model.bank_rate,
        ),
        angle_of_attack_rate: within(
            (attack - state.angle_of_attack) / dt,
            model.angle_of_attack_rate,
        ),
        thrust: model.thrust_for(state.airspeed, attack, state.flight_path),
    }
}

pub(super) fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
