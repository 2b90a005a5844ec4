//! What the header of a flight in space says besides.

use crate::space::world::Terrain;
use serde::{Deserialize, Serialize};

/// World and aircraft of a flight in space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpaceHeader {
    /// Name of the world's generator; not written if the trunks are those of a stem map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub world: Option<String>,
    /// Density of the world, in the unit of its generator; not written for a stem map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<f64>,
    /// Side of the windows of walls \[m\], if one was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<f64>,
    /// The height map, if one was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<Terrain>,
    /// Wanted height above the ground at the start \[m\], if one was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub altitude: Option<f64>,
    /// Name of the lidar, if one was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lidar: Option<String>,
    /// Trunks of a stem map: x, y, radius, and height unless it is infinite \[m\].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stems: Vec<(f64, f64, f64, Option<f64>)>,
    /// Way ahead, greatest distance to either side, greatest height \[m\].
    pub extent: [f64; 3],
    /// Radius of a sphere that stands for wing and fuselage \[m\]; not written with them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sphere: Option<f64>,
    /// Whether the measurements had almost no errors.
    pub exact: bool,
    /// Whether beams went through what they hit; not written where they ended there.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub see_through: bool,
    /// Whether programs improved the candidates.
    pub programs: bool,
    /// Name of the baseline that planned in place of the planner; not written without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<String>,
    /// `open` where only plans with a way out were flown; not written otherwise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<String>,
    /// Steady wind ahead, to the right and up [m/s]; not written in still air.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wind: Option<[f64; 3]>,
    /// `false` if all beams bore the time of the end of their sweep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deskew: Option<bool>,
    /// Error of the lidar's clock \[ms\], if one was given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lidar_clock: Option<f64>,
}
