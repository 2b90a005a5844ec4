//! The angles of attack that keep a margin to the stall.

use super::{AirState, Airframe, Control, Trim};
use crate::tuning::limits::{STALL_LEAD, STALL_LEAST_SHARE, STALL_ROOM, STALL_SHARE};

/// Distances of the angle of attack below and above level flight that keep a margin to the stall \[rad\]. The wing stalls `stall`
/// \[rad\] above level flight at an airspeed [m/s], and as far below the angle of no lift as that is above it.
#[must_use]
pub fn stall_sides(stall: f64, airframe: &Airframe, airspeed: f64) -> [f64; 2] {
    let below = stall + 2.0 * airframe.level_lift(airspeed) / airframe.lift_alpha;
    [below, stall].map(|side| {
        let share = (STALL_SHARE * side).min(side - STALL_ROOM);
        share.max(STALL_LEAST_SHARE * side)
    })
}

/// The regulator's guard against the stall, because the elevator alone could balance the aircraft beyond the stall, and a wing
/// that pitches up swings through. It bounds the elevator by the angle of attack that is there, and by the one that will be
/// there when the elevator acts.
#[derive(Clone, Copy, Debug)]
pub struct StallGuard {
    /// Elevator command and angle of attack \[rad\] of level flight.
    trim: [f64; 2],
    /// Least and greatest angle of attack \[rad\].
    limits: [f64; 2],
    /// Angle of attack in the turn that a unit of the command gives \[rad\].
    per_unit: f64,
    /// Share of the moments by which a turn damps the pitch [-].
    damped: f64,
    /// Angle of attack above that of no lift that carries the weight at an airspeed of 1 m/s [rad m^2/s^2], and at the trim's
    /// airspeed \[rad\].
    carries: [f64; 2],
    /// Path rate of an angle of attack above level flight [1/s].
    path_rate: f64,
    /// Time that the angle of attack takes to follow the elevator \[s\].
    lead: f64,
}

impl StallGuard {
    /// A guard for an airframe that stalls `stall` \[rad\] above its level trim.
    #[must_use]
    pub fn new(stall: f64, airframe: &Airframe, trim: &Trim) -> Self {
        let level = trim.state.angle_of_attack();
        let [below, above] = stall_sides(stall, &airframe.balanced(), trim.state.airspeed);
        let a = airframe;
        let speed = trim.state.airspeed;
        let flow = 0.5 * a.air_density * a.wing_area * speed;
        // A turn damps the pitch, so a command gives less angle than it would balance.
        let moment = a.turn_stiffness(speed);
        let stiffness = -flow * speed * a.moment_length * moment / a.pitch_inertia;
        Self {
            trim: [trim.control.elevator, level],
            limits: [level - below, level + above],
            per_unit: -a.moment_elevator / moment,
            damped: 1.0 - a.moment_alpha / moment,
            carries: [1.0, speed].map(|speed| a.level_lift(speed) / a.lift_alpha),
            path_rate: flow * a.lift_alpha / a.mass,
            lead: 1.0 / libm::sqrt(stiffness),
        }
    }

    /// The nearest command that does not bring the aircraft from this motion to the stall.
    #[must_use]
    pub fn within(&self, mut command: Control, air: &AirState) -> Control {
        let [elevator, level] = self.trim;
        let there = air.angle_of_attack();
        // The slower the aircraft, the less an angle turns it, and the less the turn damps the pitch.
        let [carries, at_trim] = self.carries;
        // Beyond the greatest angle nothing carries it.
        let [least, most] = self.limits;
        let slower = (carries / (air.airspeed * air.airspeed) - at_trim).min(most - level);
        let rate = air.pitch_rate - self.path_rate * (there - level - slower);
        let soon = there + self.lead * rate;
        let still = level + self.damped * slower;
        let balanced = still + self.per_unit * (command.elevator - elevator);
        // The rate may only tighten a limit.
        let least = least + STALL_LEAD * (least - there.min(soon));
        let most = most + STALL_LEAD * (most - there.max(soon));
        let kept = balanced.min(most).max(least);
        // A command within the limits keeps its bits.
        if libm::fabs(kept - balanced) > 0.0 {
            command.elevator = elevator + (kept - still) / self.per_unit;
        }
        command
    }
}
