//! Files that worlds in space are made from.

use super::{FileError, MOST_FIELD, read};
use mpp_sim::space::world::{Body, Terrain, ascii_grid, stems};
use std::path::Path;

/// Reads a stem map.
///
/// # Errors
/// [`FileError::Read`] or [`FileError::Stems`].
pub fn read_stems(path: &Path) -> Result<Vec<Body>, FileError> {
    let name = path.display().to_string();
    stems(&name, &read(path, MOST_FIELD)?).map_err(FileError::Stems)
}

/// Reads a height map.
///
/// # Errors
/// [`FileError::Read`] or [`FileError::Terrain`].
pub fn read_terrain(path: &Path) -> Result<Terrain, FileError> {
    let name = path.display().to_string();
    ascii_grid(&name, &read(path, MOST_FIELD)?).map_err(FileError::Terrain)
}
