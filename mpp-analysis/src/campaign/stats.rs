//! Intervals of success rates and of their differences.

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

/// The score interval of the difference between two shares of the same `pairs` at 95 %, without continuity
/// correction (Tango, "Equivalence test and confidence interval for the difference in proportions for the
/// paired-sample design", Statistics in Medicine 17 (1998), 891-908). `only_first` pairs succeed in the first
/// flight only, `only_second` in the second only; the difference is that of the first share less the second.
/// Without pairs the interval is -1 to 1.
#[must_use]
pub fn paired(only_first: u32, only_second: u32, pairs: u32) -> (f64, f64) {
    if pairs == 0 {
        return (-1.0, 1.0);
    }
    let difference = (f64::from(only_first) - f64::from(only_second)) / f64::from(pairs);
    // The score falls with the difference that it tests.
    let solve = |mut low: f64, mut high: f64, score: f64| {
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if paired_score(only_first, only_second, pairs, middle) > score {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    };
    (
        solve(-1.0, difference, QUANTILE),
        solve(difference, 1.0, -QUANTILE),
    )
}

/// Halvings of an interval of length 2: its end is then exact to the last bits.
const BISECTIONS: u32 = 60;

/// The score of a supposed difference: the standard errors by which the observed one exceeds it. The variance
/// takes the likeliest share of pairs of the second kind, as the paper does.
fn paired_score(only_first: u32, only_second: u32, pairs: u32, supposed: f64) -> f64 {
    let (first, second) = (f64::from(only_first), f64::from(only_second));
    let n = f64::from(pairs);
    let b = (2.0 * n - first + second) * supposed - first - second;
    let c = -second * supposed * (1.0 - supposed);
    let likeliest = ((b * b - 8.0 * n * c).max(0.0).sqrt() - b) / (4.0 * n);
    let variance = n * (2.0 * likeliest + supposed * (1.0 - supposed));
    let excess = first - second - n * supposed;
    if variance > 0.0 {
        excess / variance.sqrt()
    } else {
        excess.signum() * f64::INFINITY
    }
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
        assert_eq!(paired(0, 0, 0), (-1.0, 1.0));
    }

    /// The value of Fagerland, Lydersen and Laake, "Recommended tests and confidence intervals for paired
    /// binomial proportions", Statistics in Medicine 33 (2014), for the data of Bentur et al. (2009); and the
    /// interval of pairs that never differ, which the score equation gives in closed form.
    #[test]
    fn published_values_of_pairs() {
        let (low, high) = paired(1, 7, 21);
        assert!(
            (low + 0.517).abs() < 5e-4 && (high + 0.026).abs() < 5e-4,
            "{low} {high}"
        );
        let (low, high) = paired(0, 0, 60);
        let z2 = QUANTILE * QUANTILE;
        let expected = z2 / (60.0 + z2);
        assert!(
            (low + expected).abs() < 1e-9 && (high - expected).abs() < 1e-9,
            "{low} {high}"
        );
        let (low, high) = paired(60, 0, 60);
        assert!(
            (low - 0.8797).abs() < 5e-5 && (high - 1.0).abs() < 1e-9,
            "{low} {high}"
        );
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

        /// The ends lie 1.96 standard errors away from the observed difference, with the share of pairs of
        /// the second kind at which the likelihood is greatest, found by trying. Exchange of the flights
        /// exchanges the ends.
        #[test]
        fn the_ends_of_a_paired_interval_solve_the_score_equation(
            pairs in 5_u32..300, one in 0.0_f64..0.5, other in 0.0_f64..0.5,
        ) {
            let first = (f64::from(pairs) * one) as u32;
            let second = (f64::from(pairs) * other) as u32;
            let n = f64::from(pairs);
            let difference = (f64::from(first) - f64::from(second)) / n;
            let (low, high) = paired(first, second, pairs);
            prop_assert!(-1.0 <= low && low <= difference && difference <= high && high <= 1.0);
            let (swapped_low, swapped_high) = paired(second, first, pairs);
            prop_assert!((low + swapped_high).abs() < 1e-9 && (high + swapped_low).abs() < 1e-9);
            for end in [low, high] {
                let log = |count: f64, share: f64| if count > 0.0 { count * libm::log(share) } else { 0.0 };
                let likelihood = |share: f64| {
                    log(f64::from(second), share)
                        + log(f64::from(first), share + end)
                        + log(n - f64::from(first + second), 1.0 - 2.0 * share - end)
                };
                let (mut least, mut most) = ((-end).max(0.0), 0.5 * (1.0 - end));
                for _ in 0..200 {
                    let (a, b) = (least + (most - least) / 3.0, most - (most - least) / 3.0);
                    if likelihood(a) < likelihood(b) { least = a } else { most = b }
                }
                let error = ((2.0 * least + end - end * end) / n).sqrt();
                let distance = (difference - end).abs();
                prop_assert!((distance - QUANTILE * error).abs() < 1e-5, "{distance} {error}");
            }
        }
    }
}
