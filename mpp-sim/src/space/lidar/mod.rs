//! Lidars in space: sweeps of beams, each with its own time.
//!
//! A beam's direction is in the body's axes: ahead, to the right, *down*, as everything of the body. Its range counts from the
//! place of the sensor in the body, [`SpaceLidarConfig::offset`].

mod config;
#[cfg(test)]
mod tests;

pub use config::{LidarName, Pattern, SpaceLidarConfig};

use super::pose::Pose;
use super::world::{World, plus};
use crate::random::{self, Draws, Stream, gaussian, uniform};

/// Steps of the low-discrepancy sequence of two dimensions: powers of the root of `x^3 = x + 1`, inverted.
const SEQUENCE: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
/// Step of the rings from sweep to sweep, as a share of their distance: the golden ratio leaves the least gaps.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Way behind a return after which a beam that sees through looks for the next one \[m\]: a voxel of the map.
const BEHIND: f64 = 0.5;

/// One beam of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Direction in the body's axes, of unit length.
    pub direction: [f64; 3],
    /// Time from the start of the sweep \[s\].
    pub time: f64,
    /// Range \[m\], if there is a return.
    pub range: Option<f64>,
}

/// A lidar and its streams of random numbers.
#[derive(Clone, Debug)]
pub struct SpaceLidar {
    config: SpaceLidarConfig,
    draws: Draws,
    /// Where the sequences of directions are, within 1.
    phase: [f64; 2],
    /// Most returns of a sweep whose beams go through what they hit; by default they end there.
    through: Option<usize>,
    sweeps: usize,
}

impl SpaceLidar {
    /// The lidar of the flight with this seed.
    #[must_use]
    pub fn new(seed: u64, config: SpaceLidarConfig) -> Self {
        let mut draws = random::generator(seed, Stream::SpaceLidar);
        Self {
            config,
            phase: [uniform(&mut draws), uniform(&mut draws)],
            draws,
            through: None,
            sweeps: 0,
        }
    }

    /// Lets beams go through what they hit: nothing hides anything. A sweep has at most so many returns, the first ones among them.
    pub(super) fn see_through(&mut self, most: usize) {
        self.through = Some(most);
    }

    /// Its data.
    #[must_use]
    pub fn config(&self) -> &SpaceLidarConfig {
        &self.config
    }

    /// One sweep that begins at a time \[s\]; `pose` gives the true pose at a time. The beams come in the order of their times, so
    /// that a packet of 1 to 5 ms is a slice of them.
    pub fn sweep(
        &mut self,
        world: &World,
        pose: impl Fn(f64) -> Pose,
        start_time: f64,
    ) -> Vec<Beam> {
        let directions = self.directions();
        let beams = directions.into_iter().map(|(direction, time)| {
            let pose = pose(start_time + time);
            Beam {
                direction,
                time,
                range: self.range(world, &pose, direction),
            }
        });
        let beams: Vec<Beam> = beams.collect();
        let config = self.config;
        match self.through {
            Some(most) => self.seen_through(most, beams, |beam| {
                further(world, &pose(start_time + beam.time), &config, beam)
            }),
            None => beams,
        }
    }

    /// Beams, and behind each its further returns. Where there is no room for all of them, others are left out in each sweep.
    fn seen_through(
        &mut self,
        most: usize,
        beams: Vec<Beam>,
        further: impl Fn(&Beam) -> Vec<Beam>,
    ) -> Vec<Beam> {
        let all: Vec<Vec<Beam>> = beams.iter().map(further).collect();
        let room = most.saturating_sub(beams.len()).max(1);
        let share = all.iter().map(Vec::len).sum::<usize>().div_ceil(room);
        self.sweeps += 1;
        let mut number = self.sweeps;
        let mut seen = Vec::with_capacity(most);
        for (beam, further) in beams.into_iter().zip(all) {
            seen.push(beam);
            for beam in further {
                number += 1;
                if number.is_multiple_of(share) {
                    seen.push(beam);
                }
            }
        }
        seen.truncate(most);
        seen
    }

    /// A sweep from one pose, as if the sensor did not move.
    pub fn sweep_at(&mut self, world: &World, pose: &Pose) -> Vec<Beam> {
        self.sweep(world, |_| *pose, 0.0)
    }

    fn range(&mut self, world: &World, pose: &Pose, direction: [f64; 3]) -> Option<f64> {
        let SpaceLidarConfig {
            range: [nearest, farthest],
            noise: [constant, linear, square],
            drop_outs,
            false_returns,
            offset,
            ..
        } = self.config;
        // Every beam draws the same numbers, so that another body does not move the noise of other beams.
        let noise = gaussian(&mut self.draws);
        let [drops, is_false, share] = [0; 3].map(|_| uniform(&mut self.draws));
        let hit = world.ray(pose.place(offset), pose.direction(direction), farthest);
        if is_false < false_returns {
            let end = hit.unwrap_or(farthest).max(nearest);
            return Some(nearest + share * (end - nearest));
        }
        let hit = hit.filter(|range| *range >= nearest && drops >= drop_outs)?;
        let sigma = constant + hit * (linear + hit * square);
        Some((hit + sigma * noise).clamp(nearest, farthest))
    }

    /// Directions of the next sweep in the body's axes, with their times from its start.
    fn directions(&mut self) -> Vec<([f64; 3], f64)> {
        let SpaceLidarConfig {
            pattern,
            azimuth,
            elevation,
            period,
            mount,
            ..
        } = self.config;
        let at = |[low, high]: [f64; 2], share: f64| (low + share * (high - low)).to_radians();
        let polar = |azimuth: f64, elevation: f64| {
            let ((sin, cos), (up, level)) = (libm::sincos(azimuth), libm::sincos(elevation));
            mount.in_world([cos * level, sin * level, -up])
        };
        match pattern {
            Pattern::Rings {
                rings,
                azimuths,
                staggered,
            } => {
                let gaps = f64::from(rings.max(2) - 1);
                let mut shift = 0.0;
                if staggered {
                    self.phase[0] = wrapped(self.phase[0] + GOLDEN);
                    shift = (self.phase[0] - 0.5) / gaps;
                }
                let columns =
                    (0..azimuths).flat_map(|column| (0..rings).map(move |it| (column, it)));
                let beams = columns.map(|(column, ring)| {
                    let share = f64::from(column) / f64::from(azimuths);
                    let middle = share + 0.5 / f64::from(azimuths);
                    let height = f64::from(ring) / gaps + shift;
                    (
                        polar(at(azimuth, middle), at(elevation, height)),
                        share * period,
                    )
                });
                beams.collect()
            }
            Pattern::Scattered { beams } => {
                // As dense on the sphere everywhere: even in the sine of the elevation.
                let [low, high] = elevation.map(|it| libm::sin(it.to_radians()));
                let next = (0..beams).map(|beam| {
                    self.phase = [0, 1].map(|axis| wrapped(self.phase[axis] + SEQUENCE[axis]));
                    let up = low + self.phase[1] * (high - low);
                    let azimuth = at(azimuth, self.phase[0]);
                    let time = f64::from(beam) / f64::from(beams) * period;
                    (polar(azimuth, libm::asin(up)), time)
                });
                next.collect()
            }
            Pattern::Image { pixels } => {
                let edges = [azimuth, elevation].map(|it| it.map(|it| libm::tan(it.to_radians())));
                let on_plane = |axis: usize, pixel: u32| {
                    let share = (f64::from(pixel) + 0.5) / f64::from(pixels[axis]);
                    edges[axis][0] + share * (edges[axis][1] - edges[axis][0])
                };
                let places = (0..pixels[1]).flat_map(|row| (0..pixels[0]).map(move |it| (it, row)));
                let beams = places.map(|(column, row)| {
                    let (right, up) = (on_plane(0, column), on_plane(1, row));
                    let length = (1.0 + right * right + up * up).sqrt();
                    let in_sensor = [1.0, right, -up].map(|part| part / length);
                    (mount.in_world(in_sensor), 0.0)
                });
                beams.collect()
            }
        }
    }
}

/// A number of at least 0 within 1.
fn wrapped(value: f64) -> f64 {
    value - value.floor()
}

/// The returns of a beam behind its first one, without noise.
fn further(world: &World, pose: &Pose, config: &SpaceLidarConfig, beam: &Beam) -> Vec<Beam> {
    let (from, direction) = (pose.place(config.offset), pose.direction(beam.direction));
    let [_, farthest] = config.range;
    let mut returns = Vec::new();
    let mut way = beam.range.map_or(farthest, |range| range + BEHIND);
    while way < farthest {
        let at = plus(from, direction, way);
        let Some(next) = world.ray(at, direction, farthest - way) else {
            break;
        };
        way += next;
        // At once: still inside the same body.
        if next > 0.0 {
            let range = Some(way);
            returns.push(Beam { range, ..*beam });
        }
        way += BEHIND;
    }
    returns
}
