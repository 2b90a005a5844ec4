//! A frame made in the slow and simple way.

/// Makes a frame: header, payload and checksum in COBS, with the delimiter.
pub(crate) fn frame(magic: &[u8; 2], version: u8, id: u8, payload: &[u8]) -> Vec<u8> {
    let mut plain = [magic, [version, id].as_slice(), payload].concat();
    plain.extend(crc32(&plain).to_le_bytes());
    let mut bytes = cobs(&plain);
    bytes.push(0);
    bytes
}

/// CRC-32/ISO-HDLC, bit by bit.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = !0_u32;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 };
        }
    }
    !crc
}

/// Encodes in COBS. Each run up to a zero, or of 254 bytes, stands behind its length plus one. An
/// end without a zero after a run of 254 needs no more.
fn cobs(plain: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut rest = plain;
    loop {
        let run = rest.iter().take(254).take_while(|&&byte| byte != 0).count();
        bytes.push(run as u8 + 1);
        bytes.extend(&rest[..run]);
        rest = &rest[run..];
        match (run, rest) {
            (_, []) => return bytes,
            (254, _) => {}
            _ => rest = &rest[1..],
        }
    }
}
