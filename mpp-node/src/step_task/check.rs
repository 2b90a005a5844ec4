//! The check of the values that only a configuration or a parameter changes. A bit of memory that flips by itself is noticed
//! before it is flown, and repaired by majority. The design, which each step uses, is checked at each tick. The tuning is checked
//! when a scan may begin a cycle with it, when a parameter changes it, and every [`TUNING_PERIOD`] ticks. A flip in a spare
//! copy is noticed at the check after the next.

use super::StepTask;
use super::spare::{Copies, Spare, compare, in_turn, same};
use hil_protocol::RejectionCause;

/// Ticks from one check of the tuning to the next if no scan comes [-]: 80 ms. A check takes 605 instructions of a
/// Cortex-M7; with fewer checks a flip is told later. No cycle takes the tuning between them. Source: D30.
const TUNING_PERIOD: u32 = 8;

impl StepTask {
    /// Takes the present values as the right ones, after a change from the ground.
    #[inline(never)]
    pub(super) fn keep_values(&mut self) {
        let Some(flight) = &self.flight else {
            self.spare = None;
            return;
        };
        let design = flight.control.design();
        self.spare = Some(Spare {
            tuning: [flight.tuning; 2],
            design: [design; 2],
        });
    }

    /// Checks the values that a tick may use and repairs them. Returns false if that is not possible: the core then
    /// starts over, as after a restart.
    pub(super) fn check_values(&mut self, tick: u32, send: &mut impl FnMut(&[u8])) -> bool {
        let scan = (self.flight.as_ref()).is_some_and(|flight| flight.scan_tick.is_some());
        self.check(tick, scan || tick.is_multiple_of(TUNING_PERIOD), send)
    }

    /// Checks all values at once; see [`Self::check_values`].
    pub(super) fn check_all(&mut self, send: &mut impl FnMut(&[u8])) -> bool {
        self.check(self.clock, true, send)
    }

    fn check(&mut self, tick: u32, tuning: bool, send: &mut impl FnMut(&[u8])) -> bool {
        let copies = self.compare_values(tick, tuning);
        if copies != [Copies::Equal; 2] {
            self.reject(RejectionCause::ValuesRepaired, send);
        }
        let whole = !copies.contains(&Copies::Lost);
        if !whole {
            self.greet(send);
        }
        whole
    }

    /// Compares the design, and on demand the tuning, with one of the copies, in turn: two that agree are right. Only
    /// if they do not agree, all three are compared.
    fn compare_values(&mut self, tick: u32, tuning: bool) -> [Copies; 2] {
        let (flight, spare) = match (&self.flight, &self.spare) {
            (Some(flight), Some(spare)) => (flight, spare),
            (None, _) => return [Copies::Equal; 2],
            (Some(_), None) => return [Copies::Lost; 2],
        };
        let design = in_turn(&spare.design, tick);
        let other = in_turn(&spare.tuning, tick / TUNING_PERIOD);
        if flight.control.has(design) && (!tuning || same(&flight.tuning, other)) {
            return [Copies::Equal; 2];
        }
        self.repair_values()
    }

    // Not inlined, so that its copies are not on the stack of the whole step.
    #[inline(never)]
    fn repair_values(&mut self) -> [Copies; 2] {
        let (Some(flight), Some(spare)) = (&mut self.flight, &mut self.spare) else {
            return [Copies::Lost; 2];
        };
        let tuning = compare(&mut flight.tuning, &mut spare.tuning);
        let mut design = flight.control.design();
        let copies = compare(&mut design, &mut spare.design);
        if copies == Copies::Repaired {
            flight.control.restore(&design);
        }
        [tuning, copies]
    }
}

#[cfg(test)]
mod tests {
    use super::super::Pace;
    use super::*;
    use hil_protocol::{
        ActuatorLimits, AirData, Aircraft, Body, Configure, Decoder, MAX_FRAME, Message, Preset,
        SensorFrame, SetParameter, encode_body,
    };
    use mpp_core::flight::FlightLoop;

    const CONFIGURE: Configure = Configure {
        preset: Preset::Flight,
        aircraft: Aircraft::REFERENCE,
        paths: 25,
        seed: 0,
        replan_period_ticks: 100,
        latency_ticks: 50,
        slices_per_tick: 100,
        beams: 100,
        range_max: 45.0,
        altitude: 50.0,
        actuators: ActuatorLimits::NONE,
    };

    fn in_flight() -> StepTask {
        let mut task = StepTask::new(Pace::RealTime);
        tell(&mut task, &CONFIGURE, |_| {});
        task.set_up_done(Ok(()), &mut |_| {});
        assert_eq!(tick(&mut task, 0), [false, true]);
        task
    }

    /// Gives a message to the task.
    fn tell(task: &mut StepTask, message: &impl Body, mut send: impl FnMut(&[u8])) {
        for byte in encode_body(message, &mut [0; MAX_FRAME]).unwrap_or_default() {
            task.receive(*byte, &mut send);
        }
    }

    /// Makes a tick. Returns whether a repair was told, and whether a command came.
    fn tick(task: &mut StepTask, tick: u32) -> [bool; 2] {
        let frame = SensorFrame {
            tick,
            air: Some(AirData {
                tick,
                airspeed: 12.0 + f64::from(tick % 7) * 1e-3,
                pitch: 0.156 + f64::from(tick % 7) * 1e-4,
            }),
            position: None,
        };
        let (mut decoder, mut told) = (Decoder::new(), [false; 2]);
        tell(task, &frame, |bytes| {
            for message in bytes
                .iter()
                .filter_map(|byte| decoder.push(*byte))
                .flatten()
            {
                match message {
                    Message::Rejection(found) => {
                        told[0] |= found.cause == RejectionCause::ValuesRepaired;
                    }
                    Message::ActuatorCommand(_) => told[1] = true,
                    _ => {}
                }
            }
        });
        told
    }

    fn flip(value: &mut f64, bit: u32) {
        *value = f64::from_bits(value.to_bits() ^ 1 << bit);
    }

    #[test]
    fn any_flipped_bit_of_any_copy_is_repaired_and_told() {
        let mut task = in_flight();
        let before = task.flight.as_ref().map(|flight| flight.tuning);
        let mut at = 0;
        for bit in 0..64 {
            for copy in 0..3 {
                if let (Some(flight), Some(spare)) = (&mut task.flight, &mut task.spare) {
                    let [second, third] = &mut spare.tuning;
                    let copies = [&mut flight.tuning, second, third];
                    flip(&mut copies[copy].settings.cross_track, bit);
                }
                // The copy in use is compared at each check, and a spare copy at every other one.
                let checks = if copy == 0 { 1 } else { 2 };
                let mut repairs = [0, 0];
                for next in 1..=3 * TUNING_PERIOD {
                    let [repaired, commanded] = tick(&mut task, at + next);
                    assert!(commanded);
                    let late = next > checks * TUNING_PERIOD;
                    repairs[usize::from(late)] += u32::from(repaired);
                }
                at += 3 * TUNING_PERIOD;
                assert_eq!(repairs, [1, 0], "bit {bit}, copy {copy}");
            }
        }
        assert!(before.is_some() && task.flight.map(|flight| flight.tuning) == before);
    }

    #[test]
    fn a_flipped_setting_is_repaired_before_a_cycle_or_a_parameter_takes_it() {
        let mut task = in_flight();
        let before = task.flight.as_ref().map(|flight| flight.tuning);
        let spoil = |task: &mut StepTask| {
            if let Some(flight) = &mut task.flight {
                flip(&mut flight.tuning.settings.cross_track, 3);
            }
        };
        spoil(&mut task);
        assert_eq!(tick(&mut task, 1), [false, true]);
        assert!(task.flight.as_ref().map(|flight| flight.tuning) != before);
        if let Some(flight) = &mut task.flight {
            flight.scan_tick = Some(2);
        }
        assert_eq!(tick(&mut task, 2), [true, true]);
        assert!(task.flight.as_ref().map(|flight| flight.tuning) == before);

        spoil(&mut task);
        let set = SetParameter {
            parameter: 0,
            value: f64::NAN,
        };
        tell(&mut task, &set, |_| {});
        assert!(before.is_some() && task.flight.map(|flight| flight.tuning) == before);
    }

    #[test]
    fn a_changed_gain_is_repaired_before_it_is_flown() {
        let mut task = in_flight();
        let before = task.flight.as_ref().map(|flight| flight.control.design());
        if let Some(flight) = &mut task.flight {
            let mut settings = flight.tuning.settings;
            settings.regulator.elevator *= 2.0;
            if let Ok(other) = FlightLoop::new(&settings) {
                flight.control.restore(&other.design());
            }
            assert!(Some(flight.control.design()) != before);
        }
        assert_eq!(tick(&mut task, 1), [true, true]);
        assert!(before.is_some() && task.flight.map(|flight| flight.control.design()) == before);
    }

    #[test]
    fn three_different_copies_are_flown_by_no_tick() {
        let mut task = in_flight();
        if let (Some(flight), Some(spare)) = (&mut task.flight, &mut task.spare) {
            flip(&mut flight.tuning.settings.cross_track, 3);
            flip(&mut spare.tuning[0].settings.cross_track, 4);
        }
        let told = [1, 2, 3, 4, 5, 6, 7, 8].map(|at| tick(&mut task, at));
        assert_eq!(told[7], [true, false]);
        assert!(task.flight.is_none());
    }
}
