//! Faults on a measurement's way: measurements that do not come, come seldom, or come late.

use super::window::{TICKS_PER_SECOND, Timed, fault_table, ticks_of};
use std::collections::VecDeque;

fault_table! {
    /// The faults of a measurement's way; each may be absent. A measurement keeps the stamp of the tick at which
    /// it was taken.
    pub struct DeliveryFault {
        /// Whether no measurement comes.
        pub missing: bool,
        /// Time from a measurement until it arrives \[ms\].
        pub delay_ms: Option<u32>,
        /// Greatest number of measurements in a second \[Hz\].
        pub rate_hz: Option<f64>,
    }
}

impl DeliveryFault {
    pub(super) fn wrong_key(&self) -> Option<&'static str> {
        let delay = self.delay_ms.is_none_or(|delay| ticks_of(delay).is_some());
        let rate = self.rate_hz.is_none_or(|rate| period(rate).is_some());
        match (delay, rate) {
            (false, _) => Some("give a `delay_ms` that is a multiple of 10 and at most 10000"),
            (_, false) => Some("give a `rate_hz` of which 100 is a whole multiple"),
            _ => None,
        }
    }
}

/// The ticks between two measurements, if they are a whole number.
fn period(rate_hz: f64) -> Option<u32> {
    let period = f64::from(TICKS_PER_SECOND) / rate_hz;
    let whole = (1.0..=1e4).contains(&period) && period.fract() == 0.0;
    whole.then_some(period as u32)
}

/// One kind of measurements of one flight, on their way to the core.
#[derive(Clone, Debug)]
pub struct Delivery<T> {
    fault: DeliveryFault,
    /// The measurements under way, each with the tick at which it arrives.
    under_way: VecDeque<(u32, T)>,
}

impl<T> Delivery<T> {
    /// The way of a flight's measurements.
    #[must_use]
    pub fn new(fault: DeliveryFault) -> Self {
        Self {
            fault,
            under_way: VecDeque::new(),
        }
    }

    /// Takes the measurement of a tick, if there is one, and gives the one that arrives at this tick. If
    /// several arrive, the latest stands for all of them.
    pub fn pass(&mut self, tick: u32, taken: Option<T>) -> Option<T> {
        let fault = &self.fault;
        let mut delay = 0;
        let mut comes = true;
        if fault.window().holds(tick) {
            let due = |rate| period(rate).is_none_or(|period| tick.is_multiple_of(period));
            comes = !fault.missing && fault.rate_hz.is_none_or(due);
            delay = fault.delay_ms.and_then(ticks_of).unwrap_or(0);
        }
        let taken = taken.filter(|_| comes).map(|taken| (tick + delay, taken));
        self.under_way.extend(taken);
        let latest = self.under_way.iter().rposition(|(due, _)| *due <= tick)?;
        self.under_way.drain(..=latest).last().map(|(_, last)| last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ticks at which the arriving measurements were taken, tick by tick.
    fn passed(fault: DeliveryFault, ticks: u32) -> Vec<Option<u32>> {
        let mut delivery = Delivery::new(fault);
        (0..ticks)
            .map(|tick| delivery.pass(tick, Some(tick)))
            .collect()
    }

    #[test]
    fn without_a_fault_each_measurement_arrives_at_once() {
        let expected: Vec<_> = (0..20).map(Some).collect();
        assert_eq!(passed(DeliveryFault::default(), 20), expected);
    }

    #[test]
    fn missing_measurements_do_not_come() {
        let fault = DeliveryFault {
            from: Some(0.05),
            until: Some(0.1),
            missing: true,
            ..DeliveryFault::default()
        };
        let expected: Vec<_> = (0..20)
            .map(|tick| Some(tick).filter(|tick| !(5..10).contains(tick)))
            .collect();
        assert_eq!(passed(fault, 20), expected);
    }

    #[test]
    fn a_rate_leaves_every_nth_measurement() {
        let fault = DeliveryFault {
            rate_hz: Some(25.0),
            ..DeliveryFault::default()
        };
        let expected: Vec<_> = (0..20)
            .map(|tick| (tick % 4 == 0).then_some(tick))
            .collect();
        assert_eq!(passed(fault, 20), expected);
    }

    /// After the end of a delay the late measurements are older than the one that comes at once.
    #[test]
    fn a_late_measurement_keeps_the_tick_at_which_it_was_taken() {
        let fault = DeliveryFault {
            from: Some(0.05),
            until: Some(0.15),
            delay_ms: Some(40),
            ..DeliveryFault::default()
        };
        let expected: Vec<_> = (0..20)
            .map(|tick| match tick {
                5..9 => None,
                9..15 => Some(tick - 4),
                _ => Some(tick),
            })
            .collect();
        assert_eq!(passed(fault, 20), expected);
    }
}
