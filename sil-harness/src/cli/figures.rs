//! `figures`: draws counterparts of the paper's figures.

use super::answer::{Failure, talk};
use super::campaign::{rows_of, set_beside_ceiling};
use super::pdf::pdf;
use super::values::seed;
use crate::files::{try_directory, write_whole};
use mpp_analysis::campaign::Report;
use mpp_analysis::figure::{
    FigureError, OneReplan, Rule, candidates_svg, challenge_svg, flight_svg, rays_svg, scan_svg,
    success_svg, trajectory_svg,
};
use mpp_sim::flight::fly;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario, TICKS_PER_SECOND};
use mpp_sim::scene::Scene;
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::FIGURES)]
pub(super) struct FiguresArgs {
    /// Directory for the pictures (SVG)
    #[arg(long, default_value = "out/figures")]
    out: PathBuf,
    /// Also write each picture as PDF, which needs a build with the cargo feature `formats`
    #[arg(long)]
    pdf: bool,
    /// Seed of all flights in the pictures
    #[arg(long, default_value_t = 1, value_parser = seed)]
    seed: u64,
    /// Row files of one campaign; its success rates are then drawn too
    #[arg(long, value_name = "FILE", num_args = 1..)]
    rows: Vec<PathBuf>,
    /// Also draw which of the rows' fields can be passed at all, as `ceiling` tells
    #[arg(long, requires = "rows")]
    ceiling: bool,
}

/// Number of obstacles in the flight whose planning is drawn.
const CYCLE_OBSTACLES: usize = 30;

pub(super) fn run(args: &FiguresArgs) -> Result<u8, Failure> {
    if args.pdf {
        // Who cannot have it is told before anything is flown.
        pdf("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1\" height=\"1\"/>")?;
    }
    try_directory(&args.out)?;
    let rows = (!args.rows.is_empty()).then(|| rows_of(&args.rows));
    let rows = rows.transpose().map_err(Failure::usage)?;
    let drawing = |error: FigureError| Failure::failed(error);
    let mut pictures = vec![
        ("challenge", challenge(args.seed)?),
        (
            "flight",
            flight_svg(&flown(&Scenario::new(Preset::Flight, args.seed))?).map_err(drawing)?,
        ),
    ];
    let cycle = telling_cycle(args.seed)?;
    pictures.push(("scan", scan_svg(&cycle).map_err(drawing)?));
    pictures.push(("rays", rays_svg(&cycle).map_err(drawing)?));
    pictures.push(("trajectory", trajectory_svg(&cycle).map_err(drawing)?));
    pictures.push(("candidates", candidates_svg(&cycle).map_err(drawing)?));
    if let Some((campaign, rows)) = rows {
        let mut report = Report::new(&campaign, &rows);
        if args.ceiling {
            set_beside_ceiling(&campaign, &rows, &mut report, 0)?;
        }
        pictures.push((
            "success",
            success_svg(&report, Rule::Paper).map_err(drawing)?,
        ));
        pictures.push((
            "success-strict",
            success_svg(&report, Rule::Strict).map_err(drawing)?,
        ));
    }
    for (name, svg) in pictures {
        let path = args.out.join(name).with_extension("svg");
        let write = |path: &Path, bytes: &[u8]| {
            write_whole(path, bytes)?;
            talk(path.display());
            Ok::<(), Failure>(())
        };
        write(&path, svg.as_bytes())?;
        if args.pdf {
            write(&path.with_extension("pdf"), &pdf(&svg)?)?;
        }
    }
    Ok(0)
}

/// Finds the cycle of a flight with the most candidates of both kinds: the smaller of the two
/// numbers, feasible and not feasible, is greatest.
fn telling_cycle(seed: u64) -> Result<OneReplan, Failure> {
    let scenario = Scenario {
        obstacles: CYCLE_OBSTACLES,
        ..Scenario::new(Preset::Paper, seed)
    };
    // A flight that ends early has fewer cycles.
    let cycles = (0..16).filter_map(|second| {
        let cycle = OneReplan::of_flight(&scenario, second * TICKS_PER_SECOND).ok()?;
        let refined = cycle
            .candidates
            .iter()
            .filter(|candidate| candidate.refined.is_some());
        let feasible = refined.count();
        Some((feasible.min(cycle.candidates.len() - feasible), cycle))
    });
    let telling = cycles.max_by_key(|(both, _)| *both);
    let none = || Failure::failed("no cycle of this seed's flight could be planned");
    telling.map(|(_, cycle)| cycle).ok_or_else(none)
}

/// Draws every challenge scene with two flights through it: with one path, and with as many as usual.
fn challenge(seed: u64) -> Result<String, Failure> {
    let mut scenes = Vec::new();
    for scene in Scene::ALL {
        let many = Scenario {
            obstacles: 0,
            scene: Some(scene),
            ..Scenario::new(Preset::Flight, seed)
        };
        let alone = Scenario {
            paths: 1,
            ..many.clone()
        };
        scenes.push((scene, vec![flown(&alone)?, flown(&many)?]));
    }
    challenge_svg(&scenes).map_err(Failure::failed)
}

fn flown(scenario: &Scenario) -> Result<FlightLog, Failure> {
    fly(scenario, &mut PipeLink::new(), |_| {}).map_err(Failure::failed)
}
