//! Requests that anybody may make, and every message that can be sent on request.

use super::commands::{CUSTOM_MODE, mode_number};
use super::demands::Address;
use super::severity::Severity;
use super::tlog::EPOCH_US;
use super::vehicle::Vehicle;
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{Frame, MessageData};
use hil_protocol::{PlanOutcome, PlanReport, PlanTrajectory};
use mpp_sim::orders::Mode;
use mpp_sim::tick_record::TickRecord;

/// MAV_TYPE_FIXED_WING.
const FIXED_WING: u8 = 1;
/// MAV_AUTOPILOT_GENERIC.
const GENERIC: u8 = 0;
/// MAV_STATE_STANDBY and MAV_STATE_ACTIVE.
const STATES: [u8; 2] = [3, 4];
/// MAV_MODE_FLAG: custom mode and stabilised. `AUTO` means that the vehicle flies its own plan.
const MODE_FLAGS: u8 = CUSTOM_MODE | 16;
const AUTO: u8 = 4;
/// MAV_MODE_FLAG_SAFETY_ARMED.
const ARMED: u8 = 128;
/// MAV_PROTOCOL_CAPABILITY: missions in integers, COMMAND_INT, termination, MAVLink 2.
const CAPABILITIES: u64 = 4 | 8 | 2048 | 8192;
/// MAV_PROTOCOL_CAPABILITY: whole parameters as the bytes of an integer, or all of them as plain floats.
const PARAMETERS_BYTEWISE: u64 = 16;
const PARAMETERS_AS_FLOATS: u64 = 131_072;
/// Number of beams in an [`MPP_LIDAR_SCAN_DATA`].
const BEAMS: usize = MPP_LIDAR_SCAN_DATA::DEFAULT.ranges.len();

impl Vehicle {
    /// Answers requests that change nothing.
    pub(super) fn handle_inquiry(&mut self, frame: &Frame<'_>, from: Address) {
        if let Some(request) = frame.decode::<PARAM_REQUEST_LIST_DATA>() {
            if self.is_target(request.target_system, request.target_component) {
                self.list_parameters();
            }
        } else if let Some(request) = frame.decode::<PARAM_REQUEST_READ_DATA>() {
            if self.is_target(request.target_system, request.target_component) {
                self.read_parameter(&request);
            }
        } else if let Some(request) = frame.decode::<FILE_TRANSFER_PROTOCOL_DATA>() {
            self.answer_file_request(&request, from);
        } else if let Some(request) = frame.decode::<LOG_REQUEST_LIST_DATA>() {
            self.list_logs(&request);
        } else if let Some(ping) = frame.decode::<PING_DATA>() {
            // A ping with a target is an answer.
            if ping.target_system == 0 && ping.target_component == 0 {
                self.send(&PING_DATA {
                    target_system: from.system,
                    target_component: from.component,
                    ..ping
                });
            }
        } else if let Some(sync) = frame.decode::<TIMESYNC_DATA>() {
            // A message with another `tc1` is an answer.
            if sync.tc1 == 0 && self.is_target(sync.target_system, sync.target_component) {
                self.send(&TIMESYNC_DATA {
                    // An answer must not look like a question, not even at the start.
                    tc1: (i64::from(self.milliseconds()) * 1_000_000).max(1),
                    ts1: sync.ts1,
                    target_system: from.system,
                    target_component: from.component,
                });
            }
        } else {
            self.answer_mission(frame, from);
        }
    }

    /// Sends a message with the present values. Returns `false` if this message cannot be
    /// requested.
    pub(super) fn send_by_id(&mut self, id: u32) -> bool {
        match id {
            HEARTBEAT_DATA::ID => self.send_heartbeat(),
            SYS_STATUS_DATA::ID => self.send_system_status(),
            SYSTEM_TIME_DATA::ID => self.send(&SYSTEM_TIME_DATA {
                time_unix_usec: EPOCH_US + self.microseconds(),
                time_boot_ms: self.milliseconds(),
            }),
            PROTOCOL_VERSION_DATA::ID => self.send(&PROTOCOL_VERSION_DATA {
                version: 200,
                min_version: 200,
                max_version: 200,
                ..PROTOCOL_VERSION_DATA::DEFAULT
            }),
            _ => return self.send_motion(id) || self.send_status(id) || self.repeat(id),
        }
        true
    }

    pub(super) fn report_plan(&mut self, report: &PlanReport) {
        let count = report.candidates;
        let line = match report.outcome {
            PlanOutcome::Adopted => None,
            PlanOutcome::LeastViolating => {
                Some(format!("None of {count} feasible: least violating"))
            }
            PlanOutcome::KeptPrevious => Some(format!("None of {count} feasible: last plan kept")),
            PlanOutcome::TrimHold => Some(format!("None of {count} feasible: straight and level")),
            PlanOutcome::Pursuit => Some(format!("None of {count} passes the gate: pursuit")),
            PlanOutcome::Reserve => Some(format!("None of {count} passes the gate: reserve")),
            PlanOutcome::Latest => Some("Nothing passes the gate: what strikes latest".to_owned()),
        };
        if let Some(line) = line {
            self.say(Severity::Warning, &line);
        }
        if !report.complete {
            let line = format!("Planner deadline missed, {} slices used", report.slices);
            self.say(Severity::Warning, &line);
        }
        let message = MPP_PLAN_STATUS_DATA {
            time_boot_ms: self.milliseconds(),
            scan_tick: report.scan_tick,
            used_from_tick: report.used_from_tick,
            slices: report.slices,
            cost: report.cost as f32,
            violation: report.violation as f32,
            candidates: report.candidates,
            feasible: report.feasible,
            tree_runs: report.tree_runs,
            outcome: report.outcome as u8,
            complete: u8::from(report.complete),
        };
        self.send_event(&message);
        self.last.plan = Some(message);
    }

    pub(super) fn send_heartbeat(&mut self) {
        let armed = if self.armed { ARMED } else { 0 };
        let by_plan = if self.mode == Mode::Auto { AUTO } else { 0 };
        self.send(&HEARTBEAT_DATA {
            custom_mode: mode_number(self.mode),
            mavtype: FIXED_WING,
            autopilot: GENERIC,
            base_mode: MODE_FLAGS | by_plan | armed,
            system_status: STATES[usize::from(self.armed)],
            mavlink_version: MINOR_MAVLINK_VERSION,
        });
    }

    /// Tells a station what the vehicle can do. From here on the station knows that whole parameters come as integers;
    /// one that never asks gets every parameter as a float.
    pub(super) fn tell_version(&mut self, from: Address) {
        let own = self.channels.own(from);
        let typed = own.is_some_and(|channel| {
            channel.typed = true;
            true
        });
        let form = if typed {
            PARAMETERS_BYTEWISE
        } else {
            PARAMETERS_AS_FLOATS
        };
        let part = |text: &str| text.parse().unwrap_or(0_u8);
        let version = [
            0,
            part(env!("CARGO_PKG_VERSION_PATCH")),
            part(env!("CARGO_PKG_VERSION_MINOR")),
            part(env!("CARGO_PKG_VERSION_MAJOR")),
        ];
        let message = AUTOPILOT_VERSION_DATA {
            capabilities: CAPABILITIES | form,
            flight_sw_version: u32::from_le_bytes(version),
            uid: u64::from(self.system),
            ..AUTOPILOT_VERSION_DATA::DEFAULT
        };
        // What is true for this station is not for others.
        self.send_to_station(&message, from);
    }

    pub(super) fn report_scan(&mut self, record: &TickRecord<'_>) {
        let (Some(scan), Some(tuning)) = (record.scan, self.tuning) else {
            return;
        };
        let centimetres = |metres: f32| (metres * 100.0).round() as u16;
        let reach = centimetres(tuning.configure.range_max);
        let returns = scan.ranges.iter().copied().filter(|range| *range > 0.0);
        let nearest = returns.reduce(f32::min).map(centimetres);
        // A scan with more beams than the message is thinned out evenly.
        let stride = scan.ranges.len().div_ceil(BEAMS).max(1);
        let mut message = MPP_LIDAR_SCAN_DATA {
            time_boot_ms: self.milliseconds(),
            tick: scan.tick,
            angle_min: scan.angle_min,
            angle_increment: scan.angle_increment * stride as f32,
            range_max: reach,
            ranges: [u16::MAX; BEAMS],
            ..MPP_LIDAR_SCAN_DATA::DEFAULT
        };
        for (place, range) in message
            .ranges
            .iter_mut()
            .zip(scan.ranges.iter().step_by(stride))
        {
            message.count += 1;
            if *range > 0.0 {
                *place = centimetres(*range);
            }
        }
        self.send_event(&message);
        self.last.scan = Some(message);
        let beams = scan.ranges.len().saturating_sub(1) as f32;
        self.send_event(&DISTANCE_SENSOR_DATA {
            time_boot_ms: self.milliseconds(),
            min_distance: 0,
            max_distance: reach,
            // A value beyond the greatest range means that nothing is there.
            current_distance: nearest.unwrap_or(reach.saturating_add(1)),
            covariance: u8::MAX,
            vertical_fov: beams * scan.angle_increment,
            ..DISTANCE_SENSOR_DATA::DEFAULT
        });
    }

    pub(super) fn send_trajectory(&mut self, trajectory: &PlanTrajectory) {
        let mut message = MPP_TRAJECTORY_DATA {
            time_boot_ms: self.milliseconds(),
            scan_tick: trajectory.scan_tick,
            dt: trajectory.period,
            count: trajectory.knots.len() as u8,
            ..MPP_TRAJECTORY_DATA::DEFAULT
        };
        let places = message
            .x
            .iter_mut()
            .zip(&mut message.z)
            .zip(&mut message.gamma);
        for (((x, z), gamma), knot) in places.zip(&trajectory.knots) {
            [*x, *z, *gamma] = *knot;
        }
        self.send_event(&message);
        self.last.trajectory = Some(message);
    }
}
