//! The named airframes.

use mpp_core::vehicle::Airframe;
use proptest::prelude::*;

pub(crate) fn named() -> impl Strategy<Value = Airframe> {
    prop_oneof![Just(Airframe::PAPER), Just(Airframe::REFERENCE)]
}
