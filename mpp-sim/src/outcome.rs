//! The outcome of a flight and its extreme values.
//!
//! Two rules judge every flight. A flight is a *success* by the paper's rule when it neither touches
//! an obstacle nor reaches an extreme attitude. It is *strict* when it also stays within
//! [`ALTITUDE_BAND`] of its initial altitude: a flight over the field does not plan through it. The
//! flight goes on until the paper's rule ends it.

use crate::field::Field;
use crate::generator;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::VehicleState;
use serde::{Deserialize, Serialize};

/// Pitch beyond which a flight has failed \[rad\] (paper, section IV).
pub const PITCH_LIMIT: f64 = 60_f64.to_radians();
/// Flight path angle beyond which a flight has failed \[rad\] (paper, section IV). In wind it is
/// the angle of the motion through the air.
pub const FLIGHT_PATH_LIMIT: f64 = 45_f64.to_radians();
/// Distance from the initial altitude beyond which a flight is not strict \[m\]: the obstacles' centres
/// lie within 10 m of it, and their radius is 1 m.
pub const ALTITUDE_BAND: f64 = generator::BAND;

/// The outcome of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The aircraft flew to the end.
    Survived,
    /// The aircraft touched the inside of an obstacle between two ticks.
    Collision,
    /// The pitch went beyond [`PITCH_LIMIT`].
    PitchLimit,
    /// The flight path angle went beyond [`FLIGHT_PATH_LIMIT`], or the plant had no flight path any more: its airspeed fell
    /// to zero.
    FlightPathLimit,
    /// An order from the ground ended the flight.
    Terminated,
    /// Ended by whoever started it, before anything was decided.
    Interrupted,
    /// In space: the aircraft left the band to the side or upwards, or ran out of time.
    NotArrived,
}

impl Outcome {
    /// The process's exit code for a flight that ended so.
    #[must_use]
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Survived => 0,
            Self::Collision => 3,
            Self::PitchLimit | Self::FlightPathLimit => 4,
            Self::Terminated => 8,
            Self::Interrupted => 130,
            Self::NotArrived => 5,
        }
    }
}

impl core::fmt::Display for Outcome {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Survived => "survived",
            Self::Collision => "collision",
            Self::PitchLimit => "pitch limit",
            Self::FlightPathLimit => "flight path limit",
            Self::Terminated => "terminated",
            Self::Interrupted => "interrupted",
            Self::NotArrived => "not arrived",
        })
    }
}

/// The class of a flight. Every flight has exactly one class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// Success by the strict rule.
    Success,
    /// Success by the paper's rule, but further than [`ALTITUDE_BAND`] from the initial altitude; in space, not arrived.
    LeftBand,
    /// A collision while a plan was flown.
    Collision,
    /// Pitch beyond [`PITCH_LIMIT`] while a plan was flown.
    Pitch,
    /// Flight path angle beyond [`FLIGHT_PATH_LIMIT`] while a plan was flown.
    FlightPath,
    /// An order from the ground ended the flight.
    Terminated,
    /// Any failure by the paper's rule without a plan: the core held level trim when the flight
    /// ended, or its last planning cycle found no new plan. In the second case the core flew an
    /// older plan or held level trim.
    NoPlan,
    /// Ended by whoever started it: neither a success nor a failure. No campaign has such flights.
    Interrupted,
}

impl Class {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 8] = [
        Self::Success,
        Self::LeftBand,
        Self::Collision,
        Self::Pitch,
        Self::FlightPath,
        Self::Terminated,
        Self::NoPlan,
        Self::Interrupted,
    ];

    /// The class of a flight. `planless` is true in the cases that [`Class::NoPlan`] describes.
    #[must_use]
    pub fn of(outcome: Outcome, strict: bool, planless: bool) -> Self {
        match outcome {
            Outcome::Survived if strict => Self::Success,
            Outcome::Survived | Outcome::NotArrived => Self::LeftBand,
            Outcome::Terminated => Self::Terminated,
            Outcome::Interrupted => Self::Interrupted,
            _ if planless => Self::NoPlan,
            Outcome::Collision => Self::Collision,
            Outcome::PitchLimit => Self::Pitch,
            Outcome::FlightPathLimit => Self::FlightPath,
        }
    }

    /// Its name in rows and reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Success => "success",
            Self::LeftBand => "left-band",
            Self::Collision => "collision",
            Self::Pitch => "pitch",
            Self::FlightPath => "flight-path",
            Self::Terminated => "terminated",
            Self::NoPlan => "no-plan",
            Self::Interrupted => "interrupted",
        }
    }
}

/// Extremes of a flight so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Score {
    /// The altitude that the flight should keep \[m\].
    pub altitude: f64,
    /// Greatest distance from the altitude of a strict success \[m\].
    pub band: f64,
    /// Radius of the aircraft's body \[m\].
    pub body_radius: f64,
    /// Least distance from the body to an obstacle's edge \[m\]: negative inside, infinite without obstacles.
    pub min_clearance: f64,
    /// Greatest `|pitch|` \[rad\].
    pub max_pitch: f64,
    /// Greatest `|flight path angle|` \[rad\].
    pub max_flight_path: f64,
    /// Greatest distance from the altitude \[m\].
    pub max_altitude_deviation: f64,
}

impl Score {
    /// The score of a flight that has not begun, of a body of this radius \[m\] that should keep within
    /// `band` of this altitude \[m\].
    #[must_use]
    pub fn new(altitude: f64, band: f64, body_radius: f64) -> Self {
        Self {
            altitude,
            band,
            body_radius,
            min_clearance: f64::INFINITY,
            max_pitch: 0.0,
            max_flight_path: 0.0,
            max_altitude_deviation: 0.0,
        }
    }

    /// Whether the flight stayed within its band.
    #[must_use]
    pub fn in_band(&self) -> bool {
        self.max_altitude_deviation <= self.band
    }

    /// Adds the motion of the tick that begins at the field's time, with the straight path between the
    /// two states. Returns the outcome if the flight ended. A collision takes precedence over an extreme attitude.
    pub fn update(
        &mut self,
        field: &dyn Field,
        from: &VehicleState,
        to: &VehicleState,
    ) -> Option<Outcome> {
        let (start, end) = ((from.x, from.z), (to.x, to.z));
        let clearance = field.clearance_of_motion(start, end, TICK_PERIOD) - self.body_radius;
        let (pitch, flight_path) = (to.air.pitch.abs(), to.air.flight_path.abs());
        self.min_clearance = self.min_clearance.min(clearance);
        self.max_pitch = self.max_pitch.max(pitch);
        self.max_flight_path = self.max_flight_path.max(flight_path);
        let deviation = (to.z - self.altitude).abs();
        self.max_altitude_deviation = self.max_altitude_deviation.max(deviation);
        if clearance < 0.0 {
            Some(Outcome::Collision)
        } else if pitch > PITCH_LIMIT {
            Some(Outcome::PitchLimit)
        } else if flight_path > FLIGHT_PATH_LIMIT {
            Some(Outcome::FlightPathLimit)
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Obstacle, ObstacleField};
    use mpp_core::vehicle::AirState;

    fn state(x: f64, z: f64, pitch_deg: f64, path_deg: f64) -> VehicleState {
        VehicleState {
            x,
            z,
            air: AirState {
                airspeed: 12.0,
                pitch: pitch_deg.to_radians(),
                pitch_rate: 0.0,
                flight_path: path_deg.to_radians(),
            },
        }
    }

    fn field() -> ObstacleField {
        ObstacleField::new(vec![Obstacle::circle(10.0, 50.0, 1.0)])
    }

    fn end(from: VehicleState, to: VehicleState) -> Option<Outcome> {
        Score::new(50.0, ALTITUDE_BAND, 0.0).update(&field(), &from, &to)
    }

    #[test]
    fn the_swept_path_counts_not_only_the_ticks() {
        let (before, after) = (state(8.0, 50.9, 0.0, 0.0), state(12.0, 50.9, 0.0, 0.0));
        assert_eq!(end(before, before), None);
        assert_eq!(end(after, after), None);
        assert_eq!(end(before, after), Some(Outcome::Collision));
    }

    #[test]
    fn attitude_limits_are_the_papers() {
        for sign in [-1.0, 1.0] {
            let at = |pitch: f64, path: f64| {
                let state = state(0.0, 50.0, sign * pitch, sign * path);
                end(state, state)
            };
            assert_eq!(at(59.9, 44.9), None);
            assert_eq!(at(60.1, 0.0), Some(Outcome::PitchLimit));
            assert_eq!(at(0.0, 45.1), Some(Outcome::FlightPathLimit));
        }
        let inside = state(10.0, 50.0, 70.0, 70.0);
        assert_eq!(end(inside, inside), Some(Outcome::Collision));
    }

    #[test]
    fn a_score_keeps_the_extremes() {
        let mut score = Score::new(50.0, ALTITUDE_BAND, 0.0);
        let path = [
            state(0.0, 50.0, -20.0, 5.0),
            state(10.0, 53.0, 10.0, -8.0),
            state(20.0, 49.0, 3.0, 1.0),
        ];
        for pair in path.windows(2) {
            assert_eq!(score.update(&field(), &pair[0], &pair[1]), None);
        }
        assert!((score.max_pitch - 10_f64.to_radians()).abs() < 1e-12);
        assert!((score.max_flight_path - 8_f64.to_radians()).abs() < 1e-12);
        assert!((score.max_altitude_deviation - 3.0).abs() < 1e-12);
        let expected = field().clearance_of_motion((0.0, 50.0), (10.0, 53.0), 0.0);
        let second = field().clearance_of_motion((10.0, 53.0), (20.0, 49.0), 0.0);
        assert!((score.min_clearance - expected.min(second)).abs() < 1e-12);
    }

    #[test]
    fn the_band_is_left_at_eleven_metres() {
        for (z, inside) in [(60.9, true), (61.1, false), (39.1, true), (38.9, false)] {
            let mut score = Score::new(50.0, ALTITUDE_BAND, 0.0);
            let at = state(0.0, z, 0.0, 0.0);
            assert_eq!(score.update(&field(), &at, &at), None);
            // A flight that comes back into the band is still not strict.
            let back = state(0.0, 50.0, 0.0, 0.0);
            score.update(&field(), &at, &back);
            assert_eq!(score.in_band(), inside, "{z}");
        }
    }

    #[test]
    fn every_flight_has_one_class() {
        use Outcome::{Collision, FlightPathLimit, Interrupted, PitchLimit, Survived};
        for (outcome, strict, planless, class) in [
            (Survived, true, false, Class::Success),
            (Survived, true, true, Class::Success),
            (Survived, false, true, Class::LeftBand),
            (Collision, false, false, Class::Collision),
            (PitchLimit, false, false, Class::Pitch),
            (FlightPathLimit, false, false, Class::FlightPath),
            (Collision, false, true, Class::NoPlan),
            (PitchLimit, false, true, Class::NoPlan),
            (Interrupted, false, true, Class::Interrupted),
        ] {
            assert_eq!(Class::of(outcome, strict, planless), class);
        }
        for class in Class::ALL {
            let json = serde_json::to_string(&class).unwrap();
            assert_eq!(json, format!("\"{}\"", class.name()));
        }
    }

    #[test]
    fn exit_codes_are_the_documented_ones() {
        assert_eq!(Outcome::Survived.exit_code(), 0);
        assert_eq!(Outcome::Collision.exit_code(), 3);
        assert_eq!(Outcome::PitchLimit.exit_code(), 4);
        assert_eq!(Outcome::FlightPathLimit.exit_code(), 4);
        assert_eq!(Outcome::Interrupted.exit_code(), 130);
    }
}
