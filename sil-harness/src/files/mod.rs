//! Files: scenarios, fields, logs, programs for solvers, recorded data.

mod worlds;

pub use worlds::{read_stems, read_terrain};

use mpp_analysis::check_reference::{Report, check, recorded_instances};
use mpp_analysis::instance::{Instance, InstanceError};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::field::{FieldError, FieldFile};
use mpp_sim::log::{FlightLog, LogError};
use mpp_sim::scenario::{LidarTable, ScenarioError, ScenarioFile};
use mpp_sim::space::world::{GridError, StemError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// The reason why a file cannot be used. The message names the file.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file cannot be read.
    #[error("cannot read {path}: {why}", path = .0.display(), why = with_advice(.1, "give a file that can be read"))]
    Read(PathBuf, #[source] io::Error),
    /// There is no aircraft with this name, and no file that can be read.
    #[error(
        "there is no aircraft `{0}`, and no such file can be read ({1}): give {known} or a file",
        known = AircraftFile::KNOWN.map(|(known, _)| known).join(", ")
    )]
    Aircraft(String, #[source] io::Error),
    /// The file cannot be written.
    #[error("cannot write {path}: {why}", path = .0.display(), why = with_advice(.1, "give a path that can be written"))]
    Write(PathBuf, #[source] io::Error),
    /// The file is no scenario; the error names the file.
    #[error("{0}")]
    Scenario(#[source] ScenarioError),
    /// The file is no field; the error names the file.
    #[error("{0}")]
    Field(#[source] FieldError),
    /// The file is no height map; the error names the file.
    #[error("{0}")]
    Terrain(#[source] GridError),
    /// The file is no stem map; the error names the file.
    #[error("{0}")]
    Stems(#[source] StemError),
    /// The file has rows of a campaign, where a flight's log is wanted.
    #[error("{path} is a row file: give a flight's log, which fly writes", path = .0.display())]
    Rows(PathBuf),
    /// The file is no flight log, or the log cannot be written.
    #[error("{path}: {1}", path = .0.display())]
    Log(PathBuf, #[source] LogError),
    /// The file holds no programs.
    #[error("{path}: {1}", path = .0.display())]
    Instances(PathBuf, #[source] InstanceError),
    /// The directory holds no programs.
    #[error(
        "{}: no programs: give a file of instances or a directory with case_*.json",
        .0.display()
    )]
    NoInstances(PathBuf),
    /// The directory holds no recorded data.
    #[error(
        "{} holds no .json files: give the directory of the recorded reference",
        .0.display()
    )]
    NoRecords(PathBuf),
}

/// What went wrong, and what to give instead if a path is at fault. The errors of this module say it themselves.
fn with_advice(error: &io::Error, advice: &str) -> String {
    match error.raw_os_error() {
        Some(_) if is_of_path(error) => format!("{error}: {advice}"),
        _ => error.to_string(),
    }
}

/// Whether another path would do, because this one leads nowhere, to the wrong kind of thing, or where nobody may write.
fn is_of_path(error: &io::Error) -> bool {
    use io::ErrorKind as Kind;
    matches!(
        error.kind(),
        Kind::NotFound
            | Kind::IsADirectory
            | Kind::NotADirectory
            | Kind::AlreadyExists
            | Kind::PermissionDenied
            | Kind::ReadOnlyFilesystem
    )
}

impl FileError {
    /// Whether the file could not be written: the command was sound, the machine was not.
    #[must_use]
    pub fn is_failure(&self) -> bool {
        matches!(self, Self::Write(..))
    }
}

/// Greatest size of a file that people write: scenarios, parameters, keys \[bytes\].
pub const MOST_WRITTEN: u64 = 1 << 20;
/// Greatest size of a field, which has at most 10,000 points \[bytes\].
const MOST_FIELD: u64 = 4 << 20;
/// Greatest size of a file that a program writes: logs, rows, programs \[bytes\].
pub const MOST_RECORDED: u64 = 1 << 30;
/// Greatest number of bytes from a pipe or a device, which may have no end.
const MOST_STREAMED: u64 = 64 << 20;

/// Reads a text of at most so many bytes. A pipe or a device gives fewer. A byte order mark, which some editors write,
/// is no part of it.
///
/// # Errors
/// The error of the operating system; or the file is longer, or is no text.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    let file = std::fs::File::open(path)?;
    let most = if file.metadata()?.is_file() {
        most
    } else {
        most.min(MOST_STREAMED)
    };
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let why = format!("it has more than {most} bytes: give another file");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, why));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let why = match error.as_bytes() {
            [0x1f, 0x8b, ..] | [b'P', b'K', 3, 4, ..] => "it is compressed: unpack it",
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => "it is UTF-16 text: save it as UTF-8",
            _ => "it is no UTF-8 text: give another file",
        };
        io::Error::new(io::ErrorKind::InvalidData, why)
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}

fn read(path: &Path, most: u64) -> Result<String, FileError> {
    read_text(path, most).map_err(|error| FileError::Read(path.to_owned(), error))
}

/// The files of a directory, in the order of their names.
fn list(directory: &Path) -> Result<Vec<PathBuf>, FileError> {
    let failed = |error| FileError::Read(directory.to_owned(), error);
    let entries = std::fs::read_dir(directory).map_err(failed)?;
    let paths = entries.map(|entry| Ok(entry.map_err(failed)?.path()));
    let mut paths = paths.collect::<Result<Vec<PathBuf>, FileError>>()?;
    paths.sort();
    Ok(paths)
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map(|stem| stem.to_string_lossy().into_owned())
        .unwrap_or_default()
}

fn is_json(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension == "json")
}

/// Reads a scenario.
///
/// # Errors
/// [`FileError::Read`] or [`FileError::Scenario`].
pub fn read_scenario(path: &Path) -> Result<ScenarioFile, FileError> {
    ScenarioFile::parse(&path.display().to_string(), &read(path, MOST_WRITTEN)?)
        .map_err(FileError::Scenario)
}

/// Reads an aircraft: one that comes with the project, by its name, or a file. Checks that it can be flown.
///
/// # Errors
/// [`FileError::Aircraft`] or [`FileError::Scenario`].
pub fn read_aircraft(name_or_path: &str) -> Result<AircraftFile, FileError> {
    if let Some(known) = AircraftFile::known(name_or_path) {
        return Ok(known);
    }
    let text = read_text(Path::new(name_or_path), MOST_WRITTEN)
        .map_err(|error| FileError::Aircraft(name_or_path.to_owned(), error))?;
    let file = AircraftFile::parse(name_or_path, &text).map_err(FileError::Scenario)?;
    let in_file = |error| ScenarioError::File(name_or_path.to_owned(), Box::new(error));
    AircraftModel::new(file.clone()).map_err(|error| FileError::Scenario(in_file(error)))?;
    Ok(file)
}

/// Reads a lidar.
///
/// # Errors
/// [`FileError::Read`] or [`FileError::Scenario`].
pub fn read_lidar(path: &Path) -> Result<LidarTable, FileError> {
    LidarTable::parse(&path.display().to_string(), &read(path, MOST_WRITTEN)?)
        .map_err(FileError::Scenario)
}

/// Reads a field.
///
/// # Errors
/// [`FileError::Read`] or [`FileError::Field`].
pub fn read_field(path: &Path) -> Result<FieldFile, FileError> {
    let name = path.display().to_string();
    FieldFile::parse(&name, &read(path, MOST_FIELD)?).map_err(FileError::Field)
}

/// Writes a field.
///
/// # Errors
/// [`FileError::Write`].
pub fn write_field(path: &Path, field: &FieldFile) -> Result<(), FileError> {
    let failed = |error| FileError::Write(path.to_owned(), io::Error::other(error));
    let text = field.to_toml().map_err(failed)?;
    write_whole(path, text.as_bytes())
}

/// Reads a flight's log.
///
/// # Errors
/// [`FileError::Read`] or [`FileError::Log`].
pub fn read_log(path: &Path) -> Result<FlightLog, FileError> {
    parse_log(path, &read_recorded(path)?)
}

/// Reads the text of a log or of a row file. A pipe gives it once only.
///
/// # Errors
/// [`FileError::Read`].
pub fn read_recorded(path: &Path) -> Result<String, FileError> {
    read(path, MOST_RECORDED)
}

/// The flight's log that a text of this file holds.
///
/// # Errors
/// [`FileError::Log`] or [`FileError::Rows`].
pub fn parse_log(path: &Path, text: &str) -> Result<FlightLog, FileError> {
    if is_row_file(text) {
        return Err(FileError::Rows(path.to_owned()));
    }
    FlightLog::from_json(text.as_bytes()).map_err(|error| FileError::Log(path.to_owned(), error))
}

/// Whether a text is that of a campaign's row file, by how it begins; else it may be a flight's log.
#[must_use]
pub fn is_row_file(text: &str) -> bool {
    text.starts_with("{\"rows\":")
}

/// Makes a directory if there is none, and writes and removes a file there: a flight should not end to find that its log
/// has no place.
///
/// # Errors
/// [`FileError::Write`].
pub fn try_directory(directory: &Path) -> Result<(), FileError> {
    let failed = |error| FileError::Write(directory.to_owned(), error);
    std::fs::create_dir_all(directory).map_err(failed)?;
    let probe = beside(&directory.join("probe"));
    std::fs::write(&probe, "")
        .and_then(|()| std::fs::remove_file(&probe))
        .map_err(failed)
}

/// Writes a flight's log: exactly the bytes that are hashed.
///
/// # Errors
/// [`FileError::Log`] or [`FileError::Write`].
pub fn write_log(path: &Path, log: &FlightLog) -> Result<(), FileError> {
    let bytes = log
        .to_json()
        .map_err(|error| FileError::Log(path.to_owned(), error))?;
    write_whole(path, &bytes)
}

/// Writes a file, and the directories above it, whole or not at all: beside its place first, and then into it. What was there
/// stays until then. A device or a pipe is written to as it is.
///
/// # Errors
/// [`FileError::Write`].
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_beside(path, bytes, std::fs::File::sync_all)
}

/// The same, but the disk may have the bytes later: for what is written in flight.
///
/// # Errors
/// [`FileError::Write`].
pub fn write_soon(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_beside(path, bytes, |_| Ok(()))
}

fn write_beside(
    path: &Path,
    bytes: &[u8],
    settle: fn(&std::fs::File) -> io::Result<()>,
) -> Result<(), FileError> {
    let failed = |error| FileError::Write(path.to_owned(), error);
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        return std::fs::write(path, bytes).map_err(failed);
    }
    if let Some(directory) = path.parent() {
        std::fs::create_dir_all(directory).map_err(failed)?;
    }
    // A link stays one: what it leads to is written.
    let place = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let beside = beside(&place);
    let written =
        write_through(&beside, bytes, settle).and_then(|()| std::fs::rename(&beside, &place));
    written.map_err(|error| {
        let _ = std::fs::remove_file(&beside);
        failed(error)
    })
}

/// A name in the same directory that nobody else writes to.
fn beside(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

/// A new file; the disk has its bytes when this returns, if `settle` sees to it.
fn write_through(
    path: &Path,
    bytes: &[u8],
    settle: fn(&std::fs::File) -> io::Result<()>,
) -> io::Result<()> {
    let mut file = std::fs::File::create(path)?;
    file.write_all(bytes)?;
    settle(&file)
}

/// Reads programs from a directory of recorded cases (`case_*.json`), from one such file, or from a
/// file of instances with one JSON object per line.
///
/// # Errors
/// [`FileError`]; also when there are no programs.
pub fn read_instances(path: &Path) -> Result<Vec<Instance>, FileError> {
    let files = if path.is_dir() {
        let mut files = list(path)?;
        files.retain(|file| is_recorded_case(file));
        files
    } else {
        vec![path.to_owned()]
    };
    let mut instances = Vec::new();
    for file in files {
        let text = read(&file, MOST_RECORDED)?;
        let found = if is_recorded_case(&file) {
            recorded_instances(&stem(&file), &text)
        } else {
            Instance::of_lines(&text)
        };
        instances.extend(found.map_err(|error| FileError::Instances(file, error))?);
    }
    if instances.is_empty() {
        return Err(FileError::NoInstances(path.to_owned()));
    }
    Ok(instances)
}

fn is_recorded_case(path: &Path) -> bool {
    is_json(path) && stem(path).starts_with("case_")
}

/// Writes programs, one JSON object per line.
///
/// # Errors
/// [`FileError::Write`].
pub fn write_instances(path: &Path, instances: &[Instance]) -> Result<(), FileError> {
    let failed = |error: serde_json::Error| FileError::Write(path.to_owned(), error.into());
    let mut bytes = Vec::new();
    for instance in instances {
        serde_json::to_writer(&mut bytes, instance).map_err(failed)?;
        bytes.push(b'\n');
    }
    write_whole(path, &bytes)
}

/// Checks every recorded file of a directory.
///
/// # Errors
/// [`FileError::Read`] or [`FileError::NoRecords`]. A file of a known kind that does not parse is a
/// failure in the report.
pub fn check_directory(directory: &Path) -> Result<Report, FileError> {
    let mut files = list(directory)?;
    files.retain(|path| is_json(path));
    if files.is_empty() {
        return Err(FileError::NoRecords(directory.to_owned()));
    }
    let texts = files
        .iter()
        .map(|path| Ok((stem(path), read(path, MOST_RECORDED)?)));
    Ok(check(texts.collect::<Result<Vec<_>, FileError>>()?))
}

#[cfg(test)]
mod tests;
