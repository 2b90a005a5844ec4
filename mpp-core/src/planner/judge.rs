//! What a roll-out is worth: its clearance in the map itself, what it does not know, its effort,
//! and the way on from where it leads.

use super::Planner;
use super::candidate::Candidate;
use crate::config::{KNOTS, STAGES};
use crate::plan::{ROOM, SIGHT};
use crate::settings::Iteration;

/// Points of a stage at which the clearance of a roll-out is looked at.
const SAMPLES: usize = 4;
/// Price of a squared lack of clearance [1/m^2], the last stage's being half of the first's.
const LACK_PRICE: f64 = 100.0;
/// Price of a point of which nothing is known, falling to nothing at the distance [`SIGHT`].
const UNKNOWN_PRICE: f64 = 5.0;

/// Share of these prices beyond the lattice's via station. By the time the aircraft is there, it flies
/// another plan: what the best path of the lattice costs on from there is added.
const FAR_SHARE: f64 = 0.5;

/// Worst lack of clearance [m], cost, and what ranks.
pub(super) struct Judgement {
    pub(super) lack: f64,
    pub(super) effort: f64,
    pub(super) price: f64,
}

impl Planner {
    /// What a roll-out is worth.
    pub(super) fn judge(&self, flown: &Candidate, iteration: &Iteration) -> Judgement {
        let field = &self.iterated.field;
        let lattice = &self.iterated.lattice;
        let via = lattice.via();
        let room_price = self.room_price();
        let (mut lack, mut price) = (0.0_f64, 0.0);
        for (stage, pair) in flown.knots.windows(2).enumerate() {
            let [from, to] = pair else { continue };
            let discount = 1.0 - 0.5 * stage as f64 / STAGES as f64;
            let (run, rise) = (to.x - from.x, to.z - from.z);
            if from.x <= via && via < to.x {
                let slope = rise / run;
                price += lattice.onward(from.z + slope * (via - from.x), slope);
            }
            for sample in 1..=SAMPLES {
                let share = sample as f64 / SAMPLES as f64;
                let (x, z) = (from.x + run * share, from.z + rise * share);
                let weight = if x > via { FAR_SHARE } else { 1.0 };
                let outside = ((z - self.settings.altitude).abs() - iteration.band).max(0.0);
                let distance = field.distance(x, z);
                let missing = (iteration.margin - distance).max(0.0) + outside;
                let crowded = (ROOM - distance).max(0.0);
                lack = lack.max(missing);
                price += weight * LACK_PRICE * discount * missing * missing;
                price += weight * room_price * discount * crowded * crowded;
                let ahead = x - self.state.x;
                if ahead < SIGHT && field.is_unknown(x, z) {
                    price += weight * UNKNOWN_PRICE * (1.0 - ahead / SIGHT);
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

    /// The program's cost of a roll-out, angles in radians.
    fn effort(&self, flown: &Candidate) -> f64 {
        let weights = &self.settings.weights;
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
            end.z - self.settings.altitude,
            end.airspeed - trim.state.airspeed,
            end.flight_path,
            end.angle_of_attack - trim.state.angle_of_attack(),
        ];
        let terminal: f64 = missing.iter().map(|missing| missing * missing).sum();
        0.5 * (efforts.sum::<f64>() + weights.terminal * terminal)
    }
}
