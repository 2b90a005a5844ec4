//! What the companion verifies on the autopilot before it is ready.

use std::collections::BTreeMap;

/// A parameter of ArduPlane, the values that a companion can fly with, and what to do otherwise.
pub(crate) struct Check {
    pub(crate) name: &'static str,
    least: f32,
    most: f32,
    advice: &'static str,
}

const fn check(name: &'static str, least: f32, most: f32, advice: &'static str) -> Check {
    Check {
        name,
        least,
        most,
        advice,
    }
}

/// All checks.
pub(crate) const CHECKS: [Check; 6] = [
    check("GUIDED_TIMEOUT", 0.1, 0.5, "set 0.3 to 0.5"),
    check("SCHED_LOOP_RATE", 63.0, 1000.0, "set 100 or more"),
    check("TRIM_THROTTLE", 2.0, 100.0, "set more than 1"),
    check("PTCH_LIM_MAX_DEG", 5.0, 80.0, "set 5 to 80"),
    check("PTCH_LIM_MIN_DEG", -80.0, -5.0, "set -80 to -5"),
    check("THR_MAX", 100.0, 100.0, "set 100"),
];

/// The parameters that the autopilot has told.
#[derive(Debug, Default)]
pub(crate) struct Checked {
    told: BTreeMap<&'static str, f32>,
}

impl Checked {
    /// Takes a value.
    pub(crate) fn hear(&mut self, name: &str, value: f32) {
        if let Some(check) = CHECKS.iter().find(|check| check.name == name) {
            self.told.insert(check.name, value);
        }
    }

    /// The names that are not told yet.
    pub(crate) fn unknown(&self) -> impl Iterator<Item = &'static str> {
        let names = CHECKS.iter().map(|check| check.name);
        names.filter(|name| !self.told.contains_key(name))
    }

    /// What keeps the companion on the ground; `None` if all is well.
    pub(crate) fn flaw(&self) -> Option<String> {
        CHECKS
            .iter()
            .find_map(|check| match self.told.get(check.name) {
                None => Some(format!("{} is not told", check.name)),
                Some(value) if (check.least..=check.most).contains(value) => None,
                Some(value) => Some(format!("{} is {value}: {}", check.name, check.advice)),
            })
    }

    /// Least and greatest pitch that the autopilot allows \[rad\].
    pub(crate) fn pitch(&self) -> Option<(f64, f64)> {
        let angle = |name| Some(f64::from(*self.told.get(name)?).to_radians());
        Some((angle("PTCH_LIM_MIN_DEG")?, angle("PTCH_LIM_MAX_DEG")?))
    }

    /// A line on what was verified.
    pub(crate) fn summary(&self) -> String {
        let pairs = self
            .told
            .iter()
            .map(|(name, value)| format!("{name} {value}"));
        pairs.collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_that_is_missing_or_out_of_range_keeps_the_companion_on_the_ground() {
        let mut checked = Checked::default();
        assert_eq!(checked.unknown().count(), CHECKS.len());
        for check in &CHECKS {
            assert!(checked.flaw().is_some());
            checked.hear(check.name, check.most);
        }
        assert_eq!(checked.flaw(), None);
        checked.hear("GUIDED_TIMEOUT", 3.0);
        let flaw = checked.flaw().unwrap();
        assert_eq!(flaw, "GUIDED_TIMEOUT is 3: set 0.3 to 0.5");
        checked.hear("GUIDED_TIMEOUT", f32::NAN);
        assert!(checked.flaw().is_some());
    }
}
