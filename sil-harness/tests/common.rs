//! The program, and places for what it writes.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub(crate) fn harness() -> Command {
    Command::new(env!("CARGO_BIN_EXE_sil-harness"))
}

/// A place of a test's own; the name keeps tests apart.
pub(crate) fn place(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("sil-harness-{}-{name}", std::process::id()))
}

/// A new directory of a test's own.
pub(crate) fn scratch(name: &str) -> PathBuf {
    let path = place(name);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Runs the harness, which writes to a directory of the test's own.
pub(crate) fn run(name: &str, arguments: &[&str]) -> (Output, PathBuf) {
    let out = scratch(name);
    let mut command = harness();
    let output = command.args(arguments).arg("--out").arg(&out).output();
    (output.unwrap(), out)
}

/// Runs the harness in a directory, where it also leaves what it writes.
pub(crate) fn run_in(directory: &Path, arguments: &[&str]) -> Output {
    let mut command = harness();
    command.current_dir(directory).args(arguments);
    command.output().unwrap()
}

/// What it says on the standard error.
pub(crate) fn talk(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
