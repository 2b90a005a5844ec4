//! Whether a collision could have been avoided: the ceiling's question, asked from the true state of the aircraft shortly
//! before impact, among all obstacles of the field, whether a beam had met them or not.

use super::{CeilingError, Feasibility, Question};
use mpp_sim::aircraft::Aircraft;
use mpp_sim::faults::Faults;
use mpp_sim::flight_observer::FlightObserver;
use mpp_sim::plant::Plant;
use mpp_sim::scenario::{Scenario, TICKS_PER_SECOND};

/// Time before impact at which the first command counts \[s\].
pub const BEFORE: u32 = 2;
/// Extent of the generators' obstacles, in a world of scale 1 \[m\].
const EXTENT: f64 = 2.0;
/// Time for which a flight stays free beyond the obstacle, at cruise \[s\].
const BEYOND: f64 = 1.0;

/// Whether commands of the last [`BEFORE`] seconds could have avoided the collision with which this flight ended: `true`
/// if a search found some, `false` if a proof says that there are none, and `None` if there is neither.
///
/// # Errors
/// [`CeilingError`] if the field or the aircraft is none that can be judged.
pub fn avoidable(
    scenario: &Scenario,
    observer: &FlightObserver,
) -> Result<Option<bool>, CeilingError> {
    let aircraft = observer.aircraft_before(scenario, BEFORE * TICKS_PER_SECOND);
    let aircraft = aircraft.map_err(CeilingError::Trim)?;
    let question = Question::before(scenario, aircraft, observer.place().0)?;
    Ok(match question.verdict() {
        Feasibility::Passable => Some(true),
        Feasibility::Blocked(_) => Some(false),
        Feasibility::Undecided => None,
    })
}

impl Question {
    /// The question whether an aircraft that will collide at a place downrange \[m\] can get past what stands there.
    pub(super) fn before(
        scenario: &Scenario,
        aircraft: Aircraft,
        place: f64,
    ) -> Result<Self, CeilingError> {
        let question = Self::new(scenario, 0.0)?;
        let (state, (low, high)) = (*aircraft.state(), question.band);
        let in_envelope = question.envelope.holds(&state.air) && (low..=high).contains(&state.z);
        let cruise = scenario.aircraft.known.cruise;
        Ok(Self {
            end: place + EXTENT * scenario.world_scale + BEYOND * cruise,
            provable: in_envelope && is_as_known(&scenario.faults),
            aircraft,
            ..question
        })
    }
}

/// Whether aircraft and air are what the envelope knows. Faults of the plant make its bounds doubtful, but for limits.
fn is_as_known(faults: &Faults) -> bool {
    let plant = |of: &Faults| (of.gusts, of.model_error, of.elevator, of.thrust);
    plant(faults) == plant(&Faults::default())
}
