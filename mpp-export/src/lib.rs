//! Logs of flights and rows of campaigns in formats that other programs read: CSV, MCAP, Parquet.
//!
//! ```text
//!   FlightLog --> flight --+               +--> csv
//!                          +--> Table -----+--> parquet
//!   rows -------> rows ----+    (schema)   +--> mcap <-- scene, space <-- the flight, flown again
//! ```
//!
//! * [`schema`]: the columns of each table with their units and frames; `docs/logs.md` is the same table for people.
//! * [`table`]: a table of values; [`flight`] and [`rows`] make tables.
//! * [`csv`], [`parquet`], [`mcap`]: the bytes of a file. The last two need the cargo feature `formats`.
//!
//! The caller reads and writes the files.

pub mod schema;

pub mod table;

pub mod flight;

pub mod rows;

pub mod csv;

#[cfg(feature = "formats")]
mod messages;
#[cfg(feature = "formats")]
mod scene;
#[cfg(feature = "formats")]
mod space;

pub mod mcap;

pub mod parquet;

mod error;

pub use error::ExportError;
