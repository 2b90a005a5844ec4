//! Parameters: before the flight the core is set up anew, in flight the next cycle takes them.

use super::StepTask;
use crate::convert;
use crate::parameters::Tuning;
use hil_protocol::{ConfigureVerdict, Message, ParameterReply, ParameterVerdict, SetParameter};
use mpp_core::flight::FlightLoop;

/// Who waits for the planner to be set up.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the values on"
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Asker {
    /// Whoever sent the configuration.
    Configure,
    /// Whoever sent this parameter; the values before it are flown if it does not do.
    Parameter(u8, Tuning),
    /// Nobody any more: a parameter did not do, and what was before is set up again.
    Nobody,
}

impl StepTask {
    pub(super) fn set_parameter(&mut self, set: &SetParameter, send: &mut impl FnMut(&[u8])) {
        if let Err(verdict) = self.tune(set) {
            self.reply_to_parameter(set.parameter, verdict, send);
        } else if self.flight.as_ref().is_some_and(|flight| flight.ready) {
            self.reply_to_parameter(set.parameter, ParameterVerdict::Accepted, send);
        }
    }

    /// Takes a value over; before the flight the answer waits for the planner.
    fn tune(&mut self, set: &SetParameter) -> Result<(), ParameterVerdict> {
        let Some(flight) = &mut self.flight else {
            return Err(ParameterVerdict::NotConfigured);
        };
        let before = flight.tuning;
        let in_flight = flight.last_tick.is_some();
        let tuning = before.with(set.parameter, set.value, in_flight)?;
        if !in_flight {
            let failed = |error| ParameterVerdict::SetUp(convert::setup_verdict(error));
            flight.control = FlightLoop::new(&tuning.settings).map_err(failed)?;
            flight.ready = false;
            flight.asker = Asker::Parameter(set.parameter, before);
        }
        flight.tuning = tuning;
        if !in_flight {
            self.order_set_up(tuning);
        }
        Ok(())
    }

    /// The planner was set up, or not, with a parameter or again with what was before it.
    pub(super) fn tuned(
        &mut self,
        result: Result<(), ConfigureVerdict>,
        send: &mut impl FnMut(&[u8]),
    ) {
        let Some(flight) = &mut self.flight else {
            return;
        };
        let Asker::Parameter(number, before) = flight.asker else {
            // What was before has worked before.
            flight.ready = true;
            return;
        };
        let verdict = match result {
            Ok(()) => {
                flight.ready = true;
                ParameterVerdict::Accepted
            }
            Err(verdict) => {
                flight.tuning = before;
                if let Ok(control) = FlightLoop::new(&before.settings) {
                    flight.control = control;
                }
                flight.asker = Asker::Nobody;
                self.order_set_up(before);
                ParameterVerdict::SetUp(verdict)
            }
        };
        self.reply_to_parameter(number, verdict, send);
    }

    fn reply_to_parameter(
        &mut self,
        parameter: u8,
        verdict: ParameterVerdict,
        send: &mut impl FnMut(&[u8]),
    ) {
        let reply = ParameterReply { parameter, verdict };
        self.emit(&Message::ParameterReply(reply), send);
    }
}
