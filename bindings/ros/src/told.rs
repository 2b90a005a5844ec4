//! What is wrong with what comes in: counted for the diagnostics, and said once.

use std::collections::BTreeMap;

/// Complaints by their kind.
#[derive(Debug, Default)]
pub(crate) struct Told {
    counts: BTreeMap<String, (u64, String)>,
    fresh: Vec<String>,
    lately: Option<String>,
}

impl Told {
    /// Takes a complaint.
    pub(crate) fn tell(&mut self, kind: &str, text: String) {
        let (count, last) = self.counts.entry(kind.to_owned()).or_default();
        *count += 1;
        if *count == 1 {
            self.fresh.push(format!("{kind}: {text}"));
        }
        self.lately = Some(format!("{kind}: {text}"));
        *last = text;
    }

    /// What was not said yet.
    pub(crate) fn fresh(&mut self) -> Vec<String> {
        std::mem::take(&mut self.fresh)
    }

    /// The newest complaint since the last question.
    pub(crate) fn lately(&mut self) -> Option<String> {
        self.lately.take()
    }

    /// Kinds with their counts and newest texts.
    pub(crate) fn counts(&self) -> impl Iterator<Item = (&str, u64, &str)> {
        self.counts
            .iter()
            .map(|(kind, (count, text))| (kind.as_str(), *count, text.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_complaint_is_said_once_and_counted_always() {
        let mut told = Told::default();
        told.tell("scan", "bad".to_owned());
        told.tell("scan", "worse".to_owned());
        assert_eq!(told.fresh(), ["scan: bad"]);
        told.tell("scan", "worst".to_owned());
        assert!(told.fresh().is_empty());
        assert_eq!(told.lately().as_deref(), Some("scan: worst"));
        assert_eq!(told.lately(), None);
        assert!(told.counts().eq([("scan", 3, "worst")]));
    }
}
