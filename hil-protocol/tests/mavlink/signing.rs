//! Tests signatures that pass, and signatures that do not.

use hil_protocol::mavlink::messages::{COMMAND_LONG_DATA, HEARTBEAT_DATA};
use hil_protocol::mavlink::{Framer, Key, Refusal, Sender, Signer, Verifier};

const NOW: u64 = 30_000_000_000_000;

fn key() -> Key {
    Key::of_passphrase("a secret")
}

fn signed(time: u64, command: u16) -> Vec<u8> {
    let mut signer = Signer::new(key(), 3, time);
    let message = COMMAND_LONG_DATA {
        command,
        ..COMMAND_LONG_DATA::DEFAULT
    };
    Sender::new(255, 190)
        .signed_frame(&message, &mut signer)
        .as_bytes()
        .to_vec()
}

fn verdict(verifier: &mut Verifier, bytes: &[u8]) -> Result<(), Refusal> {
    let mut verdict = None;
    Framer::new().receive_datagram(bytes, |frame| verdict = Some(verifier.verify(frame)));
    verdict.unwrap()
}

#[test]
fn a_signed_frame_passes_once() {
    let mut verifier = Verifier::new(key(), NOW);
    let frame = signed(NOW, 400);
    assert_eq!(verdict(&mut verifier, &frame), Ok(()));
    assert_eq!(verdict(&mut verifier, &frame), Err(Refusal::Old));
    assert_eq!(verdict(&mut verifier, &signed(NOW + 1, 400)), Ok(()));
    assert_eq!(
        verdict(&mut verifier, &signed(NOW - 1, 400)),
        Err(Refusal::Old)
    );
}

#[test]
fn the_signer_never_uses_a_time_twice() {
    let mut verifier = Verifier::new(key(), NOW);
    let mut signer = Signer::new(key(), 0, NOW);
    let mut sender = Sender::new(1, 1);
    for step in 0..300 {
        // Time stands still, goes back, or goes on.
        signer.set_time(NOW + step / 7 * 3);
        let frame = sender.signed_frame(&HEARTBEAT_DATA::DEFAULT, &mut signer);
        assert_eq!(verdict(&mut verifier, frame.as_bytes()), Ok(()));
    }
}

/// A receiver that learns the time refuses what was signed long before, from whichever sender.
#[test]
fn a_verifier_that_is_told_the_time_refuses_older_frames() {
    let mut verifier = Verifier::new(key(), 0);
    verifier.set_time(NOW);
    verifier.set_time(NOW - 1);
    assert_eq!(verifier.time(), NOW);
    let hour = 3600 * 100_000;
    assert_eq!(
        verdict(&mut verifier, &signed(NOW - hour, 400)),
        Err(Refusal::Old)
    );
    assert_eq!(verdict(&mut verifier, &signed(NOW + 1, 400)), Ok(()));
}

#[test]
fn without_a_signature_nothing_passes() {
    let frame = Sender::new(255, 190).frame(&HEARTBEAT_DATA::DEFAULT);
    let mut verifier = Verifier::new(key(), NOW);
    assert_eq!(
        verdict(&mut verifier, frame.as_bytes()),
        Err(Refusal::Unsigned)
    );
}

/// A change of any bit of the signature, or any other key, makes it wrong.
#[test]
fn a_changed_bit_or_another_key_is_refused() {
    let frame = signed(NOW, 400);
    for bit in 0..13 * 8 {
        let mut changed = frame.clone();
        let at = frame.len() - 13 + bit / 8;
        changed[at] ^= 1 << (bit % 8);
        let mut verifier = Verifier::new(key(), NOW);
        assert_eq!(
            verdict(&mut verifier, &changed),
            Err(Refusal::WrongKey),
            "bit {bit}"
        );
        // A refused frame has not moved the verifier's time on.
        assert_eq!(verdict(&mut verifier, &frame), Ok(()));
    }
    let mut verifier = Verifier::new(Key::of_passphrase("another"), NOW);
    assert_eq!(verdict(&mut verifier, &frame), Err(Refusal::WrongKey));
}

#[test]
fn a_new_sender_may_be_a_minute_behind_and_no_more() {
    const MINUTE: u64 = 6_000_000;
    let mut verifier = Verifier::new(key(), NOW);
    assert_eq!(
        verdict(&mut verifier, &signed(NOW - MINUTE - 1, 1)),
        Err(Refusal::Old)
    );
    assert_eq!(verdict(&mut verifier, &signed(NOW - MINUTE, 1)), Ok(()));
}

#[test]
fn more_senders_than_are_remembered_are_refused() {
    let mut verifier = Verifier::new(key(), NOW);
    let mut refused = 0;
    for system in 0..20 {
        let mut signer = Signer::new(key(), 0, NOW);
        let frame = Sender::new(system, 1).signed_frame(&HEARTBEAT_DATA::DEFAULT, &mut signer);
        refused +=
            usize::from(verdict(&mut verifier, frame.as_bytes()) == Err(Refusal::TooManySenders));
    }
    assert_eq!(refused, 4);
}
