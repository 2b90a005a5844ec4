//! The cycle of preset `flight`: a map with memory, few but distinct paths, and rounds of
//! linearisation about what the aircraft would really fly.
//!
//! ```text
//!                                            +--------- next candidate ---------+
//!                                            v                                  |
//! begin --> Remember --> Lattice --> Tree --> Corridor --> Linearise --> Improve --> Done
//!           map          paths       paths    faces        program       solved, flown out
//! ```
//!
//! Every candidate is improved once; the best few then get further rounds. The nonlinear roll-out of
//! the controls is what is judged, against the map itself, and what is flown.

use super::candidate::{ANGLE_SCALE, Candidate, Frame};
use super::propose::TREE_PATHS;
use super::{FEASIBLE, Phase, Planner};
use crate::config::KNOTS;
use crate::corridor::Keep;
use crate::map::{ClearanceField, GridPoint, MemoryMap};
use crate::plan::{Lattice, LatticeTask, MAX_LATTICE_PATHS};
use crate::qp::Status;
use crate::settings::{AttitudeLimits, Iteration};
use crate::vehicle::PathState;

/// Candidates of a cycle: the previous plan, the lattice's paths, the tree's.
const CANDIDATES: usize = 1 + MAX_LATTICE_PATHS + TREE_PATHS;
/// Share of the elevator's range that plans use; the rest is the regulator's.
const PLANNED_SHARE: f64 = 0.9;
/// What programs keep beyond the margin [m], so that their roll-outs still keep it.
const ROUNDING: f64 = 0.05;

/// How many margins programs keep at most, where a candidate has the room.
const MOST_MARGINS: f64 = 2.0;
/// Price of a squared lack of [`crate::plan::ROOM`] [1/m^2] for an aircraft that cannot turn at all.
const ROOM_PRICE: f64 = 2.0;

/// Beams of a scan that one slice takes in.
const BEAMS_PER_SLICE: usize = 16;

/// Workspace of the cycle.
#[derive(Clone, Debug)]
pub(super) struct Workspace {
    map: MemoryMap,
    pub(super) field: ClearanceField,
    /// Beams of the scan that the map has taken in.
    pub(super) beams: usize,
    pub(super) lattice: Lattice,
    pub(super) candidates: heapless::Vec<Candidate, CANDIDATES>,
    /// Improvements so far.
    improvements: usize,
    /// The candidates by price after the first improvement of each.
    order: [usize; CANDIDATES],
}

impl Workspace {
    pub(super) const fn new() -> Self {
        Self {
            map: MemoryMap::new(),
            field: ClearanceField::new(),
            beams: 0,
            lattice: Lattice::new(),
            candidates: heapless::Vec::new(),
            improvements: 0,
            order: [0; CANDIDATES],
        }
    }

    /// Which candidate is improved next: each once, then the best few, each with all its rounds before
    /// the next.
    fn turn(&self, iteration: &Iteration) -> Option<usize> {
        let Some(further) = self.improvements.checked_sub(self.candidates.len()) else {
            return Some(self.improvements);
        };
        let rounds = usize::from(iteration.rounds).saturating_sub(1);
        let deepened = iteration.deepened.min(self.candidates.len());
        let best = (0..deepened).find(|place| further < rounds * (place + 1))?;
        self.order.get(best).copied()
    }

    /// Where the candidate that is improved now leads, in the world [m].
    pub(super) fn path(&self, iteration: &Iteration) -> Option<[(f64, f64); KNOTS]> {
        let candidate = self.candidates.get(self.turn(iteration)?)?;
        Some(candidate.knots.each_ref().map(|knot| (knot.x, knot.z)))
    }

    pub(super) fn map_mut(&mut self) -> &mut MemoryMap {
        &mut self.map
    }

    /// Forgets the map of an earlier flight.
    pub(super) fn forget(&mut self) {
        self.map.clear();
    }
}

impl Planner {
    /// Takes in some beams of the scan; after the last, sets out on the previous plan and on the lattice.
    #[inline(never)]
    pub(super) fn remember(&mut self) {
        let state = &self.state;
        let Some((iteration, limits)) = self.limits() else {
            self.phase = Phase::Done;
            return;
        };
        if !(state.x.is_finite() && state.z.is_finite() && state.air.is_finite()) {
            // No plan starts there; the map stays as it is.
            self.phase = Phase::Done;
            return;
        }
        let altitude = self.settings.altitude;
        let work = &mut self.iterated;
        let beams = work.beams..work.beams + BEAMS_PER_SLICE;
        if beams.start == 0 {
            work.map.roll(state.x, altitude);
        }
        if beams.start < self.scan.ranges.len() {
            work.beams = beams.end;
            let sight = self.settings.sight;
            let (x, z, pitch) = (state.x, state.z, state.air.pitch);
            work.map.insert_beams(&self.scan, beams, sight, x, z, pitch);
            return;
        }
        work.field.build(&work.map);
        work.candidates.clear();
        work.improvements = 0;
        self.take_up_previous();
        let (run, rise) = self.wind.ground_velocity(&self.state.air);
        self.iterated.lattice.start(&LatticeTask {
            x: self.state.x,
            z: self.state.z,
            slope: rise / run.max(1.0),
            altitude,
            band: iteration.band,
            curvature: self.curvature(&limits),
            room_price: self.room_price(),
        });
        self.phase = Phase::Lattice;
    }

    /// What rounds and attitude go by, within what the actuators can do.
    fn limits(&self) -> Option<(Iteration, AttitudeLimits)> {
        let (mut iteration, mut attitude) = (self.settings.iteration?, self.settings.attitude?);
        attitude.angle_of_attack = attitude.angle_of_attack.min(self.balanced());
        let most = self.actuators.thrust_max.unwrap_or(f64::INFINITY);
        iteration.thrust_max = iteration.thrust_max.min(most);
        Some((iteration, attitude))
    }

    /// Angle of attack about trim that the elevator balances for plans [rad].
    fn balanced(&self) -> f64 {
        PLANNED_SHARE * self.actuators.angle_of_attack(&self.airframe)
    }

    /// What it balances of the angle of attack that plans may use, at most all of it [-].
    fn agility(&self) -> f64 {
        let allowed = self.settings.attitude.map_or(0.0, |it| it.angle_of_attack);
        (self.balanced() / allowed).min(1.0)
    }

    /// Price of a squared lack of room [1/m^2]. What gusts take, an agile aircraft wins back at once; one
    /// that turns little has to have some room in hand.
    pub(super) fn room_price(&self) -> f64 {
        ROOM_PRICE * (1.0 - self.agility())
    }

    /// Curvature [1/m] that the angle of attack allows in level flight at cruise.
    fn curvature(&self, limits: &AttitudeLimits) -> f64 {
        let a = &self.airframe;
        0.5 * a.air_density * a.wing_area * a.lift_alpha * limits.angle_of_attack / a.mass
    }

    /// One station of the lattice; after the last, its paths, and a tree in the same map.
    #[inline(never)]
    pub(super) fn search_lattice(&mut self) {
        let work = &mut self.iterated;
        if work.lattice.advance(&work.field) {
            return;
        }
        let mut paths = heapless::Vec::new();
        work.lattice.paths(&mut paths);
        for path in &paths {
            let candidate = self.along(path);
            self.propose(candidate);
        }
        self.project_map();
        self.start_tree();
    }

    /// Writes the map with memory to the grid that the tree grows in.
    fn project_map(&mut self) {
        let (x, z) = (self.state.x, self.state.z);
        self.grid.clear();
        let window = [
            [x - GridPoint::AIRCRAFT.col, x + 120.0],
            [z - GridPoint::AIRCRAFT.row, z + 38.0],
        ];
        let grid = &mut self.grid;
        self.iterated.field.surface(window[0], window[1], |x0, z0| {
            let row = libm::floor(z0 - z + GridPoint::AIRCRAFT.row) as i32;
            let col = libm::floor(x0 - x + GridPoint::AIRCRAFT.col) as i32;
            grid.mark(row, col);
        });
    }

    /// Sets the faces between the next candidate to improve and the obstacles about it.
    #[inline(never)]
    pub(super) fn separate(&mut self) {
        let Some((iteration, _)) = self.limits() else {
            self.phase = Phase::Done;
            return;
        };
        let keep = Keep {
            margin: iteration.margin + ROUNDING,
            room: iteration.margin * (1.0 / self.agility()).min(MOST_MARGINS),
            floor: self.settings.altitude - iteration.band,
            ceiling: self.settings.altitude + iteration.band,
        };
        let work = &mut self.iterated;
        if work.improvements == work.candidates.len() {
            work.order = order(&work.candidates);
        }
        let turn = work.turn(&iteration);
        let Some(candidate) = turn.and_then(|index| work.candidates.get(index)) else {
            self.phase = Phase::Done;
            return;
        };
        let cruise = self.trim.state.airspeed;
        self.corridor
            .separate(&work.field, &candidate.knots, cruise, &keep);
        self.phase = Phase::Linearise;
    }

    /// Sets up that candidate's program, about the candidate itself.
    #[inline(never)]
    pub(super) fn linearise(&mut self) {
        let Some((iteration, limits)) = self.limits() else {
            self.phase = Phase::Done;
            return;
        };
        let frame = self.frame();
        let work = &mut self.iterated;
        let turn = work.turn(&iteration);
        let Some(candidate) = turn.and_then(|index| work.candidates.get(index)) else {
            self.phase = Phase::Done;
            return;
        };
        let condensed = self
            .shared
            .condense_varying(&self.settings.weights, |dynamics| {
                frame.linearise(candidate, dynamics);
            });
        if condensed.is_err() {
            // A candidate without a model is passed over.
            work.improvements += 1;
            self.phase = Phase::Corridor;
            return;
        }
        self.problem.bounds.set_corridor(&self.corridor);
        let AttitudeLimits {
            angle_of_attack,
            flight_path,
        } = limits;
        let side = [angle_of_attack, flight_path].map(|limit| ANGLE_SCALE * limit);
        self.problem
            .bounds
            .set_attitude(side, side.map(|limit| -limit));
        self.problem.initial = frame.deviation(&frame.start, 0).into();
        self.problem.cost_limit = f64::INFINITY;
        self.solver.start(&self.shared, &self.problem);
        self.phase = Phase::Improve;
    }

    /// Some steps of the program; at its end, the roll-out replaces the candidate.
    #[inline(never)]
    pub(super) fn improve(&mut self) {
        let Some(status) = self.solve_some() else {
            return;
        };
        self.summary.candidates += 1;
        let solved = status == Status::Optimal
            && self.solver.solution(&self.shared, &mut self.candidate) == Status::Optimal;
        if solved {
            self.fly_out();
        }
        self.iterated.improvements += 1;
        self.phase = Phase::Corridor;
    }

    fn frame(&self) -> Frame {
        Frame {
            airframe: self.airframe,
            trim: self.trim,
            wind: self.wind,
            start: PathState::of(&self.state),
        }
    }

    fn fly_out(&mut self) {
        let Some((iteration, limits)) = self.limits() else {
            return;
        };
        let mut flown = self.cruising();
        // Soft rows may ask for somewhat more than the limit.
        let most = 1.5 * limits.angle_of_attack + 0.05;
        let most = most.min(self.actuators.angle_of_attack(&self.airframe));
        flown.roll_out(&self.candidate, &self.frame(), most, iteration.thrust_max);
        let judgement = self.judge(&flown, &iteration);
        flown.price = judgement.price;
        self.summary.feasible += usize::from(judgement.lack <= FEASIBLE);
        if judgement.price < self.best_price {
            self.best_price = judgement.price;
            self.summary.cost = judgement.effort;
            self.summary.violation = judgement.lack;
            self.best.fly_out(
                &flown.knots,
                &flown.controls,
                &self.airframe,
                &self.wind,
                self.time,
            );
        }
        let work = &mut self.iterated;
        if let Some(index) = work.turn(&iteration)
            && let Some(place) = work.candidates.get_mut(index)
        {
            *place = flown;
        }
    }
}

/// Candidates from the cheapest to the dearest.
fn order(candidates: &[Candidate]) -> [usize; CANDIDATES] {
    let mut order = [0; CANDIDATES];
    for (index, candidate) in candidates.iter().enumerate() {
        let before = |(other, price): (usize, f64)| {
            price
                .total_cmp(&candidate.price)
                .then(other.cmp(&index))
                .is_lt()
        };
        let prices = candidates.iter().map(|other| other.price).enumerate();
        let place = prices.filter(|other| before(*other)).count();
        if let Some(place) = order.get_mut(place) {
            *place = index;
        }
    }
    order
}
