use super::*;
use crate::messages::{Quaternion, Vector};

const TICK: i64 = 10_000_000;

fn goal(heading_z: f64, altitude: f64) -> PoseStamped {
    let mut goal = PoseStamped::default();
    goal.header.frame_id = "odom".to_owned();
    goal.pose.position.z = altitude;
    goal.pose.orientation = Quaternion {
        z: heading_z,
        w: (1.0 - heading_z * heading_z).sqrt(),
        ..Quaternion::default()
    };
    goal
}

/// Level flight along the track of `goal(0.0, 50.0)`.
fn odometry(tick: i64) -> Odometry {
    let track = Track::of(&goal(0.0, 50.0)).unwrap();
    let mut odometry = Odometry {
        header: Header::of(tick * TICK, "odom"),
        ..Odometry::default()
    };
    odometry.pose.pose = track.pose(0.12 * tick as f64, 50.0, 0.15);
    odometry.twist.twist.linear = Vector {
        x: 11.5,
        y: 0.0,
        z: -1.7,
    };
    odometry
}

fn scan(tick: i64) -> LaserScan {
    LaserScan {
        header: Header::of(tick * TICK, "lidar_vertical"),
        angle_min: -0.5,
        angle_max: 0.49,
        angle_increment: 0.01,
        range_min: 0.1,
        range_max: 45.0,
        ranges: vec![f32::INFINITY; 100],
        ..LaserScan::default()
    }
}

fn pilot() -> Pilot {
    Pilot::new("mpp", Settings::of(&[]).unwrap())
}

/// A pilot that has flown the first ticks.
fn flying(ticks: i64) -> Pilot {
    let mut pilot = pilot();
    pilot.hear_goal(&goal(0.0, 50.0));
    pilot.hear_scan(&scan(0));
    for tick in 0..ticks {
        assert_eq!(
            setpoints(&pilot.hear_odometry(&odometry(tick))),
            1,
            "{tick}"
        );
    }
    pilot
}

fn setpoints(out: &[Output]) -> usize {
    let is_one = |output: &&Output| matches!(output, Output::Setpoint(_));
    out.iter().filter(is_one).count()
}

fn kinds(pilot: &Pilot) -> Vec<&str> {
    pilot.told.counts().map(|(kind, ..)| kind).collect()
}

fn next(pilot: &Pilot) -> Option<u32> {
    pilot.flight.as_ref().map(|flight| flight.next)
}

#[test]
fn it_waits_for_goal_and_scan_and_says_so() {
    let mut pilot = pilot();
    assert_eq!(setpoints(&pilot.hear_odometry(&odometry(0))), 0);
    pilot.hear_goal(&goal(0.0, 50.0));
    assert_eq!(setpoints(&pilot.hear_odometry(&odometry(1))), 0);
    assert_eq!(kinds(&pilot), ["goal missing", "scan missing"]);
    pilot.hear_scan(&scan(1));
    let mut other = odometry(2);
    other.header.frame_id = "map".to_owned();
    assert_eq!(setpoints(&pilot.hear_odometry(&other)), 0);
    assert_eq!(kinds(&pilot)[0], "goal frame");
    assert_eq!(setpoints(&pilot.hear_odometry(&odometry(3))), 1);
}

#[test]
fn slow_odometry_makes_up_for_ticks_and_fast_one_is_thinned() {
    let mut pilot = flying(10);
    assert_eq!(setpoints(&pilot.hear_odometry(&odometry(13))), 1);
    assert_eq!(next(&pilot), Some(14));
    let mut between = odometry(13);
    between.header = Header::of(13 * TICK + TICK / 4, "odom");
    assert_eq!(setpoints(&pilot.hear_odometry(&between)), 0);
    assert_eq!(next(&pilot), Some(14));
}

#[test]
fn an_old_odometry_is_refused_and_a_hole_or_a_clock_set_back_begins_anew() {
    let mut pilot = flying(10);
    assert!(pilot.hear_odometry(&odometry(9)).is_empty());
    assert_eq!(
        (next(&pilot), kinds(&pilot)),
        (Some(10), vec!["odometry stamp"])
    );
    pilot.hear_scan(&scan(70));
    pilot.hear_odometry(&odometry(70));
    assert_eq!(next(&pilot), Some(1));
    pilot.hear_odometry(&odometry(300));
    pilot.hear_scan(&scan(0));
    pilot.hear_odometry(&odometry(0));
    assert_eq!(next(&pilot), Some(1));
    assert_eq!(kinds(&pilot)[..2], ["odometry clock", "odometry hole"]);
}

#[test]
fn a_scan_of_another_time_is_refused() {
    for stamp in [50, 150] {
        let mut pilot = flying(100);
        pilot.hear_scan(&scan(stamp));
        pilot.hear_odometry(&odometry(100));
        assert_eq!(kinds(&pilot), ["scan stamp"], "{stamp}");
    }
    let mut pilot = flying(100);
    pilot.hear_scan(&scan(95));
    pilot.hear_odometry(&odometry(100));
    let scanned = pilot.flight.as_ref().unwrap().scanned;
    assert_eq!((scanned, kinds(&pilot)), (Some(100), Vec::new()));
}

#[test]
fn another_height_changes_a_flight_and_another_line_ends_it() {
    let mut pilot = flying(10);
    pilot.hear_goal(&goal(0.0, 60.0));
    assert_eq!(next(&pilot), Some(10));
    pilot.hear_goal(&goal(0.0, -5.0));
    assert_eq!(
        (next(&pilot), kinds(&pilot)),
        (Some(10), vec!["goal height"])
    );
    pilot.hear_goal(&goal(0.1, 60.0));
    assert_eq!(next(&pilot), None);
}

#[test]
fn parameters_change_in_flight_and_hold_for_the_next_one() {
    let mut pilot = flying(10);
    let replan = number("MPP_REPLAN_S").unwrap();
    pilot.hear_parameter(replan, 0.25);
    assert_eq!(pilot.settings.replan_ticks(), 25);
    pilot.hear_parameter(replan, -1.0);
    assert_eq!(kinds(&pilot), ["parameter"]);
    pilot.hear_goal(&goal(0.1, 50.0));
    pilot.hear_scan(&scan(10));
    assert_eq!(setpoints(&pilot.hear_odometry(&odometry(10))), 1);
}
