//! A frame made in the slow and simple way, with the COBS of another crate.

/// Makes a frame: header, payload and checksum in COBS, with the delimiter.
pub(crate) fn frame(magic: &[u8; 2], version: u8, id: u8, payload: &[u8]) -> Vec<u8> {
    let mut plain = [magic, [version, id].as_slice(), payload].concat();
    plain.extend(crc32(&plain).to_le_bytes());
    let mut bytes = cobs::encode_vec(&plain);
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
