//! The queue of parameters that are sent to the ground.

use std::collections::VecDeque;

/// Number of values that are sent in a tick. It is so small that no socket's buffer overflows.
const PARAMETERS_PER_TICK: usize = 2;

/// Numbers of the parameters that are still to be sent.
#[derive(Default)]
pub(super) struct ParameterQueue(VecDeque<u8>);

impl ParameterQueue {
    /// Starts to send these numbers, and drops those of an earlier request.
    pub(super) fn begin(&mut self, numbers: Vec<u8>) {
        self.0 = numbers.into();
    }

    /// The numbers to be sent in this tick.
    pub(super) fn due(&mut self) -> Vec<u8> {
        self.0
            .drain(..PARAMETERS_PER_TICK.min(self.0.len()))
            .collect()
    }
}
