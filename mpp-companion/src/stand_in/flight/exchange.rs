//! The exchange of messages between companion and stand-in: its faults, and the watch on what the companion sends.

use super::Run;
use crate::frames::roll_pitch;
use crate::stand_in::Fault;
use crate::wire::{Framer, Mav};
use crate::{Side, State};
use mpp_sim::random::gaussian;

impl Run<'_> {
    /// Notes when a whole message tells the companion of a take-over.
    pub(super) fn note(&mut self, frame: &[u8]) {
        if let Some((_, heard)) = &mut self.taken {
            let given = self.kind.manners().mode;
            Framer::default().receive(frame, |_, _, message| {
                *heard |= match message {
                    Mav::HEARTBEAT(beat) => beat.custom_mode != given,
                    Mav::CURRENT_MODE(mode) => mode.custom_mode != given,
                    _ => false,
                };
            });
        }
    }

    /// Noise of airspeed, pitch and position, as navigation by a filter has it.
    pub(super) fn draw(&mut self) -> [f64; 4] {
        let mut draw = |sigma: f64| sigma * gaussian(&mut self.noise);
        let mut noise = [draw(0.1), draw(0.002), draw(0.05), draw(0.05)];
        if self.acting() == Some(Fault::NotFinite) && self.autopilot.tick.is_multiple_of(3) {
            noise = [f64::NAN; 4];
        }
        noise
    }

    /// Puts a frame of the autopilot on its way.
    pub(super) fn post_up(&mut self, mut frame: Vec<u8>) {
        self.count = self.count.wrapping_add(1);
        let mut due = self.autopilot.tick;
        match self.acting() {
            Some(Fault::Lost(n)) if self.count.is_multiple_of(n) => return,
            Some(Fault::Silent(ticks)) if self.since().is_some_and(|since| since < ticks) => return,
            Some(Fault::Late(ticks)) => due += ticks as u32,
            Some(Fault::Doubled) => self.up.push_back((due, frame.clone())),
            Some(Fault::Damaged) if self.count.is_multiple_of(3) => {
                let at = self.count as usize % frame.len();
                if let Some(byte) = frame.get_mut(at) {
                    *byte ^= 0x55;
                }
            }
            Some(Fault::Reordered) => match self.held.take() {
                None => {
                    self.held = Some(frame);
                    return;
                }
                Some(held) => {
                    self.up.push_back((due, frame));
                    frame = held;
                }
            },
            _ => {}
        }
        self.up.push_back((due, frame));
    }

    /// Gives the companion an input, and puts what it sends on its way.
    pub(super) fn input(&mut self, side: Side, bytes: &[u8]) {
        let now = self.now();
        let mut sent = Vec::new();
        self.companion
            .receive(now, side, bytes, &mut |frame| sent.push(frame.to_vec()));
        if let Some(log) = &mut self.log {
            // A vector takes all bytes.
            let _ = log.write(now, Some(side), bytes);
            for frame in &sent {
                let _ = log.write(now, None, frame);
            }
        }
        for frame in sent {
            self.watch(&frame);
            self.count = self.count.wrapping_add(1);
            let late = match self.acting() {
                Some(Fault::SetpointsLate(ticks)) => ticks as u32,
                Some(Fault::Lost(n)) if self.count.is_multiple_of(n) => continue,
                _ => 0,
            };
            self.down.push_back((self.autopilot.tick + late, frame));
        }
    }

    /// Judges a frame of the companion.
    fn watch(&mut self, frame: &[u8]) {
        let (taken, tick, outcome) = (self.taken, self.autopilot.tick, &mut self.outcome);
        let [least, most] = self.autopilot.pitch_limits();
        let (bank, state) = (self.kind.manners().bank, self.companion.state());
        self.framer.receive(frame, |_, _, message| {
            let Mav::SET_ATTITUDE_TARGET(target) = message else {
                return;
            };
            outcome.setpoints += u32::from(matches!(state, State::Flying | State::Climb));
            let (roll, pitch) = roll_pitch(target.q);
            let within = (least - 1e-5..=most + 1e-5).contains(&pitch) && roll.abs() <= bank + 1e-5;
            // Not a number is not within.
            if !(within && (0.0..=1.0).contains(&target.thrust)) {
                outcome.unsound += 1;
            }
            // PX4 gets level setpoints that it does not obey, so that the pilot may give the aircraft.
            if let Some((since, heard)) = taken.filter(|_| state != State::Ready) {
                outcome.late += u32::from(heard);
                outcome.last_after = outcome.last_after.max(10 * (tick - since) + 10);
            }
        });
    }

    pub(super) fn deliver(&mut self, tick: u32) {
        while self.down.front().is_some_and(|(due, _)| *due <= tick) {
            let Some((_, frame)) = self.down.pop_front() else {
                break;
            };
            let mut answers = Vec::new();
            self.autopilot
                .receive(&frame, &mut |answer| answers.push(answer));
            for answer in answers {
                self.post_up(answer);
            }
        }
    }
}
