//! The folder of the repository, the folder for the output of commands, and the version of all.

use anyhow::Result;
use std::path::{Path, PathBuf};

/// The version of the workspace.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The top folder of the repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A folder for the output of a command.
pub(crate) fn work(name: &str) -> Result<PathBuf> {
    let path = root()
        .canonicalize()?
        .join("target")
        .join("cross")
        .join(name);
    std::fs::create_dir_all(&path)?;
    Ok(path)
}

/// The files of a folder, by name.
pub(crate) fn files(place: &Path) -> Result<Vec<PathBuf>> {
    let entries: std::io::Result<Vec<_>> = std::fs::read_dir(place)?
        .map(|entry| Ok(entry?.path()))
        .collect();
    let mut files = entries?;
    files.sort();
    Ok(files)
}
