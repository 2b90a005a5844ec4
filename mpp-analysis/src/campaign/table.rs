//! The report as a table for people.

use super::grid::Cell;
use super::pairs::{AgainstCeiling, AgainstOracle};
use super::report::{CellReport, Report};
use mpp_sim::outcome::Class;
use std::fmt;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scene = self.campaign.scenario.scene;
        let kinds = self.cells.iter().map(|cell| cell.cell.kind(scene));
        let kinds: Vec<String> = kinds.collect();
        let wide = kinds.iter().map(String::len).max().unwrap_or(0).max(5);
        writeln!(
            f,
            "{:<9} {:<wide$} {:>4} {:>5} {:>9} {:>7}  {:<22} {:<22} {:>9} {:>9} {:>5} {:>11} {:>7}  {:>16}",
            "preset",
            "field",
            "Hz",
            "paths",
            "obstacles",
            "flights",
            "success [95 %]",
            "strict [95 %]",
            "left-band",
            "collision",
            "pitch",
            "flight-path",
            "no-plan",
            "clearance (5 %)",
        )?;
        for (cell, kind) in self.cells.iter().zip(&kinds) {
            let &Cell {
                preset,
                obstacles,
                paths,
                replan_hz,
                oracle,
                ..
            } = &cell.cell;
            let outcomes = |class| cell.outcomes.of(class);
            writeln!(
                f,
                "{:<9} {kind:<wide$} {replan_hz:>4} {paths:>5} {obstacles:>9} {:>7}  {:<22} {:<22} {:>9} {:>9} {:>5} {:>11} {:>7}  {:>16}",
                if oracle { "oracle" } else { preset.name() },
                cell.trials,
                percent(cell.success_rate, cell.wilson_low, cell.wilson_high),
                percent(
                    cell.strict_success_rate,
                    cell.strict_wilson_low,
                    cell.strict_wilson_high
                ),
                outcomes(Class::LeftBand),
                outcomes(Class::Collision),
                outcomes(Class::Pitch),
                outcomes(Class::FlightPath),
                outcomes(Class::NoPlan),
                cell.clearance_median
                    .zip(cell.clearance_p5)
                    .map_or("-".to_owned(), |(median, p5)| format!(
                        "{median:.2} ({p5:.2}) m"
                    )),
            )?;
        }
        for cell in &self.cells {
            if let Some(pairs) = &cell.against_oracle {
                write_pairs(f, cell, pairs)?;
            }
            if let Some(pairs) = &cell.against_ceiling {
                write_ceiling(f, cell, pairs)?;
            }
        }
        if self.flown < self.flights {
            writeln!(f, "{} of {} flights are here", self.flown, self.flights)?;
        }
        Ok(())
    }
}

fn write_pairs(
    f: &mut fmt::Formatter<'_>,
    cell: &CellReport,
    pairs: &AgainstOracle,
) -> fmt::Result {
    writeln!(
        f,
        "{}: {} of the {} fields that the oracle flies, {}; only ours {}, neither {}",
        cell.cell,
        pairs.both,
        pairs.both + pairs.only_oracle,
        percent(pairs.share, pairs.wilson_low, pairs.wilson_high),
        pairs.only_ours,
        pairs.neither
    )
}

fn write_ceiling(
    f: &mut fmt::Formatter<'_>,
    cell: &CellReport,
    pairs: &AgainstCeiling,
) -> fmt::Result {
    writeln!(
        f,
        "{}: {} of the {} passable fields, {}; blocked {}, undecided {}",
        cell.cell,
        pairs.flown,
        pairs.passable,
        percent(pairs.share, pairs.wilson_low, pairs.wilson_high),
        pairs.blocked,
        pairs.undecided
    )
}

fn percent(share: Option<f64>, low: f64, high: f64) -> String {
    match share {
        Some(share) => format!(
            "{:.1} % [{:.1}, {:.1}]",
            100.0 * share,
            100.0 * low,
            100.0 * high
        ),
        None => "-".to_owned(),
    }
}
