//! Finds or installs the tools that build and run code for other machines.

use crate::folders::{root, work};
use anyhow::{Context, Result, bail};
use std::path::Path;
use std::process::{Command, Stdio};

/// A cargo that builds for a target.
pub(crate) struct Toolchain {
    target: &'static str,
    /// Whether it is Debian's, which builds the libraries from source. Otherwise it is the
    /// installed rustup target.
    debian: bool,
}

impl Toolchain {
    /// The toolchain for a target.
    pub(crate) fn find(target: &'static str) -> Result<Self> {
        let debian = !has_rustup_target(target);
        if debian {
            install(&[
                ("/usr/bin/rustc", "rustc-web"),
                ("/usr/bin/cargo", "cargo-web"),
                (
                    "/usr/lib/rustlib/src/rust/library/core/Cargo.toml",
                    "rust-web-src",
                ),
                ("/usr/bin/ld.lld", "lld"),
            ])
            .with_context(|| format!("or, with rustup: rustup target add {target}"))?;
        }
        Ok(Self { target, debian })
    }

    /// Whether this is Debian's compiler.
    pub(crate) fn is_debian(&self) -> bool {
        self.debian
    }

    /// The libraries to build from source. Bare metal has only the core library.
    fn libraries(&self) -> &'static str {
        if self.target.starts_with("wasm32") {
            "-Zbuild-std=std,panic_abort"
        } else {
            "-Zbuild-std=core"
        }
    }

    /// `cargo SUBCOMMAND` for the target, in a folder of the repository.
    pub(crate) fn cargo(&self, subcommand: &str, folder: &str) -> Result<Command> {
        let mut command = Command::new(if self.debian {
            "/usr/bin/cargo"
        } else {
            "cargo"
        });
        command
            .current_dir(root().join(folder))
            .arg(subcommand)
            .args(["--quiet", "--target", self.target])
            .env("CARGO_TARGET_DIR", work("")?)
            // These variables would replace the flags of .cargo/config.toml.
            .env_remove("RUSTFLAGS")
            .env_remove("CARGO_ENCODED_RUSTFLAGS");
        if self.debian {
            // This avoids rustup's proxies, and uses a registry that no other version works on.
            command
                .env("PATH", "/usr/bin:/bin")
                .env("CARGO_HOME", work("cargo-home")?)
                // A build of the libraries from source is not stable.
                .env("RUSTC_BOOTSTRAP", "1");
            if !self.target.contains("linux") {
                // The targets' own linker, rust-lld, is not packaged. These are the same.
                let variable = self.target.to_uppercase().replace('-', "_");
                let linker = if self.target.starts_with("wasm32") {
                    "wasm-ld"
                } else {
                    "ld.lld"
                };
                command
                    .env(format!("CARGO_TARGET_{variable}_LINKER"), linker)
                    .arg(self.libraries());
            }
        }
        Ok(command)
    }
}

fn has_rustup_target(target: &str) -> bool {
    let output = Command::new("rustc").args(["--print", "sysroot"]).output();
    output.is_ok_and(|output| {
        let sysroot = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        let lib = Path::new(&sysroot)
            .join("lib/rustlib")
            .join(target)
            .join("lib");
        // Debian's own sysroot has only targets that are built there.
        sysroot != "/usr" && lib.is_dir()
    })
}

/// Installs the packages of missing files. `needs` holds pairs of file and Debian package.
pub(crate) fn install(needs: &[(&str, &str)]) -> Result<()> {
    let missing: Vec<&str> = needs
        .iter()
        .filter(|(file, _)| !Path::new(file).exists())
        .map(|(_, package)| *package)
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    eprintln!("installing {}", missing.join(", "));
    let how = format!("sudo apt-get install {}", missing.join(" "));
    let apt = |arguments: &[&str]| {
        let mut command = Command::new("apt-get");
        command.args(arguments).arg("-qq").stdout(Stdio::null());
        succeed(command.env("DEBIAN_FRONTEND", "noninteractive"))
    };
    apt(&["update"])
        .and_then(|()| {
            let install = ["install", "-y", "--no-install-recommends"];
            apt(&[&install, &missing[..]].concat())
        })
        .with_context(|| format!("packages are missing; on Debian 12: {how}"))
}

/// Cargo for this machine, with arguments.
pub(crate) fn cargo(arguments: &str) -> Command {
    let mut cargo = Command::new("cargo");
    cargo.current_dir(root()).args(arguments.split(' '));
    cargo
}

/// Runs a command to its end. Fails if the command fails.
pub(crate) fn succeed(command: &mut Command) -> Result<()> {
    let status = command
        .status()
        .with_context(|| format!("running {:?}", command.get_program()))?;
    if !status.success() {
        bail!("{:?} failed: {status}", command.get_program());
    }
    Ok(())
}

/// Runs a command and returns its output.
pub(crate) fn output(command: &mut Command) -> Result<String> {
    let output = command
        .output()
        .with_context(|| format!("running {:?}", command.get_program()))?;
    if !output.status.success() {
        bail!(
            "{:?} failed: {}\n{}",
            command.get_program(),
            output.status,
            String::from_utf8_lossy(&output.stderr)
        );
    }
    Ok(String::from_utf8(output.stdout)?)
}
