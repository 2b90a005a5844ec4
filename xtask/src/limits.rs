//! The budgets of docs/budgets.toml.

use crate::folders::root;
use anyhow::{Context, Result};
use std::path::PathBuf;
use toml_edit::DocumentMut;

fn path() -> PathBuf {
    root().join("docs/budgets.toml")
}

/// Reads the file.
pub(crate) fn read() -> Result<DocumentMut> {
    Ok(std::fs::read_to_string(path())?.parse()?)
}

/// Writes the file.
pub(crate) fn write(document: &DocumentMut) -> Result<()> {
    Ok(std::fs::write(path(), document.to_string())?)
}

/// Looks up a budget of the firmware.
pub(crate) fn budget(document: &DocumentMut, table: &str, name: &str) -> Result<u64> {
    document
        .get("firmware")
        .and_then(|firmware| firmware.get(table)?.get(name)?.as_integer())
        .and_then(|budget| u64::try_from(budget).ok())
        .with_context(|| format!("docs/budgets.toml has no firmware.{table}.{name}"))
}

/// The greatest budget of a table of the firmware.
pub(crate) fn worst(document: &DocumentMut, table: &str) -> Result<u64> {
    document
        .get("firmware")
        .and_then(|firmware| firmware.get(table)?.as_table())
        .and_then(|table| {
            table
                .iter()
                .filter_map(|(_, budget)| budget.as_integer())
                .max()
        })
        .and_then(|budget| u64::try_from(budget).ok())
        .with_context(|| format!("docs/budgets.toml has no firmware.{table}"))
}

/// The greatest budget of a slice \[instructions\].
pub(crate) fn longest_slice(document: &DocumentMut) -> Result<u64> {
    let flight = worst(document, "slice_worst_flight")?;
    Ok(flight.max(worst(document, "slice_worst_reference")?))
}
