//! Limits of the plans of one cycle.

use crate::settings::PlaneSettings;
use crate::tuning::{ROOM, UNKNOWN_AHEAD, UNKNOWN_STRETCH, faces, judgement, limits, open};
use crate::units::REFERENCE_CRUISE;
use crate::vehicle::{ActuatorLimits, Airframe, stall_sides};

/// Limits of plans. They follow from the settings, the actuators and the estimated airframe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Greatest distances of the angle of attack below and above trim in a program \[rad\].
    pub(super) angle_of_attack: [f64; 2],
    /// Whether elevator or stall is the limit below and above trim, so that no program may pass it.
    pub(super) held_by_elevator: [bool; 2],
    /// Greatest distances of the angle of attack below and above trim in a roll-out \[rad\]. They are larger
    /// than in a program, because its rows may be soft.
    pub(super) rolled_out: [f64; 2],
    /// Greatest rate of the angle of attack of a roll-out [rad/s].
    pub(super) turn_rate: f64,
    /// Greatest flight path angle \[rad\].
    pub(super) flight_path: f64,
    /// Greatest thrust \[N\].
    pub(super) thrust_max: f64,
    /// Greatest curvature of a path in level flight at cruise [1/m].
    pub(super) curvature: f64,
    /// Distance ahead beyond which an unknown point costs nothing \[m\].
    pub(super) unknown_ahead: f64,
    /// Clearance whose lack costs something \[m\].
    pub(super) wanted_room: f64,
    /// Weight of the squared lack of it [1/m^2].
    pub(super) room_weight: f64,
    /// Distance that a program keeps where its candidate already has that much room \[m\].
    pub(super) room: f64,
}

impl Limits {
    pub(super) const NONE: Self = Self {
        angle_of_attack: [0.0; 2],
        held_by_elevator: [false; 2],
        rolled_out: [0.0; 2],
        turn_rate: 0.0,
        flight_path: 0.0,
        thrust_max: 0.0,
        curvature: 0.0,
        unknown_ahead: UNKNOWN_AHEAD,
        wanted_room: ROOM,
        room_weight: 0.0,
        room: 0.0,
    };

    pub(super) fn new(own: &PlaneSettings, actuators: &ActuatorLimits, a: &Airframe) -> Self {
        let allowed = own.attitude.angle_of_attack;
        let rate = actuators.angle_of_attack_rate(a);
        let [below, above] = own.stall.map_or([f64::INFINITY; 2], |stall| {
            stall_sides(stall, a, REFERENCE_CRUISE)
        });
        let [down, up] =
            (actuators.angle_of_attack(a)).map(|held| held.min(rate * limits::REACH_TIME));
        // Elevator and stall bound the angle of attack alike.
        let held = [down.min(below), up.min(above)];
        // Angle of attack that the elevator balances for plans. The regulator needs the rest of the range.
        let angle_of_attack = held.map(|held| allowed.min(limits::PLANNED_SHARE * held));
        let [down, up] = angle_of_attack;
        // Share of the allowed angle of attack that the elevator balances for plans; at most 1.
        let agility = down.min(up) / allowed;
        let rolled_out = |side: usize| {
            let soft = limits::SOFT_SHARE * angle_of_attack[side] + limits::SOFT_EXTRA;
            soft.min(held[side])
        };
        // A turn that dodges an obstacle is longer by this factor, because its length is the root of twice the distance
        // to the side over the curvature.
        let farther = libm::sqrt(1.0 / agility).min(UNKNOWN_STRETCH);
        Self {
            angle_of_attack,
            held_by_elevator: angle_of_attack.map(|limit| limit < allowed),
            rolled_out: [rolled_out(0), rolled_out(1)],
            turn_rate: limits::PLANNED_RATE_SHARE * rate,
            flight_path: own.attitude.flight_path,
            thrust_max: own
                .thrust_max
                .min(actuators.thrust_max.unwrap_or(f64::INFINITY)),
            curvature: 0.5 * a.air_density * a.wing_area * a.lift_alpha * down.min(up) / a.mass
                * a.turn_gain(REFERENCE_CRUISE),
            unknown_ahead: UNKNOWN_AHEAD * farther,
            wanted_room: ROOM,
            // An agile aircraft corrects the effect of a gust at once. An aircraft that turns little needs
            // some room in reserve.
            room_weight: judgement::ROOM_WEIGHT * (1.0 - agility),
            room: own.margin * (1.0 / agility).min(faces::MOST_MARGINS),
        }
    }

    /// Asks for more room in open country: clearance costs nothing there. `openness` is the share of the map's cells ahead
    /// that are open.
    pub(super) fn widen(&mut self, margin: f64, openness: f64) {
        let share = libm::pow(openness, open::POWER);
        let weight = open::WEIGHT * share;
        if weight > self.room_weight {
            (self.wanted_room, self.room_weight) = (open::ROOM, weight);
        }
        let margins = (1.0 + open::MARGINS * share).min(open::MOST_MARGINS);
        self.room = self.room.max(margin * margins);
    }
}
