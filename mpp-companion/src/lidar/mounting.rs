//! How a sensor is mounted, and rotations between axes that point ahead, to the right and down.

use crate::CompanionError;
use std::str::FromStr;

/// The attitude of a sensor against the body: as that of an aircraft against the earth. A sensor without a turn stands upright
/// and looks ahead; a roll of 90 deg lays it on its right side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mounting {
    /// Roll, pitch and yaw \[deg\], applied yaw first.
    pub degrees: [f64; 3],
}

impl Mounting {
    /// On the right side: the sensor's sweep about its axis is in the vertical plane.
    pub const SIDE: Self = Self {
        degrees: [90.0, 0.0, 0.0],
    };

    pub(crate) fn rotation(self) -> Rotation {
        Rotation::new(self.degrees.map(f64::to_radians))
    }
}

impl FromStr for Mounting {
    type Err = CompanionError;

    fn from_str(text: &str) -> Result<Self, CompanionError> {
        let number = |part: &str| part.trim().parse().ok().filter(|it: &f64| it.is_finite());
        let parts: Option<Vec<f64>> = text.split(',').map(number).collect();
        let degrees = parts.and_then(|parts| parts.try_into().ok());
        let degrees = degrees.ok_or_else(|| CompanionError::Mounting(text.to_owned()))?;
        Ok(Self { degrees })
    }
}

/// A rotation.
#[derive(Clone, Debug)]
pub(crate) struct Rotation([[f64; 3]; 3]);

impl Rotation {
    /// No rotation.
    pub(crate) const NONE: Self = Self([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// From the axes of a body with this roll, pitch and yaw \[rad\] to the axes that it is turned against.
    pub(crate) fn new(angles: [f64; 3]) -> Self {
        let [(sr, cr), (sp, cp), (sy, cy)] = angles.map(libm::sincos);
        Self([
            [cp * cy, sr * sp * cy - cr * sy, cr * sp * cy + sr * sy],
            [cp * sy, sr * sp * sy + cr * cy, cr * sp * sy - sr * cy],
            [-sp, sr * cp, cr * cp],
        ])
    }

    /// A vector of the body by the other axes.
    pub(crate) fn of(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        self.0.map(|[a, b, c]| a * x + b * y + c * z)
    }

    /// A vector of the other axes by those of the body.
    pub(crate) fn back(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.0;
        std::array::from_fn(|axis| a[axis] * x + b[axis] * y + c[axis] * z)
    }
}
