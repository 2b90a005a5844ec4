//! Setpoints, and the last gate that each of them passes.

/// What the autopilot is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setpoint {
    /// Pitch, nose-up positive \[rad\].
    pub(crate) pitch: f64,
    /// Bank, right wing down positive \[rad\].
    pub(crate) roll: f64,
    /// Throttle, 0 to 1 [-].
    pub(crate) throttle: f64,
}

/// The limits of each setpoint. They are the narrower ones of the autopilot and of the caller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gate {
    /// Least pitch \[rad\].
    pub(crate) pitch_min: f64,
    /// Greatest pitch \[rad\].
    pub(crate) pitch_max: f64,
    /// Greatest bank \[rad\].
    pub(crate) bank: f64,
}

impl Gate {
    /// The setpoint within the limits; `None` if a number is not finite, or if the limits leave nothing.
    #[must_use]
    pub(crate) fn pass(&self, asked: Setpoint) -> Option<Setpoint> {
        let parts = [asked.pitch, asked.roll, asked.throttle];
        let sound = parts.iter().all(|part| part.is_finite()) && self.bank >= 0.0;
        (sound && self.pitch_min <= self.pitch_max).then(|| Setpoint {
            pitch: asked.pitch.clamp(self.pitch_min, self.pitch_max),
            roll: asked.roll.clamp(-self.bank, self.bank),
            throttle: asked.throttle.clamp(0.0, 1.0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GATE: Gate = Gate {
        pitch_min: -0.3,
        pitch_max: 0.4,
        bank: 0.2,
    };

    fn pass(gate: Gate, pitch: f64, roll: f64, throttle: f64) -> Option<[f64; 3]> {
        let passed = gate.pass(Setpoint {
            pitch,
            roll,
            throttle,
        })?;
        Some([passed.pitch, passed.roll, passed.throttle])
    }

    #[test]
    fn nothing_passes_that_is_not_finite_or_beyond_a_limit() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(pass(GATE, bad, 0.0, 0.5), None);
            assert_eq!(pass(GATE, 0.0, bad, 0.5), None);
            assert_eq!(pass(GATE, 0.0, 0.0, bad), None);
        }
        assert_eq!(pass(GATE, 1.0, 2.0, 7.0), Some([0.4, 0.2, 1.0]));
        assert_eq!(pass(GATE, -1.0, -2.0, -7.0), Some([-0.3, -0.2, 0.0]));
        assert_eq!(pass(GATE, 0.1, 0.1, 0.2), Some([0.1, 0.1, 0.2]));
        let pitch_min = f64::NAN;
        assert_eq!(pass(Gate { pitch_min, ..GATE }, 0.0, 0.0, 0.5), None);
        let bank = f64::NAN;
        assert_eq!(pass(Gate { bank, ..GATE }, 0.0, 0.0, 0.5), None);
    }
}
