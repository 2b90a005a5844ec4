//! The gate before adoption: a small checker of its own between the planner and the regulator, as the Simplex
//! architecture has it (Sha, "Using simplicity to control complexity", IEEE Software 18(4), 2001; run-time assurance in
//! ASTM F3269). Nothing is flown that it has not seen.
//!
//! The gate reads the occupancy grid and the offered trajectory only. It has its own copy of the aircraft, its own
//! equations, and shares neither the distance field, nor roll-out, nor judgement with the planner. It samples the trajectory
//! as the step will, so that it checks what is flown and not what was meant.
//!
//! All lengths, times and forces of this module are in the planner's [own units](Units).

mod sound;

use crate::config::{STAGE_PERIOD, STAGES};
use crate::map::RollingGrid;
use crate::settings::{PlaneSettings, Settings};
use crate::trajectory::Trajectory;
use crate::tuning::gate as numbers;
use crate::tuning::grid::CELL;
use crate::units::Units;
use crate::vehicle::{Airframe, Conditions, VehicleState, Wind};

/// The cells through which a trajectory may lead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// All but the occupied ones: what a plan is held to.
    NotOccupied,
    /// Near ahead the cells that a beam has seen free alone, and beyond them all but the occupied ones: what a reserve
    /// is held to.
    KnownFree,
    /// All but the occupied ones, and all heights above: a way out that is a height.
    Above,
}

/// Why a trajectory is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// It has a number that is not finite, or no reference when it would be taken over.
    Incomplete,
    /// It does not begin where the aircraft will be.
    Start,
    /// Its places do not follow from its speeds, or its turns not from its lift.
    Motion,
    /// It asks for more than the aircraft can do.
    Limits,
    /// It leaves the altitude band.
    Altitude,
    /// It leads into a cell that must not be entered.
    Obstacle,
    /// It is not the one that the gate has let through. The step finds that, by the [seal](Trajectory::seal).
    Altered,
}

/// What the gate says of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GateVerdict {
    /// Nothing speaks against it.
    Passes,
    /// It is refused, because of what comes so long after its beginning \[s\].
    Refused(Cause, f64),
}

/// The checker and its own copy of what it has to know.
#[derive(Clone, Debug)]
pub struct Gate {
    units: Units,
    known: Airframe,
    /// Airframe with the estimated lift, and the wind.
    airframe: Airframe,
    wind: Wind,
    /// Greatest angle of attack to either side of level flight \[rad\], and level flight's.
    alpha: [f64; 2],
    cruise: f64,
    thrust_max: f64,
    body_radius: f64,
    band: f64,
    /// Height of the middle of the band.
    altitude: f64,
    /// When the trajectories are taken over \[s\], and where the aircraft will then be if it flies on as it does.
    due: f64,
    start: (f64, f64),
}

impl Gate {
    /// A gate that is not set up. It refuses everything.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            units: Units::SI,
            known: Airframe::REFERENCE,
            airframe: Airframe::REFERENCE,
            wind: Wind::STILL,
            alpha: [0.0; 2],
            cruise: 0.0,
            thrust_max: 0.0,
            body_radius: 0.0,
            band: 0.0,
            altitude: 0.0,
            due: 0.0,
            start: (0.0, 0.0),
        }
    }

    /// Takes over aircraft, units and limits before a flight. `level` is the angle of attack of level flight \[rad\].
    pub fn set_up(&mut self, settings: &Settings, own: &PlaneSettings, level: f64, cruise: f64) {
        let units = settings.units;
        self.units = units;
        self.known = units.own_airframe(&settings.airframe.balanced());
        self.airframe = self.known;
        self.cruise = cruise / units.speed();
        let a = &self.known;
        let pressure_area = 0.5 * a.air_density * (self.cruise * self.cruise) * a.wing_area;
        let most = numbers::MOST_LOAD * a.mass * mpp_data::GRAVITY / (pressure_area * a.lift_alpha);
        self.alpha = [level, most];
        let motor = settings.actuators.thrust_max.unwrap_or(f64::INFINITY);
        self.thrust_max = own.thrust_max.min(motor) / units.force();
        self.body_radius = own.body_radius / units.length;
        self.band = own.band / units.length;
    }

    /// Begins a cycle whose trajectory is taken over at the time `due` \[s\], after a latency \[s\]: the aircraft is in this state
    /// now, and flies until then as it does. State and conditions are in SI units, the altitude is in own ones.
    pub fn begin(
        &mut self,
        due: f64,
        latency: f64,
        state: &VehicleState,
        conditions: &Conditions,
        altitude: f64,
    ) {
        let own = self.units.own_conditions(conditions);
        self.airframe = own.airframe(&self.known);
        self.wind = own.wind;
        self.altitude = altitude;
        self.due = due;
        let state = self.units.own_state(state);
        let (ahead, up) = own.wind.ground_velocity(&state.air);
        let later = latency / self.units.time;
        self.start = (state.x + ahead * later, state.z + up * later);
    }

    /// Flies a trajectory out against the map, from the time when it is taken over to its end.
    // Not inlined, so that its stack is not that of the planner's other slices.
    #[inline(never)]
    #[must_use]
    pub fn check(&self, map: &RollingGrid, plan: &Trajectory, space: Space) -> GateVerdict {
        let period = STAGE_PERIOD * self.units.time;
        let sound = plan.start.is_finite() && libm::fabs(plan.stage_period - period) < 1e-9;
        let Some(first) = (plan.sample(self.due)).filter(|_| sound) else {
            return GateVerdict::Refused(Cause::Incomplete, 0.0);
        };
        let mut last = self.units.own_state(&first.state);
        let off = libm::hypot(last.x - self.start.0, last.z - self.start.1);
        let begins = off < numbers::START;
        if !begins {
            return GateVerdict::Refused(Cause::Start, 0.0);
        }
        let half = 0.5 * STAGE_PERIOD;
        for number in 1..=2 * STAGES {
            let after = half * number as f64 * self.units.time;
            let Some(reference) = plan.sample(self.due + after) else {
                break;
            };
            let state = self.units.own_state(&reference.state);
            let thrust = reference.feedforward.thrust / self.units.force();
            // What comes within the reaction time no trajectory can avoid any more.
            let avoidable = half * number as f64 > numbers::REACTION;
            let cause = self
                .unsound(&last, &state, thrust, half)
                .or_else(|| self.beyond(&state, space))
                .or_else(|| {
                    self.strikes(map, [&last, &state], after, space)
                        .filter(|_| avoidable)
                });
            if let Some(cause) = cause {
                return GateVerdict::Refused(cause, after);
            }
            last = state;
        }
        GateVerdict::Passes
    }

    /// Whether a state is beyond the altitude band, and farther than the aircraft is already.
    fn beyond(&self, state: &VehicleState, space: Space) -> Option<Cause> {
        let spare = self.band + numbers::BAND_SPARE;
        let floor = (self.altitude - spare).min(self.start.1 - numbers::BAND_SPARE);
        let ceiling = (self.altitude + spare).max(self.start.1 + numbers::BAND_SPARE);
        let left = state.z < floor || (state.z > ceiling && space != Space::Above);
        left.then_some(Cause::Altitude)
    }

    /// Whether the way from one state to the next leads into a cell that it must not enter.
    fn strikes(
        &self,
        map: &RollingGrid,
        [from, to]: [&VehicleState; 2],
        after: f64,
        space: Space,
    ) -> Option<Cause> {
        let (run, rise) = (to.x - from.x, to.z - from.z);
        let points = libm::ceil(libm::hypot(run, rise) / numbers::STEP) as u16;
        let points = points.clamp(1, numbers::MOST_POINTS);
        let near = space == Space::KnownFree && after < numbers::KNOWN_TIME * self.units.time;
        for point in 1..=points {
            let share = f64::from(point) / f64::from(points);
            let place = (from.x + run * share, from.z + rise * share);
            if self.is_occupied_near(map, place) || (near && map.log_odds(place) == 0) {
                return Some(Cause::Obstacle);
            }
        }
        None
    }

    /// Whether an aircraft at this place overlaps an occupied cell.
    fn is_occupied_near(&self, map: &RollingGrid, (x, z): (f64, f64)) -> bool {
        let reach = self.body_radius + numbers::REACH;
        let cells = (libm::ceil(reach / CELL) as i32).clamp(1, numbers::MOST_CELLS);
        let (row, col) = map.locate((x, z));
        for right in -cells..=cells {
            let off_x = CELL * (f64::from(col) + 0.5 + f64::from(right)) - x;
            for up in -cells..=cells {
                let off_z = map.floor() + CELL * (f64::from(row) + 0.5 + f64::from(up)) - z;
                let cell = (row.saturating_add(up), col.saturating_add(right));
                if off_x * off_x + off_z * off_z < reach * reach
                    && map.log_odds_of(cell) >= crate::tuning::grid::OCCUPIED
                {
                    return true;
                }
            }
        }
        false
    }
}
