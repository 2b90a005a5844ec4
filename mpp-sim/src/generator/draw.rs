//! How each generator draws its field.

use super::config::{Generator, GeneratorName};
use crate::field::{Obstacle, Point, Shape, evenly_spaced};
use crate::random::{self, Draws, Stream};

/// Downrange distance of the first obstacle from the start \[m\] (the authors' code).
const FIRST: f64 = 25.0;
/// Downrange distance of the last obstacle from the start \[m\] (the authors' code).
const LAST: f64 = 240.0;
/// Greatest distance of the paper's centres from the altitude \[m\] (the authors' code).
const PAPERS_BAND: f64 = 10.0;
/// Distance from the altitude beyond which a flight is not strict \[m\]: the paper's band and the
/// paper's radius. [`crate::outcome::ALTITUDE_BAND`] is the same.
pub(crate) const BAND: f64 = 11.0;
/// Distance from the altitude up to which walls reach \[m\]: 3 m beyond the band, so that no way leads
/// round them that is not far out of it.
const REACH: f64 = 14.0;
/// Greatest offset of the end of a slalom's wall \[m\], in both directions.
const SLALOM_SHIFT: f64 = 1.0;
/// Steepest way from a canyon's bend to the next, or from a gap to the next [-]: 15 deg, a third of
/// the flight path angle at which a flight fails.
const STEEPEST: f64 = 0.27;
/// Least radius in a forest as a share of the greatest [-]: 0.25 m of 1 m, as in FASTER's forests.
const THINNEST: f64 = 0.25;
/// Speed at which an aircraft meets moving obstacles at their drawn places [m/s]: the paper's cruise.
const CRUISE: f64 = 12.0;
/// Distance that an endless field goes on for each second of flight [m/s]: more than an aircraft
/// flies.
const ENDLESS: f64 = 15.0;
/// Distance that an endless field goes on beyond that \[m\]: a lidar's sight.
const SIGHT: f64 = 60.0;

/// Length of an endless field as a share of the length of the others [-].
pub(super) fn endless_share(duration: f64) -> f64 {
    (ENDLESS * duration + SIGHT - FIRST) / (LAST - FIRST)
}

/// The obstacles of a field, at rest.
pub(super) fn field(
    generator: &Generator,
    seed: u64,
    count: usize,
    altitude: f64,
    duration: f64,
) -> Vec<Obstacle> {
    let Generator { radius, gap, .. } = *generator;
    // The paper's heights have a stream of their own. Whatever else is drawn does not move them.
    let mut heights = random::generator(seed, Stream::Field);
    let mut others = random::generator(seed, Stream::Generator);
    let places = evenly_spaced(FIRST, LAST, count);
    let sealed = BAND + radius;
    match generator.name {
        GeneratorName::Paper => places
            .map(|x| Obstacle::circle(x, altitude + within(PAPERS_BAND, &mut heights), radius))
            .collect(),
        GeneratorName::Sealed => places
            .map(|x| Obstacle::circle(x, altitude + within(sealed, &mut heights), radius))
            .collect(),
        GeneratorName::Endless => {
            let end = FIRST + endless_share(duration) * (LAST - FIRST);
            poisson(FIRST, end, count, &mut others)
                .into_iter()
                .map(|x| Obstacle::circle(x, altitude + within(sealed, &mut heights), radius))
                .collect()
        }
        GeneratorName::Forest => forest(generator, count, altitude, &mut others),
        GeneratorName::Canyon => {
            let middle: Vec<Point> = core::iter::once((0.0, altitude))
                .chain(wander(places, altitude, BAND - 0.5 * gap, &mut others))
                .collect();
            let off = |by: f64| middle.iter().map(|(x, z)| (*x, z + by)).collect::<Vec<_>>();
            vec![
                Obstacle::at_rest(Shape::ground(&off(-0.5 * gap))),
                Obstacle::at_rest(Shape::ceiling(&off(0.5 * gap))),
            ]
        }
        GeneratorName::Slalom => slalom(generator, places, altitude, &mut others),
        GeneratorName::Walls => wander(places, altitude, BAND - 0.5 * gap, &mut others)
            .into_iter()
            .flat_map(|(x, z)| {
                let below = upright(x, radius, altitude - REACH, z - 0.5 * gap);
                [below, upright(x, radius, z + 0.5 * gap, altitude + REACH)]
            })
            .collect(),
        GeneratorName::Wires => places
            .map(|x| {
                let centre = (x, altitude + within(sealed, &mut heights));
                bar(centre, generator, &mut others)
            })
            .collect(),
    }
}

/// A uniform number from `-half` to `half`.
fn within(half: f64, generator: &mut Draws) -> f64 {
    half * (2.0 * random::uniform(generator) - 1.0)
}

/// Places of a Poisson process from `first` to `last`, `count` of them over 215 m on average.
fn poisson(first: f64, last: f64, count: usize, generator: &mut Draws) -> Vec<f64> {
    let mut places = Vec::new();
    if count == 0 {
        return places;
    }
    let mean = (LAST - FIRST) / count as f64;
    let mut x = first;
    loop {
        // 1 - u is in (0, 1]: its logarithm is finite.
        x -= mean * libm::log(1.0 - random::uniform(generator));
        if x > last {
            return places;
        }
        places.push(x);
    }
}

/// Clusters at random places. The last one may be smaller.
fn forest(generator: &Generator, count: usize, altitude: f64, random: &mut Draws) -> Vec<Obstacle> {
    let Generator {
        radius,
        spread,
        cluster,
        ..
    } = *generator;
    let mut middle = (0.0, 0.0);
    let mut obstacles: Vec<Obstacle> = (0..count)
        .map(|number| {
            if number.is_multiple_of(cluster.max(1)) {
                let x = FIRST + (LAST - FIRST) * random::uniform(random);
                middle = (x, altitude + within(BAND + radius, random));
            }
            let x = middle.0 + spread * random::gaussian(random);
            let z = middle.1 + spread * random::gaussian(random);
            let size = THINNEST + (1.0 - THINNEST) * random::uniform(random);
            // Nothing stands nearer to the start than the first place.
            Obstacle::circle(FIRST + (x - FIRST).abs(), z, size * radius)
        })
        .collect();
    obstacles.sort_by(|a, b| a.middle().total_cmp(&b.middle()));
    obstacles
}

/// Heights at places, each uniform within `half` of the altitude, and no farther from the one before
/// than [`STEEPEST`] allows. The way to the first one begins at the start.
fn wander(
    places: impl Iterator<Item = f64>,
    altitude: f64,
    half: f64,
    generator: &mut Draws,
) -> Vec<Point> {
    let mut before = (0.0, altitude);
    places
        .map(|x| {
            let step = STEEPEST * (x - before.0);
            let z = altitude + within(half, generator);
            before = (x, z.clamp(before.1 - step, before.1 + step));
            before
        })
        .collect()
}

/// Walls from below and from above in turn. The seed decides which comes first.
fn slalom(
    generator: &Generator,
    places: impl Iterator<Item = f64>,
    altitude: f64,
    random: &mut Draws,
) -> Vec<Obstacle> {
    let Generator { radius, gap, .. } = *generator;
    let mut side = if random::uniform(random) < 0.5 {
        -1.0
    } else {
        1.0
    };
    places
        .map(|x| {
            // A wall from below ends `gap` beneath the upper edge of the band.
            let end = altitude + side * (gap - BAND) + within(SLALOM_SHIFT, random);
            // The end is round: its middle is a radius short of it.
            let points = vec![(x, altitude + side * REACH), (x, end + side * radius)];
            side = -side;
            Obstacle::at_rest(Shape::Line { points, radius })
        })
        .collect()
}

/// A wall between two heights.
fn upright(x: f64, half: f64, low: f64, high: f64) -> Obstacle {
    let corners = vec![
        (x - half, low),
        (x + half, low),
        (x + half, high),
        (x - half, high),
    ];
    Obstacle::at_rest(Shape::Polygon { corners })
}

/// A thin circle, or a bar in a random direction.
fn bar(centre: Point, generator: &Generator, random: &mut Draws) -> Obstacle {
    let Generator { radius, length, .. } = *generator;
    if length <= 0.0 {
        return Obstacle::circle(centre.0, centre.1, radius);
    }
    let (up, ahead) = libm::sincos(core::f64::consts::PI * random::uniform(random));
    let end = |share: f64| {
        (
            centre.0 + share * length * ahead,
            centre.1 + share * length * up,
        )
    };
    let points = vec![end(-0.5), end(0.5)];
    Obstacle::at_rest(Shape::Line { points, radius })
}

/// Gives each obstacle the velocity, with a random sign of its vertical part, and moves it to where
/// it has to start.
pub(super) fn set_in_motion(obstacles: &mut [Obstacle], velocity: Point, seed: u64) {
    if velocity == (0.0, 0.0) {
        return;
    }
    let mut generator = random::generator(seed, Stream::Motion);
    for obstacle in obstacles {
        let up = if random::uniform(&mut generator) < 0.5 {
            -1.0
        } else {
            1.0
        };
        obstacle.velocity = (velocity.0, up * velocity.1);
        let back = -obstacle.middle() / CRUISE;
        let (dx, dz) = (back * obstacle.velocity.0, back * obstacle.velocity.1);
        obstacle.shape.shift((dx, dz));
    }
}
