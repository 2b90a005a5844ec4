//! COBS (consistent overhead byte stuffing, Cheshire and Baker, 1999) in place.
//!
//! The plain bytes are cut into pieces at their zeros. Each piece stands behind a code, its length plus one. The same
//! pass sums them up: in a step of the core it looks at each byte that is sent once.

use super::sum::{self, CHECKSUM};

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

/// Does the work of [`stuff`] for plain bytes that no piece is too long for: the place of each zero takes a code. Whatever a
/// core sends is so short.
fn stuff_short(mut bytes: &mut [u8]) -> Option<()> {
    let mut sum = sum::START;
    loop {
        let (code, rest) = bytes.split_first_mut()?;
        let (checked, checksum) = rest.split_last_chunk_mut::<CHECKSUM>()?;
        let zero = checked.iter().position(|byte| {
            sum = sum::next(sum, *byte);
            *byte == 0
        });
        let Some(piece) = zero else {
            *checksum = sum::checksum(sum);
            *code = checked.len() as u8 + cut(checksum);
            return Some(());
        };
        *code = (piece + 1) as u8;
        bytes = rest.get_mut(piece..)?;
    }
}

/// Cuts the checksum at its zeros: the place of each takes a code. Gives the code in front of the checksum.
fn cut(checksum: &mut [u8]) -> u8 {
    let mut code = 1;
    for byte in checksum.iter_mut().rev() {
        if *byte == 0 {
            *byte = core::mem::replace(&mut code, 0);
        }
        code += 1;
    }
    code
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
