//! The check of the image: a checksum over code, constants and first contents of RAM.

use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

/// The checksum, which `cargo xtask` writes into the linked image. It counts as 0 in the sum itself.
#[unsafe(no_mangle)]
static IMAGE_CHECKSUM: u32 = 0;

unsafe extern "C" {
    /// Beginning of the flash.
    static __vector_table: u32;
    /// Where the first contents of RAM lie in the flash, which are last in it.
    static __sidata: u32;
    static __sdata: u32;
    static __edata: u32;
}

/// Without a table: it runs once, and a table takes 1 kB.
static CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// Whether the image is as it was linked.
#[must_use]
pub fn is_whole() -> bool {
    let data = (&raw const __edata as usize).saturating_sub(&raw const __sdata as usize);
    let end = (&raw const __sidata as usize).saturating_add(data);
    let mut sum = CRC.digest();
    let mut at = &raw const __vector_table;
    while (at as usize) < end {
        // SAFETY: the address is in the flash, and aligned. Reads are volatile, because flash is no object of
        // the language, and because its first word has the address 0.
        let word = unsafe { at.read_volatile() };
        let word = if core::ptr::eq(at, &raw const IMAGE_CHECKSUM) {
            0
        } else {
            word
        };
        sum.update(&word.to_le_bytes());
        at = at.wrapping_add(1);
    }
    // SAFETY: a reference is valid to read. The compiler must not take the value from the source.
    sum.finalize() == unsafe { (&raw const IMAGE_CHECKSUM).read_volatile() }
}
