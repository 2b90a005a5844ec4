//! The cause of the last set-up of the planner, which decides who gets the reply.

use crate::parameters::Tuning;

/// The cause of the last set-up of the planner.
#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap to put the values on"
)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Asker {
    /// A configuration. Its sender waits for the reply.
    Configure,
    /// A new value of the parameter with this number. Its sender waits for the reply. If the planner refuses
    /// the value, the previous values, stored here, stay in force.
    Parameter(u8, Tuning),
    /// The planner refused a parameter, and the step restores the previous values. The sender already has
    /// its reply.
    Nobody,
}
