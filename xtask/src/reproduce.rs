//! `reproduce`: builds the firmware from two checkouts and compares what a flight computer loads.
//!
//! Cargo puts the path of a local crate into the names of its symbols, and the linker orders by names. So each folder is
//! built under one name, a link in the folder for temporary files.

use crate::contents::{flash, sealed};
use crate::firmware::THUMB;
use crate::folders::{root, work};
use crate::toolchain::{Toolchain, succeed};
use anyhow::{Context, Result, bail};
use crc::{CRC_32_ISO_HDLC, Crc};
use std::path::Path;
use std::process::Command;

/// The folders.
const FOLDERS: [&str; 2] = ["reproduce/one", "reproduce/another-one/deeper"];

pub(crate) fn run() -> Result<()> {
    let [first, second] = FOLDERS.map(|folder| image(&work(folder)?));
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

/// Builds the flight image from a checkout of its own and returns what is loaded from it.
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
    if target.exists() {
        std::fs::remove_dir_all(&target)?;
    }
    let link = Link::to(folder)?;
    let mut cargo = Toolchain::find(THUMB)?.cargo("build", "firmware")?;
    cargo
        .current_dir(folder.join("firmware"))
        .env("CARGO_TARGET_DIR", Path::new(link.0).join("target"))
        .arg("--manifest-path")
        .arg(Path::new(link.0).join("firmware/Cargo.toml"))
        .args(["--release", "--bin", "uart"]);
    succeed(&mut cargo)?;
    let built = target.join(THUMB).join("release/uart");
    let bytes = std::fs::read(&built).with_context(|| built.display().to_string())?;
    flash(&sealed(bytes)?)
}

/// The one name under which each folder is built. Two of these commands cannot run at a time.
struct Link(&'static str);

impl Link {
    fn to(folder: &Path) -> Result<Self> {
        const NAME: &str = "/tmp/mpp-firmware";
        std::os::unix::fs::symlink(folder, NAME).with_context(|| {
            format!("{NAME}: another such command runs, or was killed; then remove this link")
        })?;
        Ok(Self(NAME))
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        // Who cannot remove the link is told so by the next build.
        let _ = std::fs::remove_file(self.0);
    }
}
