//! Row files. The first line is a header that describes the campaign. Each further line is the JSON
//! of one flight, in the order in which the flights ended.
//!
//! A row is written whole and at once. A killed run leaves at most an incomplete last line. The
//! next run drops this line and flies its flight again. Nothing else is lost or repeated. A full disk
//! leaves only whole rows. A file that is no row file of the campaign is not changed.

use super::error::CampaignError;
use crate::files::{MOST_RECORDED, read_text};
use mpp_analysis::campaign::Row;
use mpp_analysis::rows::Header;
use serde::Serialize;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Write};
use std::path::Path;

/// What rows are appended to; tests give one that fails.
pub trait Sheet: Write {
    /// Cuts it off after so many bytes.
    ///
    /// # Errors
    /// What the operating system says.
    fn cut(&mut self, length: u64) -> io::Result<()>;
}

impl Sheet for File {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.set_len(length)
    }
}

/// A row file that is open for writing. It is locked against other processes.
#[derive(Debug)]
pub struct RowFile<S = File> {
    path: String,
    sheet: S,
    /// Bytes of whole lines.
    length: u64,
    /// Rows among them.
    rows: usize,
    /// Why nothing is appended any more.
    broken: Option<(ErrorKind, String)>,
}

impl RowFile {
    /// Opens a file to continue it, or begins a new one. Returns the rows that the file holds.
    ///
    /// # Errors
    /// [`CampaignError`]; the file then stays as it was.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, Vec<Row>), CampaignError> {
        let name = path.display().to_string();
        let failed = |error| CampaignError::Open(name.clone(), error);
        // A device or a pipe has no rows to go on with, and might be read for ever.
        if path.metadata().is_ok_and(|found| !found.is_file()) {
            return Err(CampaignError::NoFile(name));
        }
        let mut file = OpenOptions::new()
            .read(true)
            .append(true)
            .create(true)
            .open(path)
            .map_err(failed)?;
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => CampaignError::Busy(name.clone()),
            TryLockError::Error(error) => failed(error),
        })?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        let (whole, rows) = known(&name, &bytes, header)?;
        let torn = whole < bytes.len();
        let mut rows_file = Self::over(name, file, whole as u64, rows.len());
        if torn {
            let cut = rows_file.sheet.cut(whole as u64);
            cut.map_err(|error| rows_file.full(error))?;
        }
        if whole == 0 {
            rows_file.append(header)?;
        }
        Ok((rows_file, rows))
    }
}

impl<S: Sheet> RowFile<S> {
    /// Goes on with a sheet that holds so many bytes of whole lines, and rows among them.
    pub(super) fn over(path: String, sheet: S, length: u64, rows: usize) -> Self {
        Self {
            path,
            sheet,
            length,
            rows,
            broken: None,
        }
    }

    /// Appends a row. The operating system has the row when this function returns.
    ///
    /// # Errors
    /// [`CampaignError::Full`]: the file ends with its last whole row, and takes no more.
    pub fn push(&mut self, row: &Row) -> Result<(), CampaignError> {
        self.append(row)?;
        self.rows += 1;
        Ok(())
    }

    fn append(&mut self, line: &impl Serialize) -> Result<(), CampaignError> {
        // Behind a row that failed no other one may stand, whichever thread brings it.
        if let Some((kind, why)) = &self.broken {
            let error = io::Error::new(*kind, why.clone());
            return Err(self.full(error));
        }
        let mut bytes = serde_json::to_vec(line).map_err(|error| self.full(error.into()))?;
        bytes.push(b'\n');
        let written = self.sheet.write_all(&bytes);
        if let Err(error) = written.and_then(|()| self.sheet.flush()) {
            self.broken = Some((error.kind(), error.to_string()));
            // If this fails too, the next run drops the torn line.
            let _ = self.sheet.cut(self.length);
            return Err(self.full(error));
        }
        self.length += bytes.len() as u64;
        Ok(())
    }

    fn full(&self, error: io::Error) -> CampaignError {
        CampaignError::Full(self.path.clone(), self.rows, error)
    }
}

/// The length of a file's whole lines \[bytes\] and the rows in them, if the file is this campaign's.
fn known(name: &str, bytes: &[u8], header: &Header) -> Result<(usize, Vec<Row>), CampaignError> {
    let whole = bytes.iter().rposition(|byte| *byte == b'\n');
    let whole = whole.map_or(0, |end| end + 1);
    if whole == 0 {
        // A killed run may leave an incomplete header. Any other content must not be erased.
        let own = serde_json::to_vec(header).unwrap_or_default();
        let ours = own.starts_with(bytes);
        return match ours {
            true => Ok((0, Vec::new())),
            false => Err(CampaignError::NoRowFile(name.to_owned())),
        };
    }
    let text = std::str::from_utf8(&bytes[..whole])
        .map_err(|_| CampaignError::NoRowFile(name.to_owned()))?;
    let Some((found, rows)) = parse(name, text)? else {
        return Ok((whole, Vec::new()));
    };
    match header.difference(&found) {
        Some(what) => Err(CampaignError::Differs(name.to_owned(), what)),
        None => Ok((whole, rows)),
    }
}

/// Reads a file without writing to it. An incomplete last line is left out.
///
/// # Errors
/// [`CampaignError`].
pub fn read(path: &Path) -> Result<(Header, Vec<Row>), CampaignError> {
    let name = path.display().to_string();
    let text = read_text(path, MOST_RECORDED).map_err(|error| CampaignError::Read(name, error))?;
    parse_rows(path, &text)
}

/// The rows that a text of this file holds. An incomplete last line is left out.
///
/// # Errors
/// [`CampaignError`].
pub fn parse_rows(path: &Path, text: &str) -> Result<(Header, Vec<Row>), CampaignError> {
    let name = path.display().to_string();
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let found = parse(&name, &text[..whole])?;
    found.ok_or_else(|| CampaignError::Line(name, 1, "no header: this is no row file".to_owned()))
}

/// Parses header and rows from complete lines. Returns `None` if there are no lines.
fn parse(name: &str, text: &str) -> Result<Option<(Header, Vec<Row>)>, CampaignError> {
    let wrong = |line: usize, why: String| CampaignError::Line(name.to_owned(), line + 1, why);
    let mut lines = text.lines().enumerate();
    let Some((_, first)) = lines.next() else {
        return Ok(None);
    };
    let header: Header = serde_json::from_str(first)
        .map_err(|error| wrong(0, format!("no header of this program's row files: {error}")))?;
    let mut rows: Vec<Row> = Vec::new();
    for (number, line) in lines {
        let row: Row =
            serde_json::from_str(line).map_err(|error| wrong(number, error.to_string()))?;
        if header.campaign.place(&row.cell, row.seed).is_none() {
            return Err(wrong(
                number,
                "this row is not of the file's campaign".to_owned(),
            ));
        }
        rows.push(row);
    }
    Ok(Some((header, rows)))
}

#[cfg(test)]
mod tests;
