//! Whole flights that keep a way out.

use super::forest::{flown, trunk};
use mpp_sim::outcome::Outcome;
use mpp_sim::space::SpaceFile;
use mpp_sim::space::world::Body;

fn open(seed: u64) -> SpaceFile {
    SpaceFile {
        airspeed: Some(14.0),
        lidar: Some("puck-hi-res".to_owned()),
        mode: Some("open".to_owned()),
        seed: Some(seed),
        ..SpaceFile::default()
    }
}

/// A wall of trunks from side to side 110 m ahead, and one more trunk that makes the world longer. Its only gap lies at the edge,
/// 50 m aside, where no plan reaches.
fn wall() -> Vec<Body> {
    let stands = (0..112).map(|at| trunk(110.0, f64::from(at) - 60.0));
    stands.chain([trunk(240.0, 60.0)]).collect()
}

/// Before what nobody can pass the aircraft waits on circles. Of eight flights one leaves the band, and one meets the wall
/// (decision 76 falls short).
#[test]
fn before_a_wall_the_aircraft_circles() {
    let logs = (1..=8).map(|seed| flown(open(seed), Some(wall())).unwrap());
    let [mut waited, mut met] = [0, 0];
    for log in logs {
        let mut last = log.plans.iter().rev().take(30);
        let known = last.all(|plan| plan.way_out.is_some_and(|time| time > 0.0));
        let turned = log.lateral.course.iter().any(|course| course.abs() > 3.0);
        let to_the_end = (log.summary.t_end - 40.0).abs() < 1e-9;
        let waits = to_the_end && known && turned && log.knows_way_out() > 0.8;
        let outcome = log.summary.outcome;
        waited += usize::from(waits && outcome == Outcome::NotArrived);
        met += usize::from(outcome != Outcome::NotArrived);
    }
    assert!(waited >= 6 && met <= 1, "{waited} {met}");
}

/// Past one trunk in 500 m^2 the aircraft arrives, and most of the time it knows a way out.
#[test]
fn open_country_is_crossed_with_a_way_out() {
    for seed in 30..33 {
        let file = SpaceFile {
            density: Some(0.002),
            ..open(seed)
        };
        let log = flown(file, None).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Survived, "{seed}");
        assert!(log.knows_way_out() > 0.8, "{seed}: {}", log.knows_way_out());
    }
}

#[test]
fn an_unknown_mode_and_one_for_a_baseline_are_refused() {
    let refused = |file: SpaceFile| flown(file, None).unwrap_err();
    let mode = Some("cautious".to_owned());
    assert!(refused(SpaceFile { mode, ..open(1) }).contains("give forest, open"));
    let baseline = Some("straight".to_owned());
    assert!(
        refused(SpaceFile {
            baseline,
            ..open(1)
        })
        .contains("leave candidates, programs and mode out")
    );
}
