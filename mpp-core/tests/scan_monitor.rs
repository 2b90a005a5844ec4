//! Tests what the monitor of the scans holds against a lidar, and what not.

use mpp_core::map::{Predictions, ScanMonitor, ScanVerdict};
use mpp_core::sense::LidarScan;
use mpp_core::tuning::scan_match::AGES;
use mpp_core::vehicle::Pose;

const SIGHT: f64 = 45.0;
const BEAMS: usize = 100;
/// Circles of 1 m radius ahead, above and below the way.
const FIELD: [(f64, f64, f64); 4] = [
    (22.0, 45.0, 1.0),
    (28.0, 53.0, 1.0),
    (31.0, 48.0, 1.0),
    (36.0, 56.0, 1.0),
];

fn pose(x: f64) -> Pose {
    Pose {
        x,
        z: 50.0,
        pitch: 0.156,
    }
}

/// What a lidar of 100 beams over 100 deg sees of circles.
fn seen(circles: &[(f64, f64, f64)], pose: &Pose) -> LidarScan {
    let mut scan = LidarScan::new();
    scan.angle_min = -50_f64.to_radians();
    scan.angle_increment = 100_f64.to_radians() / (BEAMS - 1) as f64;
    for beam in 0..BEAMS {
        let (up, ahead) = libm::sincos(pose.pitch + scan.beam_angle(beam));
        let ranges = circles.iter().filter_map(|(x, z, radius)| {
            let (dx, dz) = (x - pose.x, z - pose.z);
            let (along, aside) = (dx * ahead + dz * up, dz * ahead - dx * up);
            let chord = radius * radius - aside * aside;
            (along > 0.0 && chord >= 0.0).then(|| along - chord.sqrt())
        });
        let range = ranges.fold(f64::INFINITY, f64::min);
        let range = if range < SIGHT { range as f32 } else { 0.0 };
        assert!(scan.ranges.push(range).is_ok());
    }
    scan
}

fn check(
    monitor: &mut ScanMonitor,
    x: f64,
    spoil: impl Fn(&mut LidarScan),
) -> (ScanVerdict, LidarScan) {
    let mut scan = seen(&FIELD, &pose(x));
    spoil(&mut scan);
    let verdict = monitor.check(&mut scan, SIGHT, &[pose(x); AGES], &mut Predictions::new());
    (verdict, scan)
}

fn reverse(scan: &mut LidarScan) {
    scan.ranges.reverse();
}

fn darken(scan: &mut LidarScan) {
    scan.ranges
        .iter_mut()
        .take(BEAMS / 2)
        .for_each(|it| *it = 0.0);
}

#[test]
fn a_lidar_that_works_is_believed() {
    for step in [3.0, 6.0, 12.0] {
        let mut monitor = ScanMonitor::new();
        for number in 0..(40.0 / step) as i32 {
            let x = step * f64::from(number);
            let (verdict, scan) = check(&mut monitor, x, |_| {});
            assert_eq!(verdict, ScanVerdict::Agrees, "{x}");
            assert_eq!(scan.ranges, seen(&FIELD, &pose(x)).ranges);
        }
    }
}

#[test]
fn a_silent_half_is_found_at_once_and_shows_nothing_until_it_returns() {
    let mut monitor = ScanMonitor::new();
    check(&mut monitor, 0.0, |_| {});
    for x in [3.0, 6.0] {
        let (verdict, scan) = check(&mut monitor, x, darken);
        assert_eq!(verdict, ScanVerdict::Silent);
        let bad = scan.bad_beams();
        assert!((10..=BEAMS / 2).contains(&bad), "{bad}");
        assert!(
            scan.ranges
                .iter()
                .skip(BEAMS / 2)
                .all(|range| *range >= 0.0)
        );
    }
    let (verdict, scan) = check(&mut monitor, 9.0, |_| {});
    assert_eq!((verdict, scan.bad_beams()), (ScanVerdict::Agrees, 0));
}

/// An empty scan may come from a lidar that is silent altogether, one that sees near things alone from fog. The next scan decides.
#[test]
fn a_silent_half_is_told_from_a_silent_lidar_and_from_fog_by_what_returns_later() {
    let field = [(15.0, 54.5, 1.0), (31.0, 46.0, 1.0), (36.0, 60.0, 1.0)];
    let empty = |scan: &mut LidarScan| scan.ranges.fill(0.0);
    let fog = |scan: &mut LidarScan| {
        for range in scan.ranges.iter_mut().filter(|range| **range > 20.0) {
            *range = 0.0;
        }
    };
    let firsts: [(fn(&mut LidarScan), _); 2] =
        [(empty, ScanVerdict::Silent), (fog, ScanVerdict::Short)];
    for (first, verdict) in firsts {
        for (then, hidden) in [(darken as fn(&mut LidarScan), true), (|_| {}, false)] {
            let mut monitor = ScanMonitor::new();
            let mut check = |x: f64, spoil: fn(&mut LidarScan)| {
                let mut scan = seen(&field, &pose(x));
                spoil(&mut scan);
                let verdict =
                    monitor.check(&mut scan, SIGHT, &[pose(x); AGES], &mut Predictions::new());
                (verdict, monitor.hides_below(&scan))
            };
            check(0.0, |_| {});
            assert_eq!(check(3.0, first), (verdict, false));
            let (verdict, below) = check(6.0, then);
            assert_eq!((verdict == ScanVerdict::Silent, below), (hidden, hidden));
        }
    }
}

#[test]
fn beams_in_reverse_order_are_put_right_until_they_come_as_sent() {
    let mut monitor = ScanMonitor::new();
    check(&mut monitor, 0.0, |_| {});
    for x in [3.0, 6.0] {
        let (verdict, scan) = check(&mut monitor, x, reverse);
        assert_eq!(verdict, ScanVerdict::Reversed, "{x}");
        // A wrong pitch may make one scan fit so, and then its order is right.
        let right = seen(&FIELD, &pose(x)).ranges;
        assert_eq!(scan.ranges.is_empty(), x < 6.0);
        assert!(scan.ranges.is_empty() || scan.ranges == right);
    }
    check(&mut monitor, 9.0, |_| {});
    let (verdict, scan) = check(&mut monitor, 12.0, |_| {});
    assert_eq!((verdict, scan.ranges.len()), (ScanVerdict::Agrees, BEAMS));
}

#[test]
fn beams_in_reverse_order_from_the_start_are_found_by_the_second_scan() {
    let mut monitor = ScanMonitor::new();
    check(&mut monitor, 0.0, reverse);
    let (verdict, _) = check(&mut monitor, 12.0, reverse);
    assert_eq!(verdict, ScanVerdict::ReversedBefore);
}

#[test]
fn fog_shortens_the_sight_until_a_beam_returns_from_farther() {
    let fog = |scan: &mut LidarScan| {
        for range in scan.ranges.iter_mut().filter(|range| **range > 24.0) {
            *range = 0.0;
        }
    };
    let mut monitor = ScanMonitor::new();
    check(&mut monitor, 0.0, |_| {});
    assert!((monitor.sight(SIGHT) - SIGHT).abs() < 1e-9);
    let (verdict, _) = check(&mut monitor, 3.0, fog);
    assert_eq!(verdict, ScanVerdict::Short);
    assert!(
        (20.0..30.0).contains(&monitor.sight(SIGHT)),
        "{}",
        monitor.sight(SIGHT)
    );
    check(&mut monitor, 6.0, |_| {});
    assert!((monitor.sight(SIGHT) - SIGHT).abs() < 1e-9);
}

/// The next scan may look past a wire that one beam has met.
#[test]
fn a_wire_that_is_not_met_again_is_no_sign() {
    let wires = [0, 1, 2, 3].map(|number| (20.0 + 3.0 * f64::from(number), 48.0, 0.02));
    let mut monitor = ScanMonitor::new();
    for (x, shown) in [(0.0, &wires[..]), (3.0, &[]), (6.0, &wires[..]), (9.0, &[])] {
        let verdict = monitor.check(
            &mut seen(shown, &pose(x)),
            SIGHT,
            &[pose(x); AGES],
            &mut Predictions::new(),
        );
        assert_eq!(verdict, ScanVerdict::Agrees, "{x}");
    }
}

#[test]
fn a_monitor_that_forgets_holds_nothing_against_the_lidar() {
    let mut monitor = ScanMonitor::new();
    check(&mut monitor, 0.0, |_| {});
    monitor.clear();
    assert_eq!(check(&mut monitor, 3.0, reverse).0, ScanVerdict::Agrees);
}

/// A wrong pitch moves all returns by as many beams. The lidar is not the culprit then.
#[test]
fn a_wrong_pitch_is_not_held_against_the_lidar() {
    for error in [-12.0_f64, -6.0, 6.0, 12.0] {
        let mut monitor = ScanMonitor::new();
        check(&mut monitor, 0.0, |_| {});
        let told = pose(3.0);
        let pitch = told.pitch + error.to_radians();
        let mut scan = seen(&FIELD, &Pose { pitch, ..told });
        let verdict = monitor.check(&mut scan, SIGHT, &[told; AGES], &mut Predictions::new());
        assert_eq!(
            (verdict, scan.bad_beams()),
            (ScanVerdict::Agrees, 0),
            "{error}"
        );
    }
}

/// The pose of an aircraft that turns up and down, at a time \[s\].
fn turning(time: f64) -> Pose {
    let turn = 0.25 * libm::sin(2.0 * time);
    Pose {
        x: 12.0 * time,
        z: 50.0 - 1.5 * libm::cos(2.0 * time),
        pitch: 0.156 + turn,
    }
}

/// The ages \[ms\] that a monitor believes in after each of 40 scans at 4 Hz, of the true ages \[ms\]. `course` gives the pose at a
/// time, `known` the poses of a time by which the monitor judges.
fn ages_found(
    age: impl Fn(usize) -> f64,
    course: impl Fn(f64) -> Pose,
    known: impl Fn(f64) -> [Pose; AGES],
) -> Vec<usize> {
    let circles: Vec<_> = (0..24)
        .map(f64::from)
        .map(|number| {
            (
                15.0 + 6.0 * number,
                50.0 + 9.0 * libm::sin(2.4 * number),
                1.0,
            )
        })
        .collect();
    let mut monitor = ScanMonitor::new();
    let after = |number: usize| {
        let time = 0.25 * number as f64;
        let mut scan = seen(&circles, &course(time - 0.001 * age(number)));
        monitor.check(&mut scan, SIGHT, &known(time), &mut Predictions::new());
        100 * monitor.age()
    };
    (0..40).map(after).collect()
}

/// The poses of the stamp, and before it.
fn past(course: impl Fn(f64) -> Pose, time: f64) -> [Pose; AGES] {
    std::array::from_fn(|number| course(time - 0.1 * number as f64))
}

#[test]
fn the_age_that_stamps_hide_is_found_in_turns_and_its_end_too() {
    let known = |time| past(turning, time);
    assert_eq!(ages_found(|_| 0.0, turning, known), [0; 40]);
    for age in [100, 200] {
        let found = ages_found(|_| f64::from(age), turning, known);
        let first = found.iter().position(|it| *it > 0).unwrap();
        assert!(first <= 8, "{age} ms is found by scan {first}");
        assert!(
            found.iter().skip(first).all(|it| *it == age as usize),
            "{found:?}"
        );
    }
    let ends = |number: usize| if number < 20 { 100.0 } else { 0.0 };
    let found = ages_found(ends, turning, known);
    assert_eq!((found[19], found[39]), (100, 0), "{found:?}");
}

/// On a steady course scans of every age look alike, and without earlier poses there is nothing to compare.
#[test]
fn no_age_is_found_that_nothing_shows() {
    let steady = |time: f64| pose(12.0 * time);
    assert_eq!(
        ages_found(|_| 100.0, steady, |time| past(steady, time)),
        [0; 40]
    );
    assert_eq!(
        ages_found(|_| 100.0, turning, |time| [turning(time); AGES]),
        [0; 40]
    );
}

/// A pose that jumps once, or a pitch that is wrong all the time, is no age.
#[test]
fn a_wrong_pose_is_no_age() {
    let off = |by: f64| {
        move |time: f64| {
            past(turning, time).map(|it| Pose {
                pitch: it.pitch + by,
                ..it
            })
        }
    };
    assert_eq!(ages_found(|_| 0.0, turning, off(0.04)), [0; 40]);
    let jumps = |time: f64| off(if (3.9..4.1).contains(&time) { 0.1 } else { 0.0 })(time);
    assert_eq!(ages_found(|_| 0.0, turning, jumps), [0; 40]);
}
