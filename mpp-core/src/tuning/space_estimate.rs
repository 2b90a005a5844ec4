//! The tuning of the estimator in space. Decision 48 has the trials.

use core::f64::consts::PI;

/// Attitude, rates and specific force.
pub mod space_inertial {
    use super::PI;

    /// Time over which the error of an attitude is correlated \[s\]. With a longer one the filters believe that they know this error
    /// longer, and gyroscopes count more. Source: D48, as the errors of decision 46.
    pub const ATTITUDE_TIME: f64 = 2.0;
    /// White noise of gyroscopes [rad/s^(1/2)]. Less believes them longer. Source: D74, 0.05 deg/s^(1/2), a few times what small
    /// ones have.
    pub const GYRO_NOISE: f64 = 0.05 * PI / 180.0;
    /// The same as a share of the rates [s^(1/2)]: errors of scale, axes and time, which are alike over a second. Source: D74.
    pub const GYRO_SHARE: f64 = 0.01;
    /// Standard deviation of the bias of gyroscopes at first [rad/s], and of its change in a second [rad/s^(3/2)]. Less finds biases
    /// late. Source: D74; 0.2 and 0.01 deg/s, after an autopilot's own calibration.
    pub const FIRST_DRIFT: f64 = 0.2 * PI / 180.0;
    /// See [`FIRST_DRIFT`]. Source: as there.
    pub const GYRO_DRIFT: f64 = 0.01 * PI / 180.0;
    /// Standard deviation of the acceleration's error that is not the attitude's [m/s^2]. Source: chosen; an accelerometer's bias.
    pub const FORCE_BIAS: f64 = 0.05;
    /// Variance that white errors of the acceleration add to the velocity in a second [(m/s)^2]. It covers a specific force that is
    /// a tick old while the aircraft rolls. Source: chosen.
    pub const FORCE_NOISE: f64 = 0.002;
    /// Least standard deviation of an attitude that the filter believes \[rad\]. Source: chosen, 0.1 deg.
    pub const LEAST_SIGMA: f64 = 0.1 * PI / 180.0;
    /// Greatest change of an attitude beyond that of its rates, in each tick since the last one \[rad\], beside the gate on its
    /// declared error. Source: chosen, 100 deg/s of unknown turn.
    pub const MOST_CHANGE: f64 = 0.0175;
    /// Greatest rate [rad/s] and specific force [m/s^2] that a sound sample has. Source: chosen; the ranges of gyroscopes and
    /// accelerometers, 2000 deg/s and 16 g.
    pub const MOST_RATE: f64 = 35.0;
    /// See [`MOST_RATE`]. Source: as there.
    pub const MOST_FORCE: f64 = 160.0;
    /// Time over which a bias of the bank is learned \[s\]. A shorter one takes the wander of the attitude for a bias. Source: D48.
    pub const BIAS_TIME: f64 = 5.0;
    /// Greatest bias of the bank \[rad\], 5 deg. Source: chosen.
    pub const MOST_BIAS: f64 = 5.0 * PI / 180.0;
    /// Bias of the bank from which on the attitude is suspected \[rad\], 1.5 deg. Source: D48.
    pub const DOUBTED_BIAS: f64 = 1.5 * PI / 180.0;
    /// Standard deviation of a velocity's white part, beyond its declared error, as a factor on this error [-]: receivers filter
    /// their velocities, so errors of one second are alike. With 1 the filter believes a wandering error. Source: D48.
    pub const VELOCITY_DOUBT: f64 = 4.0;
}

/// The motion of the air.
pub mod space_air {
    /// Standard deviation of one measured wind along an axis [m/s]: airspeed, attitude and the angles to the flow. Source: derived.
    pub const SIGMA: f64 = 0.35;
    /// Time over which its error is correlated \[s\]. Source: as the errors of decision 46.
    pub const TIME: f64 = 0.5;
    /// Variance of the change of the wind in a second [(m/s)^2], for plans and for the angles to the flow. More follows gusts and
    /// the errors of the airspeed. Source: D48.
    pub const SMOOTH: f64 = 0.12;
    /// See [`SMOOTH`]. Source: as there.
    pub const QUICK: f64 = 3.0;
    /// Standard deviation of the specific force sideways from which the sideslip follows [m/s^2], and of the sideslip before any
    /// force is measured \[rad\]. Source: chosen; bias and model of the side force, 5 deg.
    pub const SIDE_FORCE: f64 = 0.2;
    /// See [`SIDE_FORCE`]. Source: as there.
    pub const SIDESLIP: f64 = 0.087;
    /// Greatest angle to the flow that a force may tell \[rad\]. Source: chosen, 30 deg.
    pub const MOST_ANGLE: f64 = 0.52;
    /// Standard deviation and greatest value of the sideslip \[rad\] of a wing whose nose runs away. Source: D67.
    pub const RUNAWAY: [f64; 2] = [0.5, 1.0];
    /// Least airspeed that a sound sample has, as a share of that of level flight [-]. Source: chosen.
    pub const LEAST_SHARE: f64 = 0.4;
    /// Greatest wind along an axis, as a share of the airspeed of level flight [-]. Source: chosen.
    pub const MOST_SHARE: f64 = 0.8;
}
