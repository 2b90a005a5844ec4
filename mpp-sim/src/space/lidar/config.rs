//! Lidars that people own, as data.

use crate::file_error::{ScenarioError, ensure};
use crate::names::{self, UnknownName};
use crate::space::Quaternion;
use core::fmt;
use core::str::FromStr;
use mpp_node::MOST_POINTS;

/// In which order a lidar looks where. Angles are in the sensor's axes: azimuth to the right, elevation up \[deg\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// Rings, evenly spaced in elevation, all of them measured at one azimuth after the other.
    Rings {
        /// Rings.
        rings: u32,
        /// Azimuths of each ring in a sweep.
        azimuths: u32,
        /// Whether the rings are moved, by up to half of their distance, from sweep to sweep.
        staggered: bool,
    },
    /// A low-discrepancy sequence of directions that never comes back, as dense everywhere. The sensors draw rosettes; what
    /// counts is that the gaps close with time.
    Scattered {
        /// Beams of a sweep.
        beams: u32,
    },
    /// Pixels, evenly spaced on a plane, all at the same time.
    Image {
        /// Pixels of a row and of a column.
        pixels: [u32; 2],
    },
}

/// Geometry and errors of a lidar, or of a camera that measures ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceLidarConfig {
    /// Pattern of a sweep.
    pub pattern: Pattern,
    /// Least and greatest azimuth \[deg\].
    pub azimuth: [f64; 2],
    /// Least and greatest elevation \[deg\].
    pub elevation: [f64; 2],
    /// Duration of a sweep \[s\].
    pub period: f64,
    /// Least and greatest range \[m\]: the sight of dark bark, that reflects 10 %.
    pub range: [f64; 2],
    /// Standard deviation of the range error: constant \[m\], by the range [-], and by its square [1/m].
    pub noise: [f64; 3],
    /// Share of beams without a return [-].
    pub drop_outs: f64,
    /// Share of beams that return any range before the true one [-].
    pub false_returns: f64,
    /// Place of the sensor in the body's axes: ahead, to the right, down \[m\].
    pub offset: [f64; 3],
    /// Turn of the sensor in the body.
    pub mount: Quaternion,
}

/// The named lidars.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LidarName {
    /// 90 x 16 staggered beams over 90 x 30 deg: a fan in space, to plan with little computing.
    Grid90x16,
    /// Livox Mid-360. It looks up by 52 deg and down by 7.
    Mid360,
    /// Livox Avia, ahead.
    Avia,
    /// Ouster OS1 with 32 rings.
    Os1x32,
    /// Velodyne Puck Hi-Res.
    PuckHiRes,
    /// A stereo camera such as RealSense D455, each eighth pixel of 640 x 480 on both axes.
    Depth,
    /// Stereo that looks for things at one depth only (Barry, Tedrake, 2015).
    Pushbroom,
}

impl LidarName {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Grid90x16,
        Self::Mid360,
        Self::Avia,
        Self::Os1x32,
        Self::PuckHiRes,
        Self::Depth,
        Self::Pushbroom,
    ];

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Grid90x16 => "grid-90x16",
            Self::Mid360 => "mid-360",
            Self::Avia => "avia",
            Self::Os1x32 => "os1-32",
            Self::PuckHiRes => "puck-hi-res",
            Self::Depth => "depth",
            Self::Pushbroom => "pushbroom",
        }
    }

    /// Its data. Views, ranges and rates are the makers'; errors that no source gives are chosen, and drop-outs depend on the
    /// weather: here there are none, but for the stereo of the pushbroom.
    #[must_use]
    pub fn config(self) -> SpaceLidarConfig {
        let rings = |rings, azimuths| Pattern::Rings {
            rings,
            azimuths,
            staggered: false,
        };
        let usual = SpaceLidarConfig {
            pattern: Pattern::Scattered { beams: 20_000 },
            azimuth: [-180.0, 180.0],
            elevation: [-7.0, 52.0],
            period: 0.1,
            range: [0.1, 40.0],
            // 2 to 3 cm.
            noise: [0.025, 0.0, 0.0],
            drop_outs: 0.0,
            // Livox (HAP) and Ouster: 1 of 10,000.
            false_returns: 1e-4,
            offset: [0.0; 3],
            mount: Quaternion::ONE,
        };
        match self {
            Self::Mid360 => usual,
            Self::Grid90x16 => SpaceLidarConfig {
                pattern: Pattern::Rings {
                    rings: 16,
                    azimuths: 90,
                    staggered: true,
                },
                azimuth: [-45.0, 45.0],
                elevation: [-15.0, 15.0],
                range: [0.01, 45.0],
                noise: [0.0, 0.005, 0.0],
                false_returns: 0.0,
                ..usual
            },
            Self::Avia => SpaceLidarConfig {
                pattern: Pattern::Scattered { beams: 24_000 },
                azimuth: [-35.2, 35.2],
                elevation: [-38.6, 38.6],
                range: [1.0, 190.0],
                noise: [0.02, 0.0, 0.0],
                ..usual
            },
            Self::Os1x32 => SpaceLidarConfig {
                pattern: rings(32, 1024),
                elevation: [-22.5, 22.5],
                range: [0.5, 40.0],
                // 1.5 to 10 cm, by the signal.
                noise: [0.03, 0.0, 0.0],
                ..usual
            },
            Self::PuckHiRes => SpaceLidarConfig {
                pattern: rings(16, 1875),
                elevation: [-10.0, 10.0],
                range: [0.5, 100.0],
                noise: [0.03, 0.0, 0.0],
                ..usual
            },
            Self::Depth => SpaceLidarConfig {
                pattern: Pattern::Image { pixels: [80, 60] },
                azimuth: [-43.5, 43.5],
                elevation: [-29.0, 29.0],
                period: 1.0 / 30.0,
                range: [0.6, 10.0],
                noise: [0.0, 0.0, 0.005],
                false_returns: 0.001,
                ..usual
            },
            Self::Pushbroom => SpaceLidarConfig {
                pattern: Pattern::Image { pixels: [47, 30] },
                azimuth: [-43.5, 43.5],
                elevation: [-29.0, 29.0],
                period: 1.0 / 120.0,
                // A shell about the camera instead of the plane that it is.
                range: [9.5, 10.5],
                noise: [0.0, 0.0, 0.002],
                drop_outs: 0.1,
                false_returns: 0.001,
                ..usual
            },
        }
    }
}

/// Most beams of a sweep that fliers keep, and how far from straight ahead \[deg\]: azimuth and elevation. Source: the core has
/// room for 2,048 points; the view is about that of `grid-90x16`.
const MOST_KEPT: u32 = 2000;
const KEPT: [f64; 2] = [45.0, 20.0];
/// How far from straight ahead the columns are that fliers keep of a turning lidar \[deg\]: circles need a view to the side.
const ASIDE: f64 = 90.0;
/// Least sight that may be asked for \[m\].
const LEAST_SIGHT: f64 = 5.0;

impl SpaceLidarConfig {
    /// The lidar of a flight, by its name.
    ///
    /// # Errors
    /// [`ScenarioError::Value`] for a name that is not known, and for a sweep for which the core has no room.
    pub fn kept(name: &str) -> Result<Self, ScenarioError> {
        let refused = |advice: String| ScenarioError::Value("lidar", advice);
        let name: LidarName = name
            .parse()
            .map_err(|error: UnknownName| refused(error.to_string()))?;
        let kept = name.config().thinned();
        if kept.beams() > MOST_POINTS {
            let beams = kept.beams();
            let advice = format!(
                "take another one: the core has room for {MOST_POINTS} of its {beams} beams"
            );
            return Err(refused(advice));
        }
        Ok(kept)
    }

    /// The same lidar with at most this range \[m\], as in haze or before dark bark.
    ///
    /// # Errors
    /// [`ScenarioError::Value`] for a sight with which nothing can be flown or seen.
    pub fn seeing(self, sight: Option<f64>) -> Result<Self, ScenarioError> {
        let [near, far] = self.range;
        let sight = sight.unwrap_or(far);
        let advice = format!(
            "give {LEAST_SIGHT} m or more, and more than the lidar's least range of {near} m"
        );
        let enough = sight.is_finite() && sight >= LEAST_SIGHT && sight > near;
        ensure(enough, "sight", advice)?;
        Ok(Self {
            range: [near, far.min(sight)],
            ..self
        })
    }

    /// The beams that a flier keeps of a sweep: of scattered ones those ahead, and of these as many as the core has room for. The
    /// sensor is tilted so that the middle of its view looks ahead.
    fn thinned(self) -> Self {
        let beams = match self.pattern {
            Pattern::Scattered { beams } => beams,
            Pattern::Rings { rings, .. } if self.beams() > MOST_POINTS => {
                return Self {
                    pattern: Pattern::Rings {
                        rings,
                        azimuths: MOST_KEPT / rings,
                        staggered: true,
                    },
                    azimuth: self.azimuth.map(|it| it.clamp(-ASIDE, ASIDE)),
                    ..self
                };
            }
            _ => return self,
        };
        let kept = |[least, most]: [f64; 2], middle: f64, far: f64| {
            let kept = [least.max(middle - far), most.min(middle + far)];
            (kept, (kept[1] - kept[0]) / (most - least))
        };
        let tilt = 0.5 * (self.elevation[0] + self.elevation[1]);
        let (azimuth, ahead) = kept(self.azimuth, 0.0, KEPT[0]);
        let (elevation, level) = kept(self.elevation, tilt, KEPT[1]);
        let beams = (f64::from(beams) * ahead * level) as u32;
        Self {
            pattern: Pattern::Scattered {
                beams: beams.min(MOST_KEPT),
            },
            azimuth,
            elevation,
            mount: Quaternion::pitch(-tilt.to_radians()),
            ..self
        }
    }

    /// Beams of a sweep.
    #[must_use]
    pub fn beams(&self) -> usize {
        let count = match self.pattern {
            Pattern::Rings {
                rings, azimuths, ..
            } => u64::from(rings) * u64::from(azimuths),
            Pattern::Scattered { beams } => u64::from(beams),
            Pattern::Image {
                pixels: [row, column],
            } => u64::from(row) * u64::from(column),
        };
        count as usize
    }
}

impl fmt::Display for LidarName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for LidarName {
    type Err = UnknownName;

    fn from_str(text: &str) -> Result<Self, UnknownName> {
        names::find("lidar", &Self::ALL, Self::name, text)
    }
}
