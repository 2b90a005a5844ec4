//! Tests of the conversions.

extern crate std;

use super::*;
use std::format;
use std::vec::Vec;

#[test]
fn the_reference_aircraft_of_the_link_is_that_of_the_core() {
    let wire = hil_protocol::Aircraft::REFERENCE;
    let none = hil_protocol::ActuatorLimits::NONE;
    assert_eq!(aircraft(&wire, &none), Aircraft::REFERENCE);
    let same = Settings::flight_of(&Aircraft::REFERENCE);
    assert_eq!(same, Settings::flight());
}

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

/// A verdict that says what to give says the range that the core checks.
#[test]
fn the_ranges_in_the_texts_of_verdicts_are_those_of_the_settings() {
    let mut compared = 0;
    for setting in Setting::ALL {
        let text = format!("{}", out_of_range(*setting));
        let Some((_, advice)) = text.split_once(": give ") else {
            continue;
        };
        let words = advice.split(' ').collect::<Vec<_>>();
        let told = [words[0], words[2]].map(|number| number.parse::<f64>());
        let range = setting.range().map(Ok);
        assert!(words[1] == "to" && told == range, "{setting}: {text}");
        compared += 1;
    }
    assert_eq!(compared, 9);
}

#[test]
fn every_fault_of_a_scan_has_a_cause_of_its_own() {
    let causes = [
        ScanError::Length {
            expected: 2,
            found: 1,
        },
        ScanError::AngleNotFinite,
        ScanError::NotFinite { beam: 0 },
        ScanError::OutOfRange { beam: 0 },
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
            RejectionCause::ScanNotFinite { beam: 0 },
            RejectionCause::ScanRange { beam: 0 },
        ]
    );
}
