//! The estimates of the 100 Hz step, and fault detection and isolation for sensors and actuators: the watches.
//!
//! | type | content |
//! |---|---|
//! | [`Estimator`] | all estimators of a flight in the plane; the others are its parts |
//! | [`SpaceEstimator`] | motion, wind and past poses of a flight in space |
//! | [`Ekf`], [`LaggedEkf`] | motion through the air from airspeed and pitch, and the same from late ones |
//! | [`Navigation`], [`WindFilter`] | position and wind |
//! | [`LiftEstimator`] | lift beyond that of the known airframe |
//! | [`Actuators`] | the model of motor and elevator, with [`CommandLine`], [`MotorWatch`] and [`ElevatorEffect`] |
//! | [`BiasMonitor`] | the watches for slow errors: [`AirspeedBias`], [`PitchBias`], and [`CalmFlight`] for both at once |
//! | [`PitchMonitor`] | a pitch sensor that the altitude contradicts |
//! | [`SensorMonitor`] | the trust in a sensor |
//! | [`StuckDetector`], [`SteadyTurn`] | whether a sensor repeats its values, and whether refused values show a steady turn |

mod actuators;
mod airspeed_bias;
mod answer;
mod bias_monitor;
mod calm_flight;
mod command_line;
mod ekf;
mod elevator_effect;
mod estimator;
mod history;
mod lagged;
mod lift;
mod motor_watch;
mod navigation;
mod pitch_bias;
mod pitch_monitor;
mod sensor_monitor;
mod space;
mod stuck_detector;
mod verdicts;
mod wind_filter;

pub use actuators::Actuators;
pub use airspeed_bias::{AirspeedBias, Before};
pub use bias_monitor::BiasMonitor;
pub use calm_flight::{CalmFlight, Seen};
pub use command_line::CommandLine;
pub use ekf::{Diverged, Ekf, EkfTuning};
pub use elevator_effect::ElevatorEffect;
pub use estimator::{Ahead, Estimator};
pub use history::{History, MOST_AGE, MOST_SCAN_AGE};
pub use lagged::{LaggedEkf, Taken};
pub use lift::LiftEstimator;
pub use motor_watch::{MotorWatch, Progress};
pub use navigation::{Navigation, PositionVerdict};
pub use pitch_bias::PitchBias;
pub use pitch_monitor::{PitchMonitor, Turn};
pub use sensor_monitor::{SensorMonitor, Sensors, Trust};
pub use space::{InertialSample, SpaceEstimator, SpaceFix, SpacePose, SpaceRefused};
pub use stuck_detector::{SteadyTurn, StuckDetector};
pub use wind_filter::{Observation, WindFilter};

/// The filter's decision on one measured value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasurementStatus {
    /// The filter used the value.
    Accepted,
    /// The innovation exceeds the gate, and the filter did not use the value. The covariance grows until
    /// such values pass again.
    Gated,
    /// The value is not a finite number, and the filter did not use it.
    NotFinite,
    /// The sensor has repeated the value to the last bit for some ticks. The filter did not use it.
    Frozen,
    /// There was no value.
    Missing,
    /// The value came later than the ones before, or is older than the filter remembers. The filter did not
    /// use it.
    Late,
    /// The value passes the gate, but the sensor is not trusted yet. The filter did not use it.
    Distrusted,
}

impl MeasurementStatus {
    /// Whether the value agrees with the estimate.
    #[must_use]
    pub fn is_good(self) -> bool {
        matches!(self, Self::Accepted | Self::Distrusted)
    }
}

/// The verdicts on the two values of one measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Innovation {
    /// Verdict on the airspeed.
    pub airspeed: MeasurementStatus,
    /// Verdict on the pitch.
    pub pitch: MeasurementStatus,
}

impl Innovation {
    /// The same verdict on both values.
    #[must_use]
    pub const fn both(verdict: MeasurementStatus) -> Self {
        Self {
            airspeed: verdict,
            pitch: verdict,
        }
    }
}
