//! Random cases that are the same in every run.

use proptest::test_runner::{Config, RngSeed};

pub(crate) fn seeded() -> Config {
    Config {
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..Config::default()
    }
}
