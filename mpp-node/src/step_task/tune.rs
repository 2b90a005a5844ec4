//! Changes of parameters. Before the flight the core is set up again; in flight the next cycle takes the
//! new value.

use super::asker::Asker;
use super::{Session, StepTask};
use crate::convert;
use crate::out::Out;
use crate::parameters::Tuning;
use hil_protocol::{ConfigureVerdict, ParameterReply, ParameterVerdict, SetParameter};
use mpp_core::flight::{FlightLoop, Regulated};

impl StepTask {
    // Not inlined, so that a new flight loop is not on the stack of each tick.
    #[inline(never)]
    pub(super) fn set_parameter(&mut self, set: &SetParameter, send: &mut impl Out) {
        if let Err(verdict) = self.tune(set) {
            self.reply_to_parameter(set.parameter, verdict, send);
        } else if self.session.as_ref().is_some_and(|session| session.ready) {
            self.reply_to_parameter(set.parameter, ParameterVerdict::Accepted, send);
        }
    }

    /// Takes over a value. Before the flight the reply waits for the planner.
    fn tune(&mut self, set: &SetParameter) -> Result<(), ParameterVerdict> {
        let Some(session) = &mut self.session else {
            return Err(ParameterVerdict::NotConfigured);
        };
        let in_flight = session.last_tick.is_some();
        let mut tuning = session.tuning;
        tuning.change(set.parameter, set.value, in_flight)?;
        if in_flight {
            session.tuning = tuning;
        } else {
            let failed = |error| ParameterVerdict::SetUp(convert::setup_verdict(error));
            let regulated = Regulated::new(&tuning.settings).map_err(failed)?;
            session.asker = Asker::Parameter(set.parameter, session.tuning);
            session.refit(&tuning, &regulated);
            self.request_set_up();
        }
        Ok(())
    }

    /// Handles the result of a set-up with a new value of a parameter, or with the previous values again.
    pub(super) fn tuned(&mut self, result: Result<(), ConfigureVerdict>, send: &mut impl Out) {
        let Some(session) = &mut self.session else {
            return;
        };
        let Asker::Parameter(number, before) = session.asker else {
            // The previous values have worked before, so their result needs no check.
            session.ready = true;
            return;
        };
        let verdict = match result {
            Ok(()) => {
                session.ready = true;
                ParameterVerdict::Accepted
            }
            Err(verdict) => {
                if let Ok(regulated) = Regulated::new(&before.settings) {
                    session.refit(&before, &regulated);
                }
                session.asker = Asker::Nobody;
                self.request_set_up();
                ParameterVerdict::SetUp(verdict)
            }
        };
        self.reply_to_parameter(number, verdict, send);
    }

    fn reply_to_parameter(
        &mut self,
        parameter: u8,
        verdict: ParameterVerdict,
        send: &mut impl Out,
    ) {
        let reply = ParameterReply { parameter, verdict };
        self.emit(&reply, send);
    }
}

impl Session {
    /// Takes other values before the flight, with a regulator for them. The planner is not set up for them.
    // Not inlined, so that the new loop does not lie on the stack above the design of the regulator.
    #[inline(never)]
    fn refit(&mut self, tuning: &Tuning, regulated: &Regulated) {
        self.tuning = *tuning;
        self.control = FlightLoop::regulated(&tuning.settings, regulated);
        self.ready = false;
    }
}
