//! The monitor of the pitch sensor: a sensor that shows no turn while the altitude shows that the aircraft turns.
//!
//! The model of the commands says how the aircraft turns. If the sensor shows nothing of it, either the aircraft does not
//! turn, or the sensor sticks. The altitude decides within half a second: it follows the commands, or it does not
//! (analytical redundancy: Gertler, "Fault Detection and Diagnosis in Engineering Systems", chapters 2 and 5). All altitudes
//! have passed the same filters, so that only the last turns count.
//!
//! | the sensor shows the commanded turn | the altitude follows the commands | culprit |
//! |---|---|---|
//! | yes | | none |
//! | no | no | elevator, or a gust |
//! | no | yes | pitch sensor |

use crate::tuning::pitch_monitor::{
    FADE, FAILS_FOR, FIRST_USUAL, FOLLOWS, LEAST_ALTITUDE, LEAST_ANGLE, MISSED, SEEN, SMOOTH,
    STILL, STILL_FOR, USUAL, USUALS, WAIT, WINDOW,
};

/// What a tick shows of a turn.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Measured pitch \[rad\].
    pub pitch: f64,
    /// Altitude \[m\].
    pub altitude: f64,
    /// The part of the last turns of the pitch that the commands do not explain \[rad\].
    pub unexpected: f64,
    /// Rate at which the commands turn the path [rad/s].
    pub path_rate: f64,
    /// Rate at which an angle of attack turns the path [1/s].
    pub path_slope: f64,
    /// Airspeed [m/s].
    pub airspeed: f64,
}

/// The monitor of the pitch sensor.
#[derive(Clone, Copy, Debug)]
pub struct PitchMonitor {
    altitude: [HighPass; 2],
    commanded: Climb,
    unexpected: Climb,
    /// Mean squares over [`WINDOW`] of the altitude that the unexpected turn would give, and of that which the commands do
    /// not explain [m^2].
    claimed: f64,
    left: f64,
    /// Mean pitch over [`SMOOTH`], the pitch about which this has stayed \[rad\], and for how long \[s\].
    smooth: f64,
    rest: f64,
    still: f64,
    /// Least and greatest pitch that the commands have asked for meanwhile \[rad\].
    asked: [f64; 2],
    /// Time for which the still pitch has missed a turn \[s\].
    missing: f64,
    /// Usual mean square of the unexpected turn [rad^2].
    usual: f64,
    /// Time since the first tick, and time for which altitude and pitch have contradicted each other \[s\].
    seen: f64,
    contradicted: f64,
    fails: bool,
}

impl PitchMonitor {
    /// The monitor of a sensor that works.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            altitude: [HighPass::NEW; 2],
            commanded: Climb::NEW,
            unexpected: Climb::NEW,
            claimed: 0.0,
            left: 0.0,
            smooth: 0.0,
            rest: 0.0,
            still: 0.0,
            asked: [0.0; 2],
            missing: 0.0,
            usual: FIRST_USUAL * FIRST_USUAL,
            seen: 0.0,
            contradicted: 0.0,
            fails: false,
        }
    }

    /// Whether the sensor fails.
    #[must_use]
    pub fn fails(&self) -> bool {
        self.fails
    }

    /// Whether the sensor is still, and the altitude has not said yet whether the aircraft turns.
    #[must_use]
    pub fn is_undecided(&self) -> bool {
        self.still > 0.5 * STILL_FOR && self.missing < WAIT
    }

    /// Believes the sensor again, because it shows the turns of the commands.
    pub fn believe(&mut self) {
        self.fails = false;
    }

    /// Takes in a tick after a further `period` \[s\].
    pub fn update(&mut self, turn: &Turn, period: f64) {
        let [first, second] = &mut self.altitude;
        let altitude = second.take(first.take(turn.altitude, period), period);
        let commanded = (self.commanded).advance(turn.path_rate, turn.airspeed, period);
        let unexpected = turn.path_slope * turn.unexpected;
        let claimed = (self.unexpected).advance(unexpected, turn.airspeed, period);
        let share = (period / WINDOW).min(1.0);
        let follow = |mean: &mut f64, value: f64| *mean += share * (value * value - *mean);
        follow(&mut self.claimed, claimed);
        follow(&mut self.left, altitude - commanded);
        self.seen += period;
        self.rest_at(turn, period);
        self.judge(turn, period);
    }

    /// Notes for how long the pitch has stayed about its mean, and the turns that the commands asked for meanwhile.
    fn rest_at(&mut self, turn: &Turn, period: f64) {
        self.smooth += (turn.pitch - self.smooth) * (period / SMOOTH).min(1.0);
        let asked = turn.pitch - turn.unexpected;
        if libm::fabs(self.smooth - self.rest) > STILL {
            (self.rest, self.still, self.asked) = (self.smooth, 0.0, [asked; 2]);
        }
        self.still += period;
        self.rest += (self.smooth - self.rest) * (period / self.still).min(1.0);
        let [least, most] = self.asked;
        self.asked = [least.min(asked), most.max(asked)];
    }

    fn judge(&mut self, turn: &Turn, period: f64) {
        let per_angle = turn.airspeed * turn.path_slope * FADE * FADE;
        let least = LEAST_ALTITUDE.max(LEAST_ANGLE * per_angle);
        let [lowest, highest] = self.asked;
        let missed = highest - lowest;
        let misses = self.still > STILL_FOR && missed > MISSED;
        self.missing = if misses { self.missing + period } else { 0.0 };
        if !misses {
            let off = turn.unexpected * turn.unexpected - self.usual;
            self.usual += off * (period / USUAL).min(1.0);
        }
        let unusual = missed * missed > USUALS * USUALS * self.usual;
        let follows = self.left < FOLLOWS * self.claimed && self.claimed > least * least;
        let fails = misses && unusual && follows && self.seen > SEEN;
        self.contradicted = if fails {
            self.contradicted + period
        } else {
            0.0
        };
        self.fails |= self.contradicted > FAILS_FOR;
    }
}

/// A high pass with the time [`FADE`].
#[derive(Clone, Copy, Debug)]
struct HighPass {
    last: Option<f64>,
    value: f64,
}

impl HighPass {
    const NEW: Self = Self {
        last: None,
        value: 0.0,
    };

    /// Takes a value after a further `period` \[s\] and gives what has not faded.
    fn take(&mut self, value: f64, period: f64) -> f64 {
        let change = value - self.last.replace(value).unwrap_or(value);
        self.value += change - period * self.value / FADE;
        self.value
    }
}

/// The altitude after two high passes, from the rate at which the path turns.
#[derive(Clone, Copy, Debug)]
struct Climb {
    /// Path angle \[rad\].
    angle: f64,
    /// Altitude \[m\].
    altitude: f64,
}

impl Climb {
    const NEW: Self = Self {
        angle: 0.0,
        altitude: 0.0,
    };

    fn advance(&mut self, path_rate: f64, airspeed: f64, period: f64) -> f64 {
        self.altitude += period * (airspeed * self.angle - self.altitude / FADE);
        self.angle += period * (path_rate - self.angle / FADE);
        self.altitude
    }
}
