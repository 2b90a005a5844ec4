//! One flight on one page, or two.

use super::pack::{Packed, PackedSpace, packed};
use super::page::{page, space_page};
use mpp_core::vehicle::VehicleState;
use mpp_node::parameters::Tuning;
use mpp_sim::flight::fly_with;
use mpp_sim::inspector::{Inspector, PlanDetail};
use mpp_sim::log::{FlightLog, LogError};
use mpp_sim::orders::{Again, Ground, Order, Refused};
use mpp_sim::pipe::PipeLink;
use mpp_sim::space::Look;
use mpp_sim::tick_record::TickRecord;

/// Returns the page of a flight, or of two side by side, and whether it shows the details of all planning cycles. To
/// get the details, a flight is flown again; they count only if the result is the same to the last byte.
///
/// # Errors
/// [`LogError`] when a log holds a value that cannot be flown or written.
pub fn replay(log: &FlightLog, against: Option<&FlightLog>) -> Result<(String, bool), LogError> {
    let mut whole = true;
    let mut flights = Vec::new();
    for log in [Some(log), against].into_iter().flatten() {
        log.header.scenario()?;
        let details = details(log).unwrap_or_default();
        whole &= !details.is_empty();
        flights.push(Packed::of(log, details)?);
    }
    Ok((page(&packed(&flights)?), whole))
}

/// Returns the page of a flight in space; `None` if it does not come out the same when it is flown again.
///
/// # Errors
/// [`LogError`] when the log holds a value that cannot be written.
pub fn replay_space(log: &FlightLog) -> Result<Option<String>, LogError> {
    let look = Look::again(log);
    let page = |look| Ok(space_page(&packed(&PackedSpace::of(log, look)?)?));
    look.map(page).transpose()
}

/// The planning cycles of a flight; `None` if the flight cannot be repeated.
pub fn details(log: &FlightLog) -> Option<Vec<PlanDetail>> {
    // The page has nothing to show of the planning of an oracle.
    let scenario = log
        .header
        .scenario()
        .ok()
        .filter(|asked| !asked.is_advised())?;
    let inspector = CycleInspector {
        inspector: None,
        tuning: None,
        details: Vec::new(),
    };
    // A flight that lasts longer than its log is not the same flight.
    let until = u32::try_from(log.ticks.t.len()).ok()?;
    let mut again = Again::new(Some(log.orders.clone()), inspector).until(Some(until));
    let flown = fly_with(&scenario, &mut PipeLink::new(), &mut again).ok()?;
    (flown.hash().ok()? == log.hash().ok()?).then_some(again.ground.details)
}

/// Inspects every cycle of a flight.
struct CycleInspector {
    inspector: Option<Inspector>,
    tuning: Option<Tuning>,
    details: Vec<PlanDetail>,
}

impl Ground for CycleInspector {
    fn begin(&mut self, tuning: &Tuning, _: &VehicleState) {
        self.tuning = Some(*tuning);
    }

    fn settled(&mut self, _: &Order, _: Result<(), Refused>, tuning: &Tuning) {
        self.tuning = Some(*tuning);
    }

    fn watch(&mut self, record: &TickRecord<'_>) {
        let Some(tuning) = &self.tuning else {
            return;
        };
        // The inspector does not exist before the first tick: until then any parameter may change.
        if self.inspector.is_none() {
            self.inspector = Inspector::new(tuning).ok();
        }
        let inspector = self.inspector.as_mut();
        self.details
            .extend(inspector.and_then(|inspector| inspector.look(record, tuning)));
    }
}
