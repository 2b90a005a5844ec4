//! Scans and sensor frames as they arrive: which of them are used.

use super::StepTask;
use crate::{convert, ticks};
use hil_protocol::{DecodeError, LidarScan as WireScan, RejectionCause, SensorFrame as WireFrame};

/// Old ticks in a row after which the sender counts anew: 0.2 s. A frame that comes twice, or late, is alone.
const ANEW_AFTER: u32 = 20;

impl StepTask {
    /// Checks a scan. It waits for its sensor frame.
    // Not inlined, so that the message is not on the stack of each tick.
    #[inline(never)]
    pub(super) fn take_scan(&mut self, send: &mut impl FnMut(&[u8])) -> Result<(), DecodeError> {
        self.check_scan(&self.decoder.body()?, send);
        Ok(())
    }

    fn check_scan(&mut self, wire: &WireScan, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return self.reject(RejectionCause::NotConfigured, send);
        };
        if flight.heard_scan.replace(wire.tick) == Some(wire.tick) {
            // The core has it; the command that answered it was lost.
            return;
        }
        let (beams, range_max) = {
            let configure = &flight.tuning.configure;
            (configure.beams, configure.range_max)
        };
        let frozen = self.scan.is_repeated_by(&wire.ranges);
        convert::scan(wire, &mut self.scan);
        if frozen {
            flight.scan_tick = None;
            flight.lidar_good = Some(false);
            return self.reject(RejectionCause::ScanRepeated, send);
        }
        match self.scan.check(usize::from(beams), f64::from(range_max)) {
            Ok(()) => flight.scan_tick = Some(wire.tick),
            Err(error) => {
                flight.scan_tick = None;
                flight.lidar_good = Some(false);
                self.reject(convert::scan_rejection(error), send);
            }
        }
    }

    /// Makes the tick of a sensor frame, unless the frame is old.
    pub(super) fn sensor_frame(&mut self, frame: &WireFrame, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return self.reject(RejectionCause::NotConfigured, send);
        };
        let expected = flight
            .last_tick
            .map_or(frame.tick, |last| last.wrapping_add(1));
        let found = frame.tick;
        let old = ticks(expected, found) < 0;
        if !old {
            flight.old_ticks = None;
        }
        let anew = old && self.counts_anew(found);
        if found != expected && !anew {
            self.reject(RejectionCause::TickOrder { expected, found }, send);
        }
        // The step for an old tick is already done.
        if !old || anew {
            self.tick(frame, send);
        }
    }

    /// Takes note of an old tick. Returns true if so many old ticks came in a row that the sender must count
    /// anew. The flight's time then goes on from the last step; a cycle under way gives no plan.
    fn counts_anew(&mut self, tick: u32) -> bool {
        let Some(flight) = &mut self.flight else {
            return false;
        };
        let (next, row) = flight.old_ticks.unwrap_or((tick, 0));
        let row = if tick == next { row + 1 } else { 1 };
        flight.old_ticks = Some((tick.wrapping_add(1), row));
        if row < ANEW_AFTER {
            return false;
        }
        flight.old_ticks = None;
        let (first, last) = (flight.first_tick, flight.last_tick);
        let flown = first
            .zip(last)
            .map_or(0, |(first, last)| last.wrapping_sub(first));
        flight.first_tick = Some(tick.wrapping_sub(flown.wrapping_add(1)));
        flight.cycle = None;
        flight.last_cycle = None;
        flight.last_scan = None;
        flight.blind_from = None;
        flight.heard_scan = None;
        flight.plan_tick = flight.plan_tick.map(|_| tick);
        self.plan = None;
        true
    }
}
