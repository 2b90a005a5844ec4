//! The Debian package of the harness, made with `dpkg-deb`.

use crate::folders::{VERSION, root};
use crate::toolchain::{install, output, succeed};
use anyhow::{Context, Result};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Makes the package of a harness, and returns it.
pub(crate) fn package(program: &Path) -> Result<PathBuf> {
    install(&[("/usr/bin/dpkg-deb", "dpkg")])?;
    let target = root().canonicalize()?.join("target");
    let tree = target.join("deb/tree");
    if tree.exists() {
        fs::remove_dir_all(&tree)?;
    }
    copy(program, &tree.join("usr/bin/sil-harness"), 0o755)?;
    completions(program, &tree)?;
    let manual = tree.join("usr/share/man/man1");
    succeed(Command::new(program).arg("man").arg("--out").arg(&manual))?;
    let shared = tree.join("usr/share/sil-harness");
    for folder in ["aircraft", "docs/scenarios", "docs/fields", "docs/lidars"] {
        copy_folder(&root().join(folder), &shared.join(folder))?;
    }
    let documents = tree.join("usr/share/doc/sil-harness");
    for file in ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        copy(&root().join(file), &documents.join(file), 0o644)?;
    }
    let licence = fs::read(root().join("LICENSE-MIT"))?;
    write(&documents.join("copyright"), &licence)?;
    let architecture = output(Command::new("dpkg").arg("--print-architecture"))?;
    let architecture = architecture.trim();
    write(
        &tree.join("DEBIAN/control"),
        control(architecture, size(&tree)?).as_bytes(),
    )?;
    let package = target.join(format!("deb/sil-harness_{VERSION}_{architecture}.deb"));
    let mut build = Command::new("dpkg-deb");
    succeed(
        build
            .args(["--root-owner-group", "--build"])
            .arg(&tree)
            .arg(&package),
    )?;
    Ok(package)
}

/// The package's description. It needs the C library alone.
fn control(architecture: &str, kibibytes: u64) -> String {
    format!(
        "Package: sil-harness\nVersion: {VERSION}\nArchitecture: {architecture}\nSection: science\n\
         Priority: optional\nInstalled-Size: {kibibytes}\nDepends: libc6, libgcc-s1\n\
         Maintainer: The MPP maintainers <maintainers@mpp.example>\n\
         Description: Software in the loop for Model Predictive Planning\n\
         \x20Flies the MPP flight core through obstacle fields, alone or in campaigns, and serves ground\n\
         \x20stations over MAVLink and browsers.\n"
    )
}

fn completions(program: &Path, tree: &Path) -> Result<()> {
    for (shell, place) in [
        ("bash", "usr/share/bash-completion/completions/sil-harness"),
        ("zsh", "usr/share/zsh/vendor-completions/_sil-harness"),
        (
            "fish",
            "usr/share/fish/vendor_completions.d/sil-harness.fish",
        ),
    ] {
        let script = output(Command::new(program).args(["completions", shell]))?;
        write(&tree.join(place), script.as_bytes())?;
    }
    Ok(())
}

fn write(place: &Path, bytes: &[u8]) -> Result<()> {
    fs::create_dir_all(place.parent().context("a place without a folder")?)?;
    fs::write(place, bytes).with_context(|| place.display().to_string())
}

pub(crate) fn copy(from: &Path, to: &Path, mode: u32) -> Result<()> {
    write(
        to,
        &fs::read(from).with_context(|| from.display().to_string())?,
    )?;
    Ok(fs::set_permissions(to, fs::Permissions::from_mode(mode))?)
}

/// Copies a folder of at most one level of folders.
pub(crate) fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let place = to.join(path.file_name().unwrap_or_default());
        if !path.is_dir() {
            copy(&path, &place, 0o644)?;
            continue;
        }
        for entry in fs::read_dir(&path)? {
            let file = entry?.path();
            copy(
                &file,
                &place.join(file.file_name().unwrap_or_default()),
                0o644,
            )?;
        }
    }
    Ok(())
}

/// Size of a folder \[kibibytes\].
fn size(tree: &Path) -> Result<u64> {
    let printed = output(Command::new("du").args(["-sk"]).arg(tree))?;
    let number = printed
        .split_whitespace()
        .next()
        .context("du printed nothing")?;
    Ok(number.parse()?)
}
