//! What a kind of autopilot expects.

/// System of the autopilot; the companion is a component of the same system.
pub(crate) const SYSTEM: u8 = 1;
/// The autopilot's component.
pub(crate) const AUTOPILOT: u8 = 1;

/// A parameter of an autopilot, the values that a companion can fly with, and what to do otherwise.
pub(crate) struct Check {
    pub(crate) name: &'static str,
    pub(crate) least: f32,
    pub(crate) most: f32,
    pub(crate) advice: &'static str,
}

pub(super) const fn check(
    name: &'static str,
    least: f32,
    most: f32,
    advice: &'static str,
) -> Check {
    Check {
        name,
        least,
        most,
        advice,
    }
}

/// What a kind expects.
pub(crate) struct Manners {
    /// Its name.
    pub(crate) name: &'static str,
    /// Number of the mode that takes setpoints.
    pub(crate) mode: u32,
    /// What is verified.
    pub(crate) checks: &'static [Check],
    /// The parameters with the least and the greatest pitch \[deg\].
    pub(crate) pitch: [&'static str; 2],
    /// Whether the mode is entered only while setpoints flow, and nothing is held without them.
    pub(crate) flows: bool,
    /// The greatest bank that the companion asks for \[rad\].
    pub(crate) bank: f64,
    /// Messages that are asked for, and their periods \[us\].
    pub(crate) streams: &'static [[f32; 2]],
}
