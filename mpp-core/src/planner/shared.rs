//! Internal parts that both planners share: the size of a slice, and the values of a planner that is not
//! set up.

use crate::vehicle::{AirState, Control, Trim};

/// Number of solver steps in one slice.
pub(crate) const STEPS_PER_SLICE: usize = 8;

/// The motion in a planner that is not set up.
pub(crate) const STILL: AirState = AirState {
    airspeed: 0.0,
    pitch: 0.0,
    pitch_rate: 0.0,
    flight_path: 0.0,
};

/// The trim in a planner that is not set up.
pub(crate) const NO_TRIM: Trim = Trim {
    state: STILL,
    control: Control {
        thrust: 0.0,
        elevator: 0.0,
    },
};
