//! Effect of the elevator, seen by the turns that the plan's own commands miss.
//!
//! With an elevator of `k` times the known effect the aircraft turns `k` times as much as a command should turn it, so the
//! missing part of the pitch is `k - 1` times the response to the command. A plain regression on the command would take
//! gusts for a weak elevator, because the regulator answers gusts. The plan's own command does not know them. It is the
//! instrument of this regression (Söderström and Stoica, "System Identification", chapter 8).
//!
//! A pitch sensor that fails misses turns too. [`PitchMonitor`] tells it from the elevator by the altitude.

use super::{PitchMonitor, Trust, Turn};
use crate::tuning::elevator::{
    FADE, LEAST_EFFECT, LEAST_RESPONSE, MEMORY, MOST_MISSING, NEW_FOR, PROVEN_ERROR, PROVEN_FOR,
    PROVEN_MISSING, SIGMAS, SILENT, WEAK,
};
use crate::vehicle::{AirState, Airframe, Control, GRAVITY, Trim};

/// Estimator of the elevator's effect. It compares with an airframe in balance at each elevator command.
#[derive(Clone, Copy, Debug)]
pub struct ElevatorEffect {
    /// Lift coefficient at no angle of attack [-], and its slope [1/rad].
    lift_zero: f64,
    lift_alpha: f64,
    /// Turn of the path by a unit of lift coefficient at an airspeed of 1 m/s [rad/s].
    per_lift: f64,
    /// Mass \[kg\].
    mass: f64,
    /// Elevator command of level trim, and the angle of attack \[rad\] there.
    trim: f64,
    trim_angle: f64,
    /// Angle of attack in the turn that a unit of command gives \[rad\].
    per_unit: f64,
    /// Time constant with which the angle of attack follows the command \[s\]. The damping of the pitch delays it.
    lag: f64,
    /// Pitch that the known elevator would give \[rad\].
    expected: Option<f64>,
    given: Response,
    planned: Response,
    regression: Regression,
    pitch: PitchMonitor,
    /// Time for which the regression has shown another effect \[s\].
    shown: f64,
    /// Whether the elevator has answered as it should since the effect was last set.
    proven: bool,
    silent: bool,
    /// Share of the known effect [-].
    effect: f64,
}

impl ElevatorEffect {
    /// An elevator with the known effect.
    #[must_use]
    pub fn new(known: &Airframe, trim: &Trim) -> Self {
        let airframe = known.balanced();
        let damping = airframe.moment_alpha_rate + airframe.moment_pitch_rate;
        // A turn damps the pitch, so a command turns less than it would balance.
        let stiffness = known.turn_stiffness(trim.state.airspeed);
        Self {
            trim: trim.control.elevator,
            trim_angle: airframe.angle_of_attack_for(trim.control.elevator),
            per_unit: -airframe.moment_elevator / stiffness,
            lag: (damping / stiffness).max(0.0),
            lift_zero: airframe.lift_zero,
            lift_alpha: airframe.lift_alpha,
            per_lift: 0.5 * airframe.air_density * airframe.wing_area / airframe.mass,
            mass: airframe.mass,
            expected: None,
            given: Response::default(),
            planned: Response::default(),
            regression: Regression::default(),
            pitch: PitchMonitor::new(),
            shown: 0.0,
            proven: false,
            silent: false,
            effect: 1.0,
        }
    }

    /// Share of the known effect [-].
    #[must_use]
    pub fn effect(&self) -> f64 {
        self.effect
    }

    /// Whether the pitch sensor fails by what the altitude shows.
    #[must_use]
    pub fn pitch_fails(&self) -> bool {
        self.pitch.fails()
    }

    /// Angle of attack that the commands give \[rad\].
    #[must_use]
    pub fn angle_of_attack(&self) -> f64 {
        self.trim_angle + self.given.angle
    }

    /// The trust in the elevator: suspected if its effect is corrected, excluded while it does not answer.
    #[must_use]
    pub fn trust(&self) -> Trust {
        match self.silent {
            true => Trust::Excluded,
            false if self.effect < 1.0 => Trust::Suspected,
            false => Trust::Healthy,
        }
    }

    /// The controls of the known aircraft that do what these commands do.
    #[must_use]
    pub fn effective(&self, command: Control) -> Control {
        if self.effect < 1.0 {
            let elevator = self.trim + self.effect * (command.elevator - self.trim);
            Control {
                elevator,
                ..command
            }
        } else {
            command
        }
    }

    /// The commands that do what these controls of the known aircraft do.
    #[must_use]
    pub fn command_for(&self, effective: Control) -> Control {
        if self.effect < 1.0 {
            let elevator = self.trim + (effective.elevator - self.trim) / self.effect;
            Control {
                elevator,
                ..effective
            }
        } else {
            effective
        }
    }

    /// Takes in the measured pitch \[rad\] and the altitude \[m\] after a further `period` \[s\], the motion, the offset of the
    /// lift coefficient, the effective controls since then and the elevator command of the plan.
    pub fn update(
        &mut self,
        (pitch, altitude): (f64, f64),
        air: &AirState,
        lift_offset: f64,
        effective: Control,
        planned: f64,
        period: f64,
    ) {
        let inputs = [
            pitch,
            altitude,
            lift_offset,
            effective.thrust,
            effective.elevator,
            planned,
        ];
        if !(air.is_finite() && inputs.iter().all(|input| input.is_finite())) {
            return;
        }
        let per_lift = self.per_lift * air.airspeed;
        let turn = per_lift * self.lift_alpha;
        let given = self.per_unit * (effective.elevator - self.trim);
        let turned = self.given.advance(given, self.lag, turn, period);
        let angle = self.angle_of_attack();
        let lift = self.lift_zero + lift_offset + self.lift_alpha * angle;
        let push = effective.thrust * angle / self.mass;
        // The cosine of the flight path angle, to 2 % at 45 degrees.
        let weight = GRAVITY * (1.0 - 0.5 * (air.flight_path * air.flight_path));
        let path_rate = per_lift * lift + (push - weight) / air.airspeed;
        let (planned_angle, before) = (self.per_unit * (planned - self.trim), self.expected);
        self.planned.advance(planned_angle, self.lag, turn, period);
        let before = before.unwrap_or(pitch);
        let expected = before + turned + period * (path_rate + (pitch - before) / FADE);
        let seen = Turn {
            pitch,
            altitude,
            unexpected: pitch - expected,
            path_rate,
            path_slope: turn,
            airspeed: air.airspeed,
        };
        self.pitch.update(&seen, period);
        // No turn is faster than the bound. Beyond it the comparison begins again.
        let is_turn = libm::fabs(pitch - expected) < MOST_MISSING;
        self.expected = is_turn.then_some(expected);
        if !is_turn {
            return;
        }
        let (given, planned) = (self.given.pitch, self.planned.pitch);
        self.regression
            .take([pitch - expected, given, planned], period);
        self.judge(period);
    }

    /// Sets the effect to what the regression has shown for long enough.
    fn judge(&mut self, period: f64) {
        let Some((missing, variance)) = self.regression.slope() else {
            (self.shown, self.silent) = (0.0, false);
            return;
        };
        let answers =
            libm::fabs(missing) < PROVEN_MISSING && variance < PROVEN_ERROR * PROVEN_ERROR;
        self.proven |= answers;
        if answers {
            self.pitch.believe();
        }
        let sure = missing * missing > SIGMAS * SIGMAS * variance && !self.pitch.fails();
        let none = sure && missing < -SILENT;
        self.silent = none && !self.pitch.is_undecided();
        let less = missing < -WEAK && !none;
        let more = missing > WEAK && self.effect < 1.0;
        self.shown = if sure && (less || more) {
            self.shown + period
        } else {
            0.0
        };
        let enough = if self.proven { PROVEN_FOR } else { NEW_FOR };
        if self.shown > enough {
            let effect = (self.effect * (1.0 + missing)).max(LEAST_EFFECT);
            let is_known = effect > 1.0 - PROVEN_MISSING;
            self.effect = if is_known { 1.0 } else { effect };
            self.regression = Regression::default();
            (self.shown, self.proven) = (0.0, false);
        }
    }
}

/// Response of the pitch to an angle of attack alone.
#[derive(Clone, Copy, Debug, Default)]
struct Response {
    /// Angle of attack \[rad\].
    angle: f64,
    /// Pitch \[rad\]. It fades, so that only turns count.
    pitch: f64,
}

impl Response {
    /// Moves on by `period` \[s\] to an angle of attack \[rad\] that comes with a `lag` \[s\] and turns the path by `turn`
    /// times itself per second. Gives the change of the angle of attack.
    fn advance(&mut self, angle: f64, lag: f64, turn: f64, period: f64) -> f64 {
        let change = period / (lag + period) * (angle - self.angle);
        self.angle += change;
        self.pitch += change + period * (turn * self.angle - self.pitch / FADE);
        change
    }
}

/// Regression of the missing pitch on the response to the command, with the response to the plan as instrument.
#[derive(Clone, Copy, Debug, Default)]
struct Regression {
    /// Time over which the means were taken \[s\].
    seen: f64,
    /// Means of missing pitch, response to the command and response to the plan \[rad\].
    means: [f64; 3],
    /// Their covariances [rad^2].
    covariances: [[f64; 3]; 3],
}

impl Regression {
    fn take(&mut self, values: [f64; 3], period: f64) {
        self.seen = (self.seen + period).min(MEMORY);
        let share = (period / self.seen).min(1.0);
        let mut off = values;
        for (mean, value) in self.means.iter_mut().zip(&mut off) {
            *value -= *mean;
            *mean += share * *value;
        }
        for (row, left) in self.covariances.iter_mut().zip(off) {
            for (covariance, right) in row.iter_mut().zip(off) {
                *covariance += share * ((1.0 - share) * left * right - *covariance);
            }
        }
    }

    /// Missing share of the response [-], and its variance. `None` if the response was too small.
    fn slope(&self) -> Option<(f64, f64)> {
        let [
            [missing, both, _],
            [_, given, _],
            [by_missing, by_given, planned],
        ] = self.covariances;
        if by_given < LEAST_RESPONSE {
            return None;
        }
        let slope = by_missing / by_given;
        let rest = missing - slope * (2.0 * both - slope * given);
        // The residual changes within the time of fading. One value in each such time is independent.
        let variance = rest.max(0.0) * planned * (FADE / self.seen);
        Some((slope, variance / (by_given * by_given)))
    }
}
