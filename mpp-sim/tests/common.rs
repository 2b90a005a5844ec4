//! What several tests share.

use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};

/// The aircraft with a lateral table.
pub(crate) fn models() -> impl Iterator<Item = AircraftModel> {
    let known = AircraftFile::KNOWN.into_iter();
    let files = known.map(|(name, _)| AircraftFile::known(name).unwrap());
    files
        .filter(|file| file.lateral.is_some())
        .map(|file| AircraftModel::new(file).unwrap())
}
