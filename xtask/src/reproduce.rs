//! `reproduce`: builds the firmware in two folders with other paths and compares what a flight computer loads.

use crate::contents::{flash, sealed};
use crate::firmware::THUMB;
use crate::folders::{root, work};
use crate::toolchain::{Toolchain, succeed};
use anyhow::{Context, Result, bail};
use crc::{CRC_32_ISO_HDLC, Crc};
use std::path::Path;
use std::process::Command;

/// The folders: their paths have other lengths.
const FOLDERS: [&str; 2] = ["reproduce/one", "reproduce/another-one/deeper"];

pub(crate) fn run() -> Result<()> {
    let images = FOLDERS.map(|folder| image(&work(folder)?));
    let [first, second] = images;
    let (first, second) = (first?, second?);
    if first != second {
        let place = first.iter().zip(&second).position(|(a, b)| a != b);
        bail!(
            "the images differ: {} and {} bytes, first at {place:?}",
            first.len(),
            second.len()
        );
    }
    let checksum = Crc::<u32>::new(&CRC_32_ISO_HDLC).checksum(&first);
    println!(
        "{} bytes of flash, CRC-32 {checksum:08x}, the same from {} and {}",
        first.len(),
        FOLDERS[0],
        FOLDERS[1]
    );
    Ok(())
}

/// Builds the flight image in a folder of its own and returns what is loaded from it.
fn image(folder: &Path) -> Result<Vec<u8>> {
    // What git's index holds: no file that is not part of the project can make a difference.
    let prefix = format!("--prefix={}/", folder.display());
    let mut checkout = Command::new("git");
    checkout.current_dir(root());
    succeed(checkout.args(["checkout-index", "--all", "--force", &prefix]))?;
    std::fs::copy(
        folder.join("Cargo.lock"),
        folder.join("firmware/Cargo.lock"),
    )?;
    let target = folder.join("target");
    let mut cargo = Toolchain::find(THUMB)?.cargo("build", "firmware")?;
    cargo
        .current_dir(folder.join("firmware"))
        .env("CARGO_TARGET_DIR", &target)
        .args(["--release", "--bin", "uart"]);
    succeed(&mut cargo)?;
    let built = target.join(THUMB).join("release/uart");
    let bytes = std::fs::read(&built).with_context(|| built.display().to_string())?;
    flash(&sealed(bytes)?)
}
