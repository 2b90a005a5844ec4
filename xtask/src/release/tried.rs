//! Tries what a release holds as its users do: in an empty folder, without the sources.

use super::c::{try_out, try_zephyr};
use crate::folders::files;
use crate::toolchain::output;
use anyhow::{Context, Result, ensure};
use std::fs::{create_dir_all, remove_dir_all};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// The golden flights; the first is the one that README shows.
const GOLDEN: &str = include_str!("../../../tests/golden/table.txt");

pub(super) fn try_all(place: &Path) -> Result<()> {
    let folder = std::env::temp_dir().join(format!("mpp-release-{}", std::process::id()));
    let mut sums = Command::new("sha256sum");
    output(
        sums.current_dir(place)
            .args(["--check", "--quiet", "SHA256SUMS"]),
    )?;
    for file in files(place)? {
        create_dir_all(&folder)?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let begun = Instant::now();
        let said = try_one(&file, &name, &folder).with_context(|| name.to_string())?;
        if let Some(said) = said {
            println!("{name}: {:.1} s to {said}", begun.elapsed().as_secs_f64());
        }
        remove_dir_all(&folder)?;
    }
    Ok(())
}

/// Uses a file; gives what was reached.
fn try_one(file: &Path, name: &str, folder: &Path) -> Result<Option<String>> {
    if name.ends_with(".whl") {
        return wheel(file, folder).map(Some);
    }
    if name.ends_with(".deb") {
        output(Command::new("dpkg-deb").arg("-x").arg(file).arg(folder))?;
        return fly(folder.join("usr/bin/sil-harness"), folder).map(Some);
    }
    if !name.ends_with(".tar.gz") {
        return Ok(None);
    }
    output(
        Command::new("tar")
            .current_dir(folder)
            .arg("-xzf")
            .arg(file),
    )?;
    let tree = folder.join(name.trim_end_matches(".tar.gz"));
    match name {
        _ if name.starts_with("mpp-c") => {
            let mut program = Command::new(try_out(&tree, folder)?);
            try_zephyr(&tree, folder)?;
            let said = output(program.args(["1", "20"]))?;
            check(&said).map(Some)
        }
        _ if name.contains(std::env::consts::ARCH) => {
            fly(tree.join("sil-harness"), folder).map(Some)
        }
        // A program for another machine runs in `cargo xtask aarch64`.
        _ => Ok(None),
    }
}

fn fly(program: PathBuf, folder: &Path) -> Result<String> {
    let said = output(
        Command::new(program)
            .current_dir(folder)
            .args(["fly", "--seed", "1"]),
    )?;
    check(&said)
}

fn wheel(file: &Path, folder: &Path) -> Result<String> {
    let venv = folder.join("venv");
    output(Command::new("python3").args(["-m", "venv"]).arg(&venv))?;
    let mut pip = Command::new(venv.join("bin/pip"));
    output(pip.args(["install", "--quiet"]).arg(file))?;
    let mut python = Command::new(venv.join("bin/python"));
    let said = output(python.current_dir(folder).args([
        "-c",
        "import mppflight as mpp; print(mpp.fly(seed=1).log_hash)",
    ]))?;
    check(&said)
}

/// Whether the hash is that of the golden flight of seed 1.
fn check(said: &str) -> Result<String> {
    let hash = GOLDEN
        .lines()
        .find_map(|line| line.strip_prefix("flight-20 "))
        .context("no golden flight")?
        .split_whitespace()
        .next()
        .context("no hash")?;
    ensure!(said.contains(hash), "{said}should have the hash {hash}");
    Ok(format!("the flight {hash}"))
}
