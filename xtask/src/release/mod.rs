//! `release`: makes what a release holds, in target/release-VERSION, and tries each part in a clean folder.

mod c;
mod notes;
mod tried;

pub(crate) use c::{cortex_m, lay_out, try_out};

use crate::folders::{VERSION, files, root, work};
use crate::toolchain::{cargo, output, succeed};
use crate::{aarch64, deb, wasm};
use anyhow::{Context, Result, bail};
use std::fs::{copy, create_dir_all, remove_dir_all};
use std::path::{Path, PathBuf};
use std::process::Command;

const HOST: &str = "x86_64-unknown-linux-gnu";
/// The parts, in the order in which they are made.
const PARTS: [&str; 6] = ["harness", "aarch64", "c", "deb", "wheel", "page"];

#[derive(Debug, clap::Args)]
pub(crate) struct ReleaseArgs {
    /// Make these parts alone: harness, aarch64, c, deb, wheel, page
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
}

pub(crate) fn run(args: &ReleaseArgs) -> Result<()> {
    if let Some(part) = args.only.iter().find(|it| !PARTS.contains(&it.as_str())) {
        bail!("--only {part}: the parts are {}", PARTS.join(", "));
    }
    let place = root()
        .canonicalize()?
        .join(format!("target/release-{VERSION}"));
    if place.exists() {
        remove_dir_all(&place)?;
    }
    create_dir_all(&place)?;
    for part in PARTS {
        if !args.only.is_empty() && !args.only.iter().any(|it| it == part) {
            continue;
        }
        println!("{part} ..");
        match part {
            "harness" => harness(&static_harness()?, "x86_64-linux", &place)?,
            "aarch64" => harness(&aarch64::program("thin")?, "aarch64-linux", &place)?,
            "c" => library(&place)?,
            "deb" => take(&deb::package(&static_harness()?)?, &place)?,
            "wheel" => wheel(&place)?,
            _ => {
                for page in wasm::pages()? {
                    take(&page, &place)?;
                }
            }
        }
    }
    notes::write(&place)?;
    tried::try_all(&place)?;
    for entry in files(&place)? {
        println!("{}", entry.display());
    }
    Ok(())
}

/// Builds the harness with all formats and without a shared library, so that it runs on any Linux of the processor.
fn static_harness() -> Result<PathBuf> {
    let target = work("static")?;
    let what = "-p sil-harness --features formats,clarabel";
    let mut cargo = cargo(&format!(
        "build --quiet --release --locked --target {HOST} {what}"
    ));
    cargo.env("RUSTFLAGS", flags()?).arg("--target-dir");
    succeed(cargo.arg(&target))?;
    Ok(target.join(HOST).join("release/sil-harness"))
}

/// A static program that names no folder of this machine.
fn flags() -> Result<String> {
    let home = std::env::var("CARGO_HOME").or_else(|_| {
        let home = std::env::var("HOME").context("HOME is not set")?;
        Ok::<_, anyhow::Error>(format!("{home}/.cargo"))
    })?;
    let own = root().canonicalize()?;
    Ok(format!(
        "-Ctarget-feature=+crt-static -Cstrip=symbols --remap-path-prefix={}=/mpp --remap-path-prefix={home}=/cargo",
        own.display()
    ))
}

/// Packs a harness with what it flies.
fn harness(program: &Path, machine: &str, place: &Path) -> Result<()> {
    let name = format!("sil-harness-{VERSION}-{machine}");
    let tree = place.join(&name);
    deb::copy(program, &tree.join("sil-harness"), 0o755)?;
    for folder in ["aircraft", "docs/scenarios", "docs/fields", "docs/lidars"] {
        deb::copy_folder(&root().join(folder), &tree.join(folder))?;
    }
    for file in ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        deb::copy(&root().join(file), &tree.join(file), 0o644)?;
    }
    pack(place, &name)
}

/// Packs the C library: for this machine with CMake and pkg-config, and the archives for flight computers.
fn library(place: &Path) -> Result<()> {
    succeed(&mut cargo(
        "build --quiet --release --locked -p mpp-c-plant",
    ))?;
    let name = format!("mpp-c-{VERSION}-x86_64-linux");
    let tree = place.join(&name);
    lay_out(&tree, &root().join("target/release/libmpp_c_plant.a"))?;
    let mut archives = vec![("aarch64-linux", aarch64::library()?)];
    for processor in ["cortex-m4", "cortex-m7"] {
        archives.push((processor, cortex_m(processor)?));
    }
    for (machine, archive) in archives {
        deb::copy(
            &archive,
            &tree.join("lib").join(machine).join("libmpp.a"),
            0o644,
        )?;
    }
    deb::copy_folder(&root().join("bindings/c/example"), &tree.join("example"))?;
    pack(place, &name)
}

/// Builds the wheel for any Linux since 2014: zig links against the old C library.
fn wheel(place: &Path) -> Result<()> {
    let tools = work("wheel")?;
    succeed(Command::new("python3").args(["-m", "venv"]).arg(&tools))?;
    let mut pip = Command::new(tools.join("bin/pip"));
    succeed(pip.args(["install", "--quiet", "maturin[zig]>=1.9,<2"]))?;
    let mut maturin = Command::new(tools.join("bin/maturin"));
    let path = std::env::var("PATH")?;
    maturin
        .current_dir(root().join("bindings/python"))
        .env("PATH", format!("{}:{path}", tools.join("bin").display()))
        .args(["build", "--quiet", "--release", "--locked", "--zig"])
        .args(["--compatibility", "manylinux2014", "--out"]);
    succeed(maturin.arg(place))
}

/// Makes `NAME.tar.gz` of a folder, with the same bytes each time, and removes the folder.
fn pack(place: &Path, name: &str) -> Result<()> {
    let mut git = Command::new("git");
    let time = output(git.current_dir(root()).args(["log", "-1", "--format=@%ct"]))?;
    let mut tar = Command::new("tar");
    tar.current_dir(place)
        .args(["--sort=name", "--owner=0", "--group=0", "--numeric-owner"])
        .arg(format!("--mtime={}", time.trim()))
        .args(["--use-compress-program=gzip -n", "-cf"])
        .args([&format!("{name}.tar.gz"), name]);
    succeed(&mut tar)?;
    Ok(remove_dir_all(place.join(name))?)
}

fn take(file: &Path, place: &Path) -> Result<()> {
    let name = file.file_name().context("a file has a name")?;
    copy(file, place.join(name))?;
    Ok(())
}
