//! Faults of whole scans: a lidar that shows something else, and scans that do not come or come late.

use super::delivery::{Delivery, DeliveryFault};
use super::window::{Timed, fault_table, ticks_of};
use hil_protocol::LidarScan;
use serde::{Deserialize, Serialize};

/// What a faulty lidar shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Show {
    /// Every range is 0: no beam has a return.
    Zeros,
    /// Every range is the greatest range.
    FullRange,
    /// The ranges of the first scan within the fault, under the stamps of the new scans.
    Frozen,
    /// The ranges in the wrong order: those of the last beam first.
    Reversed,
    /// Nothing from the lower half of the beams.
    UpperHalf,
    /// Nothing from the upper half of the beams.
    LowerHalf,
}

fault_table! {
    /// The faults of whole scans; each may be absent.
    pub struct ScanFault {
        /// Ranges that stand in the place of the measured ones.
        pub show: Option<Show>,
        /// Range beyond which nothing returns \[m\], as in fog.
        pub sight: Option<f64>,
        /// Time by which the ranges are older than their stamp says \[ms\].
        pub age_ms: Option<u32>,
        /// Angle by which the lidar is turned nose-up without saying so \[deg\].
        pub rotation_deg: Option<f64>,
        /// Whether no scan comes.
        pub missing: bool,
        /// Time from a scan until it arrives \[ms\].
        pub delay_ms: Option<u32>,
        /// Whether each scan arrives only when the next one is taken.
        pub one_late: bool,
    }
}

/// Greatest age that a stamp hides \[ms\].
pub const MOST_AGE_MS: u32 = 1000;

impl ScanFault {
    fn wrong_key(&self) -> Option<&'static str> {
        let turned = self.rotation_deg.unwrap_or(0.0);
        let flaw = (!(-180.0..=180.0).contains(&turned))
            .then_some("give a `rotation_deg` of -180 to 180 deg");
        let sighted = self.sight.is_none_or(|sight| sight > 0.0);
        let blind = (!sighted).then_some("give a `sight` above 0 m");
        let aged = self
            .age_ms
            .is_none_or(|age| age <= MOST_AGE_MS && ticks_of(age).is_some());
        let old = (!aged).then_some("give an `age_ms` that is a multiple of 10 and at most 1000");
        self.delivery().wrong_key().or(flaw).or(blind).or(old)
    }
}

impl ScanFault {
    fn delivery(&self) -> DeliveryFault {
        DeliveryFault {
            from: self.from,
            until: self.until,
            toggle_hz: self.toggle_hz,
            missing: self.missing,
            delay_ms: self.delay_ms,
            rate_hz: None,
        }
    }

    /// Ticks by which the ranges of a tick are older than their stamp says.
    #[must_use]
    pub fn age(&self, tick: u32) -> u32 {
        let aged = self.age_ms.filter(|_| self.window().holds(tick));
        aged.and_then(ticks_of).unwrap_or(0)
    }

    /// Angle by which the lidar is turned at a tick \[rad\].
    #[must_use]
    pub fn rotation(&self, tick: u32) -> f64 {
        let turned = self.rotation_deg.filter(|_| self.window().holds(tick));
        turned.unwrap_or(0.0).to_radians()
    }
}

/// The scans of one flight.
#[derive(Clone, Debug)]
pub struct Scans {
    fault: ScanFault,
    range_max: f32,
    /// The scan whose ranges a frozen lidar shows.
    frozen: Option<LidarScan>,
    /// The scan that waits for the next one.
    waiting: Option<LidarScan>,
    delivery: Delivery<LidarScan>,
}

impl Scans {
    /// The scans of a lidar with this greatest range \[m\].
    #[must_use]
    pub fn new(fault: ScanFault, range_max: f64) -> Self {
        Self {
            fault,
            range_max: range_max as f32,
            frozen: None,
            waiting: None,
            delivery: Delivery::new(fault.delivery()),
        }
    }

    /// What the lidar shows instead of a scan; `None` if it shows nothing.
    pub fn show(&mut self, mut scan: LidarScan) -> Option<LidarScan> {
        if !self.fault.window().holds(scan.tick) {
            self.frozen = None;
            return Some(scan);
        }
        let half = scan.ranges.len() / 2;
        match self.fault.show {
            Some(Show::Zeros) => scan.ranges.fill(0.0),
            Some(Show::FullRange) => scan.ranges.fill(self.range_max),
            Some(Show::Frozen) => {
                let first = self.frozen.get_or_insert_with(|| scan.clone());
                scan.ranges.clone_from(&first.ranges);
            }
            Some(Show::Reversed) => scan.ranges.reverse(),
            Some(Show::UpperHalf) => scan.ranges.iter_mut().take(half).for_each(|it| *it = 0.0),
            Some(Show::LowerHalf) => scan.ranges.iter_mut().skip(half).for_each(|it| *it = 0.0),
            None => {}
        }
        if let Some(sight) = self.fault.sight {
            let beyond = |range: &&mut f32| f64::from(**range) > sight;
            scan.ranges
                .iter_mut()
                .filter(beyond)
                .for_each(|it| *it = 0.0);
        }
        (!self.fault.missing).then_some(scan)
    }

    /// Takes the scan that the lidar shows at a tick and gives the one that arrives at this tick.
    pub fn pass(&mut self, tick: u32, shown: Option<LidarScan>) -> Option<LidarScan> {
        let late = self.fault.one_late && self.fault.window().holds(tick);
        let on_its_way = match shown {
            Some(scan) if late => self.waiting.replace(scan),
            shown => shown,
        };
        self.delivery.pass(tick, on_its_way)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(tick: u32) -> LidarScan {
        LidarScan {
            tick,
            angle_min: -0.5,
            angle_increment: 0.5,
            ranges: [1.0, 2.0, tick as f32].into_iter().collect(),
        }
    }

    /// The scans that arrive of those taken every 10 ticks: the tick of the arrival, and the scan.
    fn arriving(fault: ScanFault) -> Vec<(u32, LidarScan)> {
        let mut scans = Scans::new(fault, 45.0);
        let arriving = |tick: u32| {
            let shown = tick
                .is_multiple_of(10)
                .then(|| scan(tick))
                .and_then(|scan| scans.show(scan));
            scans.pass(tick, shown).map(|scan| (tick, scan))
        };
        (0..60).filter_map(arriving).collect()
    }

    /// A fault from the scan of tick 20 on, until before that of tick 40.
    fn between() -> ScanFault {
        ScanFault {
            from: Some(0.2),
            until: Some(0.4),
            ..ScanFault::default()
        }
    }

    fn whole() -> Vec<(u32, LidarScan)> {
        (0..6)
            .map(|number| (10 * number, scan(10 * number)))
            .collect()
    }

    #[test]
    fn without_a_fault_each_scan_arrives_as_it_was_taken() {
        assert_eq!(arriving(between()), whole());
    }

    #[test]
    fn a_faulty_lidar_shows_zeros_full_range_or_what_it_saw_first() {
        let shown = |show| {
            let show = Some(show);
            arriving(ScanFault { show, ..between() })
        };
        let mut expected = whole();
        for at in 2..4 {
            expected[at].1.ranges.fill(0.0);
        }
        assert_eq!(shown(Show::Zeros), expected);
        for at in 2..4 {
            expected[at].1.ranges.fill(45.0);
        }
        assert_eq!(shown(Show::FullRange), expected);
        for at in 2..4 {
            expected[at].1.ranges = scan(20).ranges;
        }
        assert_eq!(shown(Show::Frozen), expected);
    }

    #[test]
    fn a_silent_lidar_sends_nothing() {
        let missing = true;
        let mut expected = whole();
        expected.drain(2..4);
        assert_eq!(
            arriving(ScanFault {
                missing,
                ..between()
            }),
            expected
        );
    }

    #[test]
    fn a_late_scan_keeps_its_stamp() {
        let delay_ms = Some(50);
        let mut expected = whole();
        for at in 2..4 {
            expected[at].0 += 5;
        }
        assert_eq!(
            arriving(ScanFault {
                delay_ms,
                ..between()
            }),
            expected
        );
        let mut scans = Scans::new(
            ScanFault {
                one_late: true,
                ..ScanFault::default()
            },
            45.0,
        );
        assert_eq!(scans.pass(0, Some(scan(0))), None);
        assert_eq!(scans.pass(5, None), None);
        assert_eq!(scans.pass(10, Some(scan(10))), Some(scan(0)));
        assert_eq!(scans.pass(20, Some(scan(20))), Some(scan(10)));
    }

    #[test]
    fn a_turned_lidar_is_turned_within_its_time_only() {
        let fault = ScanFault {
            rotation_deg: Some(5.0),
            ..between()
        };
        assert!((fault.rotation(20) - 5_f64.to_radians()).abs() < 1e-15);
        assert_eq!((fault.rotation(19), fault.rotation(40)), (0.0, 0.0));
    }
}
