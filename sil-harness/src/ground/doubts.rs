//! Sensors that are suspected for long, or for a moment again and again, and never excluded.

use hil_protocol::{SensorState, SensorStates};

/// What a suspected tick counts. Another one takes 1 away.
const SUSPECTED: u32 = 8;
/// Count from which on stations hear of a sensor that is never excluded: one that is suspected for a second, or for a moment
/// again and again.
const DOUBTED: u32 = 100 * SUSPECTED;

/// For each sensor, its count and whether it is doubtful.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Doubts([(u32, bool); 4]);

impl Doubts {
    /// Takes in the states of a tick. Gives the sensors that are doubtful from this tick on.
    pub(super) fn take(
        &mut self,
        sensors: &SensorStates,
    ) -> impl Iterator<Item = &'static str> + use<> {
        let mut told = [None; 4];
        let states = self.0.iter_mut().zip(sensors.sensors());
        for (((suspicion, doubtful), (sensor, state)), told) in states.zip(&mut told) {
            *suspicion = match state {
                SensorState::Suspected => (*suspicion + SUSPECTED).min(2 * DOUBTED),
                _ => suspicion.saturating_sub(1),
            };
            let before = *doubtful;
            *doubtful = *suspicion > DOUBTED || (before && *suspicion > 0);
            *told = (*doubtful && !before).then_some(sensor);
        }
        told.into_iter().flatten()
    }

    pub(super) fn doubtful(&self) -> [bool; 4] {
        self.0.map(|(_, doubtful)| doubtful)
    }
}
