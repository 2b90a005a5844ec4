//! A report's failures as a table for people.

use super::report::{CellReport, Report};
use std::fmt;

/// A report's failures by cause, as a table for people.
pub struct Taxonomy<'a>(pub &'a Report);

impl fmt::Display for Taxonomy<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for cell in &self.0.cells {
            write_cell(f, cell)?;
        }
        Ok(())
    }
}

fn write_cell(f: &mut fmt::Formatter<'_>, cell: &CellReport) -> fmt::Result {
    let failed = cell.trials - cell.strict_successes;
    writeln!(
        f,
        "{}: {failed} of {} flights failed",
        cell.cell, cell.trials
    )?;
    for report in &cell.causes {
        let name = report.cause.name();
        write!(f, "  {name:<12} {:>5}", report.flights)?;
        if let Some(flies) = report.oracle_flies {
            write!(f, ", the oracle flies {flies:>5}")?;
        }
        writeln!(f, ", such as --seed {}", report.seed)?;
    }
    let (known, avoidable, unavoidable) = (
        cell.known_collisions,
        cell.avoidable_collisions,
        cell.unavoidable_collisions,
    );
    if known > 0 {
        writeln!(
            f,
            "  known collisions {known}; from two seconds before {unavoidable} are proven unavoidable, \
             {avoidable} avoidable, {} undecided",
            known.saturating_sub(avoidable + unavoidable)
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Campaign, Lists};
    use super::*;
    use mpp_sim::scenario::ScenarioFile;

    #[test]
    fn known_collisions_are_avoidable_or_not_or_undecided() {
        let campaign = Campaign::new(ScenarioFile::default(), Lists::default(), 1, Some(1));
        let mut report = Report::new(&campaign.unwrap(), &[]);
        assert!(!Taxonomy(&report).to_string().contains("known"));
        let cell = &mut report.cells[0];
        (cell.known_collisions, cell.avoidable_collisions) = (7, 4);
        cell.unavoidable_collisions = 1;
        let text = Taxonomy(&report).to_string();
        let line = "known collisions 7; from two seconds before 1 are proven unavoidable, 4 avoidable, 2 undecided";
        assert!(text.contains(line), "{text}");
    }
}
