//! Flights of ours and of the oracle, field by field.

use super::{Row, wilson};
use serde::Serialize;
use std::collections::BTreeMap;

/// Strict successes on the fields that both have flown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct AgainstOracle {
    /// Fields that both fly.
    pub both: u32,
    /// Fields that only we fly.
    pub only_ours: u32,
    /// Fields that only the oracle flies.
    pub only_oracle: u32,
    /// Fields that neither flies.
    pub neither: u32,
    /// Of the fields that the oracle flies, the share that we fly too [-]; null if it flies none.
    pub share: Option<f64>,
    /// Lower end of its 95 % interval (Wilson).
    pub wilson_low: f64,
    /// Upper end.
    pub wilson_high: f64,
}

impl AgainstOracle {
    /// Pairs rows by their seeds; a seed that only one of them has flown is left out.
    pub(super) fn new(ours: &[&Row], oracle: &[&Row]) -> Self {
        let oracle: BTreeMap<u64, bool> = oracle
            .iter()
            .map(|row| (row.seed, row.summary.strict))
            .collect();
        let mut pairs = Self::default();
        for row in ours {
            *match (row.summary.strict, oracle.get(&row.seed)) {
                (_, None) => continue,
                (true, Some(true)) => &mut pairs.both,
                (true, Some(false)) => &mut pairs.only_ours,
                (false, Some(true)) => &mut pairs.only_oracle,
                (false, Some(false)) => &mut pairs.neither,
            } += 1;
        }
        let flown = pairs.both + pairs.only_oracle;
        pairs.share = (flown > 0).then(|| f64::from(pairs.both) / f64::from(flown));
        (pairs.wilson_low, pairs.wilson_high) = wilson(pairs.both, flown);
        pairs
    }
}
