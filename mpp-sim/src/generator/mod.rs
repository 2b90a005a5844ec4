//! Generators of fields, by name: the paper's, and others that ask for other skills.
//!
//! A generator draws its field from the flight's seed. The number of obstacles is its density: so
//! many over the 215 m from the first place to the last. `docs/fields.md` shows what each makes.

mod config;
mod draw;

use crate::field::Obstacle;
pub use config::{Generator, GeneratorName};
pub(crate) use draw::BAND;

impl Generator {
    /// The obstacles of the flight with this seed and duration \[s\], which starts at a downrange
    /// distance of 0 and at `altitude` \[m\]. `count` is the number over 215 m.
    #[must_use]
    pub fn obstacles(
        &self,
        seed: u64,
        count: usize,
        altitude: f64,
        duration: f64,
    ) -> Vec<Obstacle> {
        let mut obstacles = draw::field(self, seed, count, altitude, duration);
        draw::set_in_motion(&mut obstacles, self.velocity, seed);
        obstacles
    }

    /// About how many obstacles a field has.
    #[must_use]
    pub fn expected(&self, count: usize, duration: f64) -> f64 {
        match self.name {
            GeneratorName::Endless => count as f64 * draw::endless_share(duration),
            _ => count as f64,
        }
    }
}

#[cfg(test)]
mod tests;
