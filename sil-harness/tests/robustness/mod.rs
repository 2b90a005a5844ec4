//! What goes wrong around a flight: full disks, foreign files, signals, strangers on a socket.

mod files;
#[cfg(unix)]
mod keys;
mod killed;
mod live;
mod mutated;
mod orders;
#[cfg(target_os = "linux")]
mod signals;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn harness() -> Command {
    Command::new(env!("CARGO_BIN_EXE_sil-harness"))
}

/// A new directory of this test's own; the name keeps tests apart.
fn scratch(name: &str) -> PathBuf {
    let name = format!("sil-robustness-{}-{name}", std::process::id());
    let path = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Runs the harness in a directory, where it also leaves what it writes.
fn run_in(directory: &Path, arguments: &[&str]) -> Output {
    let mut command = harness();
    command.current_dir(directory).args(arguments);
    command.output().unwrap()
}

fn talk(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
