//! Tests that every verdict, cause and error says what is wrong and what to do.

use hil_protocol::mavlink::Refusal;
use hil_protocol::{
    ConfigureVerdict, DecodeError, EncodeError, ParameterVerdict, RejectionCause, Setting,
};
use serde::de::DeserializeOwned;

/// Every variant, made from its number, which is its first byte on the wire.
fn all<T: DeserializeOwned>() -> Vec<T> {
    (0..128)
        .map_while(|number| Some(postcard::take_from_bytes(&[number, 0, 0, 0, 0]).ok()?.0))
        .collect()
}

fn sentences(errors: &[impl core::error::Error]) -> Vec<String> {
    let texts: Vec<_> = errors.iter().map(ToString::to_string).collect();
    for text in &texts {
        assert!(text.split(' ').count() > 3, "{text:?} is no sentence");
    }
    texts
}

/// Checks the sentences of errors. Each is different from the others, and tells what to do after a
/// colon.
fn check(errors: &[impl core::error::Error]) {
    let mut texts = sentences(errors);
    for text in &texts {
        assert!(text.contains(": "), "{text:?} does not say what to do");
    }
    texts.sort();
    texts.dedup();
    assert_eq!(texts.len(), errors.len());
}

#[test]
fn every_verdict_and_cause_speaks() {
    let configure: Vec<ConfigureVerdict> = all();
    let parameter: Vec<ParameterVerdict> = all();
    let causes: Vec<RejectionCause> = all();
    let faults: Vec<DecodeError> = all();
    assert_eq!(
        (
            configure.last().copied().unwrap(),
            parameter.last().copied().unwrap(),
            causes.last().copied().unwrap(),
            faults.last().copied().unwrap(),
        ),
        (
            ConfigureVerdict::SpaceLimits,
            ParameterVerdict::CruiseFixed,
            RejectionCause::ScanAged,
            DecodeError::TrailingBytes { id: 0 },
        )
    );
    let (accepted, refused) = configure.split_first().unwrap();
    sentences(&[*accepted]);
    check(refused);
    let named: Vec<_> = Setting::ALL
        .iter()
        .map(|setting| ConfigureVerdict::out_of_range(*setting))
        .collect();
    check(&named);
    let (accepted, refused) = parameter.split_first().unwrap();
    sentences(&[*accepted]);
    check(refused);
    check(&causes);
    check(&faults);
}

#[test]
fn every_other_error_speaks() {
    check(&[EncodeError::TooLong { id: 4 }]);
    check(&[
        Refusal::Unsigned,
        Refusal::WrongKey,
        Refusal::Old,
        Refusal::TooManySenders,
    ]);
}
