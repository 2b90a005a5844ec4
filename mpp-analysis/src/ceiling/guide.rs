//! A guide through a known field: the price of the way on from every place, height and slope, for an aircraft that turns at
//! once. It proves nothing; the search for a witness follows it.

use super::free::Interval;
use mpp_sim::field::{Obstacle, Point};
use mpp_sim::outcome::FLIGHT_PATH_LIMIT;

/// Price of a metre of way at a depth of a metre in an obstacle [1/m^2]. A way that cuts a corner by a hand's breadth may
/// still show where a way is, because the grid is coarse.
const DEPTH: f32 = 300.0;
/// Price of a place from which no way leads on.
const CLOSED: f32 = 1e4;
/// Price of a metre of way along an edge [1/m]; it falls with the square of the lack of room.
const TIGHT: f32 = 4.0;
/// Price of a change of slope by a step; it prefers flights that save their turns.
const TURN: f32 = 0.02;

/// Prices over a grid of places, heights and slopes.
pub(super) struct Guide {
    origin: Point,
    /// Distance of places and of heights \[m\].
    step: Point,
    heights: usize,
    /// Number of steps of slope to either side of level.
    slopes: usize,
    /// Sine of the flight path angle of a step of slope [-].
    sine: f64,
    /// By place, then by height, then by slope.
    prices: Vec<f32>,
}

/// What a guide is made for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way<'a> {
    pub(super) obstacles: &'a [Obstacle],
    pub(super) start: Point,
    pub(super) end: f64,
    pub(super) band: Interval,
    /// Distance that a flight has to keep, and the one it should have \[m\].
    pub(super) margin: f64,
    pub(super) room: f64,
    /// Rate of the sine of the flight path angle [1/m].
    pub(super) turn: f64,
    /// Distance of heights \[m\].
    pub(super) rise: f64,
    /// Number of steps of slope to either side of level.
    pub(super) slopes: usize,
}

impl Guide {
    /// Prices the ways of a field, from its end backwards.
    pub(super) fn new(way: &Way<'_>) -> Self {
        let limit = libm::sin(FLIGHT_PATH_LIMIT);
        let sine = limit / way.slopes as f64;
        let step = (sine / way.turn, way.rise);
        let heights = ((way.band.1 - way.band.0) / step.1) as usize + 1;
        let places = ((way.end - way.start.0) / step.0).ceil() as usize + 1;
        let layer = heights * (2 * way.slopes + 1);
        let mut guide = Self {
            origin: (way.start.0, way.band.0),
            step,
            heights,
            slopes: way.slopes,
            sine,
            prices: vec![0.0; places * layer],
        };
        for place in (0..places - 1).rev() {
            let x = way.start.0 + (place as f64 + 0.5) * step.0;
            let tolls = guide.tolls(way, x);
            for height in 0..heights {
                for slope in 0..=2 * way.slopes {
                    guide.prices[place * layer + height * (2 * way.slopes + 1) + slope] =
                        guide.best(place, height, slope, &tolls);
                }
            }
        }
        guide
    }

    /// The price of a metre at each height at `x`.
    fn tolls(&self, way: &Way<'_>, x: f64) -> Vec<f32> {
        let near: Vec<&Obstacle> = way
            .obstacles
            .iter()
            .filter(|one| {
                let middle = 0.5 * (way.band.0 + way.band.1);
                one.clearance((x, middle), 0.0) < way.band.1 - middle + way.margin + way.room
            })
            .collect();
        (0..self.heights)
            .map(|height| {
                let z = self.origin.1 + height as f64 * self.step.1;
                let edge = (z - way.band.0).min(way.band.1 - z);
                let clearance = near
                    .iter()
                    .map(|one| one.clearance((x, z), 0.0) - way.margin)
                    .fold(edge, f64::min);
                if clearance < 0.0 {
                    TIGHT - DEPTH * clearance as f32
                } else {
                    let lack = (1.0 - clearance / way.room).max(0.0) as f32;
                    TIGHT * lack * lack
                }
            })
            .collect()
    }

    /// The least price of the way on from a grid point.
    fn best(&self, place: usize, height: usize, slope: usize, tolls: &[f32]) -> f32 {
        let mut best = f32::INFINITY;
        for next in slope.saturating_sub(1)..=(slope + 1).min(2 * self.slopes) {
            let sine = (0.5 * (slope + next) as f64 - self.slopes as f64) * self.sine;
            let rise = self.step.0 * sine / (1.0 - sine * sine).sqrt() / self.step.1;
            let at = height as f64 + rise;
            if at < 0.0 || at > (self.heights - 1) as f64 {
                continue;
            }
            let toll = tolls[(height as f64 + 0.5 * rise).round() as usize];
            let turned = if next == slope { 0.0 } else { TURN };
            let onward = self.between(place + 1, at, next);
            best = best.min(toll * self.step.0 as f32 + turned + onward);
        }
        if best.is_finite() { best } else { CLOSED }
    }

    /// The price between two heights, at a place and a slope of the grid.
    fn between(&self, place: usize, height: f64, slope: usize) -> f32 {
        let low = (height as usize).min(self.heights - 2);
        let share = (height - low as f64) as f32;
        let price = |height: usize| {
            self.prices[(place * self.heights + height) * (2 * self.slopes + 1) + slope]
        };
        price(low) * (1.0 - share) + price(low + 1) * share
    }

    /// The price of the way on from a place with a sine of the flight path angle.
    pub(super) fn price(&self, at: Point, sine: f64) -> f32 {
        let places = self.prices.len() / (self.heights * (2 * self.slopes + 1));
        let place = ((at.0 - self.origin.0) / self.step.0).max(0.0);
        let height = ((at.1 - self.origin.1) / self.step.1).clamp(0.0, (self.heights - 1) as f64);
        let slope = (sine / self.sine + self.slopes as f64).clamp(0.0, 2.0 * self.slopes as f64);
        let near = (place as usize).min(places.saturating_sub(2));
        let low = (slope as usize).min(2 * self.slopes - 1);
        let ahead = (place - near as f64).min(1.0) as f32;
        let steep = (slope - low as f64) as f32;
        let corner = |place: usize| {
            self.between(place, height, low) * (1.0 - steep)
                + self.between(place, height, low + 1) * steep
        };
        corner(near) * (1.0 - ahead) + corner(near + 1) * ahead
    }
}
