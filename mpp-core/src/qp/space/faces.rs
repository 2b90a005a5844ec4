//! Faces of a corridor in space.

use super::kernel::Condensed;
use super::layout::{FACES, POSITION};
use super::outputs::write_face_prices;
use super::rows::{Bounds, NO_NORMALS, Normals};
use crate::config::STAGES;

/// Half-planes in space at each boundary: positions `p` with `normal . p <= bound`.
#[derive(Clone, Debug, PartialEq)]
pub struct Faces {
    normals: Normals,
    bounds: [[f64; FACES]; STAGES],
    len: [usize; STAGES],
}

impl Faces {
    /// No faces.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            normals: NO_NORMALS,
            bounds: [[f64::INFINITY; FACES]; STAGES],
            len: [0; STAGES],
        }
    }

    /// Memory of zeros, which waits for [`clear`](Self::clear).
    pub(crate) const ZEROS: Self = Self {
        normals: NO_NORMALS,
        bounds: [[0.0; FACES]; STAGES],
        len: [0; STAGES],
    };

    /// Removes every face.
    pub fn clear(&mut self) {
        self.bounds.as_flattened_mut().fill(f64::INFINITY);
        self.len = [0; STAGES];
    }

    /// Adds a face at a boundary from 1 on. Returns false if there is no room or no such boundary.
    pub fn push(&mut self, boundary: usize, normal: [f64; POSITION], bound: f64) -> bool {
        let place = boundary.checked_sub(1).and_then(|stage| {
            let len = self.len.get_mut(stage)?;
            let normal = self.normals.get_mut(stage)?.get_mut(*len)?;
            let bound = self.bounds.get_mut(stage)?.get_mut(*len)?;
            *len += 1;
            Some((normal, bound))
        });
        let Some(place) = place else {
            return false;
        };
        (*place.0, *place.1) = (normal, bound);
        true
    }

    /// The faces of a boundary from 1 on: normals and bounds.
    pub fn at(&self, boundary: usize) -> impl Iterator<Item = (&[f64; POSITION], f64)> {
        let stage = boundary.wrapping_sub(1);
        let len = self.len.get(stage).copied().unwrap_or(0);
        let normals = self.normals.get(stage).into_iter().flatten();
        let bounds = self.bounds.get(stage).into_iter().flatten().copied();
        normals.zip(bounds).take(len)
    }
}

impl Bounds {
    /// Sets the bounds of the faces, relative to the position of the program's start. Their normals go to
    /// [`Condensed::set_faces`].
    pub fn set_faces(&mut self, faces: &Faces, [x, y, z]: &[f64; POSITION]) {
        let normals = faces.normals.as_flattened();
        let rows = faces.bounds.as_flattened().iter().zip(normals);
        for (row, (bound, [a, b, c])) in self.0.iter_mut().zip(rows) {
            *row = bound - (a * x + b * y + c * z);
        }
    }
}

impl Condensed {
    /// Takes the normals of a program's faces. Call it after condensing and before the solver starts.
    pub fn set_faces(&mut self, faces: &Faces) {
        self.normals = faces.normals;
        write_face_prices(&self.response, &self.normals, &mut self.prices);
    }
}
