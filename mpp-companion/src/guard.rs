//! The state machine: it alone decides whether setpoints are sent. It has no clock; each look bears its time.

/// What the companion does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum State {
    /// The autopilot is not verified.
    Off,
    /// All is verified. The pilot has the aircraft.
    Ready,
    /// The pilot gave the aircraft. The core runs, and no setpoint is sent.
    Listening,
    /// Setpoints of the core are sent.
    Flying,
    /// Setpoints of a climb are sent.
    Climb,
    /// The aircraft is given back: the autopilot's own targets or mode are set, then nothing is sent.
    GiveBack,
    /// The autopilot is silent.
    Lost,
}

/// Why a state was left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The autopilot is verified.
    Verified,
    /// It is not any more: a parameter, or the clocks.
    NotVerified,
    /// The pilot chose the mode.
    Chosen,
    /// The mode was left, by the pilot or after it was given back, or the aircraft was disarmed.
    TakenOver,
    /// The core is ready and the flight is level.
    Settled,
    /// The core has no plan.
    NoPlan,
    /// There are no good scans.
    Blind,
    /// The core does not trust its estimate.
    Estimate,
    /// Measurements come too late.
    Late,
    /// The flight left the vertical plane: bank, or distance across the course.
    Aside,
    /// The climb is done.
    Climbed,
    /// No message came.
    Silent,
    /// Messages come again.
    Heard,
}

/// What the guard looks at. Times in s, lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sight {
    /// Time.
    pub(crate) now: f64,
    /// Time since the last message of the autopilot.
    pub(crate) silence: f64,
    /// Whether parameters and clocks are verified.
    pub(crate) verified: bool,
    /// Whether the autopilot is armed and in the mode that takes setpoints.
    pub(crate) ours: bool,
    /// Whether attitude, climb and speed are those of level cruise.
    pub(crate) level: bool,
    /// Whether the core began so lately that it misses no command yet, and has a plan.
    pub(crate) fresh: bool,
    /// Plans that were adopted one after the other.
    pub(crate) plans: u32,
    /// Time for which the core has held trim.
    pub(crate) planless: f64,
    /// Time since the last scan.
    pub(crate) unseen: f64,
    /// Whether the core trusts the scans.
    pub(crate) sees: bool,
    /// Whether the core trusts air data and position.
    pub(crate) knows: bool,
    /// Age of the newest attitude.
    pub(crate) age: f64,
    /// Bank \[rad\], without sign.
    pub(crate) bank: f64,
    /// Distance from the course, without sign.
    pub(crate) aside: f64,
    /// Height above that of hand-over.
    pub(crate) climbed: f64,
}

/// The state, and since when it lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Guard {
    /// The state.
    pub(crate) state: State,
    since: f64,
}

impl Guard {
    /// Silence after which the autopilot is lost \[s\].
    pub(crate) const SILENCE: f64 = 0.2;
    /// The least time of listening \[s\].
    pub(crate) const LISTEN: f64 = 5.0;
    /// Time without a plan, or without a scan, after which a climb begins \[s\].
    pub(crate) const PATIENCE: f64 = 1.0;
    /// The greatest age of an attitude \[s\].
    pub(crate) const AGE: f64 = 0.15;
    /// The greatest bank \[rad\].
    pub(crate) const BANK: f64 = 0.52;
    /// The greatest distance from the course \[m\].
    pub(crate) const ASIDE: f64 = 15.0;
    /// The height of a climb \[m\], and its longest time \[s\].
    pub(crate) const CLIMB: (f64, f64) = (30.0, 20.0);

    /// Before the first message.
    #[must_use]
    pub(crate) fn new(now: f64) -> Self {
        let (state, since) = (State::Off, now);
        Self { state, since }
    }

    /// Whether a setpoint may be sent now: one of the core or of a climb, or a level one to an autopilot that takes the mode
    /// of setpoints only while they flow.
    #[must_use]
    pub(crate) fn sends(&self, flows: bool) -> bool {
        match self.state {
            State::Flying | State::Climb => true,
            State::Ready | State::Listening => flows,
            State::Off | State::GiveBack | State::Lost => false,
        }
    }

    /// Moves on by what is seen. Returns the reason of a change.
    pub(crate) fn look(&mut self, sight: &Sight) -> Option<Reason> {
        let (state, reason) = self.next(sight)?;
        (self.state, self.since) = (state, sight.now);
        Some(reason)
    }

    fn next(&self, sight: &Sight) -> Option<(State, Reason)> {
        if sight.silence > Self::SILENCE {
            return (!matches!(self.state, State::Lost | State::Off))
                .then_some((State::Lost, Reason::Silent));
        }
        let lasts = sight.now - self.since;
        let holds = !matches!(self.state, State::Off | State::Ready | State::Lost);
        match self.state {
            _ if holds && !sight.ours => Some((State::Off, Reason::TakenOver)),
            State::Lost => Some((State::Off, Reason::Heard)),
            State::Off => sight.verified.then_some((State::Ready, Reason::Verified)),
            State::Ready if !sight.verified => Some((State::Off, Reason::NotVerified)),
            State::Ready => sight.ours.then_some((State::Listening, Reason::Chosen)),
            State::Listening if !sight.verified => Some((State::Off, Reason::NotVerified)),
            State::Listening => {
                let ready = lasts >= Self::LISTEN
                    && sight.level
                    && sight.fresh
                    && sight.plans >= 2
                    && Self::abort(sight).is_none();
                ready.then_some((State::Flying, Reason::Settled))
            }
            State::Flying => Self::abort(sight),
            State::Climb => {
                let (height, longest) = Self::CLIMB;
                let over = sight.climbed >= height || lasts >= longest;
                // Nobody obeys the core in a climb, so its trust says nothing.
                let sight = Sight {
                    knows: true,
                    ..*sight
                };
                match Self::abort(&sight) {
                    Some((State::GiveBack, reason)) => Some((State::GiveBack, reason)),
                    _ => over.then_some((State::GiveBack, Reason::Climbed)),
                }
            }
            State::GiveBack => None,
        }
    }

    /// Why the core must not fly on, and what to do instead.
    fn abort(sight: &Sight) -> Option<(State, Reason)> {
        let within = |value: f64, most: f64| value <= most;
        if !sight.knows {
            Some((State::GiveBack, Reason::Estimate))
        } else if !within(sight.age, Self::AGE) {
            Some((State::GiveBack, Reason::Late))
        } else if !(within(sight.bank, Self::BANK) && within(sight.aside, Self::ASIDE)) {
            Some((State::GiveBack, Reason::Aside))
        } else if !(sight.sees && within(sight.unseen, Self::PATIENCE)) {
            Some((State::Climb, Reason::Blind))
        } else if !within(sight.planless, Self::PATIENCE) {
            Some((State::Climb, Reason::NoPlan))
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests;
