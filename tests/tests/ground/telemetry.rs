//! Tests that a station sees what the log holds.

use super::radio::{CONFIG, Radio, command, heard, scenario};
use hil_protocol::LidarScan;
use hil_protocol::mavlink::MessageData;
use hil_protocol::mavlink::messages::*;
use mpp_sim::flight::fly_with;
use mpp_sim::orders::{Ground, Order};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::tick_record::TickRecord;

/// A radio, with the data that plant and core gave.
struct RecordingRadio {
    radio: Radio,
    scans: Vec<LidarScan>,
    knots: Vec<(u32, Vec<[f32; 3]>)>,
    /// Number of cycles that were not done at their deadline.
    missed: usize,
}

impl Ground for RecordingRadio {
    fn begin(
        &mut self,
        tuning: &mpp_node::parameters::Tuning,
        start: &mpp_core::vehicle::VehicleState,
    ) {
        self.radio.begin(tuning, start);
    }

    fn orders(&mut self, tick: u32) -> Vec<Order> {
        self.radio.orders(tick)
    }

    fn watch(&mut self, record: &TickRecord<'_>) {
        self.scans.extend(record.scan.cloned());
        self.knots
            .extend(record.trajectory.map(|t| (t.scan_tick, t.knots.to_vec())));
        self.missed += usize::from(record.report.is_some_and(|report| !report.complete));
        self.radio.watch(record);
    }
}

fn recorded(scenario: &Scenario) -> (RecordingRadio, mpp_sim::log::FlightLog) {
    let mut radio = RecordingRadio {
        radio: Radio::new(&CONFIG),
        scans: Vec::new(),
        knots: Vec::new(),
        missed: 0,
    };
    for id in [
        MPP_LIDAR_SCAN_DATA::ID,
        MPP_PLAN_STATUS_DATA::ID,
        MPP_TRAJECTORY_DATA::ID,
    ] {
        radio.radio.at(0, &command(511, id as f32, 1.0));
    }
    let log = fly_with(scenario, &mut PipeLink::new(), &mut radio).unwrap();
    (radio, log)
}

#[test]
fn scans_and_plans_are_those_of_the_flight() {
    let (
        RecordingRadio {
            radio,
            scans,
            knots,
            ..
        },
        log,
    ) = recorded(&scenario());
    let told = heard!(radio, MPP_LIDAR_SCAN, |scan| scan.clone());
    assert_eq!(told.len(), scans.len());
    for ((_, told), scan) in told.iter().zip(&scans) {
        assert_eq!(
            (told.tick, usize::from(told.count)),
            (scan.tick, scan.ranges.len())
        );
        assert_eq!(told.angle_increment, scan.angle_increment);
        for (range, told) in scan.ranges.iter().zip(&told.ranges) {
            let expected = if *range > 0.0 {
                (range * 100.0).round() as u16
            } else {
                u16::MAX
            };
            assert_eq!(*told, expected);
        }
    }
    let plans = heard!(radio, MPP_PLAN_STATUS, |plan| plan.clone());
    assert_eq!(plans.len(), log.plans.len());
    for ((_, told), plan) in plans.iter().zip(&log.plans) {
        assert_eq!(u64::from(told.scan_tick), plan.tick);
        assert_eq!(Some(u64::from(told.used_from_tick)), plan.used_from_tick);
        assert_eq!(u32::from(told.candidates), plan.candidates);
        assert_eq!(u32::from(told.feasible), plan.feasible);
        assert_eq!(Some(told.cost), plan.cost.map(|cost| cost as f32));
        let names = [
            "Adopted",
            "LeastViolating",
            "KeptPrevious",
            "TrimHold",
            "Pursuit",
            "Reserve",
            "Latest",
        ];
        assert_eq!(names[usize::from(told.outcome)], plan.outcome);
    }
    let trajectories = heard!(radio, MPP_TRAJECTORY, |trajectory| trajectory.clone());
    assert_eq!(trajectories.len(), knots.len());
    for ((_, told), (scan_tick, knots)) in trajectories.iter().zip(&knots) {
        assert_eq!(
            (told.scan_tick, usize::from(told.count)),
            (*scan_tick, knots.len())
        );
        for (place, knot) in knots.iter().enumerate() {
            assert_eq!([told.x[place], told.z[place], told.gamma[place]], *knot);
            // The log samples the same trajectory at the knots that were flown.
            // A plan of preset `flight` starts where it is taken over, a tick after its scan.
            let tick = *scan_tick as usize + 1 + 25 * place;
            let flown = place > 0 && place < 4 && tick < log.ticks.t.len();
            if flown
                && log
                    .plans
                    .iter()
                    .all(|plan| plan.used_from_tick != Some(tick as u64))
            {
                let reference = log.ticks.ref_z[tick].unwrap();
                assert!((reference - f64::from(knot[1])).abs() < 1e-4, "{tick}");
            }
        }
    }
}

#[test]
fn motion_is_that_of_the_log() {
    let (RecordingRadio { radio, .. }, log) = recorded(&scenario());
    let positions = heard!(radio, LOCAL_POSITION_NED, |position| position.clone());
    assert_eq!(positions.len(), 120);
    for (tick, told) in positions {
        let row = tick as usize;
        assert_eq!(told.time_boot_ms, 10 * tick);
        assert_eq!(
            (told.x, told.z),
            (log.ticks.est_x[row] as f32, -log.ticks.est_z[row] as f32)
        );
        // The velocity through the air and the estimated wind.
        let (up, ahead) = libm::sincos(log.ticks.est_flight_path[row]);
        let airspeed = log.ticks.est_airspeed[row];
        let over_ground = (
            airspeed * ahead + log.ticks.est_wind_x[row],
            airspeed * up + log.ticks.est_wind_z[row],
        );
        assert!((f64::from(told.vx) - over_ground.0).abs() < 1e-4);
        assert!((f64::from(-told.vz) - over_ground.1).abs() < 1e-4);
    }
    let attitudes = heard!(radio, ATTITUDE, |attitude| attitude.pitch);
    for (tick, pitch) in attitudes {
        assert_eq!(pitch, log.ticks.est_pitch[tick as usize] as f32);
    }
}

/// The field is a wall, so there are cycles without a feasible candidate.
#[test]
fn every_cycle_without_a_feasible_plan_is_told() {
    let dense = Scenario {
        obstacles: 60,
        ticks: 1200,
        ..Scenario::new(Preset::Paper, 1)
    };
    let (RecordingRadio { radio, .. }, log) = recorded(&dense);
    let without = log
        .plans
        .iter()
        .filter(|plan| plan.outcome != "Adopted")
        .count();
    let told = radio
        .texts()
        .iter()
        .filter(|(_, text)| text.contains("feasible"))
        .count();
    assert!(without > 0);
    assert_eq!(told, without);

    let starved = Scenario {
        slices_per_tick: 10,
        latency_ticks: 20,
        ticks: 1200,
        ..Scenario::new(Preset::Paper, 1)
    };
    let (RecordingRadio { radio, missed, .. }, _) = recorded(&starved);
    let told = radio
        .texts()
        .iter()
        .filter(|(_, text)| text.contains("deadline"))
        .count();
    assert!(missed > 0);
    assert_eq!(told, missed);
}

#[test]
fn the_distance_is_the_nearest_return() {
    let (RecordingRadio { radio, scans, .. }, _) = recorded(&scenario());
    let told = heard!(radio, DISTANCE_SENSOR, |distance| distance.current_distance);
    assert_eq!(told.len(), scans.len());
    for ((_, told), scan) in told.into_iter().zip(&scans) {
        let nearest = scan
            .ranges
            .iter()
            .copied()
            .filter(|range| *range > 0.0)
            .reduce(f32::min);
        let expected = nearest.map_or(told, |range| (range * 100.0).round() as u16);
        assert_eq!(told, expected);
    }
}
