//! Setpoints, and the last gate that each of them passes.

/// What the autopilot is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Setpoint {
    /// Pitch, nose-up positive \[rad\].
    pub(crate) pitch: f64,
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
}

impl Gate {
    /// The setpoint within the limits; `None` if a number is not finite, or if the limits leave nothing.
    #[must_use]
    pub(crate) fn pass(&self, asked: Setpoint) -> Option<Setpoint> {
        let sound = asked.pitch.is_finite() && asked.throttle.is_finite();
        (sound && self.pitch_min <= self.pitch_max).then(|| Setpoint {
            pitch: asked.pitch.clamp(self.pitch_min, self.pitch_max),
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
    };

    fn pass(pitch: f64, throttle: f64) -> Option<(f64, f64)> {
        let passed = GATE.pass(Setpoint { pitch, throttle })?;
        Some((passed.pitch, passed.throttle))
    }

    #[test]
    fn nothing_passes_that_is_not_finite_or_beyond_a_limit() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(pass(bad, 0.5), None);
            assert_eq!(pass(0.0, bad), None);
        }
        assert_eq!(pass(1.0, 7.0), Some((0.4, 1.0)));
        assert_eq!(pass(-1.0, -7.0), Some((-0.3, 0.0)));
        assert_eq!(pass(0.1, 0.2), Some((0.1, 0.2)));
        let none = Gate {
            pitch_min: f64::NAN,
            ..GATE
        };
        let level = Setpoint {
            pitch: 0.0,
            throttle: 0.5,
        };
        assert_eq!(none.pass(level), None);
    }
}
