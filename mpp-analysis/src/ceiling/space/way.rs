//! The search for a way in plan view: level turns whose bank changes at a rate.

use super::trunks::{Place, Woods};
use mpp_sim::space::world::Extent;
use std::collections::HashMap;

/// Places between two states at which the trunks are looked at.
const LOOKS: usize = 6;
/// Steps of the turn for each of them, an even number.
const PIECES: usize = 4;
/// Greatest course \[rad\].
const MOST_COURSE: f64 = 1.1;
/// Sizes of the buckets of which the cheapest state is kept: ahead, aside \[m\], course \[rad\].
const BUCKET: [f64; 3] = [1.0, 0.2, 0.06];
/// Price of a second within a metre less than the wanted room [1/s], of the square of the bank [1/s], and of a metre behind the
/// foremost.
const CLOSE: f64 = 20.0;
const BANKED: f64 = 0.05;
const BEHIND: f64 = 0.15;

/// How hard a search tries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// States that are kept at a time.
    pub(super) width: usize,
    /// Distance from trunks, and the one that it likes to have besides \[m\].
    pub(super) margin: f64,
    pub(super) room: f64,
    /// Share of the greatest bank that the way uses [-].
    pub(super) share: f64,
    /// Rate of the bank [rad/s].
    pub(super) rate: f64,
    /// Steps of the bank to either side.
    pub(super) levels: i32,
}

impl Effort {
    pub(super) const fn new(
        width: usize,
        [margin, room]: [f64; 2],
        [rate, share]: [f64; 2],
        levels: i32,
    ) -> Self {
        Self {
            width,
            margin,
            room,
            share,
            rate,
            levels,
        }
    }
}

/// The task of a search.
pub(super) struct Search<'a> {
    pub(super) woods: &'a Woods,
    pub(super) extent: &'a Extent,
    /// Airspeed [m/s].
    pub(super) airspeed: f64,
    /// Greatest bank \[rad\].
    pub(super) bank: f64,
    pub(super) effort: &'a Effort,
}

/// A way: places in equal times.
#[derive(Clone, Debug, Default)]
pub(super) struct Way {
    /// Time between places \[s\].
    pub(super) period: f64,
    pub(super) places: Vec<Place>,
}

#[derive(Clone, Copy)]
struct State {
    place: Place,
    level: i32,
    cost: f64,
    parent: u32,
}

/// The flight between two states by the change of the level: turned course, and places before it is turned there.
struct Move {
    looks: [Place; LOOKS],
    end: Place,
}

impl Search<'_> {
    /// A way from a place to the end of the extent; or how far the states that are kept come \[m\].
    pub(super) fn run(&self, start: Place) -> Result<Way, f64> {
        let levels = self.effort.levels;
        let step = self.bank / f64::from(levels);
        let period = step / self.effort.rate;
        let moves: Vec<[Option<Move>; 3]> = (-levels..=levels)
            .map(|level| {
                [-1, 0, 1].map(|change| {
                    let next: i32 = level + change;
                    (next.abs() <= levels).then(|| self.flown(level, change, step, period))
                })
            })
            .collect();
        let level = libm::round(start.bank / step) as i32;
        let mut layers = vec![vec![State {
            place: start,
            level: level.clamp(-levels, levels),
            cost: 0.0,
            parent: 0,
        }]];
        let longest = 1.5 * (self.extent.length - start.at[0]) / (self.airspeed * period) + 10.0;
        let mut farthest = start.at[0];
        let mut kept: HashMap<[i32; 4], usize> = HashMap::new();
        for _ in 0..longest as usize {
            let Some(from) = layers.last() else {
                break;
            };
            let mut next: Vec<State> = Vec::with_capacity(3 * from.len());
            kept.clear();
            for (parent, state) in (0..).zip(from) {
                for (change, flown) in (-1..).zip(&moves[(state.level + levels) as usize]) {
                    let Some(after) = flown.as_ref().and_then(|it| self.after(state, it, period))
                    else {
                        continue;
                    };
                    let state = State {
                        level: state.level + change,
                        parent,
                        ..after
                    };
                    let Place { at, course, .. } = state.place;
                    let [x, y, turn] = [at[0] / BUCKET[0], at[1] / BUCKET[1], course / BUCKET[2]]
                        .map(|it| it.floor() as i32);
                    let slot = kept.entry([x, y, turn, state.level]).or_insert(usize::MAX);
                    match next.get_mut(*slot) {
                        Some(other) if other.cost <= state.cost => {}
                        Some(other) => *other = state,
                        None => {
                            *slot = next.len();
                            next.push(state);
                        }
                    }
                }
            }
            let foremost = next.iter().map(|it| it.place.at[0]).fold(0.0, f64::max);
            farthest = foremost.max(farthest);
            if next.len() > self.effort.width {
                let price = |it: &State| it.cost + BEHIND * (foremost - it.place.at[0]);
                next.select_nth_unstable_by(self.effort.width, |a, b| {
                    price(a).total_cmp(&price(b))
                });
                next.truncate(self.effort.width);
            }
            let arrived = (next.iter().enumerate())
                .filter(|(_, it)| it.place.at[0] >= self.extent.length)
                .min_by(|(_, a), (_, b)| a.cost.total_cmp(&b.cost))
                .map(|(number, _)| number);
            layers.push(next);
            if let Some(last) = arrived {
                return Ok(traced(&layers, last, period));
            }
        }
        Err(farthest)
    }

    /// What a change of the level does to a place at the origin.
    fn flown(&self, level: i32, change: i32, step: f64, period: f64) -> Move {
        let dt = period / (PIECES * LOOKS) as f64;
        let rate = f64::from(change) * self.effort.rate;
        let mut place = Place {
            bank: f64::from(level) * step,
            ..Place::default()
        };
        let half = |from: Place| {
            (0..PIECES / 2).fold(from, |place, _| place.after(rate, self.airspeed, dt))
        };
        let looks = [0; LOOKS].map(|_| {
            let look = half(place);
            place = half(look);
            look
        });
        Move { looks, end: place }
    }

    fn after(&self, from: &State, flown: &Move, period: f64) -> Option<State> {
        let (sin, cos) = libm::sincos(from.place.course);
        let turned = |place: &Place| Place {
            at: [
                from.place.at[0] + cos * place.at[0] - sin * place.at[1],
                from.place.at[1] + sin * place.at[0] + cos * place.at[1],
            ],
            course: from.place.course + place.course,
            bank: place.bank,
        };
        let end = turned(&flown.end);
        if end.course.abs() > MOST_COURSE || end.at[1].abs() > self.extent.half_width {
            return None;
        }
        let Effort { margin, room, .. } = *self.effort;
        let half = 0.5 * self.airspeed * period / LOOKS as f64;
        let mut cost = from.cost;
        for look in &flown.looks {
            let look = turned(look);
            let gap = self.woods.gap(&look, half, margin + room);
            if gap < margin {
                return None;
            }
            let short = (margin + room - gap) / room.max(1e-9);
            cost +=
                period / LOOKS as f64 * (CLOSE * short * short + BANKED * look.bank * look.bank);
        }
        Some(State {
            place: end,
            cost,
            ..*from
        })
    }
}

fn traced(layers: &[Vec<State>], last: usize, period: f64) -> Way {
    let mut number = last;
    let mut places: Vec<Place> = (layers.iter().rev())
        .map(|layer| {
            let state = layer[number];
            number = state.parent as usize;
            state.place
        })
        .collect();
    places.reverse();
    Way { period, places }
}
