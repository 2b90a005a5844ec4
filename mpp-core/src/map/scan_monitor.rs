//! Whether a scan agrees with the one before it: what the lidar showed has to be there again.
//!
//! The monitor predicts where beams meet again what they met in the last scan, or in short sight in the last scan that saw
//! farther. It uses only returns that an adjacent beam confirms, so a wire that falls between two beams predicts nothing. What
//! comes nearer than predicted hides the rest and says nothing; what comes from farther, or not at all, is a *miss*. If most
//! misses are hits when the scan is turned, the pitch is wrong and not the lidar: the scan says nothing.

use super::fan::{answers, farthest, met, sector};
use super::rolling_grid::{has_return, is_return};
use crate::config::MAX_BEAMS;
use crate::sense::LidarScan;
use crate::tuning::scan_match::{
    ALIKE, ALIKE_SHARE, EDGE_BEAMS, LEAST_GAIN, LEAST_MISSES, LEAST_SILENT, NEAR, SECTORS,
    SIGHT_SHARE, TURN_PART, TURN_STEP, TURN_STEPS,
};
use crate::vehicle::Pose;

/// What the monitor makes of a scan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScanVerdict {
    /// Nothing speaks against the scan.
    Agrees,
    /// Sectors of the fan are silent where returns were predicted. Their beams without a return are marked as bad.
    Silent,
    /// Nothing returns from beyond a range although returns were predicted there, as in fog.
    Short,
    /// The beams come in reverse order. The first such scan is empty now; later ones have them in the right order.
    Reversed,
    /// The beams come in reverse order, and came so before: the map is wrong too. The scan is empty now.
    ReversedBefore,
}

/// The monitor of the scans, with the last scan that had a return.
#[derive(Clone, Debug)]
pub struct ScanMonitor {
    last: LidarScan,
    pose: Pose,
    /// Sectors that went silent, and from which no beam has returned since.
    silent: [bool; SECTORS],
    /// Sectors in which returns were missing that fog may hide, or a lidar that is silent altogether. No beam has returned since
    /// from the same half of the fan.
    suspected: [bool; SECTORS],
    /// Whether the beams came in reverse order, and nothing has spoken against it since.
    reversed: bool,
    /// Range beyond which returns that were predicted did not come \[m\].
    sight: f64,
}

/// How well a scan fits the last one.
#[derive(Clone, Copy)]
struct Fit {
    /// Numbers of predicted returns that came and that did not.
    hits: u32,
    misses: u32,
    /// Missed returns of each sector that are no farther than the farthest return, each counted once for every adjacent beam
    /// that confirmed it.
    missed: [u32; SECTORS],
    /// The same sums for those that are farther, and the least range of these \[m\].
    beyond: [u32; SECTORS],
    first_beyond: f64,
}

impl Fit {
    /// Nothing was predicted.
    const NOTHING: Self = Self {
        hits: 0,
        misses: 0,
        missed: [0; SECTORS],
        beyond: [0; SECTORS],
        first_beyond: f64::INFINITY,
    };

    /// Whether so much is missing beyond the farthest return that the sight is short.
    fn is_short(&self) -> bool {
        self.beyond.iter().sum::<u32>() >= LEAST_SILENT
    }
}

/// A return of the last scan that is expected again.
#[derive(Clone, Debug)]
pub struct Prediction {
    /// Where it is expected, as a number of beams from the first one [-].
    place: f64,
    /// Its range \[m\].
    range: f64,
    /// Number of adjacent beams that confirmed it.
    confirmed: u32,
}

/// What a scan should show again. The caller keeps the room for it, because it is too large for the stack.
pub type Predictions = heapless::Vec<Prediction, MAX_BEAMS>;

impl ScanMonitor {
    /// A monitor that has seen no scan.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            last: LidarScan::new(),
            pose: Pose {
                x: 0.0,
                z: 0.0,
                pitch: 0.0,
            },
            silent: [false; SECTORS],
            suspected: [false; SECTORS],
            reversed: false,
            sight: f64::INFINITY,
        }
    }

    /// Forgets the last scan and what was held against the lidar.
    pub fn clear(&mut self) {
        self.last.ranges.clear();
        self.silent = [false; SECTORS];
        self.suspected = [false; SECTORS];
        self.reversed = false;
        self.sight = f64::INFINITY;
    }

    /// The sight that returns show, of a lidar with the range `sight` \[m\].
    #[must_use]
    pub fn sight(&self, sight: f64) -> f64 {
        sight.min(self.sight)
    }

    /// Whether a silent sector of a scan begins beneath the body axis.
    #[must_use]
    pub fn hides_below(&self, scan: &LidarScan) -> bool {
        let beams = scan.ranges.len();
        (0..beams).any(|beam| self.silent[sector(beam, beams)] && scan.beam_angle(beam) < 0.0)
    }

    /// Compares a scan from a pose, by a lidar with the range `sight` \[m\], with the last one, and takes out of it what is not
    /// to be believed. A scan without a return is [`ScanVerdict::Silent`] if enough was predicted, and suspects its sectors;
    /// [`super::RollingGrid::contradicts`] judges it too, by the map.
    pub fn check(
        &mut self,
        scan: &mut LidarScan,
        sight: f64,
        pose: &Pose,
        predictions: &mut Predictions,
    ) -> ScanVerdict {
        let (mut before, known) = (false, self.reversed);
        self.predict(scan, sight, pose, false, predictions);
        let as_sent = fit(scan, sight, predictions, 0.0, false);
        if has_return(scan, sight) {
            let turned = turned_hits(scan, sight, predictions, &as_sent);
            let rival = turned.unwrap_or(0);
            before = self.note_order(scan, sight, pose, &as_sent, rival, predictions);
            if self.reversed {
                self.silent = [false; SECTORS];
                self.suspected = [false; SECTORS];
            } else {
                let held = turned.map_or(as_sent, |_| Fit::NOTHING);
                self.note_sight(scan, sight, &held);
                self.note_silence(&held, &answers(scan, sight));
            }
            // In short sight the last scan that saw farther tells more, as long as something is predicted by it.
            if self.sight >= sight || as_sent.hits + as_sent.misses == 0 {
                self.last.clone_from(scan);
                self.pose = *pose;
            }
        } else if !known && as_sent.is_short() {
            self.suspect(&as_sent);
            return ScanVerdict::Silent;
        }
        if self.reversed {
            // A wrong pitch may make one scan fit so; the next one decides.
            if known {
                scan.ranges.reverse();
            } else {
                scan.ranges.clear();
            }
            return if before {
                ScanVerdict::ReversedBefore
            } else {
                ScanVerdict::Reversed
            };
        }
        self.mute(scan, sight);
        if self.silent.contains(&true) {
            ScanVerdict::Silent
        } else if self.sight < sight {
            ScanVerdict::Short
        } else {
            ScanVerdict::Agrees
        }
    }

    /// Notes whether the reverse order fits better than the one as sent, and no worse than a turn with so many hits. Returns
    /// true if this is new and the last scan was reversed too.
    fn note_order(
        &mut self,
        scan: &LidarScan,
        sight: f64,
        pose: &Pose,
        as_sent: &Fit,
        turned: u32,
        predictions: &mut Predictions,
    ) -> bool {
        if !self.reversed && as_sent.misses < LEAST_MISSES {
            return false;
        }
        let mut hits = |before| {
            self.predict(scan, sight, pose, before, predictions);
            fit(scan, sight, predictions, 0.0, true).hits
        };
        let (both, now) = (hits(true), hits(false));
        let reversed = both.max(now);
        if self.reversed {
            self.reversed = as_sent.hits < reversed + LEAST_GAIN;
            return false;
        }
        self.reversed = reversed >= (as_sent.hits + LEAST_GAIN).max(turned);
        self.reversed && both >= now
    }

    /// Notes the range beyond which predicted returns are missing, if nothing returns from there. It holds until something does.
    fn note_sight(&mut self, scan: &LidarScan, sight: f64, fit: &Fit) {
        if farthest(scan, sight) > self.sight {
            self.sight = f64::INFINITY;
        }
        if fit.is_short() {
            self.sight = self.sight.min(fit.first_beyond);
            self.suspect(fit);
        }
    }

    /// Suspects the sectors in which returns are missing beyond the farthest one.
    fn suspect(&mut self, fit: &Fit) {
        for (suspected, beyond) in self.suspected.iter_mut().zip(fit.beyond) {
            *suspected |= beyond > 0;
        }
    }

    /// Notes the sectors in which predicted returns are missing and no beam returns. A sector stays silent until one does. What
    /// fog might hide counts once a beam has returned from farther.
    fn note_silence(&mut self, fit: &Fit, answers: &[bool; SECTORS]) {
        let missed = fit.missed.iter().zip(answers);
        let missed = missed.map(|(missed, answers)| if *answers { 0 } else { *missed });
        let told = missed.sum::<u32>() >= LEAST_SILENT;
        let clear = self.sight == f64::INFINITY;
        // Fog, and a lidar that was silent altogether, spare no half of the fan; a half that returns was not silent.
        let halves = self.suspected.chunks_mut(SECTORS / 2);
        for (suspected, answers) in halves.zip(answers.chunks(SECTORS / 2)) {
            if answers.contains(&true) {
                suspected.fill(false);
            }
        }
        let held = self.silent.iter_mut().zip(&self.suspected);
        for ((silent, suspected), (answers, missed)) in held.zip(answers.iter().zip(fit.missed)) {
            *silent |= told && missed > 0 || clear && *suspected;
            *silent &= !answers;
        }
    }

    /// Marks the beams of silent sectors as bad, so that they show no free space, and those of adjacent sectors up to the next
    /// one with a return.
    fn mute(&self, scan: &mut LidarScan, sight: f64) {
        let answers = answers(scan, sight);
        let mut silent = self.silent;
        let mut near = false;
        for (silent, answers) in silent.iter_mut().zip(&answers) {
            near = *silent || near && !answers;
            *silent = near;
        }
        near = false;
        for (silent, answers) in silent.iter_mut().zip(&answers).rev() {
            near = *silent || near && !answers;
            *silent = near;
        }
        let beams = scan.ranges.len();
        for (beam, range) in scan.ranges.iter_mut().enumerate() {
            if silent[sector(beam, beams)] && !is_return(f64::from(*range), sight) {
                *range = -1.0;
            }
        }
    }

    /// What this scan should show of the last one, if the beams of that are taken as sent or in reverse order.
    fn predict(
        &self,
        scan: &LidarScan,
        sight: f64,
        pose: &Pose,
        reversed: bool,
        predictions: &mut Predictions,
    ) {
        predictions.clear();
        let step = self.last.angle_increment;
        let last = self.last.ranges.len();
        for (beam, range) in self.last.ranges.iter().enumerate() {
            let range = f64::from(*range);
            let confirmed = self.confirmed(beam, range, sight);
            if confirmed == 0 {
                continue;
            }
            let sent = if reversed { last - 1 - beam } else { beam };
            let angle = self.pose.pitch + self.last.angle_min + step * sent as f64;
            let (up, ahead) = libm::sincos(angle);
            let (ahead, up) = (
                self.pose.x + range * ahead - pose.x,
                self.pose.z + range * up - pose.z,
            );
            let place =
                (libm::atan2(up, ahead) - pose.pitch - scan.angle_min) / scan.angle_increment;
            let range = libm::hypot(ahead, up);
            if (NEAR..=SIGHT_SHARE * sight).contains(&range) {
                // A scan has no more beams than there is room for.
                let _ = predictions.push(Prediction {
                    place,
                    range,
                    confirmed,
                });
            }
        }
    }

    /// Number of adjacent beams of the last scan that met the same surface as a beam with this range \[m\].
    fn confirmed(&self, beam: usize, range: f64, sight: f64) -> u32 {
        if !is_return(range, sight) {
            return 0;
        }
        let alike = |beam: usize| {
            let other = self
                .last
                .ranges
                .get(beam)
                .map_or(0.0, |range| f64::from(*range));
            is_return(other, sight) && libm::fabs(other - range) < ALIKE + ALIKE_SHARE * range
        };
        u32::from(alike(beam.wrapping_sub(1))) + u32::from(alike(beam + 1))
    }
}

/// How well a scan fits predictions that are moved by so many beams, if its own beams are taken as sent or in reverse order.
fn fit(scan: &LidarScan, sight: f64, predictions: &Predictions, turn: f64, reversed: bool) -> Fit {
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
fn turned_hits(
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
