//! A lidar that fails: it is told, planned without, and believed again.

use super::{Spoilt, causes, short};
use hil_protocol::{LidarScan, Message, SensorState};
use mpp_sim::faults::ScanFault;
use mpp_sim::flight::fly;
use mpp_sim::link::Link;
use mpp_sim::log::FlightLog;
use mpp_sim::outcome::Outcome;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};

/// A link to a core in this process, whose scans are changed on the way.
fn changed_scans(mut change: impl FnMut(&mut LidarScan)) -> impl Link {
    Spoilt {
        pipe: PipeLink::new(),
        spoil: move |pipe: &mut PipeLink, message: &Message| {
            let Message::LidarScan(scan) = message else {
                return false;
            };
            let mut scan = scan.clone();
            change(&mut scan);
            pipe.send(&Message::LidarScan(scan)).is_ok()
        },
    }
}

/// A lidar that freezes or goes blind is told, is excluded, and comes back.
#[test]
fn a_lidar_that_freezes_or_goes_blind_is_told() {
    let fault: [fn(&mut LidarScan, &LidarScan); 2] = [
        |scan, last| scan.ranges.clone_from(&last.ranges),
        |scan, _| scan.ranges.iter_mut().for_each(|range| *range = 0.0),
    ];
    for (fault, cause) in fault.into_iter().zip(["ScanRepeated", "ScanBlind"]) {
        let mut last: Option<LidarScan> = None;
        let mut link = changed_scans(|scan| match &last {
            Some(last) if (400..600).contains(&scan.tick) => fault(scan, last),
            _ => last = Some(scan.clone()),
        });
        let mut scenario = short(2);
        scenario.obstacles = 60;
        scenario.replan_ticks = 25;
        scenario.ticks = 1000;
        let log = fly(&scenario, &mut link, |_| {}).unwrap();
        let causes = causes(&log);
        assert!(causes.len() >= 6, "{causes:?}");
        assert!(causes.iter().all(|it| *it == cause), "{causes:?}");
        let lidar: Vec<_> = log
            .sensors
            .iter()
            .filter(|it| it.sensor == "lidar")
            .collect();
        let states: Vec<_> = lidar.iter().map(|it| it.state.clone()).collect();
        let expected = [
            SensorState::Suspected,
            SensorState::Excluded,
            SensorState::Recovering,
            SensorState::Healthy,
        ];
        assert_eq!(states, expected.map(|state| state.to_string()), "{cause}");
        assert!(lidar[1].tick < 450, "{lidar:?}");
    }
}

/// A flight at 4 Hz past 20 obstacles whose lidar sends nothing from 4 to 7 s.
fn silent(preset: Preset, latency_ticks: u32) -> FlightLog {
    let mut scenario = Scenario {
        obstacles: 20,
        replan_ticks: 25,
        latency_ticks,
        ticks: 1200,
        ..Scenario::new(preset, 2)
    };
    scenario.faults.scan = ScanFault {
        from: Some(4.0),
        until: Some(7.0),
        missing: true,
        ..ScanFault::default()
    };
    fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap()
}

/// Ticks of the scans, or of the starts without one, from which plans were made within a range of ticks.
fn planned(log: &FlightLog, ticks: std::ops::Range<u64>) -> Vec<u64> {
    let all = log.plans.iter().map(|plan| plan.tick);
    all.filter(|tick| ticks.contains(tick)).collect()
}

/// A lidar that has fallen silent is planned without, a period after each plan, and the aircraft slows down. It is back at cruise
/// when scans have come again.
#[test]
fn a_silent_lidar_is_planned_without_and_slowly() {
    let log = silent(Preset::Flight, 1);
    assert!(
        log.summary.strict && log.rejections.is_empty(),
        "{:?}",
        log.rejections
    );
    let without = planned(&log, 400..700);
    assert!(
        without.windows(2).all(|pair| pair[1] - pair[0] == 25),
        "{without:?}"
    );
    assert!(
        (400..=410).contains(&without[0]) && without.len() >= 11,
        "{without:?}"
    );
    let airspeed = |tick: usize| log.ticks.airspeed[tick];
    assert!(airspeed(399) > 11.5, "{} m/s", airspeed(399));
    assert!(airspeed(700) < 10.0, "{} m/s", airspeed(700));
    assert!(airspeed(1199) > 11.0, "{} m/s", airspeed(1199));
}

/// How long the core waits for a scan does not depend on the latency of its plans.
#[test]
fn the_first_plan_without_a_scan_starts_three_ticks_late() {
    for latency in [1, 10, 25] {
        let log = silent(Preset::Flight, latency);
        let without = planned(&log, 400..700);
        assert_eq!(without.first(), Some(&403), "latency {latency}");
    }
}

/// The first scan that comes again is used, although a plan without a scan is on its way.
#[test]
fn the_first_scan_after_a_silence_is_planned_from() {
    for latency in [1, 20] {
        let log = silent(Preset::Flight, latency);
        let again = planned(&log, 700..1000);
        assert_eq!(again[..3], [700, 725, 750], "latency {latency}: {again:?}");
    }
}

/// A lidar that is slower than the planner is no fault: each plan is made from a scan.
#[test]
fn a_slow_lidar_is_not_planned_without() {
    let mut scans = 0;
    let mut link = Spoilt {
        pipe: PipeLink::new(),
        spoil: |_: &mut PipeLink, message: &Message| {
            let is_scan = matches!(message, Message::LidarScan(_));
            scans += u32::from(is_scan);
            is_scan && scans % 2 == 0
        },
    };
    let mut scenario = short(2);
    scenario.replan_ticks = 25;
    let log = fly(&scenario, &mut link, |_| {}).unwrap();
    let ticks = planned(&log, 0..500);
    assert_eq!(ticks, (0..10).map(|scan| 50 * scan).collect::<Vec<_>>());
}

/// The paper's method has no memory. Without a scan it would plan through what it does not see.
#[test]
fn the_papers_method_plans_from_scans_only() {
    let log = silent(Preset::Paper, 1);
    assert!(planned(&log, 400..700).is_empty());
    assert!(!planned(&log, 0..400).is_empty());
}

/// A core that never got a scan has nothing to plan from.
#[test]
fn without_a_first_scan_there_is_no_plan() {
    let mut scenario = short(1);
    scenario.obstacles = 0;
    scenario.faults.scan = ScanFault {
        missing: true,
        ..ScanFault::default()
    };
    let log = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
    assert!(log.plans.is_empty(), "{:?}", log.plans);
}

/// Flies past 40 obstacles at 4 Hz with scans that a driver has changed. Gives how many of the flights with these seeds
/// survived, and the last log.
fn survived(change: impl Fn(&mut LidarScan) + Copy) -> (usize, FlightLog) {
    let logs = (900..906).map(|seed| {
        let mut link = changed_scans(change);
        let mut scenario = short(20);
        scenario.seed = seed;
        scenario.obstacles = 40;
        scenario.replan_ticks = 25;
        fly(&scenario, &mut link, |_| {}).unwrap()
    });
    let logs: Vec<_> = logs.collect();
    let alive = |log: &&FlightLog| log.summary.outcome == Outcome::Survived;
    (
        logs.iter().filter(alive).count(),
        logs.into_iter().next_back().unwrap(),
    )
}

/// What drivers send for a beam without a return, a bad beam, and another resolution than the one of before: each flies.
#[test]
fn scans_as_drivers_send_them_fly() {
    let (clean, usual) = survived(|_| {});
    assert_eq!(clean, 6);
    for code in [f32::INFINITY, f32::NAN, 81.91, 65.535, 45.3] {
        let coded = |scan: &mut LidarScan| {
            let empty = scan.ranges.iter_mut().filter(|range| **range == 0.0);
            empty.for_each(|range| *range = code);
        };
        let (alive, log) = survived(coded);
        // Nothing came back, whatever the code for it: the same flight.
        assert_eq!((alive, &log.ticks), (6, &usual.ticks), "{code}");
        assert!(log.rejections.is_empty());
    }
    let changes: [fn(&mut LidarScan); 4] = [
        |scan| scan.ranges[41] = -1.0,
        |scan| scan.ranges[41] = f32::NAN,
        |scan| {
            scan.ranges
                .iter_mut()
                .step_by(10)
                .for_each(|range| *range = f32::NEG_INFINITY);
        },
        |scan| {
            scan.ranges = scan.ranges.iter().step_by(2).copied().collect();
            scan.angle_increment *= 2.0;
        },
    ];
    for (index, change) in changes.into_iter().enumerate() {
        let (alive, log) = survived(change);
        assert!(alive >= 5, "change {index}: {alive} of 6");
        assert!(log.rejections.is_empty(), "change {index}");
    }
}

/// A lidar with many bad beams is told, and its other beams are used.
#[test]
fn a_lidar_with_many_bad_beams_is_told() {
    let (_, log) = survived(|scan| {
        scan.ranges
            .iter_mut()
            .step_by(5)
            .for_each(|range| *range = -1.0);
    });
    assert!(log.rejections.is_empty());
    let excluded = SensorState::Excluded.to_string();
    let mut told = log.sensors.iter().filter(|it| it.sensor == "lidar");
    assert!(told.any(|it| it.state == excluded));
}

/// Scans that are 100 ms older than their stamps say are told once, corrected, and told once more when they are no longer.
#[test]
fn an_age_that_stamps_hide_is_told_once_and_corrected() {
    for seed in 1..=3 {
        let mut scenario = Scenario::new(Preset::Flight, seed);
        (scenario.obstacles, scenario.replan_ticks) = (120, 25);
        for (age_ms, until, told) in [
            (None, None, 0),
            (Some(100), None, 1),
            (Some(100), Some(8.0), 2),
        ] {
            scenario.faults.scan = ScanFault {
                until,
                age_ms,
                ..ScanFault::default()
            };
            let log = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap();
            assert_eq!(
                causes(&log),
                vec!["ScanAged"; told],
                "seed {seed}, until {until:?} s"
            );
            assert_eq!(
                log.summary.outcome,
                Outcome::Survived,
                "seed {seed}, until {until:?} s"
            );
        }
    }
}
