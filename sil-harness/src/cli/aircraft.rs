//! `aircraft`: what follows from an aircraft file, and how well it flies.

use super::answer::{Failure, data, print_json};
use super::campaign::failure;
use super::loudness::progress_bar;
use super::signals::Signals;
use super::values::{Item, navigation, seed, threads, whole};
use crate::campaign::{CampaignError, Extras, run as fly_all};
use crate::files::read_aircraft;
use mpp_analysis::aircraft::{AircraftReport, Variant, flown_cells, in_sizes, in_units};
use mpp_analysis::campaign::{Campaign, Lists, Row, Shard, merge, wilson};
use mpp_sim::aircraft_file::AircraftModel;
use mpp_sim::scenario::{NavigationSource, ScenarioFile};
use serde::Serialize;
use std::sync::{Mutex, PoisonError};

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::AIRCRAFT)]
pub(super) struct AircraftArgs {
    /// Name of an aircraft that comes with the project, or a file (TOML, as docs/aircraft.md describes)
    #[arg(value_name = "NAME|FILE")]
    aircraft: String,
    /// Fly this number of flights in each cell, past obstacles that are scaled to the aircraft
    #[arg(long, default_value_t = 0, value_parser = whole::<u32>())]
    flights: u32,
    /// Numbers of obstacles to fly past, a list
    #[arg(long, value_delimiter = ',', default_values_t = [20, 40], value_parser = Item(whole::<usize>()))]
    obstacles: Vec<usize>,
    /// Fly the aircraft with its elevator's command in five units
    #[arg(long, conflicts_with = "sizes", requires = "flights")]
    units: bool,
    /// Fly the aircraft in four sizes that are similar by Froude's law
    #[arg(long, requires = "flights")]
    sizes: bool,
    /// Let an oracle fly the same fields too
    #[arg(long, requires = "flights")]
    oracle: bool,
    /// Source of positions [default: rtk]
    #[arg(long, value_parser = navigation())]
    navigation: Option<NavigationSource>,
    /// Seed of the first flight
    #[arg(long, default_value_t = 1, value_parser = seed)]
    seed: u64,
    /// Number of threads, at most 1024 and no more than there is work for; 0 takes every core
    #[arg(long, default_value_t = 0, value_parser = threads())]
    threads: usize,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Successes of one aircraft past one number of obstacles.
#[derive(Clone, Debug, Serialize)]
struct Success {
    aircraft: String,
    obstacles: usize,
    replan_hz: f64,
    oracle: bool,
    flights: u32,
    strict: u32,
    /// Wilson interval, 95 % \[-\].
    interval: (f64, f64),
    /// Flights that hit an obstacle.
    collisions: u32,
}

#[derive(Debug, Serialize)]
struct AircraftOutput {
    aircraft: AircraftReport,
    flights: Vec<Success>,
}

pub(super) fn run(args: &AircraftArgs) -> Result<u8, Failure> {
    let file = read_aircraft(&args.aircraft)?;
    let model = AircraftModel::new(file.clone()).map_err(Failure::usage)?;
    let variants = if args.units {
        in_units(&file)
    } else if args.sizes {
        in_sizes(&file)
    } else {
        let name = file.name.clone();
        vec![Variant { name, file }]
    };
    let mut output = AircraftOutput {
        aircraft: AircraftReport::new(&model),
        flights: Vec::new(),
    };
    if !args.json {
        data(&output.aircraft)?;
    }
    if args.flights > 0 {
        for variant in &variants {
            let flown = fly_variant(args, variant)?;
            if !args.json {
                flown.iter().map(line).try_for_each(data)?;
            }
            output.flights.extend(flown);
        }
    }
    if args.json {
        print_json(&output)?;
    }
    Ok(0)
}

fn line(success: &Success) -> String {
    let (low, high) = success.interval;
    format!(
        "{}{}: {} obstacles at {} Hz: {} of {} strict successes [{:.1}, {:.1} %], {}",
        success.aircraft,
        if success.oracle { ", oracle" } else { "" },
        success.obstacles,
        success.replan_hz,
        success.strict,
        success.flights,
        100.0 * low,
        100.0 * high,
        match success.collisions {
            1 => "1 collision".to_owned(),
            count => format!("{count} collisions"),
        }
    )
}

/// Flies one aircraft past each number of obstacles.
fn fly_variant(args: &AircraftArgs, variant: &Variant) -> Result<Vec<Success>, Failure> {
    let model = AircraftModel::new(variant.file.clone()).map_err(Failure::usage)?;
    let mut successes = Vec::new();
    for (obstacles, replan_hz) in flown_cells(&args.obstacles, model.units().time) {
        let mut scenario = ScenarioFile {
            aircraft: Some(variant.file.clone()),
            oracle: args.oracle.then_some(true),
            ..ScenarioFile::default()
        };
        scenario.navigation.source = args.navigation;
        let lists = Lists {
            obstacles: vec![obstacles],
            replan_hz: vec![replan_hz],
            ..Lists::default()
        };
        let campaign = Campaign::new(scenario, lists, args.flights, Some(args.seed))
            .map_err(Failure::usage)?;
        let rows = fly(&campaign, args.threads)?;
        for cell in campaign.cells() {
            let of_cell = rows.iter().filter(|row| row.cell == cell);
            let count = |is: fn(&Row) -> bool| of_cell.clone().filter(|row| is(row)).count() as u32;
            let strict = count(|row| row.summary.strict);
            successes.push(Success {
                aircraft: variant.name.clone(),
                obstacles,
                replan_hz: cell.replan_hz,
                oracle: cell.oracle,
                flights: args.flights,
                strict,
                interval: wilson(strict, args.flights),
                collisions: count(|row| {
                    row.summary.outcome == mpp_sim::outcome::Outcome::Collision
                }),
            });
        }
    }
    Ok(successes)
}

/// Flies a campaign without a row file.
fn fly(campaign: &Campaign, threads: usize) -> Result<Vec<Row>, Failure> {
    let signals = Signals::heed()?;
    let jobs = campaign.jobs(Shard::WHOLE);
    let progress = progress_bar(jobs.len() as u64, "flights");
    let rows = Mutex::new(Vec::new());
    let flown = fly_all(campaign, &jobs, threads, Extras::NONE, |row| {
        progress.inc(1);
        rows.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(row);
        match signals.raised() {
            Some(_) => Err(CampaignError::Stopped),
            None => Ok(()),
        }
    });
    progress.finish_and_clear();
    flown.map_err(|error| match signals.raised() {
        Some(code) if matches!(error, CampaignError::Stopped) => Failure::new(code, error),
        _ => failure(&error),
    })?;
    let rows = rows.into_inner().unwrap_or_else(PoisonError::into_inner);
    merge(campaign, rows).map_err(Failure::failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_that_is_printed_can_be_given_back() {
        let x8 = AircraftModel::new(mpp_sim::aircraft_file::AircraftFile::known("x8").unwrap());
        let report = AircraftReport::new(&x8.unwrap());
        let cells = |ticks| flown_cells(&[20, 40], f64::from(ticks) / 100.0);
        let rates = (1..2000).flat_map(cells).map(|(_, rate)| rate);
        for rate in rates.chain(report.replan_hz) {
            let scenario = ScenarioFile {
                replan_hz: Some(rate.to_string().parse().unwrap()),
                ..ScenarioFile::default()
            };
            assert!(scenario.build().is_ok(), "{rate}");
            assert!(rate.to_string().len() < 12, "{rate}");
        }
        let [sparse, dense] = report.replan_hz;
        let told = format!("replanning at {sparse} Hz in sparse and {dense} Hz");
        assert!(report.to_string().contains(&told), "{report}");
    }

    #[test]
    fn one_collision_is_told_as_one() {
        let told = |collisions| {
            line(&Success {
                aircraft: "zagi".to_owned(),
                obstacles: 20,
                replan_hz: 0.75188,
                oracle: false,
                flights: 50,
                strict: 49,
                interval: wilson(49, 50),
                collisions,
            })
        };
        assert_eq!(
            told(1),
            "zagi: 20 obstacles at 0.75188 Hz: 49 of 50 strict successes [89.5, 99.6 %], 1 collision"
        );
        assert!(told(0).ends_with(", 0 collisions"));
    }
}
