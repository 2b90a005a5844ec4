//! Our flights and the oracle's, compared field by field.

use super::row::Row;
use super::stats::wilson;
use crate::ceiling::Feasibility;
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

/// Strict successes beside the verdicts about the fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct AgainstCeiling {
    /// Number of fields that are proven to be blocked.
    pub blocked: u32,
    /// Number of fields that a witness passes.
    pub passable: u32,
    /// Number of the other fields.
    pub undecided: u32,
    /// Number of passable fields on which the flight succeeds.
    pub flown: u32,
    /// Our share of the passable fields [-]; null if there is no such field.
    pub share: Option<f64>,
    /// Lower end of the share's 95 % interval (Wilson).
    pub wilson_low: f64,
    /// Upper end of this interval.
    pub wilson_high: f64,
}

impl AgainstCeiling {
    /// Pairs rows with the verdicts about their seeds' fields. A seed without a row is left out.
    #[must_use]
    pub fn new(rows: &[&Row], verdicts: &[(u64, Feasibility)]) -> Self {
        let strict: BTreeMap<u64, bool> = rows
            .iter()
            .map(|row| (row.seed, row.summary.strict))
            .collect();
        let mut pairs = Self::default();
        for (seed, verdict) in verdicts {
            let Some(strict) = strict.get(seed) else {
                continue;
            };
            match verdict {
                Feasibility::Blocked(_) => pairs.blocked += 1,
                Feasibility::Undecided => pairs.undecided += 1,
                Feasibility::Passable => {
                    pairs.passable += 1;
                    pairs.flown += u32::from(*strict);
                }
            }
        }
        pairs.share =
            (pairs.passable > 0).then(|| f64::from(pairs.flown) / f64::from(pairs.passable));
        (pairs.wilson_low, pairs.wilson_high) = wilson(pairs.flown, pairs.passable);
        pairs
    }
}
