//! The part of a flight in which a fault acts.

use mpp_core::config::TICK_PERIOD;

/// A table of a fault with times.
pub(super) trait Timed: Default + PartialEq {
    /// The times at which the fault acts.
    fn window(&self) -> Window;

    /// The table without its times: what fails at them.
    fn timeless(&self) -> Self;

    /// What is wrong with its keys other than the times.
    fn wrong_key(&self) -> Option<&'static str>;
}

/// Declares the table of a fault: its times, and what fails at them. A method `wrong_key` checks the latter.
/// The table cannot hold the times as a part of its own, because serde's `flatten` takes unknown keys.
macro_rules! fault_table {
    (
        $(#[$about:meta])*
        pub struct $table:ident {
            $($(#[$meaning:meta])* pub $key:ident: $type:ty,)*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $table {
            /// Time at which the fault begins \[s\]; by default the start of the flight.
            #[serde(skip_serializing_if = "crate::faults::window::is_absent")]
            pub from: Option<f64>,
            /// Time at which the fault ends \[s\]; by default it does not end.
            #[serde(skip_serializing_if = "crate::faults::window::is_absent")]
            pub until: Option<f64>,
            /// Rate at which the fault comes and goes \[Hz\]: it acts in the first half of each period. By default it stays.
            #[serde(skip_serializing_if = "crate::faults::window::is_absent")]
            pub toggle_hz: Option<f64>,
            $(
                $(#[$meaning])*
                #[serde(skip_serializing_if = "crate::faults::window::is_absent")]
                pub $key: $type,
            )*
        }

        impl $crate::faults::window::Timed for $table {
            fn window(&self) -> $crate::faults::window::Window {
                $crate::faults::window::Window {
                    from: self.from,
                    until: self.until,
                    toggle_hz: self.toggle_hz,
                }
            }

            fn timeless(&self) -> Self {
                Self {
                    from: None,
                    until: None,
                    toggle_hz: None,
                    ..*self
                }
            }

            fn wrong_key(&self) -> Option<&'static str> {
                self.wrong_key()
            }
        }
    };
}
pub(super) use fault_table;

/// The ticks at which a fault acts, by the keys `from` and `until` \[s\] and `toggle_hz` [Hz] of its table. Without them it
/// acts during the whole flight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    pub(super) from: Option<f64>,
    pub(super) until: Option<f64>,
    pub(super) toggle_hz: Option<f64>,
}

impl Window {
    /// The first tick of the fault.
    pub(super) fn first(&self) -> u32 {
        self.from.map_or(0, whole_ticks)
    }

    /// Whether the fault acts at a tick.
    pub(super) fn holds(&self, tick: u32) -> bool {
        let within =
            tick >= self.first() && self.until.is_none_or(|until| tick < whole_ticks(until));
        within
            && self
                .toggle_hz
                .is_none_or(|rate| self.periods(tick, rate).fract() < 0.5)
    }

    /// Periods of a fault that comes and goes at this rate \[Hz\], from its first tick to this one.
    fn periods(&self, tick: u32, rate: f64) -> f64 {
        f64::from(tick - self.first()) * TICK_PERIOD * rate
    }

    /// What keeps a fault that `acts` at these times from it in a flight of so many ticks.
    pub(super) fn idle(&self, acts: bool, ticks: u32) -> Option<&'static str> {
        let given = self.from.is_some() || self.until.is_some() || self.toggle_hz.is_some();
        let first = self.first();
        if given && !acts {
            return Some(
                "nothing fails from `from` until `until`: give what fails, or leave the table out",
            );
        }
        if acts && first >= ticks {
            return Some(
                "it begins after the flight: give an earlier `from`, or a longer `duration`",
            );
        }
        let empty = acts && !self.holds(first);
        empty.then_some("it acts in no tick of 0.01 s: give a later `until`")
    }

    /// What is wrong with the two keys.
    pub(super) fn flaw(&self) -> Option<&'static str> {
        let from = self.from.unwrap_or(0.0);
        if !(0.0..=LONGEST).contains(&from) {
            return Some("give a `from` of 0 to 3600 s");
        }
        let rate = self.toggle_hz.unwrap_or(1.0);
        if !(rate > 0.0 && rate <= MOST_RATE) {
            return Some("give a `toggle_hz` above 0, and at most 50 Hz");
        }
        let ends = |until: f64| until > from && until <= LONGEST;
        let sound = self.until.is_none_or(ends);
        (!sound).then_some("give an `until` after `from`, and at most 3600 s")
    }
}

/// Ticks in a second.
pub(super) const TICKS_PER_SECOND: u32 = (1.0 / TICK_PERIOD) as u32;

/// Length of a tick \[ms\].
const TICK_MS: u32 = 1000 / TICKS_PER_SECOND;

/// Latest time of a key \[s\]: the longest flight.
const LONGEST: f64 = 3600.0;

/// Greatest rate of a fault that comes and goes \[Hz\]: one tick with it, one without.
const MOST_RATE: f64 = 50.0;

/// The tick nearest to a time \[s\].
fn whole_ticks(time: f64) -> u32 {
    (time * f64::from(TICKS_PER_SECOND)).round() as u32
}

/// Whether a table has no fault. The log then does not hold the table.
pub(super) fn is_absent<T: Default + PartialEq>(fault: &T) -> bool {
    *fault == T::default()
}

/// The ticks of a time that must be a whole number of them \[ms\]; `None` if it is not, or if it is longer
/// than 10 s.
pub(super) fn ticks_of(delay_ms: u32) -> Option<u32> {
    let sound = delay_ms.is_multiple_of(TICK_MS) && delay_ms <= 10_000;
    sound.then_some(delay_ms / TICK_MS)
}
