//! The proof that a forest is blocked: an outer approximation of everything that a flight of the envelope reaches.
//!
//! With `s = sin(course)`, bank `f` and the way ahead `x` as time, every flight of the [`SpaceEnvelope`] has
//!
//! ```text
//! dy/dx = s / sqrt(1 - s^2)
//! ds/dx = a / v^2,  with the acceleration to the right  a  in  g tan f +- uneven
//! |df/dx| <= rate / (v sqrt(1 - s^2))
//! ```
//!
//! The search goes ahead in layers. At each layer it holds, for every bin of `s` and `f`, a set of `y`. Three facts make these
//! sets hold every flight that hits nothing:
//!
//! 1. *Bins.* From a bin, a flight reaches within a layer the bins that the bounds of `ds/dx` and `df/dx` tell, rounded outwards.
//!    Between two bins of `f` it banks at most by the mean of their upper ends and half of what a layer allows.
//! 2. *Sides.* `s` is never above the two lines of greatest slope through its ends; the integral of `s / sqrt(1 - s^2)` over a line
//!    is exact. The least change is the mirror image.
//! 3. *Bodies.* The middle of the hull is a ball. Where it touches a trunk at a layer, `y` is taken out. Wings do not count.
//!
//! If all sets of a layer are empty, no flight of the envelope gets so far: the forest is blocked there.

use super::envelope::SpaceEnvelope;
use super::trunks::Trunk;
use crate::ceiling::free::Interval;
use crate::ceiling::reach::{common, unite};
use mpp_core::vehicle::GRAVITY;
use mpp_sim::space::Hull;

/// What rounding may take from a set \[m\]; it is far more than it can.
const ROUNDING: f64 = 1e-9;

/// The search for a way through.
pub(super) struct Reach<'a> {
    pub(super) trunks: &'a [Trunk],
    pub(super) envelope: &'a SpaceEnvelope,
    pub(super) hull: &'a Hull,
    /// Way to fly, and greatest distance to the side \[m\].
    pub(super) length: f64,
    pub(super) half_width: f64,
    /// Distance of layers \[m\].
    pub(super) step: f64,
    /// Bins of the sine and of the bank to either side.
    pub(super) sines: usize,
    pub(super) banks: usize,
}

/// Where a bin leads to in a layer: the place of the other bin, and the least and greatest change of `y`.
struct Leg {
    to: usize,
    change: Interval,
}

type Sets = Vec<Vec<Interval>>;

impl Reach<'_> {
    /// The first layer that no flight of the envelope reaches \[m\]; `None` if there is no such layer up to the end.
    pub(super) fn blocked_at(&self) -> Option<f64> {
        let legs: Vec<Vec<Leg>> = (0..2 * self.sines)
            .flat_map(|sine| (0..2 * self.banks).map(move |bank| (sine, bank)))
            .map(|(sine, bank)| self.legs(sine, bank))
            .collect();
        let mut sets: Sets = vec![Vec::new(); legs.len()];
        // The start is on the edge of four bins.
        for (sine, bank) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let place = self.place(self.sines - sine, self.banks - bank);
            sets[place].push((0.0, 0.0));
        }
        let layers = (self.length / self.step).floor() as usize;
        for number in 1..=layers {
            let x = number as f64 * self.step;
            sets = self.next(&sets, &legs, x);
            if sets.iter().all(Vec::is_empty) {
                return Some(x);
            }
        }
        None
    }

    fn place(&self, sine: usize, bank: usize) -> usize {
        sine * 2 * self.banks + bank
    }

    /// The ends of a bin of the sine.
    fn sine(&self, bin: usize) -> Interval {
        let width = libm::sin(self.envelope.course) / self.sines as f64;
        let low = (bin as f64 - self.sines as f64) * width;
        (low, low + width)
    }

    /// The ends of a bin of the bank \[rad\].
    fn bank(&self, bin: usize) -> Interval {
        let width = self.envelope.bank / self.banks as f64;
        let low = (bin as f64 - self.banks as f64) * width;
        (low, low + width)
    }

    /// Where a bin leads to.
    fn legs(&self, sine: usize, bank: usize) -> Vec<Leg> {
        let (envelope, step) = (self.envelope, self.step);
        let [slow, fast] = envelope.speed;
        let (from, banked) = (self.sine(sine), self.bank(bank));
        let width = from.1 - from.0;
        // No sine of the layer is beyond this.
        let most_turn = (GRAVITY * libm::tan(envelope.bank) + envelope.uneven) / (slow * slow);
        let beyond = from.0.abs().max(from.1.abs()) + most_turn * step;
        let least_cos = (1.0 - beyond * beyond).max(0.0).sqrt();
        let least_cos = least_cos.max(libm::cos(envelope.course));
        let rolled = envelope.bank_rate * step / (slow * least_cos);
        let bins = (rolled / (banked.1 - banked.0) - ROUNDING).ceil() as usize;
        let mut legs = Vec::new();
        for other in bank.saturating_sub(bins)..=(bank + bins).min(2 * self.banks - 1) {
            let to = self.bank(other);
            let steep = |low: f64, high: f64, by: f64| {
                (0.5 * (low + high) + by).clamp(-envelope.bank, envelope.bank)
            };
            let [least, most] = [
                steep(banked.0, to.0, -0.5 * rolled),
                steep(banked.1, to.1, 0.5 * rolled),
            ]
            .map(|bank| GRAVITY * libm::tan(bank));
            let by_square = |force: f64| [slow, fast].map(|v| force / (v * v));
            let least =
                (by_square(least - envelope.uneven).into_iter()).fold(f64::INFINITY, f64::min);
            let most =
                (by_square(most + envelope.uneven).into_iter()).fold(f64::NEG_INFINITY, f64::max);
            let first = sine as f64 + (least * step / width - ROUNDING).floor();
            let last = sine as f64 + (most * step / width + ROUNDING).ceil();
            let end = 2 * self.sines - 1;
            if last < 0.0 || first > end as f64 {
                continue;
            }
            for target in first.max(0.0) as usize..=(last as usize).min(end) {
                let to = self.sine(target);
                let limit = libm::sin(envelope.course);
                let right = highest(from.1, to.1, [least, most], step, limit);
                let left = -highest(-from.0, -to.0, [-most, -least], step, limit);
                legs.push(Leg {
                    to: self.place(target, other),
                    change: (left - ROUNDING, right + ROUNDING),
                });
            }
        }
        legs
    }

    /// The sets of the next layer, the one at `x`.
    fn next(&self, from: &Sets, legs: &[Vec<Leg>], x: f64) -> Sets {
        let mut sets: Sets = vec![Vec::new(); from.len()];
        for (before, legs) in from.iter().zip(legs) {
            if before.is_empty() {
                continue;
            }
            for leg in legs {
                let (left, right) = leg.change;
                sets[leg.to].extend(before.iter().map(|(low, high)| (low + left, high + right)));
            }
        }
        let reach = self.hull.radius;
        let near = |trunk: &&Trunk| (trunk.at[0] - x).abs() <= reach + trunk.radius;
        let near: Vec<Trunk> = self.trunks.iter().filter(near).copied().collect();
        let open = self.open(&near, x);
        for set in sets.iter_mut().filter(|set| !set.is_empty()) {
            unite(set);
            *set = common(set, &open);
        }
        sets
    }

    /// Where the middle of the hull touches no trunk.
    fn open(&self, near: &[Trunk], x: f64) -> Vec<Interval> {
        let mut closed: Vec<Interval> = Vec::new();
        for trunk in near {
            let ahead = trunk.at[0] - x;
            let close = trunk.radius + self.hull.radius;
            if ahead.abs() < close {
                let aside = (close * close - ahead * ahead).sqrt();
                closed.push((trunk.at[1] - aside, trunk.at[1] + aside));
            }
        }
        unite(&mut closed);
        let mut open = Vec::new();
        let mut left = -self.half_width;
        for (low, high) in closed {
            if low >= left {
                open.push((left, low));
            }
            left = left.max(high);
        }
        if left <= self.half_width {
            open.push((left, self.half_width));
        }
        open
    }
}

/// Greatest change of `y` over a distance \[m\] from a sine to another one, when the sine changes between two rates [1/m].
fn highest(from: f64, to: f64, [least, most]: [f64; 2], distance: f64, limit: f64) -> f64 {
    // `s` is below the line that rises from its start and the one that leads to its end.
    let rise = ((to - from - least * distance) / (most - least)).clamp(0.0, distance);
    let peak = (from + most * rise)
        .max(to - least * (distance - rise))
        .clamp(-limit, limit);
    rise * mean_slope(from, peak) + (distance - rise) * mean_slope(peak, to)
}

/// Mean of `s / sqrt(1 - s^2)` over a line between two sines.
fn mean_slope(from: f64, to: f64) -> f64 {
    let cosine = |sine: f64| (1.0 - sine * sine).sqrt();
    if (to - from).abs() < 1e-6 {
        let most = from.max(to);
        return most / cosine(most) + 1e-5;
    }
    (cosine(from) - cosine(to)) / (to - from)
}
