//! Intervals of success rates.

/// The 97.5 % quantile of the standard normal.
const QUANTILE: f64 = 1.959_963_984_540_054;

/// Wilson's score interval of a share, `successes` of `trials`, at 95 % (Wilson 1927, without
/// continuity correction). Without trials the interval is 0 to 1.
///
/// It is written out here, because the crates that have it bring a second linear algebra or take
/// the quantile through the platform's logarithm.
#[must_use]
pub fn wilson(successes: u32, trials: u32) -> (f64, f64) {
    if trials == 0 {
        return (0.0, 1.0);
    }
    let n = f64::from(trials);
    let share = f64::from(successes) / n;
    let z2 = QUANTILE * QUANTILE;
    let middle = share + z2 / (2.0 * n);
    let half = QUANTILE * (share * (1.0 - share) / n + z2 / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z2 / n;
    let low = if successes == 0 {
        0.0
    } else {
        (middle - half) / scale
    };
    let high = if successes == trials {
        1.0
    } else {
        (middle + half) / scale
    };
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The values of Newcombe, "Two-sided confidence intervals for the single proportion",
    /// Statistics in Medicine 17 (1998), Table I, method 3.
    #[test]
    fn published_values() {
        for (successes, trials, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let (found_low, found_high) = wilson(successes, trials);
            assert!((found_low - low).abs() < 5e-5, "{found_low}");
            assert!((found_high - high).abs() < 5e-5, "{found_high}");
        }
    }

    #[test]
    fn no_trial_tells_nothing() {
        assert_eq!(wilson(0, 0), (0.0, 1.0));
    }

    proptest! {
        /// The ends are the shares p at which the observed one lies 1.96 standard errors away.
        #[test]
        fn the_ends_solve_the_score_equation(trials in 1_u32..5000, part in 0.0_f64..=1.0) {
            let successes = (f64::from(trials) * part) as u32;
            let share = f64::from(successes) / f64::from(trials);
            let (low, high) = wilson(successes, trials);
            prop_assert!(low <= share && share <= high);
            for p in [low, high] {
                let error = (p * (1.0 - p) / f64::from(trials)).sqrt();
                prop_assert!(((share - p).abs() - QUANTILE * error).abs() < 1e-9);
            }
        }
    }
}
