//! Kalman filter on position, velocity over ground and the error of the acceleration.
//!
//! The model of an axis: `p' = v`, `v' = a - b` and `b' = -b / T + noise`, with the acceleration `a` as the known input: specific
//! force, turned by the attitude, and gravity. Its error `b` is mostly that of the attitude, a first-order Gauss-Markov process. All
//! axes have the same errors, so one covariance serves all. Source: Bar-Shalom, Li and Kirubarajan, "Estimation with Applications to
//! Tracking and Navigation", 8.2 (exponentially correlated acceleration).

use crate::tuning::navigation::{FIRST_WIND, GATE, LEAST_SIGMA};
use crate::tuning::space_inertial::{ATTITUDE_TIME, FORCE_BIAS, FORCE_NOISE};

/// Variance of the position beyond which it no longer grows [m^2].
const MOST_VARIANCE: f64 = 1e6;

/// A change of the estimate by one observation, for each axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Correction {
    /// Of the position \[m\].
    pub(super) position: [f64; 3],
    /// Of the velocity [m/s].
    pub(super) velocity: [f64; 3],
    /// Of the error of the acceleration [m/s^2].
    pub(super) bias: [f64; 3],
}

impl Correction {
    /// The change of the velocity along an axis some time ago [m/s].
    pub(super) fn velocity_then(&self, axis: usize, since: f64) -> f64 {
        self.velocity[axis] + since * self.bias[axis]
    }
}

/// The filter of three axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct InertialFilter {
    position: [f64; 3],
    velocity: [f64; 3],
    bias: [f64; 3],
    /// Covariance of position, velocity and bias of one axis.
    covariance: [[f64; 3]; 3],
}

impl InertialFilter {
    /// A filter that starts from a measured position with its standard deviation \[m\], and a velocity with its own [m/s].
    #[must_use]
    pub(super) fn start(position: [f64; 3], sigma: f64, velocity: [f64; 3], doubt: f64) -> Self {
        let mut covariance = [[0.0; 3]; 3];
        covariance[0][0] = sigma * sigma + LEAST_SIGMA * LEAST_SIGMA;
        covariance[1][1] = doubt * doubt + LEAST_SIGMA * LEAST_SIGMA;
        covariance[2][2] = FORCE_BIAS * FORCE_BIAS;
        Self {
            position,
            velocity,
            bias: [0.0; 3],
            covariance,
        }
    }

    /// Position \[m\].
    #[must_use]
    pub(super) fn position(&self) -> [f64; 3] {
        self.position
    }

    /// Velocity over ground [m/s].
    #[must_use]
    pub(super) fn velocity(&self) -> [f64; 3] {
        self.velocity
    }

    /// Error of the acceleration [m/s^2].
    #[must_use]
    pub(super) fn bias(&self) -> [f64; 3] {
        self.bias
    }

    /// Variances of position [m^2] and velocity [(m/s)^2] of an axis.
    #[must_use]
    pub(super) fn variances(&self) -> [f64; 2] {
        [self.covariance[0][0], self.covariance[1][1]]
    }

    /// Moves the estimate on by `dt` \[s\] with an acceleration over ground [m/s^2], of which the error that wanders has a
    /// standard deviation [m/s^2].
    pub(super) fn predict(&mut self, acceleration: [f64; 3], wander: f64, dt: f64) {
        let keep = libm::exp(-dt / ATTITUDE_TIME);
        for axis in 0..3 {
            let a = acceleration[axis] - self.bias[axis];
            self.position[axis] += dt * (self.velocity[axis] + 0.5 * dt * a);
            self.velocity[axis] += dt * a;
            self.bias[axis] *= keep;
        }
        if self.covariance[0][0] > MOST_VARIANCE {
            return;
        }
        let step = [[1.0, dt, -0.5 * dt * dt], [0.0, 1.0, -dt], [0.0, 0.0, keep]];
        let half = product(&step, &self.covariance);
        // `half step^T`, in its upper triangle.
        let mut next = [[0.0; 3]; 3];
        for row in 0..3 {
            for column in row..3 {
                let sum = (0..3).map(|at| half[row][at] * step[column][at]).sum();
                (next[row][column], next[column][row]) = (sum, sum);
            }
        }
        next[1][1] += FORCE_NOISE * dt;
        let wandered = wander * wander + FORCE_BIAS * FORCE_BIAS;
        next[2][2] += wandered * (1.0 - keep * keep);
        self.covariance = next;
    }

    /// Corrects all axes by a position that is off by `off` \[m\] from the estimate of its time, `age` \[s\] ago. `None`, and no
    /// correction, if the innovation of an axis is beyond the gate.
    pub(super) fn observe_position(
        &mut self,
        off: [f64; 3],
        age: f64,
        sigma: f64,
    ) -> Option<Correction> {
        self.observe([1.0, -age, -0.5 * age * age], off, sigma)
    }

    /// The same for a velocity [m/s].
    pub(super) fn observe_velocity(
        &mut self,
        off: [f64; 3],
        age: f64,
        sigma: f64,
    ) -> Option<Correction> {
        self.observe([0.0, 1.0, age], off, sigma)
    }

    fn observe(&mut self, h: [f64; 3], off: [f64; 3], sigma: f64) -> Option<Correction> {
        let c = &mut self.covariance;
        let across = c.map(|row| row[0] * h[0] + row[1] * h[1] + row[2] * h[2]);
        let own = h[0] * across[0] + h[1] * across[1] + h[2] * across[2];
        let sigma = sigma.max(LEAST_SIGMA);
        let variance = own + sigma * sigma;
        let most = GATE * GATE * variance;
        // The test is false for values that are not numbers.
        if !off.iter().all(|it| it * it <= most) {
            return None;
        }
        let gain = across.map(|it| it / variance);
        let by = Correction {
            position: off.map(|it| gain[0] * it),
            velocity: off.map(|it| gain[1] * it),
            bias: off.map(|it| gain[2] * it),
        };
        for axis in 0..3 {
            self.position[axis] += by.position[axis];
            self.velocity[axis] += by.velocity[axis];
            self.bias[axis] += by.bias[axis];
        }
        for row in 0..3 {
            for column in row..3 {
                let less = c[row][column] - gain[row] * across[column];
                (c[row][column], c[column][row]) = (less, less);
            }
        }
        Some(by)
    }

    /// Doubts the velocity as before the first fix, after a jump of the source to this position \[m\].
    pub(super) fn restart(&mut self, position: [f64; 3], sigma: f64) {
        *self = Self::start(position, sigma, self.velocity, FIRST_WIND);
    }
}

fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|row| {
        core::array::from_fn(|at| row[0] * b[0][at] + row[1] * b[1][at] + row[2] * b[2][at])
    })
}
