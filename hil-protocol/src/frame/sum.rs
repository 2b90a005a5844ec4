//! The checksum of frames byte by byte: CRC-32/ISO-HDLC, the one of Ethernet and zlib.
//!
//! Source: Sarwate, "Computation of cyclic redundancy checks via table look-up" (1988). The decoder sums up each
//! byte as it comes, which a library for slices of bytes does not do.

/// The polynomial, reflected.
const POLYNOMIAL: u32 = 0xEDB8_8320;

/// Size of the checksum \[bytes\].
pub(super) const CHECKSUM: usize = 4;

/// The register before the first byte.
pub(super) const START: u32 = u32::MAX;
/// The register after a whole message and its checksum.
pub(super) const RESIDUE: u32 = 0xDEBB_20E3;

/// The register after each byte from zero. The table takes 1 kB of flash.
static TABLE: [u32; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < table.len() {
        let mut sum = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            sum = (sum >> 1) ^ (POLYNOMIAL & (sum & 1).wrapping_neg());
            bit += 1;
        }
        table[byte] = sum;
        byte += 1;
    }
    table
};

/// The register after one more byte.
#[inline]
pub(super) fn next(sum: u32, byte: u8) -> u32 {
    let [low, ..] = sum.to_le_bytes();
    (sum >> 8) ^ TABLE[usize::from(low ^ byte)]
}

/// The register after four more bytes, as a little-endian number.
#[inline]
pub(super) fn next_word(sum: u32, word: u32) -> u32 {
    (0..4).fold(sum ^ word, |sum, _| next(sum, 0))
}

/// The checksum of the bytes after which the register is `sum`.
pub(super) const fn checksum(sum: u32) -> [u8; CHECKSUM] {
    (!sum).to_le_bytes()
}
