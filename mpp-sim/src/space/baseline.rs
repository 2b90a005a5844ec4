//! Simple planners beside which the planner in space is measured. They replace only the planner: start state, map, estimate,
//! regulator and plant are its own, and their plans have its type. They are no flight code.

use super::paper::PaperMethod;
use crate::names::by_name;
use hil_protocol::{ConfigureSpace, Message};
use mpp_core::config::{STAGE_PERIOD, TICK_PERIOD};
use mpp_core::map::{MOST_CLEARANCE, VoxelField};
use mpp_core::planner::space::{SpacePlan, SpacePlanner, towards};
use mpp_core::vehicle::{GRAVITY, SpaceModel, SpacePath};
use mpp_node::SpaceNode;

/// Bank per radian of course that is to be turned back [-]. Source: the best of 1.2 to 3 on other seeds.
const TURN_BACK: f64 = 2.0;
/// Time in which the flight path follows its command \[s\]. Source: chosen.
const FOLLOW: f64 = 0.5;
/// Flight path per metre off the altitude [rad/m], and the most \[rad\]: that of the library's climb. Source: chosen.
const TO_ALTITUDE: f64 = 0.05;
const CLIMB: f64 = 0.085;

/// The planners that a flight can have in place of ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BaselineName {
    /// Straight on at its altitude, whatever stands there.
    Straight,
    /// Seven manoeuvres with the rule of Barry, Florence and Tedrake (2018).
    Library7,
    /// 105 primitives, judged by the price of our plans with its cost-to-go.
    Library105,
    /// The method of the paper, with a third dimension.
    Paper,
}

impl BaselineName {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Straight,
        Self::Library7,
        Self::Library105,
        Self::Paper,
    ];

    /// The name, for scenarios and logs.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Library7 => "library-7",
            Self::Library105 => "library-105",
            Self::Paper => "paper",
        }
    }
}

by_name!(BaselineName, "baseline");

/// A baseline in a flight.
pub(super) struct Baseline {
    name: BaselineName,
    altitude: f64,
    band: Band,
    running: Option<Running>,
    /// With the name of the paper's method.
    paper: Option<PaperMethod>,
}

/// Heights and half the width that the centre of mass keeps \[m\].
struct Band {
    heights: [f64; 2],
    half_width: f64,
}

impl Baseline {
    /// A baseline that keeps an altitude \[m\] and limits of plans. The method of the paper draws so many paths with a seed.
    pub(super) fn new(
        name: BaselineName,
        altitude: f64,
        limits: &ConfigureSpace,
        paths: usize,
        seed: u64,
    ) -> Self {
        Self {
            paper: (name == BaselineName::Paper)
                .then(|| PaperMethod::new(paths, altitude, limits, seed)),
            name,
            altitude,
            band: Band {
                heights: limits.heights,
                half_width: limits.half_width,
            },
            running: None,
        }
    }

    /// Takes the place of the planner after a message to its node.
    pub(super) fn follow(&mut self, message: &Message, node: &mut SpaceNode) {
        let Some(planner) = node.planner_mut() else {
            return;
        };
        planner.wait_for_offers();
        if let (Message::SensorFrame(frame), Some(start)) = (message, planner.awaited().copied()) {
            let now = f64::from(frame.tick) * TICK_PERIOD;
            let plans = self.plans(now, planner, &start);
            planner.offer(&plans);
        }
    }

    fn plans(&mut self, now: f64, planner: &SpacePlanner, start: &SpacePath) -> Vec<SpacePlan> {
        let model = planner.model();
        match self.name {
            BaselineName::Straight => vec![flown(model, start, |_, state| {
                [turned_back(state, 0.0), self.level(state)]
            })],
            BaselineName::Library7 => vec![self.chosen(now, planner, start)],
            BaselineName::Library105 => self.primitives(model, start),
            BaselineName::Paper => {
                let paper = self.paper.as_mut();
                let plan = paper.and_then(|paper| paper.plan(planner, start));
                plan.into_iter().collect()
            }
        }
    }

    /// The flight path that leads to the altitude \[rad\].
    fn level(&self, state: &SpacePath) -> f64 {
        let [.., z] = state.position;
        (TO_ALTITUDE * (self.altitude - z)).clamp(-CLIMB, CLIMB)
    }

    /// Seven first banks, five second ones and three flight paths; then back to the course and level.
    fn primitives(&self, model: &SpaceModel, start: &SpacePath) -> Vec<SpacePlan> {
        let most = most_bank(model);
        let thirds = (-3..=3).map(|part| f64::from(part) / 3.0);
        let mut plans = Vec::new();
        for first in thirds {
            for second in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                for climb in [-0.25, 0.0, 0.25] {
                    plans.push(flown(model, start, |time, state| {
                        let bank = match time {
                            ..1.0 => first * most,
                            ..2.25 => second * most,
                            _ => turned_back(state, 0.0).clamp(-most, most),
                        };
                        [bank, if time < 1.5 { climb } else { 0.0 }]
                    }));
                }
            }
        }
        plans
    }
}

/// A manoeuvre of the library of seven.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Manoeuvre {
    /// Keeps the course.
    Straight,
    /// Climbs or descends at a flight path \[rad\].
    Climb(f64),
    /// Turns gently at a bank \[rad\].
    Turn(f64),
    /// Banks as much as it can, to the right for 1, and then back to the course from which it began.
    Jog(f64),
}

/// The library, in the order in which it is searched. Source: that of Barry's aircraft, github.com/andybarry/flight,
/// `trajlib/oct11-*`; in the place of its take-off a descent.
const LIBRARY: [Manoeuvre; 7] = [
    Manoeuvre::Straight,
    Manoeuvre::Climb(CLIMB),
    Manoeuvre::Climb(-CLIMB),
    Manoeuvre::Turn(-0.22),
    Manoeuvre::Turn(0.22),
    Manoeuvre::Jog(-1.0),
    Manoeuvre::Jog(1.0),
];
/// Duration of a manoeuvre \[s\]. Source: the same.
const DURATION: f64 = 3.0;
/// Duration of the first bank of a jog \[s\]. Source: chosen; 0.6 to 1.3 s fly as well.
const JOG: f64 = 1.0;
/// Clearance of the centre of mass that is enough \[m\]. Source: the best of 0.8 to 2.9 m on other seeds.
const SAFE: f64 = 1.1;
/// Time ahead over which clearances count \[s\]. Source: the best of 1 to 3 s on other seeds.
const LOOK: f64 = 1.5;
/// Clearance by which another manoeuvre must be better than the one that is flown \[m\]. Source: `plane.cfg` there.
const BETTER: f64 = 0.1;
/// Error of the course beyond which a gentle turn is preferred \[rad\]. Source: `plane.cfg` there.
const BEARING: f64 = 0.175;
/// Distance ahead of the point of the middle line at which the course aims \[m\]. Source: chosen.
const AHEAD: f64 = 40.0;
/// Points of a stage at which the clearance is looked up.
const POINTS: u32 = 4;

/// A manoeuvre that is flown.
#[derive(Clone, Copy)]
struct Running {
    manoeuvre: Manoeuvre,
    begun: f64,
    course: f64,
}

impl Baseline {
    /// The rule: the manoeuvre that is flown goes on as long as its rest is clear enough, unless a turn to the goal or the end of
    /// one is so too. Otherwise the first one that is clear enough, or else that with the largest least clearance.
    fn chosen(&mut self, now: f64, planner: &SpacePlanner, start: &SpacePath) -> SpacePlan {
        let fresh = |manoeuvre| Running {
            manoeuvre,
            begun: now,
            course: start.course,
        };
        let of = |running: &Running| {
            let plan = self.flown_on(running, now, planner.model(), start);
            let clearance = self.band.clearance(planner.field(), planner.model(), &plan);
            (*running, plan, clearance)
        };
        let running = self.running.filter(|it| !it.is_over(now));
        let current = of(&running.unwrap_or_else(|| fresh(Manoeuvre::Straight)));
        let is_safe = current.2 > SAFE;
        let preferred = preferred(start).filter(|_| is_safe);
        let others = preferred.into_iter().chain(LIBRARY);
        let others: Vec<_> = others.map(|manoeuvre| of(&fresh(manoeuvre))).collect();
        let first = others.iter().find(|other| other.2 > SAFE);
        // The first of the widest.
        let widest = others.iter().min_by(|a, b| b.2.total_cmp(&a.2));
        let other = first.or(widest).filter(|other| {
            let steers = matches!(other.0.manoeuvre, Manoeuvre::Straight | Manoeuvre::Turn(_));
            if is_safe {
                steers && other.0.manoeuvre != current.0.manoeuvre
            } else {
                other.2 > current.2 + BETTER
            }
        });
        let (running, plan, _) = *other.unwrap_or(&current);
        self.running = Some(running);
        plan
    }

    /// The rest of a manoeuvre, and straight on.
    fn flown_on(
        &self,
        running: &Running,
        now: f64,
        model: &SpaceModel,
        start: &SpacePath,
    ) -> SpacePlan {
        let most = most_bank(model);
        let age = now - running.begun;
        flown(model, start, |time, state| {
            let back = turned_back(state, running.course).clamp(-most, most);
            match running.manoeuvre {
                Manoeuvre::Climb(path) if time < DURATION => [back, path],
                Manoeuvre::Straight | Manoeuvre::Climb(_) => [back, self.level(state)],
                Manoeuvre::Turn(bank) if time < DURATION => [bank, self.level(state)],
                Manoeuvre::Turn(_) => [0.0, self.level(state)],
                Manoeuvre::Jog(side) if age + time < JOG => [side * most, self.level(state)],
                Manoeuvre::Jog(_) => [back, self.level(state)],
            }
        })
    }
}

impl Running {
    fn is_over(&self, now: f64) -> bool {
        self.manoeuvre != Manoeuvre::Straight && now - self.begun > DURATION
    }
}

impl Band {
    /// Least clearance of the centre of mass in the next second or two \[m\]; 0 if the manoeuvre leaves the band.
    fn clearance(&self, field: &VoxelField, model: &SpaceModel, plan: &SpacePlan) -> f64 {
        let [low, high] = self.heights;
        let mut least = MOST_CLEARANCE;
        for (stage, (knot, control)) in plan.knots.iter().zip(&plan.controls).enumerate() {
            for point in 1..=POINTS {
                let within = STAGE_PERIOD * f64::from(point) / f64::from(POINTS);
                let time = stage as f64 * STAGE_PERIOD + within;
                let point = knot.after(model, control, within).position;
                let [_, y, z] = point;
                if time <= LOOK {
                    least = least.min(field.clearance(&point));
                }
                if time <= DURATION && !((low..=high).contains(&z) && y.abs() <= self.half_width) {
                    return 0.0;
                }
            }
        }
        least
    }
}

/// The gentle turn to the goal, if the course is off.
fn preferred(start: &SpacePath) -> Option<Manoeuvre> {
    let [_, y, _] = start.position;
    let off = start.course - libm::atan2(-y, AHEAD);
    let turn = Manoeuvre::Turn(if off > 0.0 { -0.22 } else { 0.22 });
    (off.abs() > BEARING).then_some(turn)
}

/// The bank that turns back to a course \[rad\].
fn turned_back(state: &SpacePath, course: f64) -> f64 {
    TURN_BACK * (course - state.course)
}

/// The bank of the tightest level turn \[rad\].
fn most_bank(model: &SpaceModel) -> f64 {
    let speed = model.trim.state.airspeed;
    libm::atan(model.curvature() * speed * speed / GRAVITY)
}

/// The plan that follows bank and flight path \[rad\], as they are wanted at a time \[s\] in a state, within all limits.
fn flown(
    model: &SpaceModel,
    start: &SpacePath,
    wanted: impl Fn(f64, &SpacePath) -> [f64; 2],
) -> SpacePlan {
    let mut plan = SpacePlan::new();
    plan.fly(model, start, |stage, state| {
        let [bank, path] = wanted(stage as f64 * STAGE_PERIOD, state);
        let climb = state.airspeed * (path - state.flight_path) / FOLLOW;
        let up = GRAVITY * libm::cos(state.flight_path) + climb;
        let right = up.max(0.3 * GRAVITY) * libm::tan(bank.clamp(-1.4, 1.4));
        towards(model, state, [up, right], STAGE_PERIOD)
    });
    plan
}
