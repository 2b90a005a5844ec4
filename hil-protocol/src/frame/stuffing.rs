//! COBS (consistent overhead byte stuffing, Cheshire and Baker, 1999) in place.
//!
//! The plain bytes are cut into pieces at their zeros. Each piece stands behind a code, its length plus one. The same
//! pass sums them up: in a step of the core it looks at each byte that is sent once.

use super::sum::{self, CHECKSUM};
use core::cell::Cell;

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
    let checked = bytes.len().checked_sub(CHECKSUM)?;
    let (mut sum, mut code, mut end, mut at) = (sum::START, 0, 1, from);
    while at < checked {
        let rest = bytes.get(at..checked)?;
        let longest = rest.get(..LONGEST_PIECE).unwrap_or(rest);
        let zero = sum_to_zero(longest, &mut sum);
        let piece = zero.unwrap_or(longest.len());
        let cells = Cell::from_mut(bytes.get_mut(end..at + piece)?).as_slice_of_cells();
        for (to, from) in cells.iter().zip(cells.get(at - end..)?) {
            to.set(from.get());
        }
        (at, end) = (at + piece, end + piece);
        if zero.is_some() {
            at += 1;
        }
        if zero.is_some() || piece == LONGEST_PIECE {
            close(bytes, &mut code, &mut end);
        }
    }
    for byte in sum::checksum(sum) {
        if end - code > LONGEST_PIECE {
            close(bytes, &mut code, &mut end);
        }
        match byte {
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
/// core sends in each tick is so short.
fn stuff_short(mut bytes: &mut [u8]) -> Option<()> {
    let mut sum = sum::START;
    loop {
        let (code, rest) = bytes.split_first_mut()?;
        let (checked, checksum) = rest.split_last_chunk_mut::<CHECKSUM>()?;
        let zero = sum_to_zero(checked, &mut sum);
        let Some(piece) = zero else {
            *checksum = sum::checksum(sum);
            *code = checked.len() as u8 + cut(checksum);
            return Some(());
        };
        *code = (piece + 1) as u8;
        bytes = rest.get_mut(piece..)?;
    }
}

/// Sums bytes up to the first zero, it included, and gives its place.
fn sum_to_zero(bytes: &[u8], sum: &mut u32) -> Option<usize> {
    let (words, _) = bytes.as_chunks::<4>();
    let mut at = 0;
    for word in words.iter().map(|word| u32::from_le_bytes(*word)) {
        // This is not zero exactly if one of the four bytes is.
        if word.wrapping_sub(0x0101_0101) & !word & 0x8080_8080 != 0 {
            break;
        }
        *sum = sum::next_word(*sum, word);
        at += 4;
    }
    for byte in bytes.get(at..)? {
        *sum = sum::next(*sum, *byte);
        if *byte == 0 {
            return Some(at);
        }
        at += 1;
    }
    None
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
