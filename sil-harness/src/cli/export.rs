//! `export`: makes tables of a flight's log or a campaign's rows, for other programs.

use super::answer::{FAILURE, Failure, USAGE, data_bytes, talk};
use crate::campaign::parse_rows;
use crate::files::{is_row_file, parse_log, read_recorded, write_whole};
use clap::ValueEnum;
use mpp_export::schema::{LATERAL, PLANS, REJECTIONS, SENSORS, Schema, TICKS};
use mpp_export::table::Table;
use mpp_export::{ExportError, csv::csv, flight, mcap::mcap, parquet::parquet, rows};
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::EXPORT)]
pub(super) struct ExportArgs {
    /// Log of a flight, or row file of a campaign
    file: PathBuf,
    /// Format; MCAP and Parquet need a build with the cargo feature `formats` [default: by the ending of --out, else CSV]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Table of a flight, for CSV and Parquet [default: ticks]
    #[arg(long, value_enum)]
    table: Option<FlightTable>,
    /// File to write [default: CSV to the standard output, else the name of the log with another ending]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// One table with a line of names; null is empty
    Csv,
    /// A whole flight with time series, scans, obstacles and plans, for Foxglove
    Mcap,
    /// One table with units in its metadata
    Parquet,
}

impl Format {
    /// The format that a file's ending asks for, whichever way it is written.
    fn of(file: &Path) -> Option<Self> {
        let ending = file.extension()?.to_str()?;
        Self::from_str(ending, true).ok()
    }
}

impl ExportArgs {
    /// The format of the flag or of the ending; the two must not differ.
    fn format(&self) -> Result<Format, Failure> {
        match (self.format, self.out.as_deref().and_then(Format::of)) {
            (Some(flag), Some(ending)) if flag != ending => Err(Failure::usage(
                "--format, --out: the ending is that of another format: leave --format out, or give another ending",
            )),
            (flag, ending) => Ok(flag.or(ending).unwrap_or(Format::Csv)),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FlightTable {
    /// State, estimate, reference, controls and wind, 100 times a second
    Ticks,
    /// The lateral part of the ticks, of a flight in space
    Lateral,
    /// The plans that the core delivered
    Plans,
    /// The inputs that the core refused
    Rejections,
    /// The changes of the core's trust in a sensor
    Sensors,
}

impl FlightTable {
    fn schema(self) -> &'static Schema {
        match self {
            Self::Ticks => &TICKS,
            Self::Lateral => &LATERAL,
            Self::Plans => &PLANS,
            Self::Rejections => &REJECTIONS,
            Self::Sensors => &SENSORS,
        }
    }
}

pub(super) fn run(args: &ExportArgs) -> Result<u8, Failure> {
    let format = args.format()?;
    let bytes = bytes(args, format)?;
    let out = match (&args.out, format) {
        (Some(out), _) => out.clone(),
        (None, Format::Csv) => return data_bytes(&bytes).map(|()| 0),
        (None, Format::Mcap) => args.file.with_extension("mcap"),
        (None, Format::Parquet) => args.file.with_extension("parquet"),
    };
    write_whole(&out, &bytes)?;
    talk(format_args!("{} bytes in {}", bytes.len(), out.display()));
    Ok(0)
}

fn bytes(args: &ExportArgs, format: Format) -> Result<Vec<u8>, Failure> {
    let usage = |why: &str| Failure::usage(format!("{}: {why}", args.file.display()));
    let text = read_recorded(&args.file)?;
    if is_row_file(&text) {
        if args.table.is_some() {
            return Err(usage("a row file has one table: leave --table out"));
        }
        if format == Format::Mcap {
            return Err(usage(
                "a row file has no times: take --format csv or parquet",
            ));
        }
        return of_table(&row_table(&args.file, &text)?, format);
    }
    let log = parse_log(&args.file, &text)?;
    match (format, args.table) {
        (Format::Mcap, Some(_)) => Err(usage("MCAP holds every table: leave --table out")),
        (Format::Mcap, None) => mcap(&log).map_err(|error| failed(&error)),
        (format, table) => {
            let schema = table.unwrap_or(FlightTable::Ticks).schema();
            if table == Some(FlightTable::Lateral) && log.lateral.is_empty() {
                return Err(usage(
                    "a flight in the vertical plane has no lateral part: take another table",
                ));
            }
            let table = flight::table(&log, schema).map_err(|error| failed(&error))?;
            of_table(&table, format)
        }
    }
}

fn row_table(file: &Path, text: &str) -> Result<Table, Failure> {
    let (_, found) = parse_rows(file, text).map_err(Failure::usage)?;
    rows::table(&found).map_err(|error| failed(&error))
}

fn of_table(table: &Table, format: Format) -> Result<Vec<u8>, Failure> {
    match format {
        Format::Parquet => parquet(table).map_err(|error| failed(&error)),
        Format::Csv | Format::Mcap => Ok(csv(table)),
    }
}

fn failed(error: &ExportError) -> Failure {
    let code = match error {
        ExportError::NotBuilt(_) => USAGE,
        ExportError::Write(..) | ExportError::NoColumn(..) => FAILURE,
    };
    Failure::new(code, error)
}
