//! The contents of linked images: words that tests change, and the checksum that the image checks at its
//! start.

use anyhow::{Context, Result};
use crc::{CRC_32_ISO_HDLC, Crc};
use object::elf::PT_LOAD;
use object::read::elf::{ElfFile32, ProgramHeader};
use object::{Endianness, Object, ObjectSection, ObjectSymbol};
use std::path::Path;

/// The word for the checksum, in firmware/src/image.rs. It counts as 0 in the sum.
const CHECKSUM: &str = "IMAGE_CHECKSUM";

/// Copies an image and changes words, so that each symbol holds its value. The checksum is that of the copy.
pub(crate) fn patched(image: &Path, words: &[(&str, u32)], to: &Path) -> Result<()> {
    let mut bytes = std::fs::read(image)?;
    for (symbol, value) in words {
        write_word(&mut bytes, symbol, *value)?;
    }
    std::fs::write(to, sealed(bytes)?)?;
    Ok(())
}

/// Copies an image and flips one bit of a word, but leaves the checksum as it was.
pub(crate) fn damaged(image: &Path, symbol: &str, bit: u32, to: &Path) -> Result<()> {
    let mut bytes = std::fs::read(image)?;
    let place = place(&bytes, symbol)?;
    let byte = bytes.get_mut(place).context("a symbol beyond the file")?;
    *byte ^= 1 << bit;
    std::fs::write(to, bytes)?;
    Ok(())
}

/// Writes the checksum into a linked image.
pub(crate) fn sealed(mut bytes: Vec<u8>) -> Result<Vec<u8>> {
    write_word(&mut bytes, CHECKSUM, 0)?;
    let checksum = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&flash(&bytes)?);
    write_word(&mut bytes, CHECKSUM, checksum)?;
    Ok(bytes)
}

/// The bytes that an image puts into the flash, from the beginning of the flash to the end of the first contents of RAM.
pub(crate) fn flash(bytes: &[u8]) -> Result<Vec<u8>> {
    let file = ElfFile32::<Endianness>::parse(bytes)?;
    let address = |name: &str| -> Result<u64> {
        let symbol = file.symbol_by_name(name);
        Ok(symbol
            .with_context(|| format!("no symbol {name}"))?
            .address())
    };
    let base = address("__vector_table")?;
    let end = address("__sidata")? + address("__edata")? - address("__sdata")?;
    let length = end
        .checked_sub(base)
        .context("the contents of RAM before the flash")?;
    let mut flash = vec![0; usize::try_from(length)?];
    let endian = file.endian();
    for segment in file.elf_program_headers() {
        let (start, size) = (segment.p_paddr(endian), segment.p_filesz(endian));
        let is_loaded = segment.p_type(endian) == PT_LOAD && size > 0;
        if is_loaded && (base..end).contains(&u64::from(start)) {
            let data = segment
                .data(endian, bytes)
                .ok()
                .context("a segment beyond the file")?;
            flash
                .get_mut(usize::try_from(u64::from(start) - base)?..)
                .and_then(|flash| flash.get_mut(..data.len()))
                .context("a segment beyond the first contents of RAM")?
                .copy_from_slice(data);
        }
    }
    Ok(flash)
}

fn write_word(bytes: &mut [u8], symbol: &str, value: u32) -> Result<()> {
    let place = place(bytes, symbol)?;
    bytes
        .get_mut(place..place + 4)
        .context("a symbol beyond the file")?
        .copy_from_slice(&value.to_le_bytes());
    Ok(())
}

/// The place of a symbol's contents in the file.
fn place(bytes: &[u8], symbol: &str) -> Result<usize> {
    let file = object::File::parse(bytes)?;
    let symbol = file
        .symbol_by_name(symbol)
        .with_context(|| format!("no symbol {symbol}"))?;
    let section = symbol.section_index().context("a symbol without section")?;
    let section = file.section_by_index(section)?;
    let (start, _) = section.file_range().context("a section without bytes")?;
    Ok(usize::try_from(
        start + (symbol.address() & !1) - section.address(),
    )?)
}
