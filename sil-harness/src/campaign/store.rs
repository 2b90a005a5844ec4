//! Row files: a header line that says what is flown, then a line of JSON for each flight, in the
//! order in which they ended.
//!
//! A row is written whole and at once. A killed run leaves at most a torn last line, which the next
//! run drops; its flight is flown again. Nothing else is lost or repeated.

use super::{Campaign, CampaignError, Row, Shard};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Write};
use std::path::Path;

/// Version of the rows' layout.
const ROWS: u32 = 2;

/// A row file's first line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Version of the rows' layout.
    rows: u32,
    /// Version of `sil-harness`.
    package_version: String,
    /// [`Campaign::fingerprint`] of the program that flew the rows.
    pub fingerprint: String,
    /// What is flown.
    pub campaign: Campaign,
    /// The part of it that this file takes.
    pub shard: Shard,
}

impl Header {
    /// The header of a file that this program writes.
    ///
    /// # Errors
    /// [`CampaignError::Flight`] when the campaign's first flight fails.
    pub fn new(campaign: Campaign, shard: Shard) -> Result<Self, CampaignError> {
        Ok(Self {
            rows: ROWS,
            package_version: env!("CARGO_PKG_VERSION").to_owned(),
            fingerprint: campaign.fingerprint()?,
            campaign,
            shard,
        })
    }

    /// The first key in which another header differs, with both values.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let flat = |header: &Self| {
            let mut keys = serde_json::to_value(header).unwrap_or_default();
            let campaign = keys["campaign"].take();
            (keys, campaign)
        };
        let ((outer, inner), (other_outer, other_inner)) = (flat(self), flat(other));
        [(inner, other_inner), (outer, other_outer)]
            .iter()
            .find_map(|(own, others)| {
                let keys = own.as_object()?;
                let (key, value) = keys
                    .iter()
                    .find(|(key, value)| others[key.as_str()] != **value)?;
                Some(format!(
                    "its {key} is {}, not {value}",
                    others[key.as_str()]
                ))
            })
    }
}

/// A row file that is being written; locked against other processes.
#[derive(Debug)]
pub struct RowFile {
    path: String,
    file: File,
}

impl RowFile {
    /// Opens a file to go on with, or begins it; gives the rows that it holds.
    ///
    /// # Errors
    /// [`CampaignError`]; the file is then as it was.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, Vec<Row>), CampaignError> {
        let name = path.display().to_string();
        let failed = |error| CampaignError::File(name.clone(), error);
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
        let mut text = String::new();
        file.read_to_string(&mut text).map_err(failed)?;
        // A killed run may have torn its last line, the header's included.
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let rows = match parse(&name, &text[..whole])? {
            None => Vec::new(),
            Some((found, rows)) => match header.difference(&found) {
                Some(what) => return Err(CampaignError::Differs(name, what)),
                None => rows,
            },
        };
        file.set_len(whole as u64).map_err(failed)?;
        let mut rows_file = Self { path: name, file };
        if whole == 0 {
            rows_file.append(header)?;
        }
        Ok((rows_file, rows))
    }

    /// Appends a row; it is with the operating system when this returns.
    ///
    /// # Errors
    /// [`CampaignError::File`].
    pub fn push(&mut self, row: &Row) -> Result<(), CampaignError> {
        self.append(row)
    }

    fn append(&mut self, line: &impl Serialize) -> Result<(), CampaignError> {
        let failed = |error| CampaignError::File(self.path.clone(), error);
        let mut bytes = serde_json::to_vec(line).map_err(|error| failed(error.into()))?;
        bytes.push(b'\n');
        self.file.write_all(&bytes).map_err(failed)
    }
}

/// Reads a file without writing to it; a torn last line is left out.
///
/// # Errors
/// [`CampaignError`].
pub fn read(path: &Path) -> Result<(Header, Vec<Row>), CampaignError> {
    let name = path.display().to_string();
    let text =
        std::fs::read_to_string(path).map_err(|error| CampaignError::File(name.clone(), error))?;
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let found = parse(&name, &text[..whole])?;
    found.ok_or_else(|| CampaignError::Line(name, 1, "no header: this is no row file".to_owned()))
}

/// Header and rows of whole lines; none if there are no lines.
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

/// The rows of a campaign from several files, each flight once, in the order of cells and seeds.
///
/// # Errors
/// [`CampaignError::Disagree`] when two files differ in a flight.
pub fn merge(
    campaign: &Campaign,
    rows: impl IntoIterator<Item = Row>,
) -> Result<Vec<Row>, CampaignError> {
    let mut merged: BTreeMap<(usize, u64), Row> = BTreeMap::new();
    for row in rows {
        let Some(place) = campaign.place(&row.cell, row.seed) else {
            continue;
        };
        match merged.get(&place) {
            Some(known) if known.agrees(&row) => {}
            Some(_) => return Err(CampaignError::Disagree(row.cell, row.seed)),
            None => {
                merged.insert(place, row);
            }
        }
    }
    Ok(merged.into_values().collect())
}
