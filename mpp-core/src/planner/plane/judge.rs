//! The price of a roll-out, by which the planner ranks candidates: what it lacks of clearance in the map itself, the
//! unknown cells on its way, its effort, and the cost-to-go from the via station.

use super::PlanePlanner;
use crate::config::{KNOTS, STAGES};
use crate::trajectory::RollOut;
use crate::tuning::UNKNOWN_COST;
use crate::tuning::judgement::{FAR_SHARE, LACK_WEIGHT, LAST_STAGE, SAMPLES};

/// The price of a roll-out by its parts, and what it lacks of clearance. The parts add up to the price, up to
/// rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PriceParts {
    /// Cost of what is missing of the margin, of the wanted room and of the altitude band.
    pub clearance: f64,
    /// Cost of unknown cells near ahead.
    pub unknown: f64,
    /// Cost-to-go from the via station.
    pub cost_to_go: f64,
    /// The program's cost function.
    pub effort: f64,
    /// Worst lack of clearance, in own units of length.
    pub lack: f64,
}

/// A part to which a summand of the price belongs.
#[derive(Clone, Copy)]
enum Part {
    Clearance,
    Unknown,
    CostToGo,
}

/// Worst lack of clearance \[m\], effort, and the price that ranks candidates.
pub(super) struct Judgement {
    pub(super) lack: f64,
    pub(super) effort: f64,
    pub(super) price: f64,
}

impl PlanePlanner {
    /// Computes lack of clearance, effort and price of a roll-out.
    pub(super) fn judge(&self, flown: &RollOut) -> Judgement {
        self.add_up(flown, |_, _| {})
    }

    /// The parts of the price that [`Self::judge`] gives.
    pub(super) fn parts_of(&self, flown: &RollOut) -> PriceParts {
        let mut parts = PriceParts::default();
        let judgement = self.add_up(flown, |part, summand| match part {
            Part::Clearance => parts.clearance += summand,
            Part::Unknown => parts.unknown += summand,
            Part::CostToGo => parts.cost_to_go += summand,
        });
        PriceParts {
            effort: judgement.effort,
            lack: judgement.lack,
            ..parts
        }
    }

    /// Adds up the price, and tells `note` of each summand.
    fn add_up(&self, flown: &RollOut, mut note: impl FnMut(Part, f64)) -> Judgement {
        let (field, cost_to_go, own) = (&self.field, &self.cost_to_go, &self.settings);
        let via = cost_to_go.via();
        let [middle, half] = self.band;
        let unknown_ahead = self.limits.unknown_ahead;
        let (mut lack, mut price) = (0.0_f64, 0.0);
        let mut add = |part, summand: f64| {
            price += summand;
            note(part, summand);
        };
        for (stage, pair) in flown.knots.windows(2).enumerate() {
            let [from, to] = pair else { continue };
            let discount = 1.0 - LAST_STAGE * stage as f64 / STAGES as f64;
            let (run, rise) = (to.x - from.x, to.z - from.z);
            if from.x <= via && via < to.x {
                let slope = rise / run;
                let rest = cost_to_go.at(from.z + slope * (via - from.x), slope);
                add(Part::CostToGo, rest);
            }
            for sample in 1..=SAMPLES {
                let share = sample as f64 / SAMPLES as f64;
                let (x, z) = (from.x + run * share, from.z + rise * share);
                let weight = if x > via { FAR_SHARE } else { 1.0 };
                let outside = ((z - middle).abs() - half).max(0.0);
                let distance = field.distance(x, z);
                let missing = (own.margin - distance).max(0.0) + outside;
                let crowded = (self.limits.wanted_room - distance).max(0.0);
                lack = lack.max(missing);
                let lacking = weight * LACK_WEIGHT * discount * missing * missing;
                add(Part::Clearance, lacking);
                let crowding = weight * self.limits.room_weight * discount * crowded * crowded;
                add(Part::Clearance, crowding);
                let ahead = x - self.state.x;
                if ahead < unknown_ahead && field.is_unknown(x, z) {
                    let hidden = weight * UNKNOWN_COST * (1.0 - ahead / unknown_ahead);
                    add(Part::Unknown, hidden);
                }
            }
        }
        let effort = self.effort(flown);
        Judgement {
            lack,
            effort,
            price: price + effort,
        }
    }

    /// The program's cost function, applied to a roll-out with angles in radians.
    fn effort(&self, flown: &RollOut) -> f64 {
        let weights = &self.weights;
        let trim = &self.trim;
        let efforts = flown.controls.iter().map(|control| {
            let (rate, thrust) = (
                control.angle_of_attack_rate,
                control.thrust - trim.control.thrust,
            );
            weights.control[0] * (rate * rate) + weights.control[1] * (thrust * thrust)
        });
        let end = &flown.knots[KNOTS - 1];
        let missing = [
            end.z - self.altitude,
            end.airspeed - trim.state.airspeed,
            end.flight_path,
            end.angle_of_attack - trim.state.angle_of_attack(),
        ];
        let terminal: f64 = missing.iter().map(|missing| missing * missing).sum();
        0.5 * (efforts.sum::<f64>() + weights.terminal * terminal)
    }
}
