//! Builds the firmware.

use crate::contents;
use crate::folders::{root, work};
use crate::toolchain::{Toolchain, install, output, succeed};
use anyhow::{Context, Result, bail};
use std::path::PathBuf;
use std::process::Command;

pub(crate) const THUMB: &str = "thumbv7em-none-eabihf";

/// The images of the firmware.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Image {
    /// The flight image: flies over a serial line in real time, with the flight planner alone.
    Uart,
    /// The flight image in lockstep, to compare its bytes with the host's.
    Lockstep,
    /// Flies over semihosting, with the flight planner alone.
    Fifo,
    /// Flies over semihosting, with the paper's method beside the flight planner, to compare them.
    Comparison,
    /// The image [`Image::Lockstep`] with faults for tests.
    UartFaults,
    /// The image [`Image::Fifo`] with faults for tests.
    FifoFaults,
    /// The planner in space, over semihosting.
    Space,
    /// Flies over the serial line of a Nucleo-H743ZI.
    Nucleo,
}

/// All images for the emulator.
const ALL: [Image; 7] = [
    Image::Uart,
    Image::Lockstep,
    Image::Fifo,
    Image::Comparison,
    Image::UartFaults,
    Image::FifoFaults,
    Image::Space,
];

impl Image {
    fn name(self) -> &'static str {
        match self {
            Self::Uart => "flight",
            Self::Lockstep => "lockstep",
            Self::Fifo => "semihosting",
            Self::Comparison => "comparison",
            Self::UartFaults => "flight-faults",
            Self::FifoFaults => "semihosting-faults",
            Self::Space => "space-semihosting",
            Self::Nucleo => "nucleo-h743zi",
        }
    }

    /// The firmware's program for this image, and the features with which it is built.
    fn program(self) -> (&'static str, &'static [&'static str]) {
        match self {
            Self::Uart => ("uart", &[]),
            Self::Lockstep => ("uart", &["--features", "lockstep"]),
            Self::Fifo => ("fifo", &[]),
            Self::Comparison => ("fifo", &["--features", "paper"]),
            Self::UartFaults => ("uart", &["--features", "lockstep,faults"]),
            Self::FifoFaults => ("fifo", &["--features", "faults"]),
            Self::Space => ("space", &[]),
            Self::Nucleo => ("nucleo", &[]),
        }
    }

    /// The folder of the program's crate.
    fn folder(self) -> &'static str {
        match self {
            Self::Nucleo => "firmware/nucleo",
            _ => "firmware",
        }
    }

    /// The path to which the build writes the image.
    pub(crate) fn path(self) -> Result<PathBuf> {
        Ok(release()?.join(self.name()))
    }
}

/// The folder of cargo's output.
fn release() -> Result<PathBuf> {
    Ok(work("")?.join(THUMB).join("release"))
}

/// Builds all images, and checks the libraries for a bare 64-bit ARM, whose code the flights under Linux test.
pub(crate) fn build_all() -> Result<()> {
    build(&ALL)?;
    let toolchain = Toolchain::find("aarch64-unknown-none")?;
    let all = "--locked -p mpp-core -p hil-protocol -p mpp-node";
    succeed(toolchain.cargo("check", "")?.args(all.split(' ')))
}

/// Builds images. An image links only if nothing in it can panic.
pub(crate) fn build(images: &[Image]) -> Result<()> {
    let toolchain = Toolchain::find(THUMB)?;
    for image in images {
        let (program, features) = image.program();
        // The workspace's versions are used for everything. This is not --locked: cargo drops the
        // packages that are not used here.
        let lock = root().join(image.folder()).join("Cargo.lock");
        std::fs::copy(root().join("Cargo.lock"), lock)?;
        // Stack sizes are not loaded: the image is the same with and without them.
        let stack_sizes = ["-Z", "emit-stack-sizes", "-C", "link-arg=-Tstack_sizes.x"];
        let mut command = toolchain.cargo("rustc", image.folder())?;
        command
            .env("RUSTC_BOOTSTRAP", "1")
            .args(["--release", "--bin", program])
            .args(features)
            .arg("--")
            .args(stack_sizes);
        if !command.status().context("running cargo")?.success() {
            list_panics(&toolchain, *image)?;
            bail!("the firmware does not build; if it does not link, see the panics above");
        }
        // Several images come from the same program, so each of them is put aside.
        let bytes = std::fs::read(release()?.join(program))?;
        std::fs::write(image.path()?, contents::sealed(bytes)?)?;
    }
    has_no_faults(Image::Uart)?;
    has_no_faults(Image::Nucleo)
}

/// Checks that an image contains no fault of `firmware/src/faults.rs`, if it is built.
fn has_no_faults(image: Image) -> Result<()> {
    use object::{Object, ObjectSymbol};
    let Ok(bytes) = std::fs::read(image.path()?) else {
        return Ok(());
    };
    let file = object::File::parse(&*bytes)?;
    let mut names = file.symbols().filter_map(|symbol| symbol.name().ok());
    if let Some(name) = names.find(|name| name.starts_with("FAULT_")) {
        bail!("the flight image contains a fault for tests: {name}");
    }
    Ok(())
}

/// Links an image in spite of its panics, and prints the places of the panics.
fn list_panics(toolchain: &Toolchain, image: Image) -> Result<()> {
    let mut command = toolchain.cargo("rustc", image.folder())?;
    let handler = "link-arg=--defsym=a_panic_path_is_still_reachable=0";
    let (program, features) = image.program();
    command.args(["--release", "--bin", program]).args(features);
    succeed(command.args(["--", "-C", handler]))?;
    install(&[("/usr/bin/arm-none-eabi-objdump", "binutils-arm-none-eabi")])?;
    eprintln!("calls to panics, once their handler is defined:");
    succeed(Command::new(root().join("firmware/panic-sites")).arg(release()?.join(program)))
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
