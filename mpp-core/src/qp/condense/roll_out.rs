//! Scaled sums, and the states and outputs that follow from controls.

use super::super::dense::ControlVector;
use super::super::rows::{OUTPUTS, THRUST_OUTPUT};
use super::super::{Dynamics, StageState};
use crate::config::{KNOTS, STAGES};
use nalgebra::Vector6;

/// `sum += factor term`
pub(super) fn add_scaled(sum: &mut [f64], term: &[f64], factor: f64) {
    for (sum, term) in sum.iter_mut().zip(term) {
        *sum += factor * term;
    }
}

/// Computes states and outputs under controls from the dynamics and the offset of each stage.
pub(super) fn roll_out<'a>(
    stages: impl Iterator<Item = (&'a Dynamics, &'a Vector6<f64>)>,
    initial: &StageState,
    controls: &ControlVector,
    states: &mut [StageState; KNOTS],
    outputs: &mut [f64; OUTPUTS],
) {
    let mut state = *initial;
    let [first, later @ ..] = states;
    *first = state;
    let (motion, rest) = outputs.split_at_mut(THRUST_OUTPUT);
    let (thrusts, attitudes) = rest.split_at_mut(STAGES);
    let places = motion.as_chunks_mut::<2>().0.iter_mut().zip(thrusts);
    let places = places.zip(attitudes.as_chunks_mut::<2>().0).zip(later);
    let stages = stages.zip(controls.as_chunks::<2>().0);
    for (((dynamics, offset), control), (((motion, thrust), attitude), next)) in stages.zip(places)
    {
        state = dynamics.step_with(&state, control, offset);
        *next = state;
        let [x, z, _, pitch, _, flight_path] = state;
        *motion = [x, z];
        *attitude = [pitch, flight_path];
        *thrust = control[1];
    }
}
