//! `bench cycle`: the time of a planning cycle for two presets on the same recorded inputs, by
//! stage.
//!
//! Flights of preset `flight` are recorded. Both presets then plan every recorded cycle, in order
//! and each with its own memory. A cycle is planned several times from the same planner,
//! alternating between the presets. The fastest time counts, so that the machine's other work drops
//! out. The core has no clock: the benchmark tells the stages apart from outside, by the phase of
//! each slice.

use super::percentile::percentile;
use crate::recording::{Inputs, planner, record, settings};
use mpp_core::paper;
use mpp_core::planner::{Phase, Planner, plane};
use mpp_sim::flight::FlyError;
use mpp_sim::scenario::{Preset, Scenario};
use serde::Serialize;
use std::fmt;
use std::time::{Duration, Instant};

/// The presets. The first one is the measure for the other.
const PRESETS: [Preset; 2] = [Preset::Reference, Preset::Flight];

/// The parameters of the benchmark.
#[derive(Clone, Debug)]
pub struct CycleBench {
    /// Scenario of the first flight, except its preset. The other flights take the next seeds.
    pub scenario: Scenario,
    /// Number of flights that are recorded.
    pub flights: u32,
    /// Number of times that each cycle is planned.
    pub runs: u32,
}

/// Times of one kind \[us\].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Times {
    /// Median over cycles.
    pub median_us: f64,
    /// 99th percentile.
    pub p99_us: f64,
    /// Longest time.
    pub max_us: f64,
}

/// One preset's figures.
#[derive(Clone, Debug, Serialize)]
pub struct PresetReport {
    /// The preset.
    pub preset: Preset,
    /// Mean number of candidates refined in a cycle.
    pub candidates_mean: f64,
    /// Mean number of slices of a cycle.
    pub slices_mean: f64,
    /// Times of whole cycles.
    pub cycle: Times,
    /// Times from the scan to the map.
    pub map: Times,
    /// Times of the path search.
    pub candidates: Times,
    /// Times from paths to half-planes.
    pub corridor: Times,
    /// Times of the programs: with rounds of linearisation condensed, then solved and flown out.
    #[serde(rename = "QP")]
    pub qp: Times,
    /// Times of the beginning and the end.
    pub rest: Times,
}

/// The benchmark's figures.
#[derive(Clone, Debug, Serialize)]
pub struct CycleReport {
    /// Number of obstacles in the flights.
    pub obstacles: usize,
    /// Greatest number of candidates of a cycle.
    pub paths: u16,
    /// Replanning rate \[Hz\].
    pub replan_hz: f64,
    /// Seed of the first flight.
    pub seed: u64,
    /// Number of times that each cycle was planned.
    pub runs: u32,
    /// Number of cycles of each preset.
    pub cycles: usize,
    /// The presets: `reference`, then `flight`.
    pub presets: Vec<PresetReport>,
    /// Time of a cycle of `flight` as a multiple of that of `reference`.
    pub ratio: Ratio,
}

/// Multiples of times [-].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Ratio {
    /// Ratio of the medians.
    pub median: f64,
    /// Ratio of the 99th percentiles.
    pub p99: f64,
    /// Ratio of the longest times.
    pub max: f64,
}

/// Picks one kind of a preset's times.
type Pick = fn(&PresetReport) -> &Times;

/// Times of one cycle's parts, in the order of [`PARTS`].
type Parts = [Duration; PARTS];

/// Number of parts: map, candidates, corridor, QP, rest.
const PARTS: usize = 5;

/// Records flights and plans their cycles; `progress` is called after each flight.
///
/// # Errors
/// [`FlyError`].
pub fn run_cycle(bench: &CycleBench, mut progress: impl FnMut()) -> Result<CycleReport, FlyError> {
    let mut tallies = PRESETS.map(|_| Tally::default());
    for flight in 0..bench.flights {
        let scenario = |preset| Scenario {
            preset,
            seed: bench.scenario.seed.wrapping_add(flight.into()),
            ..bench.scenario.clone()
        };
        let mut planners = Vec::new();
        for preset in PRESETS {
            planners.push(planner(&settings(&scenario(preset))?)?);
        }
        for inputs in record(&scenario(Preset::Flight))? {
            let begun = planners.clone();
            for run in 0..bench.runs {
                for ((tally, planner), begun) in tallies.iter_mut().zip(&mut planners).zip(&begun) {
                    planner.clone_from(begun);
                    tally.add(run == 0, plan(planner, &inputs), planner);
                }
            }
        }
        progress();
    }
    let cycles = tallies.each_ref().map(|tally| tally.best.len());
    let presets: Vec<PresetReport> = PRESETS
        .into_iter()
        .zip(&tallies)
        .map(|(preset, tally)| tally.report(preset))
        .collect();
    let ratio = |of: fn(&Times) -> f64| {
        let times = presets.iter().map(|report| of(&report.cycle));
        times.reduce(|reference, flight| flight / reference)
    };
    Ok(CycleReport {
        obstacles: bench.scenario.obstacles,
        paths: bench.scenario.paths,
        replan_hz: bench.scenario.replan_hz(),
        seed: bench.scenario.seed,
        runs: bench.runs,
        cycles: cycles.into_iter().min().unwrap_or(0),
        ratio: Ratio {
            median: ratio(|times| times.median_us).unwrap_or(f64::NAN),
            p99: ratio(|times| times.p99_us).unwrap_or(f64::NAN),
            max: ratio(|times| times.max_us).unwrap_or(f64::NAN),
        },
        presets,
    })
}

/// Plans one cycle, and times its parts.
fn plan(planner: &mut Planner, inputs: &Inputs) -> Parts {
    let mut parts = [Duration::ZERO; PARTS];
    let mut last = Instant::now();
    let mut took = |part: usize| {
        let now = Instant::now();
        parts[part] += now - last;
        last = now;
    };
    planner.begin(inputs.time, &inputs.state, &inputs.conditions, &inputs.scan);
    took(PARTS - 1);
    loop {
        let part = part(planner.phase());
        let more = planner.advance();
        took(part);
        if !more {
            break;
        }
    }
    planner.finish();
    took(PARTS - 1);
    parts
}

fn part(phase: Phase) -> usize {
    match phase {
        Phase::Plane(phase) => match phase {
            plane::Phase::Map => 0,
            plane::Phase::Lattice => 1,
            plane::Phase::Faces => 2,
            plane::Phase::Linearise | plane::Phase::Improve => 3,
            plane::Phase::Gate | plane::Phase::Idle | plane::Phase::Done => 4,
        },
        Phase::Paper(phase) => match phase {
            paper::Phase::Map => 0,
            paper::Phase::Tree => 1,
            paper::Phase::Corridor => 2,
            paper::Phase::Program => 3,
            paper::Phase::Idle | paper::Phase::Done => 4,
        },
    }
}

/// Collects one preset's cycles.
#[derive(Default)]
struct Tally {
    /// The fastest run of each cycle.
    best: Vec<Parts>,
    candidates: usize,
    slices: usize,
}

impl Tally {
    fn add(&mut self, first: bool, parts: Parts, planner: &Planner) {
        let total = |parts: &Parts| parts.iter().sum::<Duration>();
        match self.best.last_mut() {
            Some(best) if !first => {
                if total(&parts) < total(best) {
                    *best = parts;
                }
            }
            _ => {
                self.best.push(parts);
                self.candidates += planner.summary().candidates;
                self.slices += planner.summary().slices;
            }
        }
    }

    fn report(&self, preset: Preset) -> PresetReport {
        let cycles = self.best.len().max(1) as f64;
        let times = |of: &dyn Fn(&Parts) -> Duration| {
            let micros = |parts| of(parts).as_secs_f64() * 1e6;
            let mut all: Vec<f64> = self.best.iter().map(micros).collect();
            all.sort_by(f64::total_cmp);
            let at = |percent| percentile(&all, percent).unwrap_or(f64::NAN);
            Times {
                median_us: at(50),
                p99_us: at(99),
                max_us: at(100),
            }
        };
        let part = |part: usize| times(&|parts: &Parts| parts[part]);
        PresetReport {
            preset,
            candidates_mean: self.candidates as f64 / cycles,
            slices_mean: self.slices as f64 / cycles,
            cycle: times(&|parts| parts.iter().sum()),
            map: part(0),
            candidates: part(1),
            corridor: part(2),
            qp: part(3),
            rest: part(4),
        }
    }
}

impl fmt::Display for CycleReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} cycles past {} obstacles, {} paths, {} Hz; median / 99th percentile / longest [us]",
            self.cycles, self.obstacles, self.paths, self.replan_hz
        )?;
        write!(f, "{:<12}", "")?;
        for report in &self.presets {
            write!(f, " {:>26}", report.preset.name())?;
        }
        let rows: [(&str, Pick); PARTS + 1] = [
            ("map", |report| &report.map),
            ("candidates", |report| &report.candidates),
            ("corridor", |report| &report.corridor),
            ("QP", |report| &report.qp),
            ("rest", |report| &report.rest),
            ("cycle", |report| &report.cycle),
        ];
        for (name, times) in rows {
            write!(f, "\n{name:<12}")?;
            for report in &self.presets {
                let Times {
                    median_us,
                    p99_us,
                    max_us,
                } = times(report);
                write!(f, " {median_us:>8.1} {p99_us:>8.1} {max_us:>8.1}")?;
            }
        }
        writeln!(
            f,
            "\nflight takes {:.2} times reference's median, {:.2} times its 99th percentile, {:.2} \
             times its longest",
            self.ratio.median, self.ratio.p99, self.ratio.max
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times depend on the machine. The parts that are timed do not.
    #[test]
    fn both_presets_plan_the_same_cycles_and_every_slice_is_counted_once() {
        let bench = CycleBench {
            scenario: Scenario {
                ticks: 300,
                ..Scenario::new(Preset::Flight, 4)
            },
            flights: 2,
            runs: 2,
        };
        let report = run_cycle(&bench, || {}).unwrap();
        assert_eq!((report.cycles, report.runs), (6, 2));
        for preset in &report.presets {
            assert!(preset.candidates_mean >= 1.0 && preset.slices_mean > preset.candidates_mean);
            let parts = [
                &preset.map,
                &preset.candidates,
                &preset.corridor,
                &preset.qp,
            ];
            // Every stage worked, and no stage took longer than the longest cycle.
            for part in parts {
                assert!(part.median_us > 0.0 && part.max_us < preset.cycle.max_us);
            }
        }
        let [reference, flight] = report.presets.as_slice() else {
            panic!("two presets");
        };
        let ratio = flight.cycle.median_us / reference.cycle.median_us;
        assert!((report.ratio.median - ratio).abs() < 1e-12);
    }
}
