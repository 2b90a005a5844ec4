//! `nucleo`: builds the image for a board that one can buy, and says what it takes of it.

use crate::firmware::{self, Image};
use crate::{budget, stack};
use anyhow::{Result, ensure};

/// Flash and RAM of an STM32H743ZI \[bytes\]: DTCM and AXI SRAM, which memory.x uses.
const FLASH: u64 = 2 << 20;
const RAM: u64 = (128 + 512) << 10;

pub(crate) fn run() -> Result<()> {
    firmware::build(&[Image::Nucleo])?;
    let path = Image::Nucleo.path()?;
    let (flash, static_ram) = budget::sizes(Image::Nucleo)?;
    let (bound, room) = (stack::bound(&path)?, stack::room(&path)?);
    println!("{}", path.display());
    println!("flash       {flash:>8} of {FLASH:>8} bytes");
    println!("static RAM  {static_ram:>8} of {:>8} bytes", RAM - room);
    println!("stack bound {bound:>8} of {room:>8} bytes");
    ensure!(flash <= FLASH, "the image does not fit into the flash");
    ensure!(
        bound <= room,
        "the stack may need more than memory.x gives it"
    );
    Ok(())
}
