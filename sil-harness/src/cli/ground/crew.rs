//! Everybody who follows a flight that the command line started.

use super::pacer::Pacer;
use crate::cli::{FAILURE, Failure, talk};
use crate::ground::transport::Transport;
use crate::ground::{Ground, Order, Refused};
use crate::log::FlightLog;
use crate::picture::live::Live;
use crate::run::{FlyError, Moment};
use flight_node::parameters::Tuning;
use indicatif::ProgressBar;
use mpp_core::vehicle::VehicleState;

/// Whoever the command line brings along.
pub(in crate::cli) struct Crew {
    /// Orders for before the first tick.
    pub(super) orders: Vec<Order>,
    /// How many orders of our own are given and not settled.
    pub(super) unsettled: usize,
    /// The values in force.
    pub(super) tuning: Option<Tuning>,
    pub(super) live: Option<Live>,
    pub(super) transport: Option<Transport>,
    pub(super) pacer: Pacer,
    pub(super) progress: ProgressBar,
}

impl Crew {
    /// The flight is over.
    pub(in crate::cli) fn end(self, result: &Result<FlightLog, FlyError>) -> Result<(), Failure> {
        self.progress.finish_and_clear();
        let how = match result {
            Ok(log) => log.summary.outcome.to_string(),
            Err(error) => error.to_string(),
        };
        if let (Some(live), Ok(log)) = (self.live, result) {
            live.end(&log.summary);
        }
        let Some(transport) = self.transport else {
            return Ok(());
        };
        let vehicle = transport
            .end(&how)
            .map_err(|error| Failure::new(FAILURE, format!("--tlog: {error}")))?;
        if vehicle.refused_signatures() > 0 {
            talk(format_args!(
                "{} commands or writes were refused: no good signature",
                vehicle.refused_signatures()
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

    fn watch(&mut self, moment: &Moment<'_>) {
        self.progress.inc(1);
        if let Some(transport) = &mut self.transport {
            transport.watch(moment);
        }
        if let (Some(live), Some(tuning)) = (&mut self.live, &self.tuning) {
            live.watch(moment, tuning);
            if let (Some(speed), Some(transport)) = (self.pacer.obey(live), &mut self.transport) {
                transport.set_patience(speed.patience());
            }
        }
        self.pacer.wait(false);
    }
}
