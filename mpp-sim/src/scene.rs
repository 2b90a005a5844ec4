//! The challenge scenes: the situations that make trajectory optimisation around obstacles hard
//! (paper, Figure 1). They are walls of circles in an otherwise empty sky.
//!
//! The flight's seed draws the place of every scene. The aircraft can pass every scene within the
//! strict rule's altitude band. Even at the worst offset, the way round that is shown as open has
//! at least 4 m between the wall and the edge of the band. The wall comes into the lidar's sight
//! more than 30 m before the aircraft reaches it. Heights are relative to the flight's altitude.

use crate::field::Obstacle;
use crate::names::by_name;
use crate::random::{self, Stream};
use serde::{Deserialize, Serialize};

/// Radius of the circles that walls are made of \[m\].
const RADIUS: f64 = 1.0;
/// Distance between the centres of these circles \[m\]: no lidar beam and no aircraft passes in
/// between.
const SPACING: f64 = 1.0;
/// Distance of a scene from the start, downrange \[m\].
const AHEAD: f64 = 60.0;
/// Greatest offset of a scene from this distance, in both directions \[m\].
const SHIFT_X: f64 = 5.0;
/// Greatest offset of a scene in height, in both directions \[m\].
const SHIFT_Z: f64 = 1.5;

/// The named challenge scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scene {
    /// A bowl of 5 m radius that opens towards the aircraft. Inside the bowl, the way to the goal
    /// leads into the wall. The ways round pass above and below.
    Flytrap,
    /// A plate, 9 m high, at a right angle to the way. Every normal of its face points straight
    /// against the flight, which cannot slow down. The ways round pass above and below.
    Dynamics,
    /// A wall that leans towards the aircraft. It reaches from 4 m on one side of the way to 15 m
    /// on the other; the seed decides which side is up. Its face leads along the long way round,
    /// out of the band. The short way passes over its near edge.
    LongWay,
}

impl Scene {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Flytrap, Self::Dynamics, Self::LongWay];

    /// Its name on the command line and in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Flytrap => "flytrap",
            Self::Dynamics => "dynamics",
            Self::LongWay => "long-way",
        }
    }

    /// Its obstacles in the flight with this seed, which starts at `start_x` and `altitude` \[m\].
    #[must_use]
    pub fn obstacles(self, seed: u64, start_x: f64, altitude: f64) -> Vec<Obstacle> {
        let mut generator = random::generator(seed, Stream::Scene);
        let mut either_way = || 2.0 * random::uniform(&mut generator) - 1.0;
        let x = start_x + AHEAD + SHIFT_X * either_way();
        let z = altitude + SHIFT_Z * either_way();
        let upside = if either_way() < 0.0 { -1.0 } else { 1.0 };
        let circle = |(dx, dz): (f64, f64)| Obstacle::circle(x + dx, z + upside * dz, RADIUS);
        self.outline().into_iter().map(circle).collect()
    }

    /// Centres of the circles relative to the place of the scene.
    fn outline(self) -> Vec<(f64, f64)> {
        match self {
            Self::Flytrap => bowl(5.0),
            Self::Dynamics => wall((0.0, -3.5), (0.0, 3.5)),
            Self::LongWay => wall((0.0, 3.0), (12.0, -14.0)),
        }
    }
}

by_name!(Scene, "scene");

/// Half a circle about the origin that opens towards the aircraft.
fn bowl(radius: f64) -> Vec<(f64, f64)> {
    let half = core::f64::consts::FRAC_PI_2;
    let gaps = (2.0 * half * radius / SPACING).ceil() as usize;
    let at = |k: usize| {
        let (up, ahead) = libm::sincos(half * (2.0 * k as f64 / gaps as f64 - 1.0));
        (radius * ahead, radius * up)
    };
    (0..=gaps).map(at).collect()
}

/// A straight row of circles from one centre to another.
fn wall(from: (f64, f64), to: (f64, f64)) -> Vec<(f64, f64)> {
    let (dx, dz) = (to.0 - from.0, to.1 - from.1);
    let gaps = (libm::hypot(dx, dz) / SPACING).ceil() as usize;
    let at = |k: usize| {
        let share = k as f64 / gaps as f64;
        (from.0 + share * dx, from.1 + share * dz)
    };
    (0..=gaps).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Circle, FieldFile};
    use crate::outcome::ALTITUDE_BAND;

    const ALTITUDE: f64 = 50.0;

    fn circles(scene: Scene, seed: u64) -> Vec<Circle> {
        FieldFile::of(&scene.obstacles(seed, 0.0, ALTITUDE)).circle
    }

    fn edges(obstacles: &[Circle], pick: fn(&Circle) -> f64) -> (f64, f64) {
        obstacles
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), o| {
                (low.min(pick(o) - o.radius), high.max(pick(o) + o.radius))
            })
    }

    #[test]
    fn every_scene_bars_the_way_ahead_and_leaves_a_fair_way_round() {
        for scene in Scene::ALL {
            for seed in 0..500 {
                let obstacles = circles(scene, seed);
                let (low, high) = edges(&obstacles, |o| o.z);
                assert!(
                    low < ALTITUDE - 1.0 && high > ALTITUDE + 1.0,
                    "{scene:?} {seed}"
                );
                let above = ALTITUDE + ALTITUDE_BAND - high;
                let below = low - (ALTITUDE - ALTITUDE_BAND);
                assert!(
                    above.max(below) >= 4.0,
                    "{scene:?} {seed}: {above} above, {below} below"
                );
                let (near, _) = edges(&obstacles, |o| o.x);
                assert!((50.0..70.0).contains(&near));
            }
        }
    }

    #[test]
    fn walls_have_no_gaps_and_the_seed_moves_them() {
        for scene in Scene::ALL {
            let obstacles = circles(scene, 1);
            for pair in obstacles.windows(2) {
                let gap = libm::hypot(pair[1].x - pair[0].x, pair[1].z - pair[0].z);
                assert!(gap <= SPACING + 1e-12);
            }
            assert_eq!(obstacles, circles(scene, 1));
            assert_ne!(obstacles, circles(scene, 2));
        }
    }

    #[test]
    fn the_flytrap_opens_towards_the_aircraft() {
        for seed in 0..20 {
            let obstacles = circles(Scene::Flytrap, seed);
            let middle = &obstacles[obstacles.len() / 2];
            let (first, last) = (&obstacles[0], &obstacles[obstacles.len() - 1]);
            assert!(middle.x > first.x + 4.5 && middle.x > last.x + 4.5);
            assert!(middle.z < first.z.max(last.z) && middle.z > first.z.min(last.z));
        }
    }

    /// Exactly one of the two ways round leads out of the band.
    #[test]
    fn the_long_way_leaves_the_band_and_the_seed_turns_it_over() {
        let mut short_way_up = 0;
        for seed in 0..200 {
            let (low, high) = edges(&circles(Scene::LongWay, seed), |o| o.z);
            let closed_below = low < ALTITUDE - ALTITUDE_BAND;
            let closed_above = high > ALTITUDE + ALTITUDE_BAND;
            assert!(closed_below != closed_above, "{seed}: {low} to {high}");
            short_way_up += usize::from(closed_below);
        }
        assert!((60..140).contains(&short_way_up), "{short_way_up}");
    }
}
