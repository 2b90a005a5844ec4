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
/// 50 m aside, where no plan reaches. Campaigns fly it as a stem map:
/// `awk 'BEGIN{print "x,y,diameter"; for(i=-60;i<52;i++) print "110," i ",0.8"; print "240,60,0.8"}' >wall.csv`,
/// `sil-harness campaign --preset space --mode open --airspeed 14 --lidar puck-hi-res --stems wall.csv --trials 24 --seed 1`.
/// Of 120 from seed 1 on 3 collide, of 120 from seed 201 on 1.
fn wall() -> Vec<Body> {
    let stands = (0..112).map(|at| trunk(110.0, f64::from(at) - 60.0));
    stands.chain([trunk(240.0, 60.0)]).collect()
}

/// Before what nobody can pass the aircraft waits on circles, in the band (decision 76).
#[test]
fn before_a_wall_the_aircraft_circles() {
    for seed in 1..=8 {
        let log = flown(open(seed), Some(wall())).unwrap();
        let turned = log.lateral.course.iter().any(|course| course.abs() > 3.0);
        let to_the_end = (log.summary.t_end - 40.0).abs() < 1e-9;
        assert_eq!(log.summary.outcome, Outcome::NotArrived, "{seed}");
        assert!(to_the_end && turned, "{seed}: {turned}");
        assert!(log.knows_way_out() > 0.9, "{seed}: {}", log.knows_way_out());
    }
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

/// Past one trunk in 200 m^2: flights that hit a trunk while windows lay ahead of a heading along x, and plans left their circles.
#[test]
fn an_aircraft_that_turns_back_sees_where_it_flies() {
    for seed in [998_035, 998_589, 998_790] {
        let file = SpaceFile {
            airspeed: Some(13.0),
            density: Some(0.005),
            ..open(seed)
        };
        let log = flown(file, None).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Survived, "{seed}");
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
