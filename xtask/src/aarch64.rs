//! `aarch64`: runs the host's own tests and flights, built for 64-bit ARM, in the user-mode
//! emulator.

use crate::flight::Harness;
use crate::folders::work;
use crate::toolchain::{Toolchain, install, output, succeed};
use anyhow::{Context, Result, ensure};
use std::path::{Path, PathBuf};
use std::process::Command;

const TARGET: &str = "aarch64-unknown-linux-gnu";
/// The folder in which the emulator finds the C library.
const SYSROOT: &str = "/usr/aarch64-linux-gnu";

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Aarch64Args {
    /// Number of seeds to fly, from 1 on
    #[arg(long, default_value_t = 1)]
    flights: u64,
    /// Fly only, and leave out the tests of mpp-core and hil-protocol
    #[arg(long)]
    no_tests: bool,
    /// Fly preset `space` through light forests
    #[arg(long)]
    space: bool,
}

pub(crate) fn run(args: &Aarch64Args) -> Result<()> {
    if !args.no_tests {
        // This is not --release: to link each test with the whole of it optimised takes an hour.
        let tests = "--locked -p mpp-core -p hil-protocol";
        succeed(cargo(&toolchain()?, "test")?.args(tests.split(' ')))?;
    }
    let folder = work("aarch64")?;
    let target = harness(&folder)?;
    let host = Harness::build(&folder)?;
    for seed in 1..=args.flights {
        let mut arguments = vec!["--seed".to_owned(), seed.to_string()];
        if args.space {
            let space = ["--preset", "space", "--density", "0.02"];
            arguments.extend(space.map(str::to_owned));
        }
        let (host, target) = (host.fly(&arguments)?, target.fly(&arguments)?);
        println!(
            "seed {seed}: host {}, aarch64 {}",
            host.hash(),
            target.hash()
        );
        ensure!(host.hash() == target.hash(), "the flights differ");
    }
    Ok(())
}

/// Builds a harness that runs in the emulator. Its logs go to a folder.
pub(crate) fn harness(folder: &Path) -> Result<Harness> {
    // Optimisation over all crates at once takes minutes here, and changes no bit.
    let program = program("off")?;
    let wrapper = folder.join("sil-harness");
    write_wrapper(&wrapper, &program)?;
    Ok(Harness::with_program(wrapper, &folder.join("emulated")))
}

/// Builds the harness with a kind of optimisation over all crates. Without any a cycle takes three times as long.
pub(crate) fn program(lto: &str) -> Result<PathBuf> {
    let mut build = cargo(&toolchain()?, "build")?;
    build.args(["--locked", "--release", "-p", "sil-harness"]);
    succeed(build.env("CARGO_PROFILE_RELEASE_LTO", lto))?;
    Ok(work("")?.join(TARGET).join("release/sil-harness"))
}

/// Builds the C library, whose workspace has no locked versions of its own.
pub(crate) fn library() -> Result<PathBuf> {
    let mut build = cargo(&toolchain()?, "build")?;
    build.args([
        "--release",
        "--manifest-path",
        "bindings/c/embed/Cargo.toml",
    ]);
    succeed(&mut build)?;
    Ok(work("")?.join(TARGET).join("release/libmpp.a"))
}

/// The compiler and the emulator.
fn toolchain() -> Result<Toolchain> {
    install(&[
        ("/usr/bin/qemu-aarch64", "qemu-user"),
        ("/usr/bin/aarch64-linux-gnu-gcc", "gcc-aarch64-linux-gnu"),
        (
            "/usr/aarch64-linux-gnu/include/stdio.h",
            "libc6-dev-arm64-cross",
        ),
    ])?;
    Toolchain::find(TARGET)
}

/// Writes a script that runs a program in the emulator.
fn write_wrapper(path: &Path, program: &Path) -> Result<()> {
    use std::os::unix::fs::PermissionsExt;
    let text = format!(
        "#!/bin/sh\nexec qemu-aarch64 -L {SYSROOT} '{}' \"$@\"\n",
        program.display()
    );
    std::fs::write(path, text)?;
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755))?;
    Ok(())
}

fn cargo(toolchain: &Toolchain, subcommand: &str) -> Result<Command> {
    let mut command = toolchain.cargo(subcommand, "")?;
    command
        .env(
            "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER",
            "aarch64-linux-gnu-gcc",
        )
        .env(
            "CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER",
            format!("qemu-aarch64 -L {SYSROOT}"),
        );
    if toolchain.is_debian() {
        let library = format!("-L {}", standard_library()?.display());
        for flags in ["RUSTFLAGS", "RUSTDOCFLAGS"] {
            let variable = format!("CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_{flags}");
            command.env(variable, &library);
        }
    }
    Ok(command)
}

/// Unpacks Debian's standard library for this target into a folder aside. The package manager knows
/// nothing of it, and the package manager's own state is left alone.
fn standard_library() -> Result<PathBuf> {
    let folder = work("aarch64-std")?;
    let library = folder.join("root/usr/lib/rustlib").join(TARGET).join("lib");
    if library.is_dir() {
        return Ok(library);
    }
    for part in ["state/lists/partial", "cache/archives/partial"] {
        std::fs::create_dir_all(folder.join(part))?;
    }
    let apt = |arguments: &[&str]| -> Result<()> {
        let mut command = Command::new("apt-get");
        for (option, value) in [
            ("APT::Architecture", "arm64".to_owned()),
            ("APT::Architectures", "arm64".to_owned()),
            ("Dir::State", folder.join("state").display().to_string()),
            ("Dir::Cache", folder.join("cache").display().to_string()),
            ("Dir::State::status", "/dev/null".to_owned()),
        ] {
            command.arg("-o").arg(format!("{option}={value}"));
        }
        succeed(command.current_dir(&folder).args(["-qq"]).args(arguments))
    };
    // The version is the same as the compiler's.
    let version = output(Command::new("dpkg-query").args(["-W", "-f", "${Version}", "rustc-web"]))?;
    apt(&["update"])?;
    apt(&["download", &format!("libstd-rust-web-dev={version}")])?;
    let package = std::fs::read_dir(&folder)?
        .filter_map(|entry| Some(entry.ok()?.path()))
        .find(|path| path.extension().is_some_and(|extension| extension == "deb"))
        .context("the package was not downloaded")?;
    succeed(
        Command::new("dpkg-deb")
            .arg("-x")
            .arg(package)
            .arg(folder.join("root")),
    )?;
    Ok(library)
}
