//! Tests that every error says what is wrong and what to do.

use mpp_core::control::RiccatiError;
use mpp_core::estimate::Diverged;
use mpp_core::planner::SetupError;
use mpp_core::qp::CondenseError;
use mpp_core::sense::ScanError;
use mpp_core::settings::Setting;
use mpp_core::vehicle::TrimError;

/// Checks the sentences of errors. Each is different from the others, and tells what to do after a
/// colon.
fn check(errors: &[impl core::error::Error]) {
    let mut texts: Vec<_> = errors.iter().map(ToString::to_string).collect();
    for text in &texts {
        let (wrong, remedy) = text.split_once(": ").unwrap_or_default();
        assert!(wrong.split(' ').count() > 3, "{text:?} is no sentence");
        assert!(remedy.split(' ').count() > 1, "{text:?} gives no remedy");
    }
    texts.sort();
    texts.dedup();
    assert_eq!(texts.len(), errors.len());
}

const TRIM: [TrimError; 6] = [
    TrimError::Airspeed,
    TrimError::Angle,
    TrimError::Airframe,
    TrimError::NotCarried,
    TrimError::NoElevator,
    TrimError::NotConverged,
];

const RICCATI: [RiccatiError; 4] = [
    RiccatiError::NotFinite,
    RiccatiError::Singular,
    RiccatiError::NotConverged,
    RiccatiError::NotStabilising,
];

#[test]
fn every_error_speaks() {
    check(&TRIM);
    check(&RICCATI);
    check(&[CondenseError]);
    check(&[Diverged]);
    check(&[
        ScanError::Length {
            expected: 100,
            found: 99,
        },
        ScanError::AngleNotFinite,
        ScanError::BadBeams { beam: 3 },
    ]);
}

#[test]
fn a_failed_set_up_speaks_as_its_cause() {
    let mut errors = vec![
        SetupError::NoSteadyState,
        SetupError::Condense(CondenseError),
        SetupError::Unstable,
        SetupError::TooManyPaths,
        SetupError::ThrustTooLow,
        SetupError::NoPaths,
        SetupError::OtherMethod,
    ];
    errors.extend(Setting::ALL.iter().map(|it| SetupError::OutOfRange(*it)));
    errors.extend(TRIM.map(SetupError::Trim));
    errors.extend(RICCATI.map(SetupError::Regulator));
    check(&errors);
}
