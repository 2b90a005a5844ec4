//! Settings of the plane planner.

use crate::qp::Penalty;

/// Limits of the attitude rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeLimits {
    /// Greatest distance of the angle of attack from trim, to either side \[rad\]. It bounds the lift, and
    /// therefore the curvature of a path.
    pub angle_of_attack: f64,
    /// Greatest flight path angle, climbing or descending \[rad\].
    pub flight_path: f64,
}

/// Settings that only the plane planner reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneSettings {
    /// Range of the lidar \[m\]. A beam without a return shows that its way is free up to this range.
    pub sight: f64,
    /// Time from the start of a cycle ([`Planner::begin`](crate::planner::Planner::begin)) until its plan is taken over
    /// \[s\]. A plan starts where the aircraft will be then.
    pub latency: f64,
    /// Penalty of violating corridor and attitude rows. These rows are soft, but those of an angle of attack that the
    /// elevator limits are hard.
    pub penalty: Penalty,
    /// Limits of the attitude rows.
    pub attitude: AttitudeLimits,
    /// Distance of the stall from the angle of attack of level flight \[rad\], if it is known. No plan goes
    /// beyond it.
    pub stall: Option<f64>,
    /// SQP iterations (linearise, solve, roll out) of the best candidates; every other candidate gets one.
    pub sqp_iterations: u8,
    /// Number of candidates that get all SQP iterations.
    pub refined_candidates: usize,
    /// Distance that a plan keeps between the aircraft and the centres of occupied cells \[m\].
    pub margin: f64,
    /// Radius of the circle that holds the aircraft \[m\].
    pub body_radius: f64,
    /// Greatest distance of a plan from the altitude \[m\].
    pub band: f64,
    /// Greatest thrust of a plan \[N\].
    pub thrust_max: f64,
}

impl PlaneSettings {
    /// The settings of preset `flight`.
    pub(crate) const PRESET: Self = Self {
        sight: 45.0,
        latency: 0.0,
        penalty: Penalty {
            linear: 1e3,
            quadratic: 1e3,
        },
        attitude: AttitudeLimits {
            angle_of_attack: 0.2,
            flight_path: 0.6,
        },
        stall: None,
        sqp_iterations: 3,
        refined_candidates: 2,
        margin: 0.8,
        body_radius: 0.0,
        band: 10.3,
        thrust_max: 20.0,
    };
}
