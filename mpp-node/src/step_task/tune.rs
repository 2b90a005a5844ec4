//! Changes of parameters. Before the flight the core is set up anew; in flight the next cycle takes the
//! new value.

use super::asker::Asker;
use super::{Flight, StepTask};
use crate::convert;
use crate::parameters::Tuning;
use hil_protocol::{ConfigureVerdict, ParameterReply, ParameterVerdict, SetParameter};
use mpp_core::flight::{FlightLoop, Regulated};

impl StepTask {
    // Not inlined, so that a new flight loop is not on the stack of each tick.
    #[inline(never)]
    pub(super) fn set_parameter(&mut self, set: &SetParameter, send: &mut impl FnMut(&[u8])) {
        if let Err(verdict) = self.tune(set) {
            self.reply_to_parameter(set.parameter, verdict, send);
        } else if self.flight.as_ref().is_some_and(|flight| flight.ready) {
            self.reply_to_parameter(set.parameter, ParameterVerdict::Accepted, send);
        }
    }

    /// Takes over a value. Before the flight the reply waits for the planner.
    fn tune(&mut self, set: &SetParameter) -> Result<(), ParameterVerdict> {
        let Some(flight) = &mut self.flight else {
            return Err(ParameterVerdict::NotConfigured);
        };
        let in_flight = flight.last_tick.is_some();
        let mut tuning = flight.tuning;
        tuning.change(set.parameter, set.value, in_flight)?;
        if in_flight {
            flight.tuning = tuning;
        } else {
            let failed = |error| ParameterVerdict::SetUp(convert::setup_verdict(error));
            let regulated = Regulated::new(&tuning.settings).map_err(failed)?;
            flight.asker = Asker::Parameter(set.parameter, flight.tuning);
            flight.refit(&tuning, &regulated);
            self.order_set_up();
        }
        Ok(())
    }

    /// Handles the result of a set-up with a new value of a parameter, or with the previous values again.
    pub(super) fn tuned(
        &mut self,
        result: Result<(), ConfigureVerdict>,
        send: &mut impl FnMut(&[u8]),
    ) {
        let Some(flight) = &mut self.flight else {
            return;
        };
        let Asker::Parameter(number, before) = flight.asker else {
            // The previous values have worked before, so their result needs no check.
            flight.ready = true;
            return;
        };
        let verdict = match result {
            Ok(()) => {
                flight.ready = true;
                ParameterVerdict::Accepted
            }
            Err(verdict) => {
                if let Ok(regulated) = Regulated::new(&before.settings) {
                    flight.refit(&before, &regulated);
                }
                flight.asker = Asker::Nobody;
                self.order_set_up();
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
        self.emit(&reply, send);
    }
}

impl Flight {
    /// Takes other values before the flight, with a regulator for them. The planner is not set up for them.
    // Not inlined, so that the new loop does not lie on the stack above the design of the regulator.
    #[inline(never)]
    fn refit(&mut self, tuning: &Tuning, regulated: &Regulated) {
        self.tuning = *tuning;
        self.control = FlightLoop::regulated(&tuning.settings, regulated);
        self.ready = false;
    }
}
