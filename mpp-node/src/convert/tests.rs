//! Tests of the conversions.

extern crate std;

use super::*;
use std::format;
use std::vec::Vec;

/// The report of the counters has the names of the core's counters, in their order.
#[test]
fn the_counters_have_their_names() {
    let text = format!("{:?}", mpp_core::health::Health::default());
    let fields = text
        .trim_start_matches("Health {")
        .split(',')
        .filter_map(|field| field.split(':').next())
        .map(str::trim);
    assert_eq!(
        fields.collect::<Vec<_>>(),
        hil_protocol::HealthReport::NAMES
    );
}

#[test]
fn every_failed_set_up_has_a_verdict_of_its_own() {
    let errors = [
        SetupError::Trim(TrimError::NotCarried),
        SetupError::Trim(TrimError::NoElevator),
        SetupError::Trim(TrimError::NotConverged),
        SetupError::Regulator(RiccatiError::NotFinite),
        SetupError::Regulator(RiccatiError::Singular),
        SetupError::Regulator(RiccatiError::NotConverged),
        SetupError::Regulator(RiccatiError::NotStabilising),
        SetupError::NoSteadyState,
        SetupError::Condense(CondenseError),
        SetupError::Unstable,
        SetupError::TooManyPaths,
        SetupError::ThrustTooLow,
        SetupError::NoPaths,
        SetupError::OtherMethod,
    ];
    let numbers = Setting::ALL.iter().copied().map(SetupError::OutOfRange);
    let verdicts = errors.into_iter().chain(numbers).map(setup_verdict);
    for (index, verdict) in verdicts.clone().enumerate() {
        let mut earlier = verdicts.clone().take(index);
        assert!(!earlier.any(|other| other == verdict), "{verdict}");
    }
}

#[test]
fn every_fault_of_a_scan_has_a_cause_of_its_own() {
    let causes = [
        ScanError::Length {
            expected: 2,
            found: 1,
        },
        ScanError::AngleNotFinite,
        ScanError::BadBeams { beam: 0 },
    ]
    .map(scan_rejection);
    assert_eq!(
        causes,
        [
            RejectionCause::ScanLength {
                expected: 2,
                found: 1
            },
            RejectionCause::ScanAngle,
            RejectionCause::ScanRange { beam: 0 },
        ]
    );
}
