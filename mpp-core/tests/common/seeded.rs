//! Random cases that are the same in every run.

use mpp_core::vehicle::Airframe;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

pub(crate) fn seeded() -> Config {
    Config {
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..Config::default()
    }
}

pub(crate) fn named() -> impl Strategy<Value = Airframe> {
    prop_oneof![Just(Airframe::PAPER), Just(Airframe::REFERENCE)]
}
