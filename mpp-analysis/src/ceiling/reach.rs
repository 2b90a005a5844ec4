//! The proof that a field is blocked: an outer approximation of everything that an aircraft of the envelope reaches.
//!
//! With `s = sin(gamma)` and the distance `x` downrange as time, every flight of the envelope has
//!
//! ```text
//! dz/dx = s / sqrt(1 - s^2)        ds/dx = gamma' / v  in  [least, most]
//! ```
//!
//! The bounds of `ds/dx` are those of [`Envelope::turn`]. The search goes downrange in layers. At each layer it holds, for
//! every bin of `s`, a set of heights. Three facts make these sets hold every flight that hits nothing:
//!
//! 1. *Bins.* In coordinates that move with the middle rate, `s` changes by at most `h` per metre to either side. A bin has the
//!    width `h dx / n`. From a bin, a flight reaches within `dx` the bins up to `n` away, and no other ones.
//! 2. *Heights.* Between two bins the height changes most along the flight that first climbs more as fast as it can and then
//!    less as fast as it can. The integral of `s / sqrt(1 - s^2)` over `s` is `-sqrt(1 - s^2)`, so this change is exact. The least
//!    change is the mirror image.
//! 3. *Obstacles.* At a layer, and only there, heights within an obstacle are taken out. Between layers nothing is.
//!
//! If all sets of a layer are empty, no flight of the envelope gets so far: the field is blocked there.

use super::envelope::Envelope;
use super::free::{Interval, free};
use mpp_sim::field::{Obstacle, Point};
use mpp_sim::outcome::FLIGHT_PATH_LIMIT;

/// What rounding may take from a height in a layer \[m\]; it is far more than it can.
const ROUNDING: f64 = 1e-9;

/// The search for a way through.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach<'a> {
    pub(super) obstacles: &'a [Obstacle],
    pub(super) envelope: &'a Envelope,
    pub(super) start: Point,
    /// Sine of the flight path angle at the start [-].
    pub(super) sine: f64,
    /// Place that a flight has to reach \[m\].
    pub(super) end: f64,
    pub(super) band: Interval,
    pub(super) margin: f64,
    /// Distance of layers \[m\].
    pub(super) step: f64,
    /// Bins that `s` passes in a layer, to either side.
    pub(super) bins: i64,
}

/// Sets of heights by bin; the first bin has the index `first`.
struct Layer {
    first: i64,
    heights: Vec<Vec<Interval>>,
}

impl Reach<'_> {
    /// The first layer that no flight of the envelope reaches \[m\]; `None` if there is no such layer up to the end.
    pub(super) fn blocked_at(&self) -> Option<f64> {
        let mut layer = Layer {
            first: 0,
            heights: vec![vec![(self.start.1, self.start.1)]],
        };
        let layers = ((self.end - self.start.0) / self.step).floor() as i64;
        for number in 1..=layers {
            let x = self.start.0 + number as f64 * self.step;
            layer = self.next(&layer, number, x);
            if layer.heights.iter().all(Vec::is_empty) {
                return Some(x);
            }
        }
        None
    }

    /// Half the range of the rate of `s` [1/m].
    fn half_rate(&self) -> f64 {
        0.5 * (self.envelope.turn[1] - self.envelope.turn[0])
    }

    /// Middle of this range [1/m].
    fn middle_rate(&self) -> f64 {
        0.5 * (self.envelope.turn[1] + self.envelope.turn[0])
    }

    /// The sines of a bin in a layer, as far as they are in the envelope; `None` if they are not. The first layer has the
    /// single sine of the start.
    fn sines(&self, bin: i64, layer: i64) -> Option<[f64; 2]> {
        if layer == 0 {
            return Some([self.sine; 2]);
        }
        let width = self.half_rate() * self.step / self.bins as f64;
        let shift = self.sine + self.middle_rate() * self.step * layer as f64;
        let most = libm::sin(FLIGHT_PATH_LIMIT);
        let low = bin as f64 * width + shift - ROUNDING;
        let high = (bin + 1) as f64 * width + shift + ROUNDING;
        (low <= most && high >= -most).then(|| [low.max(-most), high.min(most)])
    }

    /// The next layer, the one with this number at `x`.
    fn next(&self, from: &Layer, number: i64, x: f64) -> Layer {
        let first = from.first - self.bins;
        let count = from.heights.len() + 2 * self.bins as usize;
        let open = free(&self.near(x), x, self.band, self.margin);
        let mut heights = vec![Vec::new(); count];
        for (index, sets) in heights.iter_mut().enumerate() {
            let bin = first + index as i64;
            let Some(after) = self.sines(bin, number) else {
                continue;
            };
            for before_bin in bin - self.bins..=bin + self.bins {
                let place = usize::try_from(before_bin - from.first).ok();
                let Some(before) = place.and_then(|place| from.heights.get(place)) else {
                    continue;
                };
                if before.is_empty() {
                    continue;
                }
                let Some(sines) = self.sines(before_bin, number - 1) else {
                    continue;
                };
                let (sink, climb) = self.changes(sines, after);
                sets.extend(before.iter().map(|(low, high)| (low + sink, high + climb)));
            }
            unite(sets);
            *sets = common(sets, &open);
        }
        trimmed(Layer { first, heights })
    }

    /// Obstacles that may close heights at `x`.
    fn near(&self, x: f64) -> Vec<Obstacle> {
        let middle = 0.5 * (self.band.0 + self.band.1);
        let reach = 0.5 * (self.band.1 - self.band.0) + self.margin;
        let near = |one: &&Obstacle| one.clearance((x, middle), 0.0) <= reach;
        self.obstacles.iter().filter(near).cloned().collect()
    }

    /// Least and greatest change of height in a layer, from sines to sines \[m\].
    fn changes(&self, from: [f64; 2], to: [f64; 2]) -> (f64, f64) {
        let [least, most] = self.envelope.turn;
        let climb = highest(from[1], to[1], most, -least, self.step);
        let sink = -highest(-from[0], -to[0], -least, most, self.step);
        (sink - ROUNDING, climb + ROUNDING)
    }
}

/// Greatest change of height over `distance` \[m\] from a sine to another one, when the sine rises by at most `up` and falls by at
/// most `down` per metre \[m\].
fn highest(from: f64, to: f64, up: f64, down: f64, distance: f64) -> f64 {
    let most = libm::sin(FLIGHT_PATH_LIMIT);
    let peak = (distance + from / up + to / down) / (1.0 / up + 1.0 / down);
    // Between bins that a flight just reaches, rounding may put the peak beneath one of the ends.
    let peak = peak.max(from).max(to).min(most);
    let integral = |sine: f64| -(1.0 - sine * sine).sqrt();
    let rising = (integral(peak) - integral(from)) / up;
    let falling = (integral(peak) - integral(to)) / down;
    let rest = (distance - (peak - from) / up - (peak - to) / down).max(0.0);
    rising + falling + rest * peak / (1.0 - peak * peak).sqrt()
}

/// Puts intervals in order and joins those that overlap.
pub(super) fn unite(intervals: &mut Vec<Interval>) {
    intervals.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut joined: Vec<Interval> = Vec::with_capacity(intervals.len());
    for &(low, high) in intervals.iter() {
        match joined.last_mut() {
            Some(last) if low <= last.1 => last.1 = last.1.max(high),
            _ => joined.push((low, high)),
        }
    }
    *intervals = joined;
}

/// What two ordered lists of intervals have in common.
pub(super) fn common(some: &[Interval], others: &[Interval]) -> Vec<Interval> {
    let mut both = Vec::new();
    for a in some {
        for b in others {
            let (low, high) = (a.0.max(b.0), a.1.min(b.1));
            if low <= high {
                both.push((low, high));
            }
        }
    }
    both
}

/// The layer without the empty bins at its ends.
fn trimmed(mut layer: Layer) -> Layer {
    let empty = layer
        .heights
        .iter()
        .take_while(|sets| sets.is_empty())
        .count();
    layer.heights.drain(..empty);
    while layer.heights.last().is_some_and(Vec::is_empty) {
        layer.heights.pop();
    }
    layer.first += empty as i64;
    layer
}
