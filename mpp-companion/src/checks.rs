//! What the companion verifies on the autopilot before it is ready.

use crate::autopilot::{Check, Kind};
use mavlink::dialects::common::PARAM_VALUE_DATA;
use std::collections::BTreeMap;

/// The parameters that the autopilot has told.
#[derive(Debug)]
pub(crate) struct Checked {
    kind: Kind,
    told: BTreeMap<&'static str, f32>,
}

impl Checked {
    /// Nothing is told yet by an autopilot of this kind.
    pub(crate) fn new(kind: Kind) -> Self {
        let told = BTreeMap::new();
        Self { kind, told }
    }

    fn checks(&self) -> &'static [Check] {
        self.kind.manners().checks
    }

    /// Takes a value.
    pub(crate) fn hear(&mut self, told: &PARAM_VALUE_DATA) {
        let name = told.param_id.to_str().unwrap_or_default();
        if let Some(check) = self.checks().iter().find(|check| check.name == name) {
            self.told.insert(check.name, self.kind.value(told));
        }
    }

    /// The names that are not told yet.
    pub(crate) fn unknown(&self) -> impl Iterator<Item = &'static str> {
        let names = self.checks().iter().map(|check| check.name);
        names.filter(|name| !self.told.contains_key(name))
    }

    /// What keeps the companion on the ground; `None` if all is well.
    pub(crate) fn flaw(&self) -> Option<String> {
        self.checks()
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
        let [least, most] = self.kind.manners().pitch;
        Some((angle(least)?, angle(most)?))
    }

    /// A line on what was verified.
    pub(crate) fn summary(&self) -> String {
        let pairs = self
            .told
            .iter()
            .map(|(name, value)| format!("{name} {value}"));
        let manners = self.kind.manners();
        let begin = format!("{}, mode {}", manners.name, manners.mode);
        [begin]
            .into_iter()
            .chain(pairs)
            .collect::<Vec<_>>()
            .join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name: &str, param_value: f32) -> PARAM_VALUE_DATA {
        PARAM_VALUE_DATA {
            param_value,
            param_id: name.into(),
            ..PARAM_VALUE_DATA::DEFAULT
        }
    }

    #[test]
    fn a_parameter_that_is_missing_or_out_of_range_keeps_the_companion_on_the_ground() {
        for (kind, name) in [
            (Kind::ArduPlane, "GUIDED_TIMEOUT"),
            (Kind::Px4, "COM_OF_LOSS_T"),
        ] {
            let mut checked = Checked::new(kind);
            assert_eq!(checked.unknown().count(), kind.manners().checks.len());
            for check in kind.manners().checks {
                assert!(checked.flaw().is_some());
                checked.hear(&told(check.name, check.most));
            }
            assert_eq!(checked.flaw(), None);
            assert!(checked.pitch().is_some_and(|(least, most)| least < most));
            checked.hear(&told(name, 3.0));
            let flaw = checked.flaw().unwrap();
            assert_eq!(flaw, format!("{name} is 3: set 0.3 to 0.5"));
            checked.hear(&told(name, f32::NAN));
            assert!(checked.flaw().is_some());
        }
    }
}
