//! A true airframe that differs from the one that the core knows.

use crate::random::{self, Stream};
use mpp_core::vehicle::Airframe;
use serde::{Deserialize, Serialize};

/// Errors of the airframe as shares of the values that the core assumes [-]. The moment of inertia
/// has no error: the wrong mass is cargo near the centre.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ModelError {
    /// Error of the mass.
    pub mass: f64,
    /// Error of the lift slope `C_La`.
    pub lift_slope: f64,
    /// Error of the pitch stiffness `C_Ma`.
    pub pitch_stiffness: f64,
    /// Source of the errors' signs.
    pub signs: Signs,
}

/// The source of the errors' signs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Signs {
    /// The errors have the signs that are written.
    #[default]
    Given,
    /// The flight's seed draws the sign of each error.
    Drawn,
}

impl ModelError {
    /// The true airframe of the flight with this seed. The core knows the airframe `known`.
    #[must_use]
    pub fn airframe(&self, seed: u64, known: Airframe) -> Airframe {
        let mut generator = random::generator(seed, Stream::ModelError);
        let mut factor = |error: f64| {
            let negative = self.signs == Signs::Drawn && random::uniform(&mut generator) < 0.5;
            if negative { 1.0 - error } else { 1.0 + error }
        };
        Airframe {
            mass: known.mass * factor(self.mass),
            lift_alpha: known.lift_alpha * factor(self.lift_slope),
            moment_alpha: known.moment_alpha * factor(self.pitch_stiffness),
            ..known
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    const KNOWN: Airframe = Airframe::REFERENCE;

    #[test]
    fn no_error_changes_no_bit() {
        assert_eq!(ModelError::default().airframe(1, KNOWN), KNOWN);
        let drawn = ModelError {
            signs: Signs::Drawn,
            ..ModelError::default()
        };
        assert_eq!(drawn.airframe(1, KNOWN), KNOWN);
    }

    #[test]
    fn given_errors_are_as_written() {
        let error = ModelError {
            mass: 0.1,
            lift_slope: -0.2,
            pitch_stiffness: 0.3,
            signs: Signs::Given,
        };
        for seed in 0..5 {
            let airframe = error.airframe(seed, KNOWN);
            assert!((airframe.mass / KNOWN.mass - 1.1).abs() < 1e-12);
            assert!((airframe.lift_alpha / KNOWN.lift_alpha - 0.8).abs() < 1e-12);
            assert!((airframe.moment_alpha / KNOWN.moment_alpha - 1.3).abs() < 1e-12);
        }
    }

    #[test]
    fn drawn_signs_give_all_eight_corners() {
        let error = ModelError {
            mass: 0.1,
            lift_slope: 0.1,
            pitch_stiffness: 0.1,
            signs: Signs::Drawn,
        };
        let corners: BTreeSet<[bool; 3]> = (0..100)
            .map(|seed| {
                let airframe = error.airframe(seed, KNOWN);
                [
                    airframe.mass / KNOWN.mass,
                    airframe.lift_alpha / KNOWN.lift_alpha,
                    airframe.moment_alpha / KNOWN.moment_alpha,
                ]
                .map(|factor| {
                    assert!(((factor - 1.0).abs() - 0.1).abs() < 1e-12, "{factor}");
                    factor > 1.0
                })
            })
            .collect();
        assert_eq!(corners.len(), 8);
    }
}
