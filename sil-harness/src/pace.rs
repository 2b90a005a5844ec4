//! The speed of a flight relative to real time.

use std::fmt;

/// Slowest and fastest speed relative to real time. At a slower speed a tick would take more than a
/// second.
const RANGE: std::ops::RangeInclusive<f64> = 0.01..=1000.0;

/// The answer to a speed that is not valid.
pub const ADVICE: &str = "give a speed from 0.01 to 1000, or max";

/// A speed relative to real time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// As fast as it goes.
    Max,
    /// So many times that of the clock.
    Times(f64),
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Max => f.write_str("max"),
            Self::Times(times) => write!(f, "{times}"),
        }
    }
}

/// Reads a speed.
///
/// # Errors
/// [`ADVICE`].
pub fn speed(text: &str) -> Result<Speed, String> {
    match text.parse::<f64>() {
        _ if text == "max" => Ok(Speed::Max),
        Ok(times) if RANGE.contains(&times) => Ok(Speed::Times(times)),
        _ => Err(ADVICE.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_read_or_refused_with_their_range() {
        assert_eq!(speed("max"), Ok(Speed::Max));
        for times in [0.01, 0.25, 1.0, 1000.0] {
            assert_eq!(speed(&times.to_string()), Ok(Speed::Times(times)));
            assert_eq!(Speed::Times(times).to_string(), times.to_string());
        }
        for nonsense in [
            "", "0", "-1", "1e-300", "1e-4", "0.0099", "1000.1", "1e300", "inf", "NaN", "fast",
        ] {
            assert_eq!(speed(nonsense), Err(ADVICE.to_owned()), "{nonsense}");
        }
    }
}
