//! The crew: everybody who follows a flight that the command line started.

use super::pacer::{Pacer, patience};
use crate::cli::answer::{FAILURE, Failure, talk};
use crate::cli::signals::Signals;
use crate::ground::transport::Transport;
use crate::live::Live;
use indicatif::ProgressBar;
use mpp_core::vehicle::VehicleState;
use mpp_node::parameters::Tuning;
use mpp_sim::flight::FlyError;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::{Ground, Order, Refused};
use mpp_sim::tick_record::TickRecord;

/// The ground of a flight that the command line started.
pub(in crate::cli) struct Crew {
    /// Orders to give before the first tick.
    pub(super) orders: Vec<Order>,
    /// Number of our own orders that are given and not settled.
    pub(super) unsettled: usize,
    /// The values in force.
    pub(super) tuning: Option<Tuning>,
    pub(super) live: Option<Live>,
    pub(super) transport: Option<Transport>,
    pub(super) pacer: Pacer,
    pub(super) progress: ProgressBar,
    pub(super) signals: Signals,
}

impl Crew {
    /// The exit code of the signal that came, if one did.
    pub(in crate::cli) fn interrupted(&self) -> Option<u8> {
        self.signals.raised()
    }

    /// Ends the crew's work after the flight.
    pub(in crate::cli) fn end(self, result: &Result<FlightLog, FlyError>) -> Result<(), Failure> {
        self.progress.finish_and_clear();
        let how = match result {
            Ok(log) => log.summary.outcome.to_string(),
            Err(error) => error.to_string(),
        };
        if let (Some(live), Ok(log)) = (self.live, result) {
            live.end(log);
        }
        let Some(transport) = self.transport else {
            return Ok(());
        };
        let vehicle = transport
            .end(&how)
            .map_err(|error| Failure::new(FAILURE, format!("--tlog: {error}")))?;
        if vehicle.refused_signatures() > 0 {
            talk(format_args!(
                "{} commands or writes were refused: no good signature, or one whose time is old or \
                 more than a minute ahead of this clock",
                vehicle.refused_signatures()
            ));
        }
        if vehicle.lost_demands() > 0 {
            talk(format_args!(
                "{} commands or writes were lost: too many came at once, send them slower",
                vehicle.lost_demands()
            ));
        }
        Ok(())
    }
}

impl Ground for Crew {
    fn begin(&mut self, tuning: &Tuning, start: &VehicleState) {
        self.tuning = Some(*tuning);
        if let Some(transport) = &mut self.transport {
            transport.begin(tuning, start);
        }
    }

    fn orders(&mut self, tick: u32) -> Vec<Order> {
        let mut orders = std::mem::take(&mut self.orders);
        self.unsettled = orders.len();
        if let Some(transport) = &mut self.transport {
            orders.extend(transport.orders(tick));
        }
        orders
    }

    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        self.tuning = Some(*tuning);
        if let (Some(live), Ok(())) = (&mut self.live, result) {
            live.ordered(order);
        }
        if self.unsettled > 0 {
            self.unsettled -= 1;
            if let Err(refused) = result {
                talk(format_args!("order {order:?}: {refused}"));
            }
            if let Some(transport) = &mut self.transport {
                transport.tuned(tuning);
            }
        } else if let Some(transport) = &mut self.transport {
            transport.settled(order, result, tuning);
        }
    }

    fn ready(&mut self) -> bool {
        let Some(transport) = &mut self.transport else {
            return true;
        };
        if transport.ready() {
            return true;
        }
        transport.hold();
        self.pacer.wait(true);
        false
    }

    fn interrupts(&mut self, _: u32) -> bool {
        self.signals.raised().is_some()
    }

    fn watch(&mut self, record: &TickRecord<'_>) {
        self.progress.inc(1);
        if let Some(transport) = &mut self.transport {
            transport.watch(record);
        }
        if let (Some(live), Some(tuning)) = (&mut self.live, &self.tuning) {
            live.watch(record, tuning);
            let interrupted = || self.signals.raised().is_some();
            let speed = self.pacer.obey(live, interrupted);
            if let (Some(speed), Some(transport)) = (speed, &mut self.transport) {
                transport.set_patience(patience(speed));
            }
        }
        self.pacer.wait(false);
    }
}
