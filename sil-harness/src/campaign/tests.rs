//! Tests campaigns: the rows are the same however they are flown, written and read.

use super::*;
use mpp_analysis::campaign::{
    Campaign, Disagreement, FaultCampaign, FaultReport, Lists, NamedFault, Report, Row, Shard,
    Taxonomy, merge, wilson,
};
use mpp_sim::scenario::{Preset, ScenarioFile};
use std::path::PathBuf;
use std::sync::Mutex;

/// Eight short flights in four cells.
fn short() -> Campaign {
    let scenario = ScenarioFile {
        duration: Some(1.0),
        ..ScenarioFile::default()
    };
    let lists = Lists {
        preset: vec![Preset::Paper],
        obstacles: vec![20, 60, 20],
        paths: vec![0, 5],
        ..Lists::default()
    };
    Campaign::new(scenario, lists, 2, Some(11)).unwrap()
}

fn fly_jobs(campaign: &Campaign, shard: Shard, threads: usize) -> Vec<Row> {
    let rows = Mutex::new(Vec::new());
    let keep = |row| {
        rows.lock().unwrap().push(row);
        Ok(())
    };
    let jobs = campaign.jobs(shard);
    run(campaign, &jobs, threads, Extras::HASHED, keep).unwrap();
    rows.into_inner().unwrap()
}

fn scratch(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("mpp-campaign-{}-{name}.jsonl", std::process::id()))
}

#[test]
fn absent_lists_are_the_scenarios_and_repetitions_are_dropped() {
    let campaign = short();
    assert_eq!(campaign.obstacles, [20, 60]);
    assert_eq!(campaign.replan_hz, [1.0]);
    assert_eq!(campaign.cells().len(), 4);
    let plain = Campaign::new(ScenarioFile::default(), Lists::default(), 3, None).unwrap();
    assert_eq!((plain.cells().len(), plain.seed), (1, 1));
    let absurd = Lists {
        replan_hz: vec![1.0, 3.0],
        ..Lists::default()
    };
    let error = Campaign::new(ScenarioFile::default(), absurd, 3, None).unwrap_err();
    assert!(error.to_string().starts_with("replan_hz: give"), "{error}");
}

#[test]
fn rows_depend_neither_on_threads_nor_on_shards() {
    let campaign = short();
    let whole = merge(&campaign, fly_jobs(&campaign, Shard::WHOLE, 1)).unwrap();
    assert_eq!(whole.len(), 8);
    let threaded = merge(&campaign, fly_jobs(&campaign, Shard::WHOLE, 3)).unwrap();
    assert_eq!(whole, threaded);
    let shards = ["3/3", "1/3", "2/3"].map(|shard| shard.parse().unwrap());
    let parts = shards.map(|shard| fly_jobs(&campaign, shard, 1));
    assert_eq!(parts.each_ref().map(Vec::len), [2, 3, 3]);
    assert_eq!(
        merge(&campaign, parts.into_iter().flatten()).unwrap(),
        whole
    );
    // The rows come from eight different flights.
    let mut hashes: Vec<&str> = whole.iter().map(|row| row.log_hash.as_str()).collect();
    hashes.sort_unstable();
    hashes.dedup();
    assert_eq!(hashes.len(), 8);
}

#[test]
fn a_shard_is_a_part_of_a_whole() {
    for absurd in ["", "1", "0/3", "4/3", "1/0", "a/b", "-1/3"] {
        assert!(absurd.parse::<Shard>().is_err(), "{absurd}");
    }
}

/// Writes a file, cuts it at every kind of place, and continues it.
#[test]
fn a_cut_file_is_gone_on_with_and_nothing_is_lost_or_repeated() {
    let campaign = short();
    let header = header(campaign.clone(), Shard::WHOLE).unwrap();
    let rows = fly_jobs(&campaign, Shard::WHOLE, 1);
    let path = scratch("cut");
    let _ = std::fs::remove_file(&path);
    let (mut file, known) = RowFile::open(&path, &header).unwrap();
    assert!(known.is_empty());
    rows.iter().for_each(|row| file.push(row).unwrap());
    drop(file);
    let whole = std::fs::read(&path).unwrap();
    let ends: Vec<usize> = (0..whole.len()).filter(|at| whole[*at] == b'\n').collect();
    for line in 0..ends.len() {
        for cut in [ends[line].saturating_sub(40), ends[line], ends[line] + 1] {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let (mut file, known) = RowFile::open(&path, &header).unwrap();
            assert_eq!(known, rows[..known.len()]);
            // Only the incomplete line is dropped.
            let complete = ends.iter().filter(|end| **end < cut).count();
            assert_eq!(known.len(), complete.saturating_sub(1));
            rows[known.len()..]
                .iter()
                .for_each(|row| file.push(row).unwrap());
            drop(file);
            assert_eq!(std::fs::read(&path).unwrap(), whole, "cut at {cut}");
        }
    }
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn another_campaigns_file_is_refused_by_what_differs() {
    let campaign = short();
    let header = header(campaign.clone(), Shard::WHOLE).unwrap();
    let path = scratch("other");
    let _ = std::fs::remove_file(&path);
    let (file, _) = RowFile::open(&path, &header).unwrap();
    let busy = RowFile::open(&path, &header).unwrap_err();
    assert!(
        busy.to_string()
            .contains("being written by another process"),
        "{busy}"
    );
    drop(file);
    let before = std::fs::read(&path).unwrap();
    let mut other_program = header.clone();
    other_program.fingerprint = "another".to_owned();
    let error = RowFile::open(&path, &other_program).unwrap_err();
    assert!(error.to_string().contains("its fingerprint is"), "{error}");
    let others = [
        (
            Campaign {
                trials: 3,
                ..campaign.clone()
            },
            Shard::WHOLE,
            "its trials is 2, not 3",
        ),
        (campaign.clone(), "1/2".parse().unwrap(), "its shard is"),
        (
            Campaign {
                seed: 12,
                ..campaign
            },
            Shard::WHOLE,
            "its seed is 11, not 12",
        ),
    ];
    for (campaign, shard, what) in others {
        let error = RowFile::open(&path, &super::header(campaign, shard).unwrap()).unwrap_err();
        assert!(error.to_string().contains(what), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), before);
    }
    std::fs::write(&path, "a poem\n").unwrap();
    let error = RowFile::open(&path, &header).unwrap_err();
    assert!(error.to_string().contains("line 1: no header"), "{error}");
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn a_row_of_another_campaign_and_a_spoilt_line_are_named() {
    let campaign = short();
    let header = header(campaign.clone(), Shard::WHOLE).unwrap();
    let path = scratch("lines");
    let _ = std::fs::remove_file(&path);
    let (mut file, _) = RowFile::open(&path, &header).unwrap();
    let mut row = fly_jobs(&campaign, "1/8".parse().unwrap(), 1).remove(0);
    file.push(&row).unwrap();
    row.seed = 999;
    file.push(&row).unwrap();
    drop(file);
    let error = read(&path).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("line 3: this row is not of the file"),
        "{error}"
    );
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("\"class\"", "\"klass\"")).unwrap();
    let error = read(&path).unwrap_err();
    assert!(
        error.to_string().contains("line 2: missing field `class`"),
        "{error}"
    );
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn files_that_disagree_about_a_flight_are_refused() {
    let campaign = short();
    let row = fly_jobs(&campaign, "1/8".parse().unwrap(), 1).remove(0);
    let timed = Row {
        core_ms: Some(3.0),
        ..row.clone()
    };
    assert_eq!(merge(&campaign, [row.clone(), timed]).unwrap().len(), 1);
    let mut other = row.clone();
    other.summary.replans += 1;
    assert!(matches!(
        merge(&campaign, [row, other]),
        Err(Disagreement { .. })
    ));
}

#[test]
fn a_report_counts_what_its_rows_say() {
    let campaign = short();
    let mut rows = merge(&campaign, fly_jobs(&campaign, Shard::WHOLE, 1)).unwrap();
    rows[0].summary.class = mpp_sim::outcome::Class::LeftBand;
    rows[0].summary.strict = false;
    rows[1].summary.class = mpp_sim::outcome::Class::NoPlan;
    (rows[1].summary.strict, rows[1].success) = (false, false);
    let report = serde_json::to_value(Report::new(&campaign, &rows)).unwrap();
    assert_eq!(
        (&report["flights"], &report["flown"]),
        (&8.into(), &8.into())
    );
    let cell = &report["cells"][0];
    assert_eq!(cell["preset"], "paper");
    assert_eq!(
        (&cell["obstacles"], &cell["paths"], &cell["trials"]),
        (&20.into(), &0.into(), &2.into())
    );
    assert_eq!(
        (&cell["successes"], &cell["strict_successes"]),
        (&1.into(), &0.into())
    );
    assert_eq!(cell["success_rate"], 0.5);
    let (low, high) = wilson(1, 2);
    assert_eq!(
        (&cell["wilson_low"], &cell["wilson_high"]),
        (&low.into(), &high.into())
    );
    assert_eq!(
        (&cell["outcomes"]["left-band"], &cell["outcomes"]["no-plan"]),
        (&1.into(), &1.into())
    );
    let total = |cell: &serde_json::Value| {
        let outcomes = cell["outcomes"].as_object().unwrap();
        outcomes
            .values()
            .filter_map(serde_json::Value::as_u64)
            .sum::<u64>()
    };
    assert!(
        report["cells"]
            .as_array()
            .unwrap()
            .iter()
            .all(|cell| total(cell) == 2)
    );
    // A cell without flights has no success rate yet.
    let early = Report::new(&campaign, &rows[..2]);
    assert_eq!(early.cells[3].success_rate, None);
    assert!(early.to_string().contains("2 of 8 flights are here"));
}

#[test]
fn an_oracle_is_paired_field_by_field() {
    let mut campaign = short();
    (campaign.oracle, campaign.obstacles, campaign.paths) = (true, vec![20], vec![5]);
    campaign.trials = 5;
    let cells = campaign.cells();
    assert_eq!(cells.len(), 2);
    assert!(!cells[0].oracle && cells[1].oracle && cells[1].preset == Preset::Flight);
    let flown = fly_jobs(&campaign, "1/10".parse().unwrap(), 1).remove(0);
    let row = |cell: usize, trial: u64, strict: bool| {
        let mut row = flown.clone();
        (row.cell, row.seed, row.summary.strict) = (cells[cell].clone(), 11 + trial, strict);
        row
    };
    // The oracle has not flown our last field yet.
    let ours = [true, false, true, false, true];
    let theirs = [true, true, false, false];
    let ours = (0..).zip(ours).map(|(trial, strict)| row(0, trial, strict));
    let theirs = (0..)
        .zip(theirs)
        .map(|(trial, strict)| row(1, trial, strict));
    let rows = merge(&campaign, theirs.chain(ours)).unwrap();
    let report = Report::new(&campaign, &rows);
    let pairs = report.cells[0].against_oracle.unwrap();
    assert_eq!((pairs.both, pairs.only_ours), (1, 1));
    assert_eq!((pairs.only_oracle, pairs.neither), (1, 1));
    assert_eq!(pairs.share, Some(0.5));
    assert_eq!((pairs.wilson_low, pairs.wilson_high), wilson(1, 2));
    assert_eq!(report.cells[1].against_oracle, None);
    let text = report.to_string();
    assert!(
        text.contains(": 1 of the 2 fields that the oracle flies"),
        "{text}"
    );
}

#[test]
fn failures_are_sorted_by_cause() {
    use mpp_sim::inquest::{Cause, Failure};
    let mut campaign = short();
    (campaign.oracle, campaign.obstacles, campaign.paths) = (true, vec![20], vec![5]);
    campaign.trials = 4;
    let cells = campaign.cells();
    let flown = fly_jobs(&campaign, "1/8".parse().unwrap(), 1).remove(0);
    let row = |cell: usize, trial: u64, cause: Option<Cause>| {
        let mut row = flown.clone();
        (row.cell, row.seed, row.summary.strict) =
            (cells[cell].clone(), 11 + trial, cause.is_none());
        row.summary.failure = cause.map(|cause| Failure {
            cause,
            seen_before: Some(1.5),
            plan_clearance: None,
            off_plan: None,
        });
        row
    };
    let ours = [
        Some(Cause::Tracking),
        Some(Cause::Hidden),
        None,
        Some(Cause::Hidden),
    ];
    let theirs = [None, None, None, Some(Cause::Tracking)];
    let ours = (0..).zip(ours).map(|(trial, cause)| row(0, trial, cause));
    let theirs = (0..).zip(theirs).map(|(trial, cause)| row(1, trial, cause));
    let report = Report::new(&campaign, &merge(&campaign, ours.chain(theirs)).unwrap());
    let found: Vec<_> = report.cells[0]
        .causes
        .iter()
        .map(|report| {
            (
                report.cause,
                report.flights,
                report.oracle_flies,
                report.seed,
            )
        })
        .collect();
    let expected = [
        (Cause::Hidden, 2, Some(1), 12),
        (Cause::Tracking, 1, Some(1), 11),
    ];
    assert_eq!(found, expected);
    let text = Taxonomy(&report).to_string();
    assert!(text.contains(": 3 of 4 flights failed\n  hidden           2, the oracle flies     1"));
    // A row names the cause as the report does.
    let json = serde_json::to_value(row(0, 0, Some(Cause::Hidden))).unwrap();
    assert_eq!(json["failure"]["cause"], "hidden");
    let back: Row = serde_json::from_value(json).unwrap();
    assert_eq!(back, row(0, 0, Some(Cause::Hidden)));
}

/// Short pairs of flights with two faults in two cells, on one thread and on three.
#[test]
fn a_report_of_faults_does_not_depend_on_threads() {
    let scenario = ScenarioFile {
        duration: Some(7.0),
        ..ScenarioFile::default()
    };
    let names = ["link-silent-1s", "elevator-rate-120"].map(str::to_owned);
    let faults = NamedFault::of(&names).unwrap();
    let lists = Lists {
        paths: vec![3],
        ..Lists::default()
    };
    let campaign = FaultCampaign::new(&scenario, &lists, 2, Some(11), &faults).unwrap();
    let report = |threads| {
        let flown = run_faults(&campaign, threads, || Ok(())).unwrap();
        FaultReport::new(&campaign, &flown)
    };
    let (one, three) = (report(1), report(3));
    let json = |report: &FaultReport| serde_json::to_string(report).unwrap();
    assert_eq!(json(&one), json(&three));
    let cells: Vec<_> = one
        .faults
        .iter()
        .map(|row| (row.name, row.obstacles))
        .collect();
    let expected = [
        ("link-silent-1s", 20),
        ("link-silent-1s", 40),
        ("elevator-rate-120", 120),
    ];
    assert_eq!(cells, expected);
    for row in &one.faults {
        assert_eq!(row.pairs, 2);
        assert_eq!(row.clean + row.only_faulty, row.faulty + row.only_clean);
    }
    // The core refuses the tick after the silence, which comes 1 s after the onset.
    let after = one.faults[0].flagged_s.unwrap();
    assert!(after > 0.0 && after <= 1.0, "{after}");
    let stopped = run_faults(&campaign, 1, || Err(CampaignError::Stopped)).unwrap_err();
    assert!(matches!(stopped, CampaignError::Stopped));
}
