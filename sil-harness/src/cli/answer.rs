//! The answers of the command line: data on stdout, messages on stderr, an exit code.

use crate::files::FileError;
use std::io::{ErrorKind, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code: the harness cannot do something, or it found an error.
pub(super) const FAILURE: u8 = 1;
/// Exit code: the command line is invalid.
pub(super) const USAGE: u8 = 2;
/// Exit code of a flight that has to be strict: it left the altitude band.
pub(super) const LEFT_BAND: u8 = 5;
/// Exit code: the link to the core failed.
pub(super) const LINK: u8 = 6;

/// Whether people asked for results and errors only.
static QUIET: AtomicBool = AtomicBool::new(false);

/// From now on [`talk`] is silent.
pub(super) fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Whether [`talk`] is silent.
pub(super) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Prints a line for people, unless they want results and errors only.
pub(super) fn talk(line: impl std::fmt::Display) {
    if !is_quiet() {
        complain(line);
    }
}

/// Prints an error. A flight does not depend on its readers, so a closed pipe is not an error
/// (`eprintln!` would panic).
pub(super) fn complain(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Prints a line of data. A reader that closes the pipe is no error; any other error, for instance a
/// full disk, is a failure.
pub(super) fn data(line: impl std::fmt::Display) -> Result<(), Failure> {
    let mut stdout = std::io::stdout();
    printed(writeln!(stdout, "{line}").and_then(|()| stdout.flush()))
}

fn printed(result: std::io::Result<()>) -> Result<(), Failure> {
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let what = format!("cannot write the result to the standard output: {error}");
            Err(Failure::new(FAILURE, what))
        }
        _ => Ok(()),
    }
}

/// Prints a line of data: a value as JSON.
pub(super) fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    data(serde_json::to_string(value).map_err(Failure::failed)?)
}

/// Prints a report, for people or as JSON.
pub(super) fn print(
    report: &(impl serde::Serialize + std::fmt::Display),
    json: bool,
) -> Result<(), Failure> {
    if json {
        return print_json(report);
    }
    data(report.to_string().trim_end())
}

/// Prints bytes of data as they are, with the same exception.
pub(super) fn data_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = std::io::stdout();
    printed(stdout.write_all(bytes).and_then(|()| stdout.flush()))
}

/// The reason why a command failed.
pub(super) struct Failure {
    pub(super) code: u8,
    pub(super) message: String,
}

impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        let code = if error.is_failure() { FAILURE } else { USAGE };
        Self::new(code, error)
    }
}

impl Failure {
    pub(super) fn new(code: u8, message: impl std::fmt::Display) -> Self {
        Self {
            code,
            message: message.to_string(),
        }
    }

    /// The command line, or a file that it names, makes no sense.
    pub(super) fn usage(message: impl std::fmt::Display) -> Self {
        Self::new(USAGE, message)
    }

    /// The harness cannot do something, or it found an error.
    pub(super) fn failed(message: impl std::fmt::Display) -> Self {
        Self::new(FAILURE, message)
    }
}
