//! Internal parts that both planners share: the size of a slice, the random numbers of the tree, and the
//! values of a planner that is not set up.

use crate::vehicle::{AirState, Control, Trim};
use rand_core::Rng;
use rand_pcg::Pcg64Mcg;

/// Number of samples of the tree in one slice.
pub(super) const SAMPLES_PER_SLICE: usize = 10;
/// Number of solver steps in one slice.
pub(super) const STEPS_PER_SLICE: usize = 8;

/// The motion in a planner that is not set up.
pub(super) const STILL: AirState = AirState {
    airspeed: 0.0,
    pitch: 0.0,
    pitch_rate: 0.0,
    flight_path: 0.0,
};

/// The trim in a planner that is not set up.
pub(super) const NO_TRIM: Trim = Trim {
    state: STILL,
    control: Control {
        thrust: 0.0,
        elevator: 0.0,
    },
};

/// The 53 high bits of a random number, scaled to [0, 1).
pub(super) fn unit_interval(random: &mut Pcg64Mcg) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
    (random.next_u64() >> 11) as f64 * STEP
}
