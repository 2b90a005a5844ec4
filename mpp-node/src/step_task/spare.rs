//! Spare copies of the values that only a configuration or a parameter changes. A bit of memory that flips by
//! itself is noticed at the next tick and repaired by majority; it is never flown unnoticed.

use super::{Flight, StepTask};
use crate::parameters::Tuning;
use hil_protocol::RejectionCause;
use mpp_core::flight::{Design, FlightLoop};

/// The second and the third copy. The first one is in use.
#[derive(Clone, Copy)]
pub(super) struct Spare {
    tuning: [Tuning; 2],
    design: [Design; 2],
}

impl Spare {
    /// Copies of the values of a flight.
    pub(super) fn new(tuning: &Tuning, control: &FlightLoop) -> Self {
        Self {
            tuning: [*tuning; 2],
            design: [control.design(); 2],
        }
    }
}

/// The result of a comparison of three copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Copies {
    /// All are equal.
    Equal,
    /// One was different, and has the value of the others now.
    Repaired,
    /// All are different.
    Lost,
}

/// Compares three copies and repairs one that differs. A flip of the sign of a zero does not count.
fn compare<T: Copy + PartialEq>(first: &mut T, others: &mut [T; 2]) -> Copies {
    let [second, third] = others;
    if first == second && second == third {
        return Copies::Equal;
    }
    if first == second {
        *third = *first;
    } else if first == third {
        *second = *first;
    } else if second == third {
        *first = *second;
    } else {
        return Copies::Lost;
    }
    Copies::Repaired
}

impl Flight {
    /// Takes the present values as the right ones, after a change from the ground.
    pub(super) fn keep_values(&mut self) {
        self.spare = Spare::new(&self.tuning, &self.control);
    }

    fn compare_values(&mut self) -> [Copies; 2] {
        let tuning = compare(&mut self.tuning, &mut self.spare.tuning);
        let mut design = self.control.design();
        let copies = compare(&mut design, &mut self.spare.design);
        if copies == Copies::Repaired {
            self.control.restore(&design);
        }
        [tuning, copies]
    }
}

impl StepTask {
    /// Checks the values of the flight and repairs them. Returns false if that is not possible: the core then
    /// starts over, as after a restart.
    pub(super) fn check_values(&mut self, send: &mut impl FnMut(&[u8])) -> bool {
        let Some(flight) = &mut self.flight else {
            return true;
        };
        let copies = flight.compare_values();
        if copies != [Copies::Equal; 2] {
            self.reject(RejectionCause::ValuesRepaired, send);
        }
        let whole = !copies.contains(&Copies::Lost);
        if !whole {
            self.greet(send);
        }
        whole
    }
}

#[cfg(test)]
mod tests {
    use super::super::Pace;
    use super::*;
    use hil_protocol::{
        ActuatorLimits, AirframeId, Configure, Decoder, Message, Preset, SensorFrame,
    };

    const CONFIGURE: Configure = Configure {
        preset: Preset::Flight,
        airframe: AirframeId::Reference,
        paths: 25,
        seed: 0,
        replan_period_ticks: 100,
        latency_ticks: 50,
        slices_per_tick: 100,
        beams: 100,
        range_max: 45.0,
        altitude: 50.0,
        actuators: ActuatorLimits {
            thrust_max: None,
            thrust_lag: None,
            elevator_range: None,
            elevator_rate: None,
        },
    };

    fn in_flight() -> StepTask {
        let mut task = StepTask::new(Pace::RealTime);
        task.handle(&Message::Configure(CONFIGURE), &mut |_| {});
        task.set_up_done(Ok(()), &mut |_| {});
        assert_eq!(tick(&mut task, 0), [false, true]);
        task
    }

    /// Makes a tick. Returns whether a repair was told, and whether a command came.
    fn tick(task: &mut StepTask, tick: u32) -> [bool; 2] {
        let frame = SensorFrame {
            tick,
            airspeed: 12.0 + f64::from(tick) * 1e-3,
            pitch: 0.156 + f64::from(tick) * 1e-4,
            x: 0.12 * f64::from(tick),
            z: 50.0,
        };
        let (mut decoder, mut told) = (Decoder::new(), [false; 2]);
        task.handle(&Message::SensorFrame(frame), &mut |bytes| {
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
                if let Some(flight) = &mut task.flight {
                    let Spare { tuning, .. } = &mut flight.spare;
                    let [second, third] = tuning;
                    let copies = [&mut flight.tuning, second, third];
                    flip(&mut copies[copy].settings.cross_track, bit);
                }
                for expected in [[true, true], [false, true]] {
                    at += 1;
                    assert_eq!(tick(&mut task, at), expected, "bit {bit}, copy {copy}");
                }
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
        if let Some(flight) = &mut task.flight {
            flip(&mut flight.tuning.settings.cross_track, 3);
            flip(&mut flight.spare.tuning[0].settings.cross_track, 4);
        }
        assert_eq!(tick(&mut task, 1), [true, false]);
        assert!(task.flight.is_none());
    }
}
