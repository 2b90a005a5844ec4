//! Messages as bytes: the fields, and the byte of each message in the checksum of its frames.

use core::mem;
use core::ops::{Deref, DerefMut};
use core::str::Utf8Error;

/// A message of the dialect.
pub trait MessageData: Sized {
    /// Id of the message.
    const ID: u32;
    /// Name of the message in the dialect.
    const NAME: &'static str;
    /// The byte that the checksum of a frame covers beside the bytes of the frame. It depends on the names and
    /// types of the fields, so two dialects with different fields do not read one another's frames.
    const EXTRA_CRC: u8;
    /// Size of the payload with all fields \[bytes\].
    const ENCODED_LEN: usize;

    /// Writes the fields, and returns the length of the payload. Zeros at its end do not count, but its first
    /// byte always does.
    fn ser(&self, payload: &mut [u8; 255]) -> usize;

    /// Reads the fields. What a short payload lacks is zero.
    fn deser(payload: &[u8]) -> Self;
}

/// A field of a message.
pub(super) trait Field: Sized {
    /// Type of the field, or of its elements, in the dialect.
    const KIND: &'static str;
    /// Number of the elements of an array; 0 if the field is none.
    const COUNT: u8 = 0;
    const SIZE: usize;
    const ZERO: Self;

    /// Writes the value to the beginning of `rest`, and moves `rest` behind it.
    fn write(&self, rest: &mut &mut [u8]);

    /// Reads the value from the beginning of `rest`, and moves `rest` behind it.
    fn read(rest: &mut &[u8]) -> Self;
}

macro_rules! numbers {
    ($($type:ident $kind:literal)*) => {$(
        impl Field for $type {
            const KIND: &'static str = $kind;
            const SIZE: usize = size_of::<Self>();
            const ZERO: Self = 0 as Self;

            fn write(&self, rest: &mut &mut [u8]) {
                put(rest, &self.to_le_bytes());
            }

            fn read(rest: &mut &[u8]) -> Self {
                Self::from_le_bytes(take(rest))
            }
        }
    )*};
}

numbers! {
    u8 "uint8_t" i8 "int8_t" u16 "uint16_t" i16 "int16_t" u32 "uint32_t" i32 "int32_t"
    u64 "uint64_t" i64 "int64_t" f32 "float"
}

impl<T: Field + Copy, const N: usize> Field for [T; N] {
    const KIND: &'static str = T::KIND;
    const COUNT: u8 = N as u8;
    const SIZE: usize = N * T::SIZE;
    const ZERO: Self = [T::ZERO; N];

    fn write(&self, rest: &mut &mut [u8]) {
        for value in self {
            value.write(rest);
        }
    }

    fn read(rest: &mut &[u8]) -> Self {
        [(); N].map(|()| T::read(rest))
    }
}

/// A text as a field of `N` bytes. A shorter text ends with a zero byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CharArray<const N: usize>([u8; N]);

impl<const N: usize> CharArray<N> {
    /// The text.
    ///
    /// # Errors
    /// [`Utf8Error`]: the bytes before the first zero are not UTF-8.
    pub fn to_str(&self) -> Result<&str, Utf8Error> {
        let text = self.0.split(|byte| *byte == 0).next();
        core::str::from_utf8(text.unwrap_or_default())
    }
}

impl<const N: usize> From<[u8; N]> for CharArray<N> {
    fn from(bytes: [u8; N]) -> Self {
        Self(bytes)
    }
}

impl<const N: usize> Deref for CharArray<N> {
    type Target = [u8; N];

    fn deref(&self) -> &[u8; N] {
        &self.0
    }
}

impl<const N: usize> DerefMut for CharArray<N> {
    fn deref_mut(&mut self) -> &mut [u8; N] {
        &mut self.0
    }
}

impl<const N: usize> Field for CharArray<N> {
    const KIND: &'static str = "char";
    const COUNT: u8 = N as u8;
    const SIZE: usize = N;
    const ZERO: Self = Self([0; N]);

    fn write(&self, rest: &mut &mut [u8]) {
        put(rest, &self.0);
    }

    fn read(rest: &mut &[u8]) -> Self {
        Self(take(rest))
    }
}

/// A text as a field of `N` bytes, cut before the first character that does not fit.
#[must_use]
pub fn text<const N: usize>(text: &str) -> CharArray<N> {
    let text = text.get(..text.floor_char_boundary(N)).unwrap_or_default();
    CharArray(take(&mut text.as_bytes()))
}

/// Writes bytes that have room: the table of messages says that a message fits its payload.
fn put(rest: &mut &mut [u8], bytes: &[u8]) {
    if let Some((place, behind)) = mem::take(rest).split_at_mut_checked(bytes.len()) {
        place.copy_from_slice(bytes);
        *rest = behind;
    }
}

/// The next `N` bytes, with zeros in place of bytes that are not there.
fn take<const N: usize>(rest: &mut &[u8]) -> [u8; N] {
    let mut bytes = [0; N];
    let (there, behind) = rest.split_at_checked(N).unwrap_or((*rest, &[]));
    for (byte, there) in bytes.iter_mut().zip(there) {
        *byte = *there;
    }
    *rest = behind;
    bytes
}

/// The length of a payload without the zeros at its end.
pub(super) fn length(payload: &[u8]) -> usize {
    let last = payload.iter().rposition(|byte| *byte != 0);
    last.map_or(1, |last| last + 1)
}

/// The checksum of a frame: of its bytes from the second on, and of the message's own byte.
pub(super) fn checksum(bytes: &[u8], extra: u8) -> u16 {
    let sum = bytes.iter().fold(EMPTY, |sum, byte| add(sum, *byte));
    add(sum, extra)
}

/// What the checksum of a message's fields needs of a field.
pub(super) struct Signature {
    kind: &'static str,
    name: &'static str,
    count: u8,
}

impl Signature {
    pub(super) const fn of<T: Field>(name: &'static str) -> Self {
        Self {
            kind: T::KIND,
            name,
            count: T::COUNT,
        }
    }
}

/// The checksum of a message's name and of its fields in their order, extensions excepted, in one byte.
///
/// Source: <https://mavlink.io/en/guide/serialization.html#crc_extra>. The compiler computes it.
#[allow(clippy::indexing_slicing)]
pub(super) const fn extra_crc(name: &str, fields: &[Signature]) -> u8 {
    let mut sum = add_word(EMPTY, name);
    let mut at = 0;
    while at < fields.len() {
        let Signature { kind, name, count } = fields[at];
        sum = add_word(add_word(sum, kind), name);
        if count > 0 {
            sum = add(sum, count);
        }
        at += 1;
    }
    (sum ^ sum >> 8) as u8
}

#[allow(clippy::indexing_slicing)]
const fn add_word(mut sum: u16, word: &str) -> u16 {
    let mut at = 0;
    while at < word.len() {
        sum = add(sum, word.as_bytes()[at]);
        at += 1;
    }
    add(sum, b' ')
}

/// The checksum of no bytes.
const EMPTY: u16 = 0xFFFF;

/// CRC-16/MCRF4XX with one more byte.
const fn add(sum: u16, byte: u8) -> u16 {
    let low = sum as u8 ^ byte;
    let mixed = (low ^ low << 4) as u16;
    sum >> 8 ^ mixed << 8 ^ mixed << 3 ^ mixed >> 4
}
