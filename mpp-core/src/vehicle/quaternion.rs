//! Attitudes as unit quaternions. Axes: x ahead, y to the right, z down.

use super::within;

/// A turn from a body's axes to the world's: scalar part, then the vector part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion(pub [f64; 4]);

impl Quaternion {
    /// No turn.
    pub const ONE: Self = Self([1.0, 0.0, 0.0, 0.0]);

    /// A turn about the y axis by an angle \[rad\], nose-up.
    #[must_use]
    pub fn pitch(angle: f64) -> Self {
        let (sin, cos) = libm::sincos(0.5 * angle);
        Self([cos, 0.0, sin, 0.0])
    }

    /// A turn about the x axis by an angle \[rad\], to the right.
    #[must_use]
    pub fn roll(angle: f64) -> Self {
        let (sin, cos) = libm::sincos(0.5 * angle);
        Self([cos, sin, 0.0, 0.0])
    }

    /// The attitude with a bank, a pitch and a heading \[rad\].
    #[must_use]
    pub fn attitude([bank, pitch, heading]: [f64; 3]) -> Self {
        let (sin, cos) = libm::sincos(0.5 * heading);
        let turned = Self([cos, 0.0, 0.0, sin]);
        turned.times(Self::pitch(pitch)).times(Self::roll(bank))
    }

    /// Bank, pitch and heading \[rad\].
    #[must_use]
    pub fn angles(self) -> [f64; 3] {
        let [[ahead, _, _], [right, _, _], [sunk, bank_sin, bank_cos]] = self.rows();
        [
            libm::atan2(bank_sin, bank_cos),
            -libm::asin(within(sunk, 1.0)),
            libm::atan2(right, ahead),
        ]
    }

    /// A turn about an axis of the body by an angle \[rad\], the length of the vector.
    #[must_use]
    pub fn about(by: [f64; 3]) -> Self {
        let square = by.iter().map(|it| it * it).sum::<f64>();
        let angle = libm::sqrt(square);
        // The limit of `sin(angle / 2) / angle` for small angles.
        let share = if angle > 1e-6 {
            libm::sin(0.5 * angle) / angle
        } else {
            0.5
        };
        let [x, y, z] = by.map(|it| it * share);
        Self([libm::cos(0.5 * angle), x, y, z])
    }

    /// Angle to another attitude \[rad\].
    #[must_use]
    pub fn angle_to(self, other: Self) -> f64 {
        let cosine: f64 = self.0.iter().zip(other.0).map(|(a, b)| a * b).sum();
        2.0 * libm::acos(cosine.abs().min(1.0))
    }

    /// The turn about the body's axes that leads to another attitude \[rad\], where it is small: of half a turn it tells 2 rad.
    #[must_use]
    pub fn turn_to(self, other: Self) -> [f64; 3] {
        let [w, x, y, z] = self.0;
        let Self([scalar, about @ ..]) = Self([w, -x, -y, -z]).times(other);
        let twice = if scalar < 0.0 { -2.0 } else { 2.0 };
        about.map(|it| twice * it)
    }

    /// The attitude at a share of the way to another one.
    #[must_use]
    pub fn towards(self, other: Self, share: f64) -> Self {
        let cosine: f64 = self.0.iter().zip(other.0).map(|(a, b)| a * b).sum();
        // Quaternions of opposite sign are the same attitude.
        let signed = if cosine < 0.0 { -share } else { share };
        let [a, b, c, d] = self.0;
        let [w, x, y, z] = other.0.map(|part| signed * part);
        let kept = 1.0 - share;
        Self([kept * a + w, kept * b + x, kept * c + y, kept * d + z]).normalised()
    }

    /// This turn after another one.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, other.0);
        Self([
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y + c * w + d * x - b * z,
            a * z + d * w + b * y - c * x,
        ])
    }

    /// Time derivative under a turn rate in the body's axes [rad/s].
    #[must_use]
    pub fn rate(self, [x, y, z]: [f64; 3]) -> Self {
        self.times(Self([0.0, 0.5 * x, 0.5 * y, 0.5 * z]))
    }

    /// `self + h rate`, which is not of unit length.
    #[must_use]
    pub fn moved(self, rate: Self, h: f64) -> Self {
        let ([a, b, c, d], [w, x, y, z]) = (self.0, rate.0);
        Self([a + h * w, b + h * x, c + h * y, d + h * z])
    }

    /// The length; 1 for a turn.
    #[must_use]
    pub fn length(self) -> f64 {
        let [w, x, y, z] = self.0;
        libm::sqrt(w * w + x * x + (y * y + z * z))
    }

    /// The turn of unit length.
    #[must_use]
    pub fn normalised(self) -> Self {
        let length = self.length();
        Self(self.0.map(|part| part / length))
    }

    /// The rows of the matrix that turns body axes into the world's.
    fn rows(self) -> [[f64; 3]; 3] {
        let [w, x, y, z] = self.0;
        [
            [
                1.0 - 2.0 * (y * y + z * z),
                2.0 * (x * y - w * z),
                2.0 * (x * z + w * y),
            ],
            [
                2.0 * (x * y + w * z),
                1.0 - 2.0 * (x * x + z * z),
                2.0 * (y * z - w * x),
            ],
            [
                2.0 * (x * z - w * y),
                2.0 * (y * z + w * x),
                1.0 - 2.0 * (x * x + y * y),
            ],
        ]
    }

    /// A vector of the body in the world's axes.
    #[must_use]
    pub fn in_world(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        self.rows().map(|[a, b, c]| a * x + b * y + c * z)
    }

    /// A vector of the world in the body's axes.
    #[must_use]
    pub fn world_in(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [a, b, c] = self.rows();
        [0, 1, 2].map(|axis| a[axis] * x + b[axis] * y + c[axis] * z)
    }
}
