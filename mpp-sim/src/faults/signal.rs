//! Faults of one signal: a sensor that reports another value, or an actuator that gives another one.

use super::window::{Timed, fault_table, is_absent};
use crate::random::{self, Draws, Stream};
use mpp_core::config::TICK_PERIOD;

fault_table! {
    /// The faults of one signal; each may be absent. They act in this order: `scale`, `bias`, `frozen`, `ramp`,
    /// `noise`, `quantum`.
    pub struct SignalFault {
        /// Factor on the value [-].
        pub scale: Option<f64>,
        /// Constant error, in the unit of the signal.
        pub bias: Option<f64>,
        /// Error that grows from the beginning of the fault on, in units of the signal per second.
        pub ramp: Option<f64>,
        /// Standard deviation of additional white noise, in the unit of the signal.
        pub noise: Option<f64>,
        /// Step between the values that the signal can have, in the unit of the signal.
        pub quantum: Option<f64>,
        /// Whether the signal keeps the first value that it has within the fault. What stands after it in the order
        /// still acts, so a stuck sensor can drift and be noisy.
        pub frozen: bool,
    }
}

/// Greatest number of a fault. What follows from one that is much greater is not finite.
const MOST: f64 = 1e9;

impl SignalFault {
    fn wrong_key(&self) -> Option<&'static str> {
        let bounded = |value: Option<f64>| value.is_none_or(|it| it.abs() <= MOST);
        let (noise, quantum) = (self.noise.unwrap_or(0.0), self.quantum.unwrap_or(1.0));
        let keys = [
            (bounded(self.scale), "give a `scale` of at most 1e9"),
            (bounded(self.bias), "give a `bias` of at most 1e9"),
            (bounded(self.ramp), "give a `ramp` of at most 1e9"),
            ((0.0..=MOST).contains(&noise), "give a `noise` of 0 to 1e9"),
            (
                quantum > 0.0 && quantum <= MOST,
                "give a `quantum` above 0, and at most 1e9",
            ),
        ];
        let flaw = keys.into_iter().find(|(sound, _)| !sound);
        flaw.map(|(_, advice)| advice)
    }
}

impl SignalFault {
    /// The same fault of a signal whose unit is so many of this one's.
    #[must_use]
    pub fn in_units_of(self, unit: f64) -> Self {
        let convert = |value: Option<f64>| value.map(|value| value * unit);
        Self {
            bias: convert(self.bias),
            ramp: convert(self.ramp),
            noise: convert(self.noise),
            quantum: convert(self.quantum),
            ..self
        }
    }
}

/// One signal of one flight.
#[derive(Clone, Debug)]
pub struct Signal {
    fault: SignalFault,
    generator: Draws,
    /// The value that a frozen signal keeps.
    kept: Option<f64>,
}

impl Signal {
    /// The signal of the flight with this seed, with its own stream of noise.
    #[must_use]
    pub fn new(seed: u64, stream: Stream, fault: SignalFault) -> Self {
        Self {
            fault,
            generator: random::generator(seed, stream),
            kept: None,
        }
    }

    /// Whether the fault acts at a tick.
    #[must_use]
    pub fn acts(&self, tick: u32) -> bool {
        !is_absent(&self.fault) && self.fault.window().holds(tick)
    }

    /// The value that the signal has at a tick instead of this one.
    pub fn pass(&mut self, tick: u32, value: f64) -> f64 {
        let fault = self.fault;
        if !self.acts(tick) {
            self.kept = None;
            return value;
        }
        let mut spoilt = value * fault.scale.unwrap_or(1.0) + fault.bias.unwrap_or(0.0);
        if fault.frozen {
            spoilt = *self.kept.get_or_insert(spoilt);
        }
        if let Some(ramp) = fault.ramp {
            spoilt += ramp * f64::from(tick - fault.window().first()) * TICK_PERIOD;
        }
        if let Some(noise) = fault.noise {
            spoilt += noise * random::gaussian(&mut self.generator);
        }
        if let Some(quantum) = fault.quantum {
            spoilt = (spoilt / quantum).round() * quantum;
        }
        spoilt
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a signal makes of these values, tick by tick.
    fn passed(fault: SignalFault, values: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let mut signal = Signal::new(3, Stream::AirspeedFault, fault);
        (0..)
            .zip(values)
            .map(|(tick, value)| signal.pass(tick, value))
            .collect()
    }

    fn rising(count: u32) -> impl Iterator<Item = f64> {
        (0..count).map(|tick| 10.0 + f64::from(tick))
    }

    #[test]
    fn without_a_fault_a_signal_is_what_it_was_to_the_last_bit() {
        let values: Vec<f64> = rising(50).map(|value| value / 3.0).collect();
        assert_eq!(passed(SignalFault::default(), values.clone()), values);
    }

    #[test]
    fn scale_bias_and_ramp_act_within_their_time_only() {
        let fault = SignalFault {
            from: Some(0.1),
            until: Some(0.2),
            scale: Some(2.0),
            bias: Some(-3.0),
            ramp: Some(50.0),
            ..SignalFault::default()
        };
        for (tick, value) in passed(fault, rising(30)).into_iter().enumerate() {
            let true_value = 10.0 + tick as f64;
            let expected = match tick {
                10..20 => 2.0 * true_value - 3.0 + 0.5 * (tick - 10) as f64,
                _ => true_value,
            };
            assert!((value - expected).abs() < 1e-9, "{tick}: {value}");
        }
    }

    #[test]
    fn a_frozen_signal_keeps_its_first_value_and_comes_back() {
        let fault = SignalFault {
            from: Some(0.05),
            until: Some(0.1),
            frozen: true,
            ..SignalFault::default()
        };
        let mut expected: Vec<f64> = rising(20).collect();
        expected[5..10].fill(15.0);
        assert_eq!(passed(fault, rising(20)), expected);
    }

    #[test]
    fn noise_has_its_spread_and_a_quantum_its_steps() {
        const COUNT: usize = 50_000;
        let noise = SignalFault {
            noise: Some(0.5),
            ..SignalFault::default()
        };
        let values = passed(noise, vec![0.0; COUNT]);
        let square = values.iter().map(|value| value * value).sum::<f64>() / COUNT as f64;
        assert!((square.sqrt() / 0.5 - 1.0).abs() < 0.02, "{square}");
        let coarse = SignalFault {
            quantum: Some(0.25),
            ..SignalFault::default()
        };
        assert_eq!(passed(coarse, [1.1, 1.2, -0.4]), [1.0, 1.25, -0.5]);
    }

    #[test]
    fn another_unit_changes_the_errors_and_not_the_factor() {
        let degrees = SignalFault {
            scale: Some(2.0),
            bias: Some(180.0),
            ..SignalFault::default()
        };
        let radians = degrees.in_units_of(1_f64.to_radians());
        assert_eq!(radians.scale, Some(2.0));
        let pi = core::f64::consts::PI;
        assert!((passed(radians, [1.0])[0] - 2.0 - pi).abs() < 1e-12);
    }
}
