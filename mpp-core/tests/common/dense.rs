//! Dense fields.

use crate::common::draw::Draw;
use crate::common::world::Disc;

/// 60 discs at random places in 50 m x 24 m.
pub(crate) fn dense(seed: u64) -> Vec<Disc> {
    let mut draw = Draw::new(seed);
    (0..60)
        .map(|_| {
            (
                draw.between(112.0, 162.0),
                draw.between(38.0, 62.0),
                draw.between(0.3, 1.0),
            )
        })
        .collect()
}
