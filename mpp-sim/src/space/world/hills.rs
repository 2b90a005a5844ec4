//! Hills: a height map that is drawn.

use super::terrain::Terrain;
use super::{Extent, World, WorldError};
use crate::random::{Draws, uniform};
use core::f64::consts::PI;

/// Usual wanted height over terrain \[m\]. Source: chosen, below the tops of most hills.
pub const ALTITUDE: f64 = 15.0;
/// Distance of heights \[m\].
const CELL: f64 = 5.0;
/// Hills on a metre ahead [1/m]: the feet of some meet. Source: chosen.
const RATE: f64 = 0.03;
/// Least and greatest radius of a hill \[m\]. Source: chosen; a flight of 240 m passes about six.
const RADIUS: [f64; 2] = [30.0, 80.0];
/// Steepest slope of a hill, as a share of that of the steepest one [-]. Source: chosen.
const SHARE: [f64; 2] = [0.7, 1.0];

/// The world of hills that are nowhere steeper than `slope`. `area`: the least and the greatest x, and the greatest y. Around
/// the start it is level up to a distance of `free` \[m\].
pub(super) fn hills(
    [slope, altitude]: [f64; 2],
    extent: Extent,
    area: [f64; 3],
    free: f64,
    draws: &mut Draws,
) -> Result<World, WorldError> {
    let world = World::over(drawn(slope, area, free, draws), altitude)?;
    let extent = Extent {
        ceiling: world.extent.ceiling,
        ..extent
    };
    Ok(World { extent, ..world })
}

/// Hills with the outline of a cosine. The ground is as high as the highest one.
fn drawn(slope: f64, [first, last, half]: [f64; 3], free: f64, draws: &mut Draws) -> Terrain {
    let mut hills: Vec<[f64; 4]> = Vec::new();
    let mut x = first;
    loop {
        x -= libm::log(1.0 - uniform(draws)) / RATE;
        let mut between = |[low, high]: [f64; 2]| low + (high - low) * uniform(draws);
        let (y, radius, share) = (between([-half, half]), between(RADIUS), between(SHARE));
        if x > last {
            break;
        }
        // The steepest slope of `height cos^2(pi d / 2 radius)` is `height pi / 2 radius`.
        let height = share * slope * 2.0 * radius / PI;
        if libm::hypot(x, y) > free + radius {
            hills.push([x, y, radius, height]);
        }
    }
    let height = |x: f64, y: f64| {
        let of = |[at, aside, radius, height]: &[f64; 4]| {
            let distance = (libm::hypot(x - at, y - aside) / radius).min(1.0);
            let share = libm::cos(0.5 * PI * distance);
            height * share * share
        };
        hills.iter().map(of).fold(0.0, f64::max)
    };
    let (columns, rows) = (((last - first) / CELL) as u32, (2.0 * half / CELL) as u32);
    let along = |from: f64, step: u32| from + f64::from(step) * CELL;
    let row = |row| {
        (0..=columns)
            .map(|it| height(along(first, it), along(-half, row)))
            .collect()
    };
    Terrain {
        corner: [first, -half],
        cell: CELL,
        rows: (0..=rows).map(row).collect(),
    }
}
