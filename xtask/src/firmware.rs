//! Builds the firmware.

use crate::toolchain::{Toolchain, install, output, succeed};
use crate::{root, work};
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::Command;

const THUMB: &str = "thumbv7em-none-eabihf";

/// The images.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Image {
    Uart,
    Fifo,
}

impl Image {
    fn name(self) -> &'static str {
        match self {
            Self::Uart => "uart",
            Self::Fifo => "fifo",
        }
    }

    /// Where the build puts it.
    pub(crate) fn path(self) -> Result<PathBuf> {
        Ok(work("")?.join(THUMB).join("release").join(self.name()))
    }
}

/// Builds both images and the libraries for a bare 64-bit ARM.
pub(crate) fn build_all() -> Result<()> {
    build()?;
    let toolchain = Toolchain::find("aarch64-unknown-none")?;
    succeed(toolchain.cargo("build", "")?.args([
        "--release",
        "--locked",
        "-p",
        "mpp-core",
        "-p",
        "hil-protocol",
        "-p",
        "flight-node",
    ]))
}

/// Builds both images. They only link if nothing in them can panic.
pub(crate) fn build() -> Result<()> {
    // The workspace's versions of everything. Not --locked: cargo drops what is not used here.
    std::fs::copy(
        root().join("Cargo.lock"),
        root().join("firmware/Cargo.lock"),
    )?;
    let toolchain = Toolchain::find(THUMB)?;
    for image in [Image::Uart, Image::Fifo] {
        // Stack sizes are not loaded: the image is the same with and without them.
        let stack_sizes = ["-Z", "emit-stack-sizes", "-C", "link-arg=-Tstack_sizes.x"];
        let mut command = toolchain.cargo("rustc", "firmware")?;
        command
            .env("RUSTC_BOOTSTRAP", "1")
            .args(["--release", "--bin", image.name(), "--"])
            .args(stack_sizes);
        if !command.status().context("running cargo")?.success() {
            list_panics(&toolchain, image)?;
            bail!("the firmware does not build; if it does not link, see the panics above");
        }
    }
    Ok(())
}

/// Links an image in spite of its panics, and prints where they are.
fn list_panics(toolchain: &Toolchain, image: Image) -> Result<()> {
    let mut command = toolchain.cargo("rustc", "firmware")?;
    let handler = "link-arg=--defsym=a_panic_path_is_still_reachable=0";
    succeed(command.args(["--release", "--bin", image.name(), "--", "-C", handler]))?;
    install(&[("/usr/bin/arm-none-eabi-objdump", "binutils-arm-none-eabi")])?;
    eprintln!("calls to panics, once their handler is defined:");
    succeed(Command::new(root().join("firmware/panic-sites")).arg(image.path()?))
}

/// Copies an image with a word changed: `symbol` holds `value`.
pub(crate) fn patched(image: Image, symbol: &str, value: u32, to: &Path) -> Result<()> {
    use object::{Object, ObjectSection, ObjectSymbol};
    let mut bytes = std::fs::read(image.path()?)?;
    let offset = {
        let file = object::File::parse(&*bytes)?;
        let symbol = file
            .symbol_by_name(symbol)
            .with_context(|| format!("no symbol {symbol}"))?;
        let section = symbol.section_index().context("a symbol without section")?;
        let section = file.section_by_index(section)?;
        let (start, _) = section.file_range().context("a section without bytes")?;
        usize::try_from(start + symbol.address() - section.address())?
    };
    bytes
        .get_mut(offset..offset + 4)
        .context("a symbol beyond the file")?
        .copy_from_slice(&value.to_le_bytes());
    std::fs::write(to, bytes)?;
    Ok(())
}

/// Versions of compiler and emulator, for reports.
pub(crate) fn versions() -> Result<String> {
    let toolchain = Toolchain::find(THUMB)?;
    let rustc = if toolchain.is_debian() {
        "/usr/bin/rustc"
    } else {
        "rustc"
    };
    let rustc = output(Command::new(rustc).arg("--version"))?;
    let qemu = output(Command::new("qemu-system-arm").arg("--version"))?;
    let first = |text: &str| text.lines().next().unwrap_or_default().to_owned();
    Ok(format!("{}; {}", first(&rustc), first(&qemu)))
}
