//! The folder of the repository, and the folder for the output of commands.

use anyhow::Result;
use std::path::{Path, PathBuf};

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
