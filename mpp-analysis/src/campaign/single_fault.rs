//! One fault as a half of a pair: what it changes, what fails with it, and its file with another start.

use super::faults::NamedFault;
use mpp_sim::scenario::ScenarioError;
use toml::{Table, Value};

/// Tables of a fault that have a start, with the names of what is the culprit when the core tells a failure. Those of a
/// sensor's values, of scans and of actuators can come and go.
const TIMED: [(&str, &[&str], bool); 9] = [
    ("airspeed", &["airspeed"], true),
    ("pitch", &["pitch"], true),
    ("x", &["position"], true),
    ("z", &["position"], true),
    ("air", &["airspeed", "pitch"], false),
    ("position", &["position"], false),
    ("scan", &["lidar"], true),
    ("elevator", &["elevator"], true),
    ("thrust", &["motor"], true),
];
/// Names of faults that are no single ones, or that are none.
const NO_SINGLE: [&str; 4] = [
    "rtk",
    "both-frozen",
    "airspeed-pitch-bias",
    "airspeed-pitch-bias-high",
];

/// One fault that can be a half of a pair.
#[derive(Clone, Debug)]
pub(super) struct Single {
    pub(super) name: &'static str,
    /// Its file.
    file: Table,
}

impl Single {
    /// Reads a fault's file. Returns `None` for one that is no half of a pair: a fault in a field of its own is no fault in
    /// this one.
    pub(super) fn of(fault: &NamedFault) -> Result<Option<Self>, ScenarioError> {
        let wrong = |error| ScenarioError::Toml(fault.name.to_owned(), Box::new(error));
        let file: Table = toml::from_str(fault.text).map_err(wrong)?;
        let name = fault.name;
        let half = !file.contains_key("obstacles") && !NO_SINGLE.contains(&name);
        Ok(half.then_some(Self { name, file }))
    }

    /// Its tables of faults, with what is known of each.
    fn faults(&self) -> impl Iterator<Item = (&String, &Value)> {
        self.file
            .get("faults")
            .and_then(Value::as_table)
            .into_iter()
            .flatten()
    }

    /// What it changes: the tables of faults, and the other keys of its file.
    fn changes(&self) -> impl Iterator<Item = &String> {
        let others = self.file.keys().filter(|key| *key != "faults");
        others.chain(self.faults().map(|(name, _)| name))
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.changes()
            .any(|name| other.changes().any(|its| its == name))
    }

    /// Whether it has a start.
    pub(super) fn is_timed(&self) -> bool {
        self.faults()
            .any(|(name, table)| known(name).is_some() || table.get("from").is_some())
    }

    /// Whether it can come and go, and does not yet.
    pub(super) fn toggles(&self) -> bool {
        self.faults().any(|(name, table)| {
            known(name).is_some_and(|it| it.2) && table.get("toggle_hz").is_none()
        })
    }

    /// Whether neither link nor clock fails.
    pub(super) fn is_of_a_part(&self) -> bool {
        !self
            .faults()
            .any(|(name, _)| name == "link" || name == "clock")
    }

    /// Names of what fails with it, as the core tells them.
    pub(super) fn culprits(&self) -> impl Iterator<Item = &'static str> {
        let tables = self.faults().filter_map(|(name, _)| known(name));
        tables.flat_map(|table| table.1.iter().copied())
    }

    /// Its file with another start \[s\]. It lasts as long as it does in its own, and comes and goes at a rate \[Hz\].
    pub(super) fn begun(&self, start: f64, toggle_hz: Option<f64>) -> Table {
        let mut file = self.file.clone();
        let faults = file.get_mut("faults").and_then(Value::as_table_mut);
        for (name, table) in faults.into_iter().flatten() {
            let Some(table) = table.as_table_mut() else {
                continue;
            };
            let time = |table: &Table, key: &str| table.get(key).and_then(Value::as_float);
            let from = time(table, "from");
            let until = time(table, "until").map(|until| start + until - from.unwrap_or(0.0));
            if known(name).is_some() || from.is_some() {
                table.insert("from".to_owned(), in_ticks(start));
            }
            if let Some(until) = until {
                table.insert("until".to_owned(), in_ticks(until));
            }
            if let Some(rate) = toggle_hz.filter(|_| known(name).is_some_and(|it| it.2)) {
                table.insert("toggle_hz".to_owned(), rate.into());
            }
        }
        file
    }
}

/// What is known of a table of faults that has a start.
fn known(name: &str) -> Option<&'static (&'static str, &'static [&'static str], bool)> {
    TIMED.iter().find(|it| it.0 == name)
}

/// A time as a whole number of ticks of 0.01 s.
fn in_ticks(time: f64) -> Value {
    ((time * 100.0).round() / 100.0).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn single(text: &'static str) -> Single {
        let fault = NamedFault {
            name: "one",
            text,
            asked: None,
        };
        Single::of(&fault).unwrap().unwrap()
    }

    #[test]
    fn a_fault_begins_when_it_was_drawn_and_lasts_as_long_as_its_own() {
        let begun = |text, rate| single(text).begun(2.5, rate).to_string();
        let scan = "[faults.scan]\nfrom = 5.0\nuntil = 8.0\nmissing = true\n";
        let moved = begun(scan, None);
        assert!(
            moved.contains("from = 2.5\n") && moved.contains("until = 5.5\n"),
            "{moved}"
        );
        let bias = "[faults.pitch]\nbias = 5.0\n";
        assert!(begun(bias, None).contains("from = 2.5"));
        assert!(begun(bias, Some(4.5)).contains("toggle_hz = 4.5"));
        let clock = "[faults.clock]\nfrom = 8.0\njump = 1.0\n";
        let moved = begun(clock, Some(4.5));
        assert!(
            moved.contains("from = 2.5") && !moved.contains("toggle"),
            "{moved}"
        );
        let always = "[navigation]\nsource = \"gnss-ins\"\n";
        assert_eq!(begun(always, None), always);
    }

    #[test]
    fn its_tables_name_the_culprit() {
        let (pitch, link) = (
            single("[faults.pitch]\nbias = 5.0\n"),
            single("[faults.link]\nloss = 0.5\n"),
        );
        assert_eq!(pitch.culprits().collect::<Vec<_>>(), ["pitch"]);
        assert!(pitch.is_of_a_part() && !link.is_of_a_part());
    }
}
