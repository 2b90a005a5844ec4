//! What a scan should show of the one before it, and how well it does.

use super::fan::{farthest, met, sector};
use crate::config::MAX_BEAMS;
use crate::sense::LidarScan;
use crate::tuning::scan_match::{
    EDGE_BEAMS, LEAST_SILENT, SECTORS, TURN_PART, TURN_STEP, TURN_STEPS,
};

/// A return of the last scan that is expected again.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// Where it is expected, as a number of beams from the first one [-].
    pub(super) place: f64,
    /// Its range \[m\].
    pub(super) range: f64,
    /// Number of adjacent beams that confirmed it.
    pub(super) confirmed: u32,
}

/// What a scan should show again. The caller keeps the room for it, because it is too large for the stack.
pub type Predictions = heapless::Vec<Prediction, MAX_BEAMS>;

/// How well a scan fits the last one.
#[derive(Clone, Copy)]
pub(super) struct Fit {
    /// Numbers of predicted returns that came and that did not.
    pub(super) hits: u32,
    pub(super) misses: u32,
    /// Missed returns of each sector that are no farther than the farthest return, each counted once for every adjacent beam
    /// that confirmed it.
    pub(super) missed: [u32; SECTORS],
    /// The same sums for those that are farther, and the least range of these \[m\].
    pub(super) beyond: [u32; SECTORS],
    pub(super) first_beyond: f64,
}

impl Fit {
    /// Nothing was predicted.
    pub(super) const NOTHING: Self = Self {
        hits: 0,
        misses: 0,
        missed: [0; SECTORS],
        beyond: [0; SECTORS],
        first_beyond: f64::INFINITY,
    };
}

/// How well a scan fits predictions that are moved by so many beams, if its own beams are taken as sent or in reverse order.
pub(super) fn fit(
    scan: &LidarScan,
    sight: f64,
    predictions: &Predictions,
    turn: f64,
    reversed: bool,
) -> Fit {
    let mut fit = Fit::NOTHING;
    let far = farthest(scan, sight);
    let beams = scan.ranges.len();
    for it in predictions {
        let place = it.place + turn;
        if !(EDGE_BEAMS..=beams as f64 - 1.0 - EDGE_BEAMS).contains(&place) {
            continue;
        }
        let first = place as usize;
        match met(scan, sight, first, it.range, reversed) {
            Some(true) => fit.hits += 1,
            Some(false) => {
                fit.misses += 1;
                if it.range > far {
                    fit.beyond[sector(first, beams)] += it.confirmed;
                    fit.first_beyond = fit.first_beyond.min(it.range);
                } else {
                    fit.missed[sector(first, beams)] += it.confirmed;
                }
            }
            None => {}
        }
    }
    fit
}

/// The most hits of a scan that is turned, as by a wrong pitch, if a turn makes hits of enough misses. `None` too if the misses
/// are too few to be held against the lidar.
pub(super) fn turned_hits(
    scan: &LidarScan,
    sight: f64,
    predictions: &Predictions,
    as_sent: &Fit,
) -> Option<u32> {
    // A miss weighs as many adjacent beams as confirmed it, 2 at most.
    if 2 * as_sent.misses < LEAST_SILENT {
        return None;
    }
    let turns = (1..=TURN_STEPS).flat_map(|it| [it, -it]);
    let hits = |turn| fit(scan, sight, predictions, TURN_STEP * f64::from(turn), false).hits;
    let most = turns.map(hits).max()?;
    (most >= as_sent.hits + as_sent.misses.div_ceil(TURN_PART)).then_some(most)
}
