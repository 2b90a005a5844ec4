//! Campaigns as data: the grid of flights, a row for each flight, and the report about the rows.
//!
//! Every cell of the grid flies the same seeds, so that cells can be compared flight by flight. A
//! row depends only on its cell and seed. `fly` with the same flags and seed repeats the flight,
//! with the same log hash.

mod causes;
mod drawn;
mod fault_report;
mod faults;
mod grid;
mod merge;
mod pairs;
mod report;
mod row;
mod sequential;
mod single_fault;
mod stats;
mod table;
mod taxonomy;

pub use causes::CauseReport;
pub use drawn::{FaultPair, FaultPairs, PairReport, PairRow};
pub use fault_report::{FaultReport, FaultRow, Flown, Told};
pub use faults::{FaultCampaign, FaultJob, NamedFault};
pub use grid::{Campaign, Cell, Lists, NamedField, NoShard, Shard};
pub use merge::{Disagreement, merge};
pub use pairs::{AgainstCeiling, AgainstOracle};
pub use report::{CellReport, Outcomes, Report};
pub use row::Row;
pub use sequential::{BLOCK, Sequential};
pub use stats::{paired, wilson};
pub use taxonomy::Taxonomy;
