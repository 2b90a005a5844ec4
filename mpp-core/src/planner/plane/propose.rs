//! The candidates of a cycle before the first program: the previous plan and the paths of the lattice.

use super::PlanePlanner;
use super::candidate::Candidate;
use crate::config::{KNOTS, STAGE_PERIOD, STAGES};
use crate::lattice::LatticePath;
use crate::trajectory::RollOut;
use crate::vehicle::{PathControl, PathState};

impl PlanePlanner {
    /// Proposes the rest of the previous plan as a candidate, the warm start.
    pub(super) fn warm_start(&mut self) {
        if self.last_plan(self.time).is_none() {
            return;
        }
        let cruise = self.trim.state.airspeed;
        let mut candidate = self.cruising();
        let mut last = PathState::of(&self.state);
        for (stage, knot) in candidate.flown.knots.iter_mut().enumerate().skip(1) {
            let time = self.time + STAGE_PERIOD * stage as f64 * self.units.time;
            *knot = match self.last_plan(time) {
                Some(state) => PathState::of(&state),
                None => PathState {
                    x: last.x + (cruise + self.wind.x) * STAGE_PERIOD,
                    z: last.z,
                    airspeed: cruise,
                    flight_path: 0.0,
                    angle_of_attack: self.trim.state.angle_of_attack(),
                },
            };
            last = *knot;
        }
        self.propose(candidate);
    }

    /// Adds a candidate, if the settings allow one more.
    pub(super) fn propose(&mut self, candidate: Candidate) {
        if self.candidates.len() < self.paths {
            // The list has as many places as there are proposals, so the push cannot fail.
            let _ = self.candidates.push(candidate);
        }
    }

    /// A candidate with the aircraft's present state at every knot and the thrust of cruise.
    // Not inlined, because four callers would hold a copy each.
    #[inline(never)]
    pub(super) fn cruising(&self) -> Candidate {
        let thrust = self.trim.control.thrust;
        Candidate {
            flown: RollOut {
                knots: [PathState::of(&self.state); KNOTS],
                controls: [PathControl {
                    angle_of_attack_rate: 0.0,
                    thrust,
                }; STAGES],
                thrust: self.thrust,
            },
            price: f64::INFINITY,
        }
    }

    /// The candidate that follows a path of the lattice at cruise speed.
    pub(super) fn along(&self, path: &LatticePath) -> Candidate {
        let start = PathState::of(&self.state);
        let spacing = self.cost_to_go.spacing();
        let at = |x: f64| {
            let stations = ((x - start.x) / spacing).clamp(0.0, (path.len() - 2) as f64);
            let station = stations as usize;
            let height = |station: usize| path.get(station).copied().unwrap_or(start.z);
            let (from, to) = (height(station), height(station + 1));
            let share = (x - start.x) / spacing - station as f64;
            (from + (to - from) * share, (to - from) / spacing)
        };
        let mut candidate = self.cruising();
        let cruise = self.trim.state.airspeed;
        let mut x = start.x;
        for knot in candidate.flown.knots.iter_mut().skip(1) {
            let slope = at(x).1;
            x += (cruise / libm::sqrt(1.0 + slope * slope) + self.wind.x) * STAGE_PERIOD;
            let (z, slope) = at(x);
            *knot = self.steady(x, z, libm::atan(slope));
        }
        candidate
    }

    /// A knot at cruise speed with the angle `course` over ground \[rad\].
    fn steady(&self, x: f64, z: f64, course: f64) -> PathState {
        PathState {
            x,
            z,
            airspeed: self.trim.state.airspeed,
            flight_path: course - self.wind.z / self.trim.state.airspeed,
            angle_of_attack: self.trim.state.angle_of_attack(),
        }
    }
}
