//! MAVLink 2 frames of the dialect `common`, from bytes and to bytes.

pub(crate) use mavlink::dialects::common::MavMessage as Mav;
use mavlink::{MAVLinkV2MessageRaw, MavHeader, MavlinkVersion, Message};

const START: u8 = 0xFD;
const SIGNED: u8 = 1;
/// Component of an onboard computer.
pub(crate) const OWN_COMPONENT: u8 = 191;

/// Finds frames in a stream of bytes. A frame of a message that the dialect lacks is skipped as a whole: bytes within it that
/// look like a beginning would hold back what follows. In a damaged frame the search goes on behind its first byte.
#[derive(Debug, Default)]
pub(crate) struct Framer {
    bytes: Vec<u8>,
}

impl Framer {
    /// Takes bytes in, and gives each whole message with the system and component that sent it.
    pub(crate) fn receive(&mut self, bytes: &[u8], mut give: impl FnMut(u32, u8, Mav)) {
        self.bytes.extend_from_slice(bytes);
        let mut at = 0;
        while let Some(start) = self.bytes.iter().skip(at).position(|byte| *byte == START) {
            at += start;
            let rest = self.bytes.get(at..).unwrap_or_default();
            let [_, length, flags, ..] = rest else {
                break;
            };
            let signature = if flags & SIGNED == 0 { 0 } else { 13 };
            let size = 12 + usize::from(*length) + signature;
            let Some(frame) = rest.get(..size) else {
                break;
            };
            match read(frame) {
                Ok(message) => {
                    at += size;
                    if let Some((system, component, message)) = message {
                        give(system, component, message);
                    }
                }
                Err(Damaged) => at += 1,
            }
        }
        let known = self.bytes.iter().skip(at).any(|byte| *byte == START);
        self.bytes
            .drain(..if known { at } else { self.bytes.len() });
    }
}

/// The checksum of a frame is wrong, or the frame has flags that nobody knows.
struct Damaged;

/// The message of a whole frame with its sender; `None` if the dialect lacks it.
fn read(frame: &[u8]) -> Result<Option<(u32, u8, Mav)>, Damaged> {
    let mut raw = MAVLinkV2MessageRaw::new();
    let room = raw.as_mut_slice().get_mut(..frame.len());
    let room = room.filter(|_| frame.get(2).is_some_and(|flags| flags & !SIGNED == 0));
    room.ok_or(Damaged)?.copy_from_slice(frame);
    if Mav::default_message_from_id(raw.message_id()).is_none() {
        return Ok(None);
    }
    if !raw.has_valid_crc::<Mav>() {
        return Err(Damaged);
    }
    let message = Mav::parse(MavlinkVersion::V2, raw.message_id(), raw.payload());
    // An error is a value that no enumeration of the dialect has.
    let sender = (raw.system_id(), raw.component_id());
    Ok(message.ok().map(|message| (sender.0, sender.1, message)))
}

/// Makes frames of one sender.
#[derive(Debug)]
pub(crate) struct Sender {
    header: MavHeader,
}

impl Sender {
    pub(crate) fn new(system: u8, component: u8) -> Self {
        let header = MavHeader {
            system_id: u32::from(system),
            component_id: component,
            sequence: 0,
        };
        Self { header }
    }

    /// The frame of a message.
    pub(crate) fn frame(&mut self, message: &Mav) -> Vec<u8> {
        let mut raw = MAVLinkV2MessageRaw::new();
        raw.serialize_message(self.header, message);
        self.header.sequence = self.header.sequence.wrapping_add(1);
        raw.raw_bytes().to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavlink::dialects::common::VFR_HUD_DATA;

    #[test]
    fn frames_come_whole_from_a_torn_and_dirty_stream() {
        let mut sender = Sender::new(1, 1);
        let hud = |airspeed| {
            Mav::VFR_HUD(VFR_HUD_DATA {
                airspeed,
                ..VFR_HUD_DATA::DEFAULT
            })
        };
        let mut stream = vec![7, START, 9];
        stream.extend(sender.frame(&hud(1.0)));
        let mut damaged = sender.frame(&hud(2.0));
        damaged[12] ^= 1;
        stream.extend(damaged);
        stream.extend(sender.frame(&hud(3.0)));
        stream.extend([0; 30]);
        let mut framer = Framer::default();
        let mut found = Vec::new();
        for piece in stream.chunks(5) {
            framer.receive(piece, |system, component, message| {
                assert_eq!((system, component), (1, 1));
                found.push(message);
            });
        }
        assert_eq!(found, [hud(1.0), hud(3.0)]);
    }

    /// ArduPlane sends messages of a dialect of its own beside those that the companion takes.
    #[test]
    fn a_message_of_another_dialect_holds_nothing_back() {
        let mut sender = Sender::new(1, 1);
        let hud = Mav::VFR_HUD(VFR_HUD_DATA {
            airspeed: 1.0,
            ..VFR_HUD_DATA::DEFAULT
        });
        // AHRS2 (178) of ardupilotmega, with a byte that begins no frame.
        let mut stream = vec![START, 24, 0, 0, 0, 1, 1, 178, 0, 0];
        stream.extend([START, 200, 0].into_iter().cycle().take(24 + 2));
        stream.extend(sender.frame(&hud));
        let mut found = Vec::new();
        Framer::default().receive(&stream, |_, _, message| found.push(message));
        assert_eq!(found, [hud]);
    }
}
