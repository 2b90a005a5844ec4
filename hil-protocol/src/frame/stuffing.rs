//! COBS (consistent overhead byte stuffing, Cheshire and Baker, 1999) in place.
//!
//! The plain bytes are cut into pieces at their zeros. Each piece stands behind a code, its length plus one. The same
//! pass sums them up: in a step of the core it looks at each byte that is sent once.

use super::{CHECKSUM, sum};

/// The longest piece \[bytes\]. It is cut after so many bytes, without a zero.
pub(super) const LONGEST_PIECE: usize = 254;

/// Number of codes that so many plain bytes need besides the places of their zeros.
pub(super) const fn codes(plain: usize) -> usize {
    plain.div_ceil(LONGEST_PIECE)
}

/// Stuffs the plain bytes from place `from` to the end of a buffer, to its beginning, after it has written their
/// checksum into the last four. Gives the number of bytes on the wire. `from` is the number of their [`codes`], so nothing
/// is written over before it is read.
pub(super) fn stuff(bytes: &mut [u8], from: usize) -> Option<usize> {
    if from <= 1 {
        stuff_short(bytes)?;
        return Some(bytes.len());
    }
    let (checked, checksum) = bytes.get_mut(from..)?.split_last_chunk_mut()?;
    *checksum = sum::checksum(
        checked
            .iter()
            .fold(sum::START, |sum, byte| sum::next(sum, *byte)),
    );
    let (mut code, mut end) = (0, 1);
    for at in from..bytes.len() {
        if end - code > LONGEST_PIECE {
            close(bytes, &mut code, &mut end);
        }
        match bytes.get(at).copied().unwrap_or_default() {
            0 => close(bytes, &mut code, &mut end),
            byte => {
                write(bytes, end, byte);
                end += 1;
            }
        }
    }
    close(bytes, &mut code, &mut end);
    Some(code)
}

/// Does the work of [`stuff`] for plain bytes that no piece is too long for. Whatever a core sends is so short.
fn stuff_short(mut bytes: &mut [u8]) -> Option<()> {
    let mut sum = sum::START;
    loop {
        let (open, _) = bytes.split_last_chunk::<CHECKSUM>()?;
        let (_, checked) = open.split_first()?;
        let zero = checked.iter().position(|byte| {
            sum = sum::next(sum, *byte);
            *byte == 0
        });
        let Some(piece) = zero else { break };
        write(bytes, 0, (piece + 1) as u8);
        bytes = bytes.get_mut(piece + 1..)?;
    }
    *bytes.last_chunk_mut()? = sum::checksum(sum);
    cut(bytes);
    Some(())
}

/// Cuts plain bytes at their zeros: the place of each takes a code.
fn cut(mut bytes: &mut [u8]) {
    while let Some((code, behind)) = bytes.split_first_mut() {
        let zero = behind.iter().position(|byte| *byte == 0);
        let piece = zero.unwrap_or(behind.len());
        *code = (piece + 1) as u8;
        bytes = behind.get_mut(piece..).unwrap_or_default();
    }
}

/// Writes the code of the open piece, and opens the next one.
fn close(bytes: &mut [u8], code: &mut usize, end: &mut usize) {
    write(bytes, *code, (*end - *code) as u8);
    *code = *end;
    *end += 1;
}

fn write(bytes: &mut [u8], at: usize, byte: u8) {
    if let Some(place) = bytes.get_mut(at) {
        *place = byte;
    }
}
