//! Success rates over the number of obstacles, with their 95 % bands (paper, Figure 8).

use super::error::FigureError;
use super::mark::{Mark, Outline};
use super::page::{COLUMN, Sample, document, legend, legend_height};
use super::panel::{Axis, Panel};
use crate::campaign::{AgainstCeiling, Campaign, Cell, CellReport, Report};
use mpp_sim::scenario::Preset;
use plotters::prelude::*;

/// The colours of the curves, from few paths to many or from the first preset to the last. These colours mean
/// nothing else in any figure.
const SHADES: [RGBColor; 4] = [
    RGBColor(150, 150, 150),
    RGBColor(188, 157, 225),
    RGBColor(134, 85, 190),
    RGBColor(74, 20, 134),
];
/// The oracle's curve.
const ORACLE: RGBColor = RGBColor(0, 150, 150);
/// The curve of the fields that can be passed at all.
const CEILING: RGBColor = RGBColor(200, 90, 0);
/// The paper's results.
const PUBLISHED: RGBColor = RGBColor(30, 30, 30);
/// Height of a panel \[px\].
const HEIGHT: u32 = 1150;

/// The paper's success rates [%] by number of paths, over 0, 5, 10, 15 and 20 obstacles.
const PAPER: [(u16, [f64; 5]); 4] = [
    (0, [100.0, 67.0, 28.0, 25.0, 18.0]),
    (1, [100.0, 91.0, 67.0, 51.0, 35.0]),
    (5, [100.0, 94.0, 85.0, 71.0, 65.0]),
    (25, [100.0, 99.0, 98.0, 97.0, 90.0]),
];

/// The rule that decides on success.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// The paper's rule.
    Paper,
    /// The strict rule.
    Strict,
}

/// Draws a panel for each preset and replanning rate of a campaign, with a curve for each number of
/// paths. If the campaign has one number of paths, its presets share a panel. Rings beside a curve's marks are the
/// paper's results. The curves of the oracle and of the ceiling are in each panel; the ceiling's band reaches
/// from the fields that are proven to be passable to those that are not proven to be blocked.
///
/// # Errors
/// [`FigureError`].
pub fn success_svg(report: &Report, rule: Rule) -> Result<String, FigureError> {
    let names = names(&report.campaign);
    let mut entries: Vec<(Sample, &str)> = names
        .iter()
        .enumerate()
        .map(|(index, name)| {
            (
                Sample::Curve(shade(index, names.len()), Outline::of_curve(index)),
                name.as_str(),
            )
        })
        .collect();
    if report.campaign.oracle {
        entries.push((
            Sample::Curve(ORACLE, Outline::of_curve(names.len())),
            "oracle",
        ));
    }
    if report
        .cells
        .iter()
        .any(|cell| cell.against_ceiling.is_some())
    {
        entries.push((Sample::Line(CEILING, 16), "passable"));
    }
    let compared = rule == Rule::Paper && report.campaign.preset.contains(&Preset::Reference);
    if compared {
        entries.push((Sample::Ring(PUBLISHED), "published"));
    }
    let top = legend_height(entries.len());
    let panels: Vec<Panel> = panels(report, rule);
    document((COLUMN, top + HEIGHT * panels.len() as u32), |canvas| {
        let (head, mut rest) = canvas.split_vertically(top);
        legend(&head, &entries)?;
        for panel in &panels {
            let (area, below) = rest.split_vertically(HEIGHT);
            rest = below;
            panel.draw(&area)?;
        }
        Ok(())
    })
}

/// Whether presets share a panel: there is one number of paths.
fn shared(campaign: &Campaign) -> bool {
    campaign.paths.len() == 1 && campaign.preset.len() > 1
}

/// What the curves of a panel are called.
fn names(campaign: &Campaign) -> Vec<String> {
    if shared(campaign) {
        let presets = campaign.preset.iter();
        return presets.map(|preset| preset.name().to_owned()).collect();
    }
    let name = |paths: &u16| match paths {
        0 => "RRT* alone".to_owned(),
        1 => "1 path".to_owned(),
        more => format!("{more} paths"),
    };
    campaign.paths.iter().map(name).collect()
}

/// The colour of a curve. The colours go evenly from light to dark.
fn shade(index: usize, count: usize) -> RGBColor {
    let last = SHADES.len() - 1;
    let place = if count > 1 {
        index * last / (count - 1)
    } else {
        last
    };
    SHADES[place.min(last)]
}

fn panels(report: &Report, rule: Rule) -> Vec<Panel> {
    let campaign = &report.campaign;
    let groups: Vec<&[Preset]> = if shared(campaign) {
        vec![&campaign.preset]
    } else {
        campaign.preset.chunks(1).collect()
    };
    let rates = |group| campaign.replan_hz.iter().map(move |rate| (group, *rate));
    let panels = groups.into_iter().flat_map(rates);
    panels
        .map(|(presets, replan_hz)| panel(report, rule, presets, replan_hz))
        .collect()
}

/// The curves of some presets at a replanning rate, with those of the oracle and of the ceiling.
fn panel(report: &Report, rule: Rule, presets: &[Preset], replan_hz: f64) -> Panel {
    let campaign = &report.campaign;
    let most = campaign.obstacles.iter().copied().max().unwrap_or(0) as f64;
    let x = Axis::tight("Obstacles", -0.02 * most..1.03 * most.max(1.0), 8);
    let y_label = match rule {
        Rule::Paper => "Success (%)",
        Rule::Strict => "Strict success (%)",
    };
    let mut panel = Panel::new(x, Axis::tight(y_label, -3.0..108.0, 6));
    let at_rate = |cell: &Cell| cell.replan_hz.to_bits() == replan_hz.to_bits();
    let curves: Vec<(Preset, u16)> = presets
        .iter()
        .flat_map(|preset| campaign.paths.iter().map(|paths| (*preset, *paths)))
        .collect();
    for (index, &(preset, paths)) in curves.iter().enumerate() {
        let cells = cells(report, |cell| {
            (cell.preset, cell.paths, cell.oracle) == (preset, paths, false) && at_rate(cell)
        });
        // Marks of one number of obstacles stand beside each other.
        let beside = (index as f64 - 0.5 * (curves.len() as f64 - 1.0)) * 0.012 * most;
        let look = Look {
            colour: shade(index, curves.len()),
            outline: Outline::of_curve(index),
            beside,
        };
        curve(&mut panel, &cells, rule, &look);
        if rule == Rule::Paper && preset == Preset::Reference {
            let rings = published(paths).into_iter().map(|(x, rate)| Mark {
                at: (x + beside, rate),
                outline: Outline::Ring,
                colour: PUBLISHED,
            });
            panel.marks.extend(rings);
        }
    }
    let look = Look {
        colour: ORACLE,
        outline: Outline::of_curve(curves.len()),
        beside: 0.0,
    };
    curve(&mut panel, &cells(report, |cell| cell.oracle), rule, &look);
    ceiling(&mut panel, &cells(report, |_| true));
    let of_panel = cells(report, |cell| {
        !cell.oracle && presets.contains(&cell.preset) && at_rate(cell)
    });
    let names: Vec<&str> = presets.iter().map(|preset| preset.name()).collect();
    let words = format!("{}, {replan_hz} Hz{}", names.join(", "), flights(&of_panel));
    panel.labels.push(((0.02 * most, 8.0), words, BLACK));
    panel
}

/// The flown cells of a curve, by obstacles.
fn cells(report: &Report, of: impl Fn(&Cell) -> bool) -> Vec<&CellReport> {
    let mut cells: Vec<&CellReport> = report.cells.iter().collect();
    cells.retain(|cell| of(&cell.cell) && cell.trials > 0);
    cells.sort_by_key(|cell| cell.cell.obstacles);
    cells
}

/// How many flights stand behind each point of a panel, such as `, n = 300`.
fn flights(cells: &[&CellReport]) -> String {
    let trials = || cells.iter().map(|cell| cell.trials);
    match (trials().min(), trials().max()) {
        (Some(least), Some(most)) if least == most => format!(", n = {most}"),
        (Some(least), Some(most)) => format!(", n = {least} to {most}"),
        _ => String::new(),
    }
}

/// How a curve looks: its colour, the shape of its marks, and how far they stand beside their place [obstacles].
struct Look {
    colour: RGBColor,
    outline: Outline,
    beside: f64,
}

/// Adds a curve upon its band, with a mark for each cell.
fn curve(panel: &mut Panel, cells: &[&CellReport], rule: Rule, look: &Look) {
    let colour = look.colour;
    if cells.is_empty() {
        return;
    }
    let value = |cell: &CellReport| match rule {
        Rule::Paper => (cell.wilson_low, cell.success_rate, cell.wilson_high),
        Rule::Strict => (
            cell.strict_wilson_low,
            cell.strict_success_rate,
            cell.strict_wilson_high,
        ),
    };
    let at = |cell: &CellReport, share: f64| (cell.cell.obstacles as f64, 100.0 * share);
    let low = cells.iter().map(|cell| at(cell, value(cell).0));
    let high = cells.iter().rev().map(|cell| at(cell, value(cell).2));
    panel
        .areas
        .push((low.chain(high).collect(), colour.mix(0.25)));
    let middle = cells
        .iter()
        .map(|cell| at(cell, value(cell).1.unwrap_or(0.0)));
    let middle: Vec<_> = middle.collect();
    panel.line(colour, 16, &middle);
    panel.marks.extend(middle.iter().map(|(x, rate)| Mark {
        at: (x + look.beside, *rate),
        outline: look.outline,
        colour,
    }));
}

/// Adds the curve of the passable fields upon its band.
fn ceiling(panel: &mut Panel, cells: &[&CellReport]) {
    let mut beside: Vec<(f64, AgainstCeiling)> = cells
        .iter()
        .filter_map(|cell| Some((cell.cell.obstacles as f64, cell.against_ceiling?)))
        .collect();
    beside.dedup_by(|a, b| a.0.total_cmp(&b.0).is_eq());
    if beside.is_empty() {
        return;
    }
    let share = |part: u32, of: &AgainstCeiling| {
        100.0 * f64::from(part) / f64::from((of.passable + of.blocked + of.undecided).max(1))
    };
    let low: Vec<(f64, f64)> = beside
        .iter()
        .map(|(x, of)| (*x, share(of.passable, of)))
        .collect();
    let high = beside
        .iter()
        .rev()
        .map(|(x, of)| (*x, share(of.passable + of.undecided, of)));
    let band = low.iter().copied().chain(high).collect();
    panel.areas.push((band, CEILING.mix(0.25)));
    panel.line(CEILING, 16, &low);
}

fn published(paths: u16) -> Vec<(f64, f64)> {
    let rates = PAPER.iter().find(|(known, _)| *known == paths);
    let points = rates
        .iter()
        .flat_map(|(_, rates)| [0.0, 5.0, 10.0, 15.0, 20.0].into_iter().zip(*rates));
    points.collect()
}
