//! What follows from the lateral part of an aircraft file.

use super::Mode;
use mpp_core::vehicle::{GRAVITY, LateralAirframe, linearize_lateral};
use mpp_sim::aircraft_file::{AircraftModel, Lateral, RollLoop};
use nalgebra::Complex;
use serde::Serialize;
use std::fmt;

/// What follows from the lateral part of an aircraft file, in level flight at cruise.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LateralReport {
    /// Where the lateral numbers come from.
    pub source: String,
    /// The autopilot's roll loop, and greatest bank and its rate of plans [deg, deg/s]. It is printed only: the file has it.
    #[serde(skip)]
    pub roll_loop: Option<(RollLoop, [f64; 2])>,
    /// The lateral modes.
    pub modes: LateralModes,
    /// Steady roll rate of the greatest aileron [deg/s], without sideslip.
    pub roll_rate_deg: f64,
    /// Level turns at 30, 45 and 60 deg of bank.
    pub turns: [LevelTurn; 3],
    /// The turn at the stall, or at the greatest lift that the elevator balances; null without these limits.
    pub smallest: Option<LevelTurn>,
}

/// A level turn at cruise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LevelTurn {
    /// Bank \[deg\].
    pub bank_deg: f64,
    /// Radius \[m\].
    pub radius: f64,
    /// Whether the wing carries the aircraft in this turn.
    pub carried: bool,
}

/// The lateral modes. A time constant is negative if the mode grows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LateralModes {
    /// Time constant of the roll mode \[s\]; null if roll and spiral are one oscillation.
    pub roll_time: Option<f64>,
    /// Time constant of the spiral mode \[s\]; null likewise.
    pub spiral_time: Option<f64>,
    /// The oscillation of sideslip, yaw and roll. A product of two real modes has a damping ratio above 1; null if one of them
    /// grows.
    pub dutch_roll: Option<Mode>,
}

impl LateralModes {
    /// The modes of an aircraft in its level trim.
    fn of(model: &AircraftModel, lateral: &LateralAirframe) -> Self {
        let linear = linearize_lateral(&model.known.airframe, lateral, &model.trim);
        let values = linear.a.complex_eigenvalues();
        let (mut real, mut pairs) = (Vec::new(), Vec::new());
        for value in values.iter() {
            if value.im.abs() <= 1e-9 * value.norm_sqr().sqrt() {
                real.push(value.re);
            } else if value.im > 0.0 {
                pairs.push(*value);
            }
        }
        real.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
        pairs.sort_by(|a, b| b.norm_sqr().total_cmp(&a.norm_sqr()));
        let time = |value: Option<f64>| value.map(|value| -1.0 / value);
        let of_pair = |value: &Complex<f64>| Mode::of(value.norm_sqr(), 2.0 * value.re);
        let of_real =
            |slow: f64, fast: f64| (slow * fast > 0.0).then(|| Mode::of(slow * fast, slow + fast));
        match (real.as_slice(), pairs.first()) {
            ([spiral, slow, fast, roll], None) => Self {
                roll_time: time(Some(*roll)),
                spiral_time: time(Some(*spiral)),
                dutch_roll: of_real(*slow, *fast),
            },
            (real, pair) => Self {
                roll_time: time(real.get(1).copied()),
                spiral_time: time(real.first().copied()),
                dutch_roll: pair.map(of_pair),
            },
        }
    }
}

impl LateralReport {
    /// The report about an aircraft that lifts at most `load` times its weight, if its file has the lateral table.
    pub(super) fn new(model: &AircraftModel, load: f64) -> Option<Self> {
        let file = model.file.lateral.as_ref()?;
        let lateral = file.airframe();
        let speed = model.known.cruise;
        let turn = |bank: f64| LevelTurn {
            bank_deg: bank.to_degrees(),
            radius: speed * speed / (GRAVITY * libm::tan(bank)),
            carried: 1.0 / libm::cos(bank) <= load * (1.0 + 1e-9),
        };
        Some(Self {
            source: file.source.clone(),
            roll_loop: (file.roll_loop).map(|it| (it, model.file.plan_bank().map(f64::to_degrees))),
            modes: LateralModes::of(model, &lateral),
            roll_rate_deg: most_roll_rate(file, &lateral, speed).to_degrees(),
            turns: [30_f64, 45.0, 60.0].map(|bank| turn(bank.to_radians())),
            smallest: (load > 1.0 && load.is_finite()).then(|| turn(libm::acos(1.0 / load))),
        })
    }
}

/// Roll rate [rad/s] at which the damping balances the greatest aileron at an airspeed [m/s].
fn most_roll_rate(file: &Lateral, lateral: &LateralAirframe, speed: f64) -> f64 {
    let aileron = lateral.roll.aileron * file.aileron.range.to_radians();
    aileron / -lateral.roll.roll_rate * (2.0 * speed / lateral.span)
}

impl fmt::Display for LateralReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let modes = &self.modes;
        writeln!(f, "lateral        {}", self.source)?;
        let time = |time: f64| {
            let verb = if time > 0.0 { "decays" } else { "grows" };
            format!("{verb} in {:.3} s", time.abs())
        };
        let real = |it: Option<f64>| it.map_or("one oscillation with the other".to_owned(), time);
        if let Some((it, [bank, rate])) = &self.roll_loop {
            let (w, damping, delay) = (it.frequency, it.damping, it.delay);
            writeln!(
                f,
                "roll loop      {w:.2} rad/s, damping {damping:.2}, dead time {delay:.2} s; plans bank up to {bank:.0} deg, at {rate:.0} deg/s"
            )?;
        } else {
            writeln!(
                f,
                "roll mode      {}; {:.0} deg/s at full aileron",
                real(modes.roll_time),
                self.roll_rate_deg
            )?;
            writeln!(f, "spiral mode    {}", real(modes.spiral_time))?;
            let none = "no oscillation: two modes, of which one grows".to_owned();
            let dutch = modes.dutch_roll.map_or(none, |mode| mode.to_string());
            writeln!(f, "Dutch roll     {dutch}")?;
        }
        let turns = self.turns.map(|turn| {
            let beyond = if turn.carried {
                ""
            } else {
                " (more than the wing carries)"
            };
            format!("{:.1} m at {:.0} deg{beyond}", turn.radius, turn.bank_deg)
        });
        let [first, second, third] = turns;
        write!(f, "level turns    {first}, {second}, {third}; ")?;
        match self.smallest {
            Some(turn) => writeln!(
                f,
                "smallest {:.1} m at {:.0} deg",
                turn.radius, turn.bank_deg
            ),
            None => writeln!(f, "no smallest: no limit of the lift"),
        }
    }
}
