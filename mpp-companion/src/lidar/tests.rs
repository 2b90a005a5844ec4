//! Datagrams byte by byte from the document's table, messages, and the scans that come of them.

use super::*;
use crate::stand_in::flight::rig::{datagram, point};
use mavlink::dialects::common::MavFrame;

const WANTED: Wanted = Wanted {
    body: 0.6,
    range: 70.0,
    beams: 101,
};
const LIVOX: ScanSource = ScanSource::Livox(Mounting::SIDE, 2.0);

/// The range of the beam at this angle against the body axis \[deg\].
fn range(scan: &LidarScan, degrees: i32) -> f32 {
    scan.ranges[(degrees + 50) as usize]
}

/// Sets the checksum: CRC-32 bit by bit.
fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut sum = u32::MAX;
    for byte in &bytes[28..] {
        sum ^= u32::from(*byte);
        for _ in 0..8 {
            sum = (sum >> 1) ^ (0xEDB8_8320 * (sum & 1));
        }
    }
    bytes[24..28].copy_from_slice(&(!sum).to_le_bytes());
    bytes
}

/// A Mid-360 that sends these points each 5 ms up to a time \[us\], but for some of the datagrams.
fn heard(points: &[Vec<u8>], to: u64, pose: &Pose, lost: impl Fn(u64) -> bool) -> Lidar {
    let mut lidar = Lidar::new(LIVOX, WANTED).unwrap();
    for count in (0..=to / 5000).filter(|count| !lost(*count)) {
        let bytes = datagram(count as u16, 5_000_000 * count, 1, points);
        lidar.receive(5000 * count, &bytes, Some(pose));
    }
    lidar
}

#[test]
fn the_three_kinds_of_point_say_the_same_place() {
    // 3 m ahead, 4 m to the left and 12 m up: 13 m away, 22.62 deg from the zenith, 53.13 deg to the left.
    let round = [0xC8, 0x32, 0, 0, 0xD6, 0x08, 0xC1, 0x14, 90, 0];
    let points = [
        (1, point([3.0, -4.0, -12.0], 0)),
        (2, vec![0x2C, 1, 0x90, 1, 0xB0, 4, 90, 0]),
        (3, round.to_vec()),
    ];
    for (data_type, point) in points {
        let bytes = summed(datagram(7, 5000, data_type, &[point]));
        let packet = Packet::read(&bytes).unwrap();
        assert_eq!((packet.count, packet.taken, packet.lasted), (7, 5, 5000));
        let seen: Vec<_> = packet.returns().collect();
        let off = [0, 1, 2].map(|axis| (seen[0][axis] - [3.0, -4.0, -12.0][axis]).abs());
        assert!(
            off.iter().all(|off| *off < 2e-3) && seen.len() == 1,
            "{seen:?}"
        );
    }
    // A beam without a return, and low confidence in the third property.
    let points = [(0, 0.0), (0b10_0101, 2.0), (0b01_0101, 3.0)];
    let points = points.map(|(tag, ahead)| point([ahead, 0.0, 0.0], tag));
    let bytes = datagram(0, 0, 1, &points);
    assert_eq!(Packet::read(&bytes).unwrap().returns().count(), 1);
}

#[test]
fn bad_datagrams_are_refused_and_counted() {
    let good = summed(datagram(1, 5, 1, &[point([9.0, 0.0, 0.0], 0)]));
    let with = |at: usize, value: u8| {
        let mut bytes = good.clone();
        bytes[at] = value;
        bytes
    };
    let mut lidar = Lidar::new(LIVOX, WANTED).unwrap();
    for (bytes, why) in [
        (
            good[..35].to_vec(),
            "35 bytes are no point data of a Mid-360",
        ),
        (
            good[..49].to_vec(),
            "49 bytes came, the header says 50 with 1 points",
        ),
        (
            with(5, 2),
            "50 bytes came, the header says 50 with 2 points",
        ),
        (with(0, 1), "version is 1: it must be 0"),
        (with(10, 0), "data type is 0: it must be 1, 2 or 3"),
        (with(11, 3), "time type is 3: it must be 0, 1 or 2"),
        (with(40, 1), "the checksum is wrong"),
    ] {
        lidar.receive(0, &bytes, Some(&Pose::LEVEL));
        let told = format!("lidar messages: 0 lost, 0 late, 1 refused, the last one: {why}");
        assert_eq!((lidar.trouble(), lidar.heard), (Some(told), None));
    }
    // No bytes bring it down.
    for (at, size) in (0..50).flat_map(|at| (0..=50).map(move |size| (at, size))) {
        lidar.receive(1, &with(at, !good[at])[..size], Some(&Pose::LEVEL));
    }
}

#[test]
fn the_slice_is_the_vertical_plane_ahead() {
    // On its right side the sensor's left is up. What is aside, or within the aircraft, is none.
    let places = [
        [10.0, 0.0, 0.0],
        [10.0, -10.0, 0.0],
        [5.0, 5.0, -4.0],
        [0.3, 0.0, 0.0],
    ];
    let points = places.map(|place| point(place, 0));
    let mut lidar = heard(&points, 200_000, &Pose::LEVEL, |_| false);
    let (age, scan) = lidar.take(200_000, 190_000, Some(&Pose::LEVEL)).unwrap();
    assert_eq!((age, scan.ranges.len(), lidar.trouble()), (0, 101, None));
    assert!((range(&scan, 0) - 10.0).abs() < 1e-3);
    let up = range(&scan, 45).max(range(&scan, 46));
    assert!((up - 14.142).abs() < 1e-3 && range(&scan, -39).abs() < 1e-9);
    let met = scan.ranges.iter().filter(|range| **range > 0.0).count();
    assert!((2..=4).contains(&met) && scan.ranges.iter().all(|range| *range >= 0.0));
}

#[test]
fn a_scan_is_turned_back_and_moved_to_the_time_of_the_attitude() {
    // Banked, nose up by 10 deg, 30 deg to the right of the course. An obstacle is 30 m along it.
    let angles = [0.2, 10_f64.to_radians(), 30_f64.to_radians()];
    let pose = Pose {
        attitude: Rotation::new(angles),
        pitch: angles[1],
        velocity: [20.0, 0.0],
    };
    let seen = Mounting::SIDE
        .rotation()
        .back(pose.attitude.back([30.0, 0.0, 0.0]));
    let mut lidar = heard(&[point(seen, 0)], 95_000, &pose, |_| false);
    let (_, scan) = lidar.take(100_000, 145_000, Some(&pose)).unwrap();
    // The oldest return is the nearest by now.
    let found = range(&scan, -10);
    assert!((found - (30.0 - 20.0 * 0.145)).abs() < 0.01, "{found}");
}

#[test]
fn a_hole_in_the_points_is_no_air() {
    let points = [point([10.0, 0.0, 0.0], 0)];
    let scanned = |to, lost: &dyn Fn(u64) -> bool| {
        let mut lidar = heard(&points, to, &Pose::LEVEL, lost);
        let scan = lidar.take(200_000, 200_000, Some(&Pose::LEVEL));
        (scan.is_some(), lidar.trouble())
    };
    let told = |lost| Some(format!("lidar messages: {lost} lost, 0 late, 0 refused"));
    assert_eq!(scanned(200_000, &|count| count == 30), (true, told(1)));
    assert_eq!(scanned(200_000, &|count| count % 4 == 0), (false, told(9)));
    assert_eq!(scanned(200_000, &|count| count >= 20), (false, None));
    assert_eq!(scanned(50_000, &|_| false), (false, None));
    // Repeated, and 250 ms in a queue.
    let mut lidar = heard(&points, 200_000, &Pose::LEVEL, |_| false);
    for (count, taken) in [(40, 200_000_000), (41, 205_000_000)] {
        lidar.receive(
            455_000,
            &datagram(count, taken, 1, &points),
            Some(&Pose::LEVEL),
        );
    }
    let late = "lidar messages: 0 lost, 1 late, 0 refused".to_owned();
    assert_eq!((lidar.heard, lidar.trouble()), (Some(200_000), Some(late)));
}

#[test]
fn distances_fill_their_whole_step_and_what_is_not_told_is_not_air() {
    let mut lidar = Lidar::new(ScanSource::Obstacles(Mounting::SIDE), WANTED).unwrap();
    // From 36 deg up to 36 deg down in steps of 2 deg: air, but for an obstacle 20 deg below the axis.
    let mut told = OBSTACLE_DISTANCE_DATA {
        time_usec: 5,
        distances: [u16::MAX; 72],
        max_distance: 7000,
        increment_f: 2.0,
        angle_offset: -36.0,
        frame: MavFrame::MAV_FRAME_BODY_FRD,
        ..OBSTACLE_DISTANCE_DATA::DEFAULT
    };
    told.distances[..37].fill(7001);
    told.distances[28] = 2500;
    let frame = crate::wire::Sender::new(1, 196).frame(&Mav::OBSTACLE_DISTANCE(told.clone()));
    for torn in frame.chunks(40) {
        lidar.receive(0, torn, Some(&Pose::LEVEL));
    }
    let (_, scan) = lidar.take(0, 0, Some(&Pose::LEVEL)).unwrap();
    let centimetres = |degrees| (100.0 * range(&scan, degrees)).round() as i32;
    assert_eq!([-21, -20, -19].map(centimetres), [2500; 3]);
    assert_eq!([0, -23, 36].map(centimetres), [0; 3]);
    assert_eq!([39, -50].map(centimetres), [-100; 2]);

    let mut refused = |change: &dyn Fn(&mut OBSTACLE_DISTANCE_DATA)| {
        change(&mut told);
        lidar.hear(9, &told, Some(&Pose::LEVEL));
        lidar.trouble().is_some_and(|it| it.contains("1 refused")) && lidar.heard == Some(0)
    };
    assert!(refused(&|_| ()), "the same distances again");
    for (distance, width) in [(1, f32::NAN), (2, 0.0), (3, 91.0)] {
        assert!(refused(&|told| {
            told.distances[3] = distance;
            told.increment_f = width;
        }));
    }
    assert!(refused(&|told| {
        told.distances[3] = 4;
        told.frame = MavFrame::MAV_FRAME_GLOBAL;
    }));
}

#[test]
fn a_sensor_that_does_not_see_the_vertical_plane_is_refused() {
    for (mounting, fits) in [
        ("90,0,0", true),
        ("-90, 0, 0", true),
        ("80,0,0", true),
        ("0,0,0", false),
        ("90,0,90", false),
        ("0,90,0", false),
    ] {
        let mounting: Mounting = mounting.parse().unwrap();
        for source in [
            ScanSource::Livox(mounting, 2.0),
            ScanSource::Obstacles(mounting),
        ] {
            let unseen = matches!(Lidar::new(source, WANTED), Err(CompanionError::Unseen(..)));
            assert_eq!(unseen, !fits, "{source:?}");
        }
    }
    for text in ["", "90", "90,0", "90,0,0,0", "90,0,x", "90,0,inf"] {
        assert!(text.parse::<Mounting>().is_err(), "{text}");
    }
    for slice in [0.0, 31.0, f64::NAN] {
        let refused = Lidar::new(ScanSource::Livox(Mounting::SIDE, slice), WANTED);
        assert!(matches!(refused, Err(CompanionError::Mounting(_))));
    }
}
