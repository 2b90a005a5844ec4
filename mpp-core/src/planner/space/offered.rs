//! Plans of others. A host that compares planners lets this one keep the map's distances and the cost-to-go, and brings its own
//! plans.

use super::candidate::SpacePlan;
use super::{Phase, SpacePlanner};
use crate::vehicle::SpacePath;

impl SpacePlanner {
    /// Lets each cycle end before the candidates, and wait for [`offer`](Self::offer). [`choose`](Self::choose) undoes it.
    pub fn wait_for_offers(&mut self) {
        self.wanted = 0;
    }

    /// The state in which offered plans must begin, as long as the cycle waits for them.
    #[must_use]
    pub fn awaited(&self) -> Option<&SpacePath> {
        (self.phase == Phase::Offers).then_some(&self.start)
    }

    /// Judges plans as if they were candidates, and ends the cycle. The cheapest one is [`best`](Self::best).
    pub fn offer(&mut self, plans: &[SpacePlan]) {
        for plan in plans {
            let candidate = self.judged(*plan);
            self.consider(candidate);
        }
        self.phase = Phase::Idle;
    }
}
