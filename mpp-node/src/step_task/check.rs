//! The check of the values that only a configuration or a parameter changes. A bit of memory that flips by
//! itself is noticed at the next tick, or in a spare copy at the next but one, and repaired by majority; it is
//! never flown unnoticed.

use super::StepTask;
use super::spare::{Copies, Spare, compare, same};
use hil_protocol::RejectionCause;

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

    /// Checks the values of the flight and repairs them. Returns false if that is not possible: the core then
    /// starts over, as after a restart.
    pub(super) fn check_values(&mut self, tick: u32, send: &mut impl FnMut(&[u8])) -> bool {
        let copies = self.compare_values(tick);
        if copies != [Copies::Equal; 2] {
            self.reject(RejectionCause::ValuesRepaired, send);
        }
        let whole = !copies.contains(&Copies::Lost);
        if !whole {
            self.greet(send);
        }
        whole
    }

    /// Compares the values in use with one of the copies, in turn: two that agree are right. Only if they do
    /// not agree, all three are compared.
    fn compare_values(&mut self, tick: u32) -> [Copies; 2] {
        let (flight, spare) = match (&self.flight, &self.spare) {
            (Some(flight), Some(spare)) => (flight, spare),
            (None, _) => return [Copies::Equal; 2],
            (Some(_), None) => return [Copies::Lost; 2],
        };
        let turn = (tick % 2) as usize;
        if same(&flight.tuning, &spare.tuning[turn]) && flight.control.has(&spare.design[turn]) {
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
        SensorFrame, encode_body,
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
                airspeed: 12.0 + f64::from(tick) * 1e-3,
                pitch: 0.156 + f64::from(tick) * 1e-4,
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
                        assert_eq!(found.cause, RejectionCause::ValuesRepaired);
                        told[0] = true;
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
                // The copy in use is compared at each tick, and a spare copy at every other one.
                let told = [1, 2, 3].map(|next| tick(&mut task, at + next));
                at += 3;
                assert!(told.iter().all(|[_, commanded]| *commanded));
                let repairs = told.iter().filter(|[repaired, _]| *repaired).count();
                assert_eq!(repairs, 1, "bit {bit}, copy {copy}");
                let by = if copy == 0 { 1 } else { 2 };
                assert!(told.iter().take(by).any(|[repaired, _]| *repaired));
            }
        }
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
        assert_eq!(tick(&mut task, 1), [true, false]);
        assert!(task.flight.is_none());
    }
}
