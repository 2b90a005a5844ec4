//! Settings of the paper's method.

use super::{Initial, Padding, Rules};
use crate::vehicle::JacobianForm;

/// Settings that only the paper's method reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperSettings {
    /// Rules of map, path search and raytracing.
    pub rules: Rules,
    /// Form of the Jacobian in the plan's model.
    pub jacobian: JacobianForm,
    /// Rule for the first state of the plan.
    pub initial: Initial,
    /// Distance that the corridor keeps from obstacles.
    pub padding: Padding,
}

impl PaperSettings {
    /// The settings of the authors' code.
    pub(crate) const AUTHORS: Self = Self {
        rules: Rules::Authors,
        jacobian: JacobianForm::Authors,
        initial: Initial::ThroughSteadyState,
        padding: Padding::AUTHORS,
    };

    /// The settings of the paper's text with its errors corrected.
    pub(crate) const CORRECTED: Self = Self {
        rules: Rules::Corrected,
        jacobian: JacobianForm::Exact,
        initial: Initial::Estimate,
        ..Self::AUTHORS
    };
}
