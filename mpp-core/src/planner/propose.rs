//! The candidates of an iterated cycle, before anything is solved: the previous plan, the paths of the
//! lattice, the distinct ones of the tree.

use super::candidate::{Candidate, same_signature};
use super::{Phase, Planner};
use crate::config::{KNOTS, STAGE_PERIOD, STAGES};
use crate::map::GridPoint;
use crate::plan::{LatticePath, resample};
use crate::vehicle::{PathControl, PathState};

/// Distinct paths that are taken from the tree.
pub(super) const TREE_PATHS: usize = 2;

impl Planner {
    /// The previous plan, from here on, is a candidate.
    pub(super) fn take_up_previous(&mut self) {
        if self.best.sample(self.time).is_none() {
            return;
        }
        let cruise = self.trim.state.airspeed;
        let mut candidate = self.cruising();
        let mut last = PathState::of(&self.state);
        for (stage, knot) in candidate.knots.iter_mut().enumerate().skip(1) {
            let time = self.time + STAGE_PERIOD * stage as f64;
            *knot = match self.best.sample(time) {
                Some(reference) => PathState::of(&reference.state),
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

    /// One candidate more, if there is room.
    pub(super) fn propose(&mut self, candidate: Candidate) {
        let candidates = &mut self.iterated.candidates;
        if candidates.len() < self.settings.paths {
            let _ = candidates.push(candidate);
        }
    }

    /// A candidate at cruise, standing where the aircraft is.
    pub(super) fn cruising(&self) -> Candidate {
        let thrust = self.trim.control.thrust;
        Candidate {
            knots: [PathState::of(&self.state); KNOTS],
            controls: [PathControl {
                angle_of_attack_rate: 0.0,
                thrust,
            }; STAGES],
            price: f64::INFINITY,
        }
    }

    /// A lattice path, flown at cruise speed.
    pub(super) fn along(&self, path: &LatticePath) -> Candidate {
        let start = PathState::of(&self.state);
        let spacing = self.iterated.lattice.spacing();
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
        for knot in candidate.knots.iter_mut().skip(1) {
            let slope = at(x).1;
            x += (cruise / libm::sqrt(1.0 + slope * slope) + self.wind.x) * STAGE_PERIOD;
            let (z, slope) = at(x);
            *knot = self.steady(x, z, libm::atan(slope));
        }
        candidate
    }

    /// A knot at cruise, on a course of this angle over ground [rad].
    fn steady(&self, x: f64, z: f64, course: f64) -> PathState {
        PathState {
            x,
            z,
            airspeed: self.trim.state.airspeed,
            flight_path: course - self.wind.z / self.trim.state.airspeed,
            angle_of_attack: self.trim.state.angle_of_attack(),
        }
    }

    /// The tree's paths that pass some obstacle on another side than every candidate so far.
    #[inline(never)]
    pub(super) fn take_tree_paths(&mut self) {
        let mut from = 0;
        let mut taken = 0;
        while taken < TREE_PATHS {
            let Some(next) = self.search.next_path(from, &mut self.path) else {
                break;
            };
            from = next;
            self.points = resample(&self.path, self.settings.rules);
            let mut candidate = self.cruising();
            let mut before = self.points[0];
            for (knot, point) in candidate.knots.iter_mut().zip(&self.points).skip(1) {
                let slope = libm::atan2(point.row - before.row, point.col - before.col);
                *knot = self.steady(
                    self.state.x + point.col - GridPoint::AIRCRAFT.col,
                    self.state.z + point.row - GridPoint::AIRCRAFT.row,
                    slope,
                );
                before = *point;
            }
            let work = &mut self.iterated;
            let field = &work.field;
            let known = |other: &Candidate| same_signature(field, &candidate.knots, &other.knots);
            if !work.candidates.iter().any(known) {
                taken += 1;
                self.propose(candidate);
            }
        }
        self.phase = Phase::Corridor;
    }
}
