//! Hostile MAVLink bytes into framer and verifier.

use super::draw::Draw;
use super::{ROUND, Report};
use hil_protocol::mavlink::messages::{COMMAND_LONG_DATA, HEARTBEAT_DATA, PARAM_SET_DATA};
use hil_protocol::mavlink::{Framer, Key, MAX_FRAME, MessageData, Sender, Signer, Verifier};

/// The time of the verifier's start [10 us since 2015-01-01].
const START: u64 = 1 << 44;

/// One round of hostile bytes, and a good frame.
pub(super) fn round(draw: &mut Draw) -> Result<Report, String> {
    let key = Key::of_passphrase("ours");
    let mut verifier = Verifier::new(key.clone(), START);
    let mut ours = Signer::new(key, 1, START);
    let mut theirs = Signer::new(Key::of_passphrase("theirs"), 1, START);
    let mut senders = (Sender::new(255, 190), Sender::new(255, 190));
    let mut framer = Framer::new();
    let mut report = Report::default();
    // Frames that were signed with our key, as they were.
    let mut signed: Vec<Vec<u8>> = vec![];
    let mut wrong = None;
    for _ in 0..ROUND {
        let mut bytes = match draw.below(8) {
            0 => draw.bytes(2 * MAX_FRAME),
            1 | 2 => {
                let frame = any_message(draw, &mut senders.0, Some(&mut ours));
                signed.push(frame.clone());
                frame
            }
            3 => any_message(draw, &mut senders.1, Some(&mut theirs)),
            // A repetition of a frame that was good once.
            4 if !signed.is_empty() => signed[draw.below(signed.len())].clone(),
            _ => any_message(draw, &mut senders.1, None),
        };
        if draw.once_in(3) {
            draw.damage(&mut bytes);
        }
        let mut take = |frame: &hil_protocol::mavlink::Frame<'_>| {
            report.found += 1;
            let _ = frame.decode::<COMMAND_LONG_DATA>();
            let _ = frame.decode::<PARAM_SET_DATA>();
            if verifier.verify(frame).is_ok() {
                let known = signed.iter().position(|it| it == frame.bytes);
                match known {
                    // Each passes once at most.
                    Some(place) => drop(signed.remove(place)),
                    None => wrong = Some(format!("it took a forged frame: {:?}", frame.bytes)),
                }
            }
        };
        if draw.once_in(2) {
            framer.receive(&bytes, &mut take);
        } else {
            framer.receive_datagram(&bytes, &mut take);
        }
        report.frames += 1;
    }
    if let Some(wrong) = wrong {
        return Err(wrong);
    }
    // A frame in a datagram of its own is found whatever came before, and its signature is taken.
    let good = senders.0.signed_frame(&HEARTBEAT_DATA::DEFAULT, &mut ours);
    let mut taken = false;
    framer.receive_datagram(good.as_bytes(), |frame| {
        taken |= frame.bytes == good.as_bytes() && verifier.verify(frame).is_ok();
    });
    if taken {
        Ok(report)
    } else {
        Err(format!("it misses a good frame: {:?}", framer.counters()))
    }
}

/// A frame of a message with random fields.
fn any_message(draw: &mut Draw, sender: &mut Sender, signer: Option<&mut Signer>) -> Vec<u8> {
    match draw.below(3) {
        0 => frame::<COMMAND_LONG_DATA>(draw, sender, signer),
        1 => frame::<PARAM_SET_DATA>(draw, sender, signer),
        _ => frame::<HEARTBEAT_DATA>(draw, sender, signer),
    }
}

fn frame<M: MessageData>(
    draw: &mut Draw,
    sender: &mut Sender,
    signer: Option<&mut Signer>,
) -> Vec<u8> {
    let payload: Vec<u8> = (0..64).map(|_| draw.bits() as u8).collect();
    let message = M::deser(&payload);
    let frame = match signer {
        Some(signer) => sender.signed_frame(&message, signer),
        None => sender.frame(&message),
    };
    frame.as_bytes().to_vec()
}
