//! The filter of the motion through the air for air data that come late.
//!
//! The filter stays behind by the age of the air data, so that it meets each measurement at its own time.
//! From there the equations of motion lead to the present under the controls flown since. Source: Larsen,
//! Andersen, Ravn and Poulsen, "Incorporation of time delayed measurements in a discrete-time Kalman filter"
//! (1998), which compares this way with others.

use super::history::MOST_AGE;
use super::{Diverged, Ekf, EkfTuning, Innovation};
use crate::config::TICK_PERIOD;
use crate::sense::Measurement;
use crate::tuning::sensors::LATE_MEASUREMENTS;
use crate::vehicle::{AirState, Airframe, Control, air_rate};

/// Number of ticks of which the controls are kept; a power of two.
const TICKS: usize = 32;

const _: () = assert!((MOST_AGE as usize) < TICKS);

/// The control that the actuators gave in one period.
#[derive(Clone, Copy, Debug)]
struct Flown {
    control: Control,
    /// Length of the period \[s\].
    period: f64,
}

/// The fate of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Taken {
    /// The filter took it; these are the verdicts on its values.
    Measured(Innovation),
    /// It came later than the ones before. The filter did not use it.
    Late,
}

/// An extended Kalman filter that is `lag` ticks behind, and the way from there to the present.
#[derive(Clone, Debug)]
pub struct LaggedEkf {
    ekf: Ekf,
    flown: [Flown; TICKS],
    /// Number of periods so far.
    count: u32,
    /// Ticks by which the filter is behind.
    lag: u32,
    /// Ticks that the filter still waits, so that it falls behind to the age of the measurements.
    waits: u32,
    /// Measurements in a row that were older than the filter.
    late: u8,
    present: AirState,
    /// The value of [`Self::follows`].
    follows: f64,
}

impl LaggedEkf {
    /// A filter that starts from an estimate.
    #[inline(always)]
    #[must_use]
    pub fn new(airframe: Airframe, tuning: EkfTuning, estimate: AirState) -> Self {
        Self {
            ekf: Ekf::new(airframe, tuning, estimate),
            flown: [Flown {
                control: Control {
                    thrust: 0.0,
                    elevator: 0.0,
                },
                period: 0.0,
            }; TICKS],
            count: 0,
            lag: 0,
            waits: 0,
            late: 0,
            present: estimate,
            follows: follows(&tuning),
        }
    }

    /// The estimate for the present.
    #[must_use]
    pub fn present(&self) -> &AirState {
        &self.present
    }

    /// The filter's tuning.
    #[must_use]
    pub fn tuning(&self) -> &EkfTuning {
        self.ekf.tuning()
    }

    /// Ticks by which the filter is behind.
    #[must_use]
    pub fn lag(&self) -> u32 {
        self.lag
    }

    /// Sets the airframe for the predictions from now on.
    pub fn set_airframe(&mut self, airframe: &Airframe) {
        self.ekf.set_airframe(airframe);
    }

    /// Moves the present on by `period` \[s\] under the control flown in that time.
    ///
    /// # Errors
    /// [`Diverged`] if a prediction is not finite. The filter then keeps its estimate.
    pub fn predict(&mut self, control: Control, period: f64) -> Result<(), Diverged> {
        if let Some(slot) = self.flown.get_mut(self.count as usize % TICKS) {
            *slot = Flown { control, period };
        }
        self.count = self.count.wrapping_add(1);
        self.lag += 1;
        let result = if self.waits > 0 && self.lag <= MOST_AGE {
            self.waits -= 1;
            Ok(())
        } else {
            self.catch_up()
        };
        self.look_ahead();
        result
    }

    /// Doubts the motion; see [`Ekf::doubt`].
    pub fn doubt(&mut self, sigmas: [f64; 4]) {
        self.ekf.doubt(sigmas);
    }

    /// Rate at which the estimated airspeed follows the measured one in steady flight [1/s]: a constant push by `a`
    /// leaves it behind by `a` over this.
    #[must_use]
    pub fn follows(&self) -> f64 {
        self.follows
    }

    /// Turns the estimated motion; see [`Ekf::turn`].
    pub fn turn(&mut self, by: f64) {
        self.ekf.turn(by);
        self.look_ahead();
    }

    /// Replaces path and angle of attack; see [`Ekf::restart_pitch`].
    pub fn restart_pitch(&mut self, flight_path: f64, angle_of_attack: f64) {
        self.ekf.restart_pitch(flight_path, angle_of_attack);
        self.look_ahead();
    }

    /// Moves the estimated airspeed by a known error [m/s].
    pub fn shift_airspeed(&mut self, by: f64) {
        self.ekf.shift_airspeed(by);
        self.look_ahead();
    }

    /// Takes a measurement that is `age` ticks old. It uses airspeed and pitch only where `used` says so.
    pub fn take(&mut self, age: u32, measurement: &Measurement, used: [bool; 2]) -> Taken {
        if age > MOST_AGE {
            return Taken::Late;
        }
        if age > self.lag {
            // One measurement that is late is left out; if all are, the filter falls behind to their age.
            self.late = self.late.saturating_add(1);
            if self.late >= LATE_MEASUREMENTS && self.waits == 0 {
                self.waits = age - self.lag;
            }
            return Taken::Late;
        }
        self.late = 0;
        self.waits = 0;
        while self.lag > age {
            // A prediction that is not finite was counted when the present went over it.
            let _ = self.catch_up();
        }
        let innovation = self.ekf.update_by(measurement, used);
        self.look_ahead();
        Taken::Measured(innovation)
    }

    /// Moves the filter on by the oldest period that it has not passed.
    fn catch_up(&mut self) -> Result<(), Diverged> {
        let flown = self.flown_before(self.lag);
        self.lag = self.lag.saturating_sub(1);
        self.ekf.predict(flown.control, flown.period)
    }

    /// Flies from the filter's estimate to the present (forward Euler).
    fn look_ahead(&mut self) {
        let mut state = *self.ekf.estimate();
        for before in (1..=self.lag.min(MOST_AGE)).rev() {
            let Flown { control, period } = self.flown_before(before);
            let rate = air_rate(self.ekf.airframe(), &state, control).to_vector();
            let next = AirState::from_vector(&(state.to_vector() + rate * period));
            if !next.is_finite() {
                break;
            }
            state = next;
        }
        self.present = state;
    }

    /// The period that began `before` periods ago.
    fn flown_before(&self, before: u32) -> Flown {
        let slot = self.count.wrapping_sub(before) as usize % TICKS;
        self.flown.get(slot).copied().unwrap_or(Flown {
            control: Control {
                thrust: 0.0,
                elevator: 0.0,
            },
            period: 0.0,
        })
    }
}

/// The gain on the airspeed of a steady filter, over a tick [1/s].
fn follows(tuning: &EkfTuning) -> f64 {
    libm::sqrt(tuning.process_noise[0] / tuning.airspeed_variance) / TICK_PERIOD
}
