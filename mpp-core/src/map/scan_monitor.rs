//! Whether a scan agrees with the one before it: what the lidar showed has to be there again.
//!
//! The monitor predicts where beams meet again what they met in the last scan, or in short sight in the last scan that saw
//! farther. It uses only returns that an adjacent beam confirms, so a wire that falls between two beams predicts nothing. What
//! comes nearer than predicted hides the rest and says nothing; what comes from farther, or not at all, is a *miss*. If most
//! misses are hits when the scan is turned, the pitch is wrong and not the lidar: the scan says nothing.

use super::fan::{answers, farthest, sector};
use super::rolling_grid::{has_return, is_return};
use super::scan_age::AgeWatch;
use super::scan_fit::{Fit, Prediction, Predictions, fit, turned_hits};
use crate::sense::LidarScan;
use crate::tuning::scan_match::{
    AGES, ALIKE, ALIKE_SHARE, EDGE_BEAMS, LEAST_GAIN, LEAST_MISSES, LEAST_SILENT, MOST_MISFIT,
    NEAR, SECTORS, SIGHT_SHARE, SPREAD, SPREAD_SHARE,
};
use crate::vehicle::{Pose, ScanPoses};

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
    poses: ScanPoses,
    age: AgeWatch,
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

impl ScanMonitor {
    /// A monitor that has seen no scan.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            last: LidarScan::new(),
            poses: [Pose {
                x: 0.0,
                z: 0.0,
                pitch: 0.0,
            }; AGES],
            age: AgeWatch::new(),
            silent: [false; SECTORS],
            suspected: [false; SECTORS],
            reversed: false,
            sight: f64::INFINITY,
        }
    }

    /// Forgets everything, for another flight.
    pub fn start(&mut self) {
        self.age = AgeWatch::new();
        self.clear();
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

    /// The age that the stamps of scans hide, as a number of [`crate::tuning::scan_match::AGE_STEP`] [-].
    #[must_use]
    pub fn age(&self) -> usize {
        self.age.number()
    }

    /// The pose of a scan by this age.
    #[must_use]
    pub fn pose<'a>(&self, poses: &'a ScanPoses) -> &'a Pose {
        self.age.pose(poses)
    }

    /// Compares a scan from one of these poses, by a lidar with the range `sight` \[m\], with the last one, and takes out of it what is not
    /// to be believed. A scan without a return is [`ScanVerdict::Silent`] if enough was predicted, and suspects its sectors;
    /// [`super::RollingGrid::contradicts`] judges it too, by the map.
    pub fn check(
        &mut self,
        scan: &mut LidarScan,
        sight: f64,
        poses: &ScanPoses,
        predictions: &mut Predictions,
    ) -> ScanVerdict {
        let returns = has_return(scan, sight);
        if returns {
            self.note_age(scan, sight, poses);
        }
        let pose = self.pose(poses);
        let (mut before, known) = (false, self.reversed);
        self.predict(scan, sight, pose, false, predictions);
        let as_sent = fit(scan, sight, predictions, 0.0, false);
        if returns {
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
                self.poses = *poses;
            }
        } else if !known && self.suspect(&as_sent) {
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

    /// Notes how well the scan fits the last one if both are older than their stamps say.
    #[inline(never)]
    fn note_age(&mut self, scan: &LidarScan, sight: f64, poses: &ScanPoses) {
        // Earlier poses are not known at the start of a flight, or while the pitch is left out.
        let known = |poses: &ScanPoses| usize::from(poses[AGES - 1].x < poses[0].x);
        let ages = 1 + (AGES - 1) * known(poses) * known(&self.poses);
        let (mut sums, mut returns) = ([0.0; AGES], 0.0);
        for (beam, range) in self.last.ranges.iter().enumerate() {
            let range = f64::from(*range);
            if self.confirmed(beam, range, sight) == 0 {
                continue;
            }
            let mut costs = [0.0; AGES];
            for ((cost, from), to) in costs.iter_mut().zip(&self.poses).zip(poses).take(ages) {
                *cost = self.misfit(scan, sight, [from, to], beam, range);
            }
            if costs.iter().sum::<f64>().is_finite() {
                returns += 1.0;
                for (sum, cost) in sums.iter_mut().zip(costs) {
                    *sum += cost;
                }
            }
        }
        self.age.note(sums.get(..ages).unwrap_or_default(), returns);
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
        if self.suspect(fit) {
            self.sight = self.sight.min(fit.first_beyond);
        }
    }

    /// Suspects the sectors in which returns are missing beyond the farthest one, if they are enough to make the sight short.
    #[inline(never)]
    fn suspect(&mut self, fit: &Fit) -> bool {
        if fit.beyond.iter().sum::<u32>() < LEAST_SILENT {
            return false;
        }
        for (suspected, beyond) in self.suspected.iter_mut().zip(fit.beyond) {
            *suspected |= beyond > 0;
        }
        true
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
        let (mut answers, mut silent) = (answers(scan, sight), self.silent);
        // Up and then down the fan.
        for _ in 0..2 {
            spread(&mut silent, &answers);
            silent.reverse();
            answers.reverse();
        }
        let beams = scan.ranges.len();
        for (beam, range) in scan.ranges.iter_mut().enumerate() {
            if silent[sector(beam, beams)] && !is_return(f64::from(*range), sight) {
                *range = -1.0;
            }
        }
    }

    /// What this scan should show of the last one, if the beams of that are taken as sent or in reverse order.
    #[inline(never)]
    fn predict(
        &self,
        scan: &LidarScan,
        sight: f64,
        pose: &Pose,
        reversed: bool,
        predictions: &mut Predictions,
    ) {
        predictions.clear();
        let from = self.pose(&self.poses);
        let last = self.last.ranges.len();
        for (beam, range) in self.last.ranges.iter().enumerate() {
            let range = f64::from(*range);
            let confirmed = self.confirmed(beam, range, sight);
            if confirmed == 0 {
                continue;
            }
            let sent = if reversed { last - 1 - beam } else { beam };
            let (place, range) = self.seen_again(scan, [from, pose], sent, range);
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

    /// Where a scan should show again what a beam of the last one met at a range \[m\], as a number of beams from the first one [-],
    /// and its range then \[m\].
    #[inline(never)]
    fn seen_again(
        &self,
        scan: &LidarScan,
        [from, pose]: [&Pose; 2],
        beam: usize,
        range: f64,
    ) -> (f64, f64) {
        let (up, ahead) = libm::sincos(from.pitch + self.last.beam_angle(beam));
        let (ahead, up) = (
            from.x + range * ahead - pose.x,
            from.z + range * up - pose.z,
        );
        let angle = libm::atan2(up, ahead) - pose.pitch - scan.angle_min;
        (angle / scan.angle_increment, libm::hypot(ahead, up))
    }

    /// How far the nearest return of a scan is from where it should show again what a beam of the last one met at a range \[m\], from
    /// these poses of both, in squared standard deviations [-]. Infinite where nothing is predicted.
    #[inline(never)]
    fn misfit(
        &self,
        scan: &LidarScan,
        sight: f64,
        poses: [&Pose; 2],
        beam: usize,
        range: f64,
    ) -> f64 {
        let (place, range) = self.seen_again(scan, poses, beam, range);
        let last = scan.ranges.len() as f64 - 1.0;
        let inside = (EDGE_BEAMS..=last - EDGE_BEAMS).contains(&place);
        if !inside || !(NEAR..=SIGHT_SHARE * sight).contains(&range) {
            return f64::INFINITY;
        }
        let first = place as usize;
        let near = first.saturating_sub(2)..(first + 4).min(scan.ranges.len());
        let spread = SPREAD + SPREAD_SHARE * range;
        let mut least = MOST_MISFIT;
        for beam in near {
            let met = scan.ranges.get(beam).map_or(0.0, |met| f64::from(*met));
            if is_return(met, sight) {
                let aside = (place - beam as f64) * scan.angle_increment * range;
                let off = met - range;
                least = least.min((aside * aside + off * off) / (spread * spread));
            }
        }
        least
    }

    /// Number of adjacent beams of the last scan that met the same surface as a beam with this range \[m\].
    #[inline(never)]
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

/// Spreads silence up the fan to sectors without an answer.
#[inline(never)]
fn spread(silent: &mut [bool], answers: &[bool]) {
    let mut near = false;
    for (silent, answers) in silent.iter_mut().zip(answers) {
        near = *silent || near && !answers;
        *silent = near;
    }
}
