//! COBS (consistent overhead byte stuffing, Cheshire and Baker, 1999) in place.
//!
//! The plain bytes are cut into pieces at their zeros. Each piece stands behind a code, its length plus one.

/// The longest piece \[bytes\]. It is cut after so many bytes, without a zero.
pub(super) const LONGEST_PIECE: usize = 254;

/// Number of codes that so many plain bytes need besides the places of their zeros.
pub(super) const fn codes(plain: usize) -> usize {
    plain.div_ceil(LONGEST_PIECE)
}

/// Stuffs the plain bytes from place `from` to the end of a buffer, to its beginning. Gives the number of bytes
/// on the wire. `from` is the number of their [`codes`], so nothing is written over before it is read.
pub(super) fn stuff(bytes: &mut [u8], from: usize) -> usize {
    if from <= 1 {
        stuff_short(bytes);
        return bytes.len();
    }
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
    code
}

/// Stuffs plain bytes that no piece is too long for: the place of each zero takes a code. Whatever a core sends
/// is so short.
fn stuff_short(mut bytes: &mut [u8]) {
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
