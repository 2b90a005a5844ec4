//! The check of two values that only a configuration or a parameter changes: the [`Tuning`](crate::parameters::Tuning) and
//! the [`Design`](mpp_core::flight::Design) of the flight loop. A bit of them that flips by itself is noticed before it is
//! flown, and repaired by majority. The design, which each step uses, is checked at each tick. The tuning is checked when a
//! scan may begin a cycle with it, when a parameter changes it, and every [`TUNING_PERIOD`] ticks. A flip in a spare copy is
//! noticed at the check after the next.
//!
//! No other value has copies: neither what estimates and health counters hold, nor what the watches of sensors and actuators
//! have derived from the settings ([`EstimatorDesign`](mpp_core::estimate::EstimatorDesign) names it), nor the memory of the
//! planner.

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
    use crate::parameters::Tuning;
    use hil_protocol::{
        ActuatorLimits, AirData, Aircraft, Body, Configure, Decoder, MAX_FRAME, Message, Preset,
        SensorFrame, SetParameter, encode_body,
    };
    use mpp_core::flight::FlightLoop;
    use mpp_core::settings::Settings;

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

    /// Makes ticks after the tick `at`, as many as any repair takes and more. Returns the repairs that were told in the first
    /// `checked` of them, and those told later.
    fn repairs(task: &mut StepTask, at: &mut u32, checked: u32) -> [u32; 2] {
        let mut repairs = [0, 0];
        for next in 1..=3 * TUNING_PERIOD {
            let [repaired, commanded] = tick(task, *at + next);
            assert!(commanded);
            repairs[usize::from(next > checked)] += u32::from(repaired);
        }
        *at += 3 * TUNING_PERIOD;
        repairs
    }

    fn flip(value: &mut f64, bit: u32) {
        *value = f64::from_bits(value.to_bits() ^ 1 << bit);
    }

    /// Flips a bit of a number of the tuning.
    type Flip = fn(&mut Tuning, u32);

    /// Numbers of the tuning, from its beginning to its end.
    const NUMBERS: [(&str, Flip); 7] = [
        ("mass", |all, bit| {
            flip(&mut all.settings.airframe.mass, bit);
        }),
        ("gate", |all, bit| {
            flip(&mut all.settings.estimator.gate, bit);
        }),
        ("cross-track", |all, bit| {
            flip(&mut all.settings.cross_track, bit);
        }),
        ("altitude", |all, bit| {
            flip(&mut all.settings.planner.altitude, bit);
        }),
        ("sight", |all, bit| {
            if let Some(own) = all.settings.planner.plane_mut() {
                flip(&mut own.sight, bit);
            }
        }),
        ("configured altitude", |all, bit| {
            flip(&mut all.configure.altitude, bit);
        }),
        ("latency", |all, bit| {
            all.configure.latency_ticks ^= 1 << (bit % 32);
        }),
    ];

    #[test]
    fn a_flipped_bit_of_a_copy_of_the_tuning_is_repaired_and_told() {
        let mut task = in_flight();
        let before = task.flight.as_ref().map(|flight| flight.tuning);
        let mut at = 0;
        for (name, number) in NUMBERS {
            for (bit, copy) in (0..64)
                .step_by(3)
                .flat_map(|bit| [(bit, 0), (bit, 1), (bit, 2)])
            {
                if let (Some(flight), Some(spare)) = (&mut task.flight, &mut task.spare) {
                    let [second, third] = &mut spare.tuning;
                    let copies = [&mut flight.tuning, second, third];
                    number(copies[copy], bit);
                }
                // The copy in use is compared at each check, and a spare copy at every other one.
                let checks = if copy == 0 { 1 } else { 2 };
                let repairs = repairs(&mut task, &mut at, checks * TUNING_PERIOD);
                assert_eq!(repairs, [1, 0], "{name}, bit {bit}, copy {copy}");
            }
        }
        assert!(before.is_some() && task.flight.map(|flight| flight.tuning) == before);
    }

    /// Changes settings so that they give another design.
    type Change = fn(&mut Settings);

    /// A change of each part of the design.
    const CHANGES: [(&str, Change); 6] = [
        ("airframe, gain and trim", |settings| {
            settings.airframe.mass *= 1.01;
        }),
        ("actuators", |settings| {
            settings.actuators.thrust_max = Some(15.0);
        }),
        ("filter", |settings| settings.estimator.gate += 1.0),
        ("wind", |settings| settings.wind_change = Some(2.0)),
        ("cross-track", |settings| settings.cross_track *= 1.01),
        ("airspeed", |settings| settings.airspeed_hold *= 1.01),
    ];

    /// A design in use that has changed is repaired before the next tick flies it.
    #[test]
    fn a_changed_copy_of_the_design_is_repaired_and_told() {
        let mut task = in_flight();
        let tuning = task.flight.as_ref().map(|flight| flight.tuning).unwrap();
        let before = task.flight.as_ref().map(|flight| flight.control.design());
        let mut at = 0;
        for (name, change) in CHANGES {
            let mut settings = tuning.settings;
            change(&mut settings);
            let other = FlightLoop::new(&settings).unwrap().design();
            assert!(Some(other) != before, "{name}");
            for copy in 0..3 {
                if let (Some(flight), Some(spare)) = (&mut task.flight, &mut task.spare) {
                    match copy {
                        0 => flight.control.restore(&other),
                        copy => spare.design[copy - 1] = other,
                    }
                }
                let checks = if copy == 0 { 1 } else { 2 };
                let repairs = repairs(&mut task, &mut at, checks);
                assert_eq!(repairs, [1, 0], "{name}, copy {copy}");
                let now = task.flight.as_ref().map(|flight| flight.control.design());
                assert!(now == before, "{name}, copy {copy}");
            }
        }
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
