//! Errors as codes, with texts.

use core::ffi::{CStr, c_char};
use hil_protocol::ConfigureVerdict;
use mpp_core::planner::SetupError;
use mpp_core::sense::ScanError;
use mpp_core::settings::Setting;

/// The result of a call. Every result but `Ok` leaves the core as it was; only a refused `mpp_set_up` leaves it
/// without a configuration.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MppStatus {
    /// The call did what it says.
    Ok = 0,
    /// A pointer is null.
    Null = 1,
    /// The storage is too small.
    Storage = 2,
    /// The storage is not aligned.
    Alignment = 3,
    /// The core has no configuration.
    NotSetUp = 4,
    /// A planning cycle is under way.
    Busy = 5,
    /// No planning cycle is under way: none was begun, or a step has dropped it.
    Idle = 6,
    /// A time is not finite, or goes back.
    Time = 7,
    /// The number of beams is not that of the configuration.
    ScanLength = 8,
    /// A range is not finite, negative or too long, or an angle is not finite.
    ScanRange = 9,
    /// The scan is older than the poses that the core remembers.
    ScanAge = 10,
    /// The plan does not start yet. The cycle goes on.
    Early = 11,
    /// The time has jumped, and no position has told since where the aircraft is.
    Lost = 12,
    /// The scan is not newer than the last one, or repeats its ranges to the last bit.
    ScanRepeated = 13,
    /// The number of paths.
    Paths = 20,
    /// The latency.
    Period = 21,
    /// The number of beams.
    Beams = 22,
    /// The range of the lidar.
    Range = 23,
    /// The altitude.
    Altitude = 24,
    /// A limit of an actuator.
    Actuators = 25,
    /// The aircraft does not fly level.
    Trim = 26,
    /// The greatest thrust does not carry level flight.
    Thrust = 27,
    /// No regulator holds the aircraft.
    Regulator = 28,
    /// A number is out of its range; `mpp_refused` names it.
    OutOfRange = 29,
    /// The planner cannot be set up.
    Planner = 30,
}

/// Each code with its text.
const TEXTS: [(MppStatus, &CStr); 25] = [
    (MppStatus::Ok, c"done"),
    (
        MppStatus::Null,
        c"a pointer is null: give the address of a value",
    ),
    (
        MppStatus::Storage,
        c"the storage is too small: give mpp_storage_size() bytes",
    ),
    (
        MppStatus::Alignment,
        c"the storage is not aligned: align it to 16 bytes",
    ),
    (
        MppStatus::NotSetUp,
        c"the core is not set up: call mpp_set_up first",
    ),
    (
        MppStatus::Busy,
        c"a planning cycle is under way: call mpp_finish first",
    ),
    (
        MppStatus::Idle,
        c"no planning cycle is under way: call mpp_begin with the next scan",
    ),
    (
        MppStatus::Time,
        c"the time is not a finite number or goes back: give seconds that grow",
    ),
    (
        MppStatus::ScanLength,
        c"the scan has another number of beams than the configuration: give as many as its field beams says",
    ),
    (
        MppStatus::ScanRange,
        c"an angle of the scan is not a number, or more than half of the ranges are negative: check the lidar",
    ),
    (
        MppStatus::ScanAge,
        c"the scan is older than 120 ticks or than the first step: give its age in ticks",
    ),
    (
        MppStatus::Early,
        c"the plan does not start yet: call mpp_finish again latency_ticks after the step before mpp_begin",
    ),
    (
        MppStatus::Lost,
        c"the time has jumped and the pose is in doubt: give mpp_step a position, or begin again 0.3 s later",
    ),
    (
        MppStatus::ScanRepeated,
        c"the scan is not newer than the last one, or repeats it: give each scan once, and check the lidar",
    ),
    (
        MppStatus::Paths,
        c"there is no room for that many candidate paths, or there are none: give 1 to 50",
    ),
    (
        MppStatus::Period,
        c"the latency is zero or longer than a plan: give 1 to 37 ticks for each m/s of cruise, and check cruise",
    ),
    (
        MppStatus::Beams,
        c"the core cannot take that number of beams: give 1 to 128",
    ),
    (
        MppStatus::Range,
        c"range_max is out of range or not a finite number: give 1 to 100000 metres",
    ),
    (
        MppStatus::Altitude,
        c"the altitude is out of range or not a finite number: give -1000 to 20000 metres",
    ),
    (
        MppStatus::Actuators,
        c"a limit of an actuator is not a positive number: give 0 for no limit",
    ),
    (
        MppStatus::Trim,
        c"the aircraft has no level flight at its cruise: check cruise, wing, mass and elevator",
    ),
    (
        MppStatus::Thrust,
        c"the greatest thrust does not carry level flight: raise thrust_max, or check cruise, wing and drag",
    ),
    (
        MppStatus::Regulator,
        c"no regulator holds the aircraft: check its derivatives and inertia",
    ),
    (
        MppStatus::OutOfRange,
        c"a number is out of range or not finite: mpp_refused gives its name and range, correct it",
    ),
    (
        MppStatus::Planner,
        c"the planner finds no model of the aircraft: check moment_alpha and the other derivatives",
    ),
];

/// Text of a code; of a number that is no code, a text that says so.
fn text(code: i32) -> &'static CStr {
    let known = TEXTS.iter().find(|(status, _)| *status as i32 == code);
    known.map_or(c"this number is no status of the core", |(_, text)| *text)
}

impl MppStatus {
    /// The code of a refused configuration.
    pub(crate) fn of_configuration(verdict: ConfigureVerdict) -> Self {
        use ConfigureVerdict as V;
        match verdict {
            V::Accepted => Self::Ok,
            V::TooManyPaths { .. } | V::PathsZero => Self::Paths,
            V::ReplanPeriod | V::Latency | V::SlicesPerTick | V::OutOfRange(Setting::Latency) => {
                Self::Period
            }
            V::Beams { .. } => Self::Beams,
            V::RangeMax => Self::Range,
            V::NonFinite => Self::Altitude,
            V::Actuators => Self::Actuators,
            V::NotTrimmable | V::CruiseAirspeed | V::NotCarried | V::NoElevator => Self::Trim,
            V::ThrustTooLow => Self::Thrust,
            V::RegulatorNotFinite
            | V::RegulatorSingular
            | V::RegulatorNotConverged
            | V::RegulatorNotStabilising
            | V::Unstable
            | V::LateralGain => Self::Regulator,
            V::PlanModel
            | V::PlanWeights
            | V::OtherPreset
            | V::PresetNotBuilt
            | V::NoSuchPlanner => Self::Planner,
            V::AlreadyConfigured | V::ImageDamaged => Self::Busy,
            V::AirframeNotFinite
            | V::Penalty
            | V::Margin
            | V::Band
            | V::PlanThrust
            | V::WindChange
            | V::AngleOfAttackLimit
            | V::FlightPathLimit
            | V::LateralMissing
            | V::LateralAircraft
            | V::SpaceLimits
            | V::OutOfRange(_) => Self::OutOfRange,
        }
    }

    /// The code of a failed set-up.
    pub(crate) fn of_set_up(error: SetupError) -> Self {
        use SetupError as E;
        match error {
            E::Trim(_) => Self::Trim,
            E::Regulator(_) | E::Unstable => Self::Regulator,
            E::TooManyPaths | E::NoPaths => Self::Paths,
            E::OutOfRange(Setting::Sight) => Self::Range,
            E::OutOfRange(Setting::Altitude) => Self::Altitude,
            E::OutOfRange(_) => Self::OutOfRange,
            E::ThrustTooLow => Self::Thrust,
            E::NoSteadyState | E::Condense(_) | E::OtherMethod => Self::Planner,
        }
    }

    /// The code of a refused scan.
    pub(crate) fn of_scan(error: ScanError) -> Self {
        match error {
            ScanError::Length { .. } => Self::ScanLength,
            ScanError::BadBeams { .. } | ScanError::AngleNotFinite => Self::ScanRange,
        }
    }
}

/// Text of a status, for people: what is wrong and what to do. Any number may be given.
#[unsafe(no_mangle)]
#[expect(unsafe_code, reason = "the name is exported")]
pub extern "C" fn mpp_text(status: i32) -> *const c_char {
    text(status).as_ptr()
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use mpp_core::config::{MAX_BEAMS, MAX_PATHS, STAGE_PERIOD, STAGES, TICK_PERIOD};
    use mpp_core::estimate::{MOST_AGE, MOST_SCAN_AGE};
    use mpp_core::tuning::sensors::{FROZEN_TICKS, LONGEST_DOUBT};
    use mpp_core::units::REFERENCE_CRUISE;
    use std::collections::BTreeSet;
    use std::format;

    #[test]
    fn every_code_has_a_text_of_its_own() {
        let texts: BTreeSet<_> = TEXTS
            .iter()
            .map(|(status, _)| text(*status as i32))
            .collect();
        let codes: BTreeSet<_> = TEXTS.iter().map(|(status, _)| *status as i32).collect();
        assert_eq!((texts.len(), codes.len()), (TEXTS.len(), TEXTS.len()));
        assert!(!texts.contains(text(-1)));
    }

    #[test]
    fn texts_and_header_give_the_limits_of_the_core() {
        let [altitude, sight] = [Setting::Altitude, Setting::Sight].map(|setting| {
            let [least, most] = setting.range();
            format!("{least} to {most}")
        });
        let longest = (STAGES as f64 * STAGE_PERIOD / REFERENCE_CRUISE / TICK_PERIOD) as u32;
        let [paths, beams] = [MAX_PATHS, MAX_BEAMS].map(|most| format!("1 to {most}"));
        let texts = [
            (MppStatus::Paths, paths.clone()),
            (MppStatus::Beams, beams.clone()),
            (MppStatus::ScanAge, format!("than {MOST_SCAN_AGE} ticks")),
            (MppStatus::Altitude, altitude.clone()),
            (MppStatus::Range, sight.clone()),
            (MppStatus::Lost, format!("{LONGEST_DOUBT} s later")),
            (MppStatus::Period, format!("1 to {longest} ticks")),
        ];
        for (status, limit) in texts {
            let text = text(status as i32).to_str().unwrap();
            assert!(text.contains(&limit), "{text}: {limit}");
        }
        let header = include_str!("../../include/mpp.h");
        for limit in [
            format!("cycle, {paths}."),
            format!("scan, {beams}."),
            format!("returns [m], {altitude}."),
            format!("reports [m], {sight}."),
            format!("step, at most {MOST_SCAN_AGE}."),
            format!("of 10 ms, at most {MOST_AGE}."),
            format!("after {FROZEN_TICKS} repeats"),
        ] {
            assert!(header.contains(&limit), "{limit}");
        }
    }
}
