//! The nouns that core, link and files share: the aircraft, the limits of its actuators, and the numbers of the
//! settings.
//!
//! `mpp-core` and `hil-protocol` re-export them where they are used. The order of fields and variants goes over the
//! link, which has no names: append only, once a release speaks the version.

#![no_std]
#![forbid(unsafe_code)]

mod actuators;
mod aircraft;
mod airframe;
mod lateral;
mod setting;

pub use actuators::{ActuatorLimits, Control};
pub use aircraft::Aircraft;
pub use airframe::{Airframe, GRAVITY};
pub use lateral::{Derivatives, LateralAirframe, LateralControl};
pub use setting::{OutOfRange, Setting};
