//! Errors as codes, with texts.

use core::ffi::{CStr, c_char};
use hil_protocol::ConfigureVerdict;
use mpp_core::sense::ScanError;

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
    /// No planning cycle is under way.
    Idle = 6,
    /// A time is not finite, or goes back.
    Time = 7,
    /// The number of beams is not that of the configuration.
    ScanLength = 8,
    /// A range is not finite, negative or too long, or an angle is not finite.
    ScanRange = 9,
    /// The scan is older than the poses that the core remembers.
    ScanAge = 10,
    /// The number of paths.
    Paths = 20,
    /// The replanning period or the latency.
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
    /// A number is out of its range.
    OutOfRange = 29,
    /// The planner cannot be set up.
    Planner = 30,
}

/// Each code with its text.
const TEXTS: [(MppStatus, &CStr); 22] = [
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
        c"no planning cycle is under way: call mpp_begin first",
    ),
    (
        MppStatus::Time,
        c"the time is not a finite number or goes back: give seconds that grow",
    ),
    (
        MppStatus::ScanLength,
        c"the scan has another number of beams than the configuration",
    ),
    (
        MppStatus::ScanRange,
        c"a range or an angle of the scan is not a number or out of range: give 0 for no return",
    ),
    (
        MppStatus::ScanAge,
        c"the scan is too old: give its age in ticks, below 50",
    ),
    (
        MppStatus::Paths,
        c"there is no room for that many candidate paths, or there are none: give 1 to 100",
    ),
    (
        MppStatus::Period,
        c"the replanning period is zero, or the latency is zero or longer than it",
    ),
    (
        MppStatus::Beams,
        c"the core cannot take that number of beams: give 1 to 128",
    ),
    (
        MppStatus::Range,
        c"the range of the lidar is out of range: give 1 to 10000 metres",
    ),
    (
        MppStatus::Altitude,
        c"the altitude is out of range or not a finite number: give metres",
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
        c"the greatest thrust does not carry level flight",
    ),
    (
        MppStatus::Regulator,
        c"no regulator holds the aircraft: check its derivatives and inertia",
    ),
    (
        MppStatus::OutOfRange,
        c"a number of the aircraft or the configuration is out of range or not finite",
    ),
    (
        MppStatus::Planner,
        c"the planner cannot be set up with these numbers",
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
            V::ReplanPeriod | V::Latency | V::SlicesPerTick => Self::Period,
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
            | V::Unstable => Self::Regulator,
            V::PlanModel | V::PlanWeights | V::OtherPreset | V::PresetNotBuilt => Self::Planner,
            V::AlreadyConfigured | V::ImageDamaged => Self::Busy,
            V::AirframeNotFinite
            | V::Penalty
            | V::Margin
            | V::Band
            | V::PlanThrust
            | V::WindChange
            | V::AngleOfAttackLimit
            | V::FlightPathLimit
            | V::OutOfRange(_) => Self::OutOfRange,
        }
    }

    /// The code of a refused scan.
    pub(crate) fn of_scan(error: ScanError) -> Self {
        match error {
            ScanError::Length { .. } => Self::ScanLength,
            ScanError::NotFinite { .. }
            | ScanError::OutOfRange { .. }
            | ScanError::AngleNotFinite => Self::ScanRange,
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
    use std::collections::BTreeSet;

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
}
