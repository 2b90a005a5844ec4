//! Our flights and the oracle's, compared field by field.

use super::row::Row;
use super::stats::wilson;
use serde::Serialize;
use std::collections::BTreeMap;

/// Strict successes on the fields that both have flown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct AgainstOracle {
    /// Number of fields on which both succeed.
    pub both: u32,
    /// Number of fields on which only our flight succeeds.
    pub only_ours: u32,
    /// Number of fields on which only the oracle succeeds.
    pub only_oracle: u32,
    /// Number of fields on which neither succeeds.
    pub neither: u32,
    /// Our share of the fields on which the oracle succeeds [-]; null if it succeeds on no field.
    pub share: Option<f64>,
    /// Lower end of the share's 95 % interval (Wilson).
    pub wilson_low: f64,
    /// Upper end of this interval.
    pub wilson_high: f64,
}

impl AgainstOracle {
    /// Pairs rows by their seeds. A seed that only one side has flown is left out.
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
