//! Flies a campaign on all cores.

use super::error::CampaignError;
use hil_protocol::Message;
use mpp_analysis::campaign::{
    Campaign, Cell, FaultCampaign, FaultJob, FaultPair, FaultPairs, Flown, Row, Shard,
};
use mpp_analysis::ceiling::{Feasibility, decide};
use mpp_analysis::rows::Header;
use mpp_core::vehicle::{VehicleState, Wind};
use mpp_sim::flight::{FlyError, fly, fly_in_brief};
use mpp_sim::flight_observer::FlightObserver;
use mpp_sim::link::{Link, LinkError};
use mpp_sim::log::FlightLog;
use mpp_sim::outcome::Outcome;
use mpp_sim::pipe::DirectLink;
use mpp_sim::scenario::Scenario;
use mpp_sim::tick_record::TickRecord;
use rayon::prelude::*;
use std::num::NonZeroUsize;
use std::time::{Duration, Instant};

/// Stack of a thread [bytes]. The core is built on the stack before it moves to its box.
const STACK: usize = 8 << 20;

/// What the rows of a campaign hold besides what its report needs.
#[derive(Clone, Copy)]
pub struct Extras {
    /// The log's hash; without it the flights have no log.
    pub hashed: bool,
    /// Whether known collisions were avoidable, which takes a tenth of a dense campaign's time.
    pub judged: bool,
    /// The core's wall time.
    pub timed: bool,
}

impl Extras {
    /// What a report needs.
    pub const NONE: Self = Self {
        hashed: false,
        judged: false,
        timed: false,
    };
    /// What the seeds alone determine, as row files hold it.
    pub const HASHED: Self = Self {
        hashed: true,
        judged: true,
        timed: false,
    };
}

/// The first line of a row file of this program.
///
/// # Errors
/// [`CampaignError`] of the first flight that fails.
pub fn header(campaign: Campaign, shard: Shard) -> Result<Header, CampaignError> {
    let hash = |start: &Campaign, cell: &Cell, seed| {
        let row = flown(&mut DirectLink::new(), start, cell, seed, Extras::HASHED)?;
        Ok(row.log_hash)
    };
    Header::new(campaign, shard, hash)
}

/// Flies these flights on this number of threads; 0 means as many as there are cores. Each thread
/// gives its row to `keep` as soon as the row is flown.
///
/// # Errors
/// [`CampaignError`] of the first flight or row that fails; the rows kept so far are valid.
pub fn run(
    campaign: &Campaign,
    jobs: &[(Cell, u64)],
    threads: usize,
    extras: Extras,
    keep: impl Fn(Row) -> Result<(), CampaignError> + Sync,
) -> Result<(), CampaignError> {
    let pool = pool(threads, jobs.len(), STACK)?;
    pool.install(|| {
        // With `par_bridge` the flights start in order, and no flight runs on a stack of half-split
        // lists.
        jobs.iter()
            .par_bridge()
            .try_for_each_init(DirectLink::new, |link, (cell, seed)| {
                keep(flown(link, campaign, cell, *seed, extras)?)
            })
    })
}

/// Flies the flights of a campaign of faults. `done` is called after each flight. The result is in the order
/// of the flights.
///
/// # Errors
/// [`CampaignError`] of the first flight that fails, or the error of `done`.
pub fn run_faults(
    campaign: &FaultCampaign,
    threads: usize,
    done: impl Fn() -> Result<(), CampaignError> + Sync,
) -> Result<Vec<(FaultJob, Flown)>, CampaignError> {
    let fly_one = |link: &mut DirectLink, job: FaultJob| {
        let scenario = campaign.scenario(&job).map_err(CampaignError::Scenario)?;
        let (log, observer, _) = observed(&scenario, link, Extras::NONE).map_err(|error| {
            let fault = campaign.name(&job).unwrap_or("no fault");
            CampaignError::Faulty(fault, Box::new(job.cell.clone()), job.seed, error)
        })?;
        done()?;
        Ok((job, kept(&log, &observer)))
    };
    let jobs = campaign.jobs();
    pool(threads, jobs.len(), STACK)?.install(|| {
        let flown = jobs.into_par_iter().map_init(DirectLink::new, fly_one);
        flown.collect()
    })
}

/// What a campaign of faults keeps of a flight.
fn kept(log: &FlightLog, observer: &FlightObserver) -> Flown {
    Flown {
        strict: log.summary.strict,
        survived: log.summary.outcome == Outcome::Survived,
        known_collision: observer.known_collision(log),
        flagged: observer.flagged(),
        told: observer.told().clone(),
    }
}

/// Flies the flights of a campaign of pairs of faults. `done` is called after each flight. The result is in the order
/// of the flights.
///
/// # Errors
/// [`CampaignError`] of the first flight that fails, or the error of `done`.
pub fn run_pairs(
    campaign: &FaultPairs,
    threads: usize,
    done: impl Fn() -> Result<(), CampaignError> + Sync,
) -> Result<Vec<(FaultPair, Flown)>, CampaignError> {
    let fly_one = |link: &mut DirectLink, pair: FaultPair| {
        let scenario = campaign.scenario(&pair).map_err(CampaignError::Scenario)?;
        let (log, observer, _) = observed(&scenario, link, Extras::NONE)
            .map_err(|error| CampaignError::Pair(pair.faults.join(" and "), pair.seed, error))?;
        done()?;
        Ok((pair, kept(&log, &observer)))
    };
    let pairs = campaign.pairs();
    pool(threads, pairs.len(), STACK)?.install(|| {
        let flown = pairs.into_par_iter().map_init(DirectLink::new, fly_one);
        flown.collect()
    })
}

/// Decides about the fields of a cell. `done` is called after each. The result is in the order of the seeds.
///
/// # Errors
/// [`CampaignError`] of the first field that cannot be judged, or the error of `done`.
pub fn decide_all(
    campaign: &Campaign,
    cell: &Cell,
    margin: f64,
    threads: usize,
    done: impl Fn() -> Result<(), CampaignError> + Sync,
) -> Result<Vec<(u64, Feasibility)>, CampaignError> {
    let decide_one = |seed: u64| {
        let scenario = campaign
            .scenario(cell, seed)
            .map_err(CampaignError::Scenario)?;
        let verdict = decide(&scenario, margin).map_err(CampaignError::Ceiling)?;
        done()?;
        Ok((seed, verdict))
    };
    let seeds: Vec<u64> = campaign.seeds().collect();
    pool(threads, seeds.len(), STACK)?.install(|| seeds.into_par_iter().map(decide_one).collect())
}

/// A pool of this number of threads, 0 as many as there are cores, and no more than there are jobs, with stacks of this size
/// [bytes].
pub(crate) fn pool(
    threads: usize,
    jobs: usize,
    stack: usize,
) -> Result<rayon::ThreadPool, CampaignError> {
    let builder = rayon::ThreadPoolBuilder::new().num_threads(useful(threads, jobs));
    builder
        .stack_size(stack)
        .build()
        .map_err(CampaignError::Threads)
}

/// How many of these threads have a job. Each thread takes memory for its stack, with a job or without.
fn useful(threads: usize, jobs: usize) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let threads = if threads == 0 { cores() } else { threads };
    threads.min(jobs).max(1)
}

/// Flies a scenario in this process. Also gives the time for which the core worked, if it is asked for.
fn observed(
    scenario: &Scenario,
    link: &mut DirectLink,
    extras: Extras,
) -> Result<(FlightLog, FlightObserver, Duration), FlyError> {
    link.restart(scenario);
    let mut link = Stopwatch {
        link,
        timed: extras.timed,
        elapsed: Duration::ZERO,
    };
    let mut observer = FlightObserver::of(scenario);
    let watch = |record: &TickRecord<'_>| observer.watch(record);
    let log = if extras.hashed {
        fly(scenario, &mut link, watch)?
    } else {
        fly_in_brief(scenario, &mut link, watch)?
    };
    Ok((log, observer, link.elapsed))
}

/// Flies one row.
fn flown(
    link: &mut DirectLink,
    campaign: &Campaign,
    cell: &Cell,
    seed: u64,
    extras: Extras,
) -> Result<Row, CampaignError> {
    let scenario = campaign
        .scenario(cell, seed)
        .map_err(CampaignError::Scenario)?;
    let (log, observer, elapsed) = observed(&scenario, link, extras)
        .map_err(|error| CampaignError::Flight(Box::new(cell.clone()), seed, error))?;
    let hash = extras.hashed.then(|| log.hash()).transpose();
    let hash = hash.map_err(|error| CampaignError::Log(Box::new(cell.clone()), seed, error))?;
    let row = Row {
        log_hash: hash.unwrap_or_default(),
        core_ms: extras.timed.then_some(elapsed.as_secs_f64() * 1e3),
        ..Row::new(cell.clone(), &log, &observer)
    };
    Ok(if extras.judged {
        row.judged(&scenario, &observer)
    } else {
        row
    })
}

/// A link that measures how long the core works, if it is asked to. In this process the core works during `send`.
struct Stopwatch<'a> {
    link: &'a mut DirectLink,
    timed: bool,
    elapsed: Duration,
}

impl Link for Stopwatch<'_> {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        let begin = self.timed.then(Instant::now);
        let sent = self.link.send(message);
        self.elapsed += begin.map_or(Duration::ZERO, |begin| begin.elapsed());
        sent
    }

    fn reveal(&mut self, truth: &VehicleState, wind: Wind) -> Result<(), LinkError> {
        self.link.reveal(truth, wind)
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.link.receive(awaited)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mpp_analysis::campaign::Lists;
    use mpp_sim::pipe::PipeLink;
    use mpp_sim::scenario::{Preset, ScenarioFile};

    /// The rows by structs, of flights that share a core, are the rows over frames: with an oracle, faults of the link and
    /// the clock, and after a flight by another preset.
    #[test]
    fn a_row_by_structs_is_the_row_over_frames() {
        let mut link = DirectLink::new();
        let faults = "duration = 6.0\n[faults.link]\nfrom = 1.0\nloss = 0.2\n[faults.clock]\nfrom = 2.0\njump = 1.0\n";
        let lists = |obstacles, preset| Lists {
            obstacles: vec![obstacles],
            preset: vec![preset],
            replan_hz: vec![4.0],
            ..Lists::default()
        };
        for (text, obstacles, preset) in [
            ("duration = 6.0", 160, Preset::Flight),
            ("duration = 3.0", 40, Preset::Paper),
            (faults, 40, Preset::Flight),
            ("duration = 3.0\noracle = true", 40, Preset::Flight),
            ("duration = 6.0", 40, Preset::Flight),
        ] {
            let file = ScenarioFile::parse("test", text).unwrap();
            let campaign = Campaign::new(file, lists(obstacles, preset), 1, Some(77)).unwrap();
            for cell in campaign.cells() {
                let row = flown(&mut link, &campaign, &cell, 77, Extras::HASHED).unwrap();
                let scenario = campaign.scenario(&cell, 77).unwrap();
                let mut observer = FlightObserver::of(&scenario);
                let mut wire = PipeLink::of(&scenario);
                let log = fly(&scenario, &mut wire, |record| observer.watch(record)).unwrap();
                let brief = Row::new(cell.clone(), &log, &observer);
                assert_eq!(
                    flown(&mut link, &campaign, &cell, 77, Extras::NONE).unwrap(),
                    brief
                );
                let log_hash = log.hash().unwrap();
                assert_eq!(row, Row { log_hash, ..brief }.judged(&scenario, &observer));
            }
        }
    }

    #[test]
    fn no_thread_is_without_a_job() {
        assert_eq!(useful(1_000, 3), 3);
        assert_eq!(useful(2, 3), 2);
        assert_eq!(useful(4, 0), 1);
        assert_eq!(useful(0, 1), 1);
        assert!(useful(0, 1_000_000) >= 1);
    }
}
