//! A scenario found again in what a log says of it, by the limits of a scenario file.

use super::file::{MAX_DURATION, check};
use super::{Scenario, TICKS_PER_SECOND};
use crate::field::FieldFile;
use crate::file_error::{ScenarioError, ensure};

/// Times of a flight as its log has them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Times {
    pub(crate) replan_hz: f64,
    pub(crate) latency: f64,
    pub(crate) duration: f64,
}

impl Scenario {
    /// This scenario with these times and, beside what it draws itself, the obstacles of `field`.
    pub(crate) fn recorded(
        mut self,
        times: Times,
        field: &FieldFile,
    ) -> Result<Self, ScenarioError> {
        let rate = f64::from(TICKS_PER_SECOND);
        self.replan_ticks = whole("replan_hz", rate / times.replan_hz, u32::from(u16::MAX))?;
        self.latency_ticks = whole("latency", rate * times.latency, self.replan_ticks)?;
        let longest = MAX_DURATION * TICKS_PER_SECOND;
        self.ticks = whole("duration", rate * times.duration, longest)?;
        // Before anything is drawn: what is asked for may be more than there is memory.
        field.check().map_err(ScenarioError::Field)?;
        check(&self)?;
        let drawn = FieldFile::of(&self.drawn());
        self.placed = field.without(&drawn).obstacles();
        check(&self)?;
        Ok(self)
    }
}

/// A number of ticks, 1 to `most`.
fn whole(key: &'static str, ticks: f64, most: u32) -> Result<u32, ScenarioError> {
    let ticks = ticks.round();
    let advice = format!("this is not 1 to {most} ticks of the flight");
    ensure((1.0..=f64::from(most)).contains(&ticks), key, advice)?;
    Ok(ticks as u32)
}
