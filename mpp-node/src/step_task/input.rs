//! Scans and sensor frames as they arrive: which of them are used.

use super::StepTask;
use crate::out::Out;
use crate::{convert, ticks};
use hil_protocol::{DecodeError, LidarScan as WireScan, RejectionCause, SensorFrame as WireFrame};

/// Old ticks in a row that show a restarted count of the sender: 0.2 s. A frame that comes twice, or late, is alone.
const RESTARTED_AFTER: u32 = 20;

/// A lidar of which more than one beam in so many is bad is not sound. Its other beams are used all the same.
const SPOILT_SHARE: usize = 10;

/// Most ticks that may miss between two old ticks of a count that was restarted, on a line that loses frames.
const MOST_MISSING: i32 = 20;

impl StepTask {
    /// Checks a scan. It waits for its sensor frame.
    // Not inlined, so that the message is not on the stack of each tick.
    #[inline(never)]
    pub(super) fn take_scan(&mut self, send: &mut impl Out) -> Result<(), DecodeError> {
        self.check_scan(&self.decoder.body()?, send);
        Ok(())
    }

    pub(super) fn check_scan(&mut self, wire: &WireScan, send: &mut impl Out) {
        let Some(session) = &mut self.session else {
            return self.reject(RejectionCause::NotConfigured, send);
        };
        if session.heard_scan.replace(wire.tick) == Some(wire.tick) {
            // The core has it; the command that answered it was lost.
            return;
        }
        let beams = usize::from(session.tuning.configure.beams);
        let frozen = self.scan.is_repeated_by(&wire.ranges);
        convert::scan(wire, &mut self.scan);
        if frozen {
            session.scan_tick = None;
            session.lidar_good = Some(false);
            return self.reject(RejectionCause::ScanRepeated, send);
        }
        match self.scan.check(beams) {
            Ok(()) => {
                session.scan_tick = Some(wire.tick);
                session.spoilt = SPOILT_SHARE * self.scan.bad_beams() > wire.ranges.len();
            }
            Err(error) => {
                session.scan_tick = None;
                session.lidar_good = Some(false);
                self.reject(convert::scan_rejection(error), send);
            }
        }
    }

    /// Makes the tick of a sensor frame, unless the frame is old.
    pub(super) fn sensor_frame(&mut self, frame: &WireFrame, send: &mut impl Out) {
        let Some(session) = &mut self.session else {
            return self.reject(RejectionCause::NotConfigured, send);
        };
        let expected = session
            .last_tick
            .map_or(frame.tick, |last| last.wrapping_add(1));
        let found = frame.tick;
        let old = ticks(expected, found) < 0;
        if !old {
            session.old_ticks = None;
        }
        let restarted = old && self.restarts_count(found);
        if found != expected && !restarted {
            self.reject(RejectionCause::TickOrder { expected, found }, send);
        }
        // The step for an old tick is already done.
        if !old || restarted {
            self.tick(frame, send);
        }
    }

    /// Takes note of an old tick. Returns true if so many old ticks came in a row that the sender must have restarted its
    /// count. The flight's time then continues from the last step; a cycle under way gives no plan.
    fn restarts_count(&mut self, tick: u32) -> bool {
        let Some(session) = &mut self.session else {
            return false;
        };
        let (next, row) = session.old_ticks.unwrap_or((tick, 0));
        let rises = (0..=MOST_MISSING).contains(&ticks(next, tick));
        let row = if rises { row + 1 } else { 1 };
        session.old_ticks = Some((tick.wrapping_add(1), row));
        if row < RESTARTED_AFTER {
            return false;
        }
        session.old_ticks = None;
        let (first, last) = (session.first_tick, session.last_tick);
        let flown = first
            .zip(last)
            .map_or(0, |(first, last)| last.wrapping_sub(first));
        session.first_tick = Some(tick.wrapping_sub(flown.wrapping_add(1)));
        session.cycle = None;
        session.last_cycle = None;
        session.last_scan = None;
        session.blind_from = None;
        session.heard_scan = None;
        session.plan_tick = session.plan_tick.map(|_| tick);
        self.plan = None;
        true
    }
}
