//! The set-up of a flight: a configuration, the regulator that is designed for it, and the planner's reply.

use super::asker::Asker;
use super::{Session, StepTask};
use crate::convert;
use crate::mail::PlanRequest;
use crate::out::Out;
use crate::parameters::Tuning;
use hil_protocol::{Configure, ConfigureReply, ConfigureVerdict, DecodeError};
use mpp_core::estimate::SensorMonitor;
use mpp_core::flight::{FlightLoop, Regulated};

impl StepTask {
    // Not inlined, so that a new flight is not on the stack of each tick.
    #[inline(never)]
    pub(super) fn read_configure(&mut self, send: &mut impl Out) -> Result<(), DecodeError> {
        self.configure(&self.decoder.body()?, send);
        Ok(())
    }

    pub(super) fn configure(&mut self, configure: &Configure, send: &mut impl Out) {
        match self.prepare(configure) {
            Ok((tuning, regulated)) => {
                self.begin(&tuning, &regulated);
                self.request_set_up();
            }
            Err(verdict) => self.reply(verdict, send),
        }
    }

    /// Requests the set-up of the planner with the values of the session. It replaces a request that still waits.
    pub(super) fn request_set_up(&mut self) {
        let Some(session) = &self.session else {
            return;
        };
        self.set_ups = self.set_ups.wrapping_add(1);
        self.request = Some(PlanRequest::SetUp {
            number: self.set_ups,
            settings: session.tuning.settings,
        });
    }

    /// Checks a configuration, and designs the regulator for it.
    #[inline(never)]
    fn prepare(&self, configure: &Configure) -> Result<(Tuning, Regulated), ConfigureVerdict> {
        if self.session.is_some() {
            return Err(ConfigureVerdict::AlreadyConfigured);
        }
        if let Some(refusal) = self.refusal {
            return Err(refusal);
        }
        let tuning = Tuning::new(configure)?;
        let regulated = Regulated::new(&tuning.settings).map_err(convert::setup_verdict)?;
        Ok((tuning, regulated))
    }

    /// Begins a flight, which waits for the planner to be set up.
    // Not inlined, so that the new flight does not lie on the stack above the design of the regulator.
    #[inline(never)]
    fn begin(&mut self, tuning: &Tuning, regulated: &Regulated) {
        let configure = &tuning.configure;
        let between = configure
            .replan_period_ticks
            .saturating_add(configure.latency_ticks);
        self.session = Some(Session {
            tuning: *tuning,
            asker: Asker::Configure,
            ready: false,
            control: FlightLoop::regulated(&tuning.settings, regulated),
            first_tick: None,
            last_tick: None,
            cycle: None,
            last_cycle: None,
            last_scan: None,
            scan_interval: None,
            blind_from: None,
            plan_tick: None,
            untold: None,
            unsteered: None,
            scan_tick: None,
            heard_scan: None,
            forget: false,
            old_ticks: None,
            lidar: SensorMonitor::new(u16::try_from(between).unwrap_or(u16::MAX)),
            lidar_good: None,
            spoilt: false,
        });
    }

    pub(super) fn set_up_done(
        &mut self,
        result: Result<(), ConfigureVerdict>,
        send: &mut impl Out,
    ) {
        let Some(session) = &mut self.session else {
            return;
        };
        if session.ready {
            // The planner was restarted in flight, so no sender waits for a reply.
            return;
        }
        if session.asker != Asker::Configure {
            return self.tuned(result, send);
        }
        match result {
            Ok(()) => {
                session.ready = true;
                self.reply(ConfigureVerdict::Accepted, send);
            }
            Err(verdict) => {
                self.session = None;
                self.reply(verdict, send);
            }
        }
    }

    fn reply(&mut self, verdict: ConfigureVerdict, send: &mut impl Out) {
        self.emit(&ConfigureReply { verdict }, send);
    }
}
