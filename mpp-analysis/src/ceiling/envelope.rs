//! The envelope: the flights about which the ceiling speaks, and how tightly they can turn.

use super::CeilingError;
use mpp_core::vehicle::{AirState, Airframe, GRAVITY};
use mpp_sim::outcome::{FLIGHT_PATH_LIMIT, PITCH_LIMIT};
use mpp_sim::scenario::Scenario;

/// Distance of the angle of attack from trim as a multiple of what plans use [-]: 0.35 rad for the reference
/// aircraft.
const ANGLE_OF_ATTACK: f64 = 1.75;
/// The same as a multiple of what an elevator with limits balances [-]: a swing may exceed the balance.
const OVERSHOOT: f64 = 1.5;
/// Airspeeds of the envelope as shares of cruise [-]. Our own flights past 160 obstacles stay within them.
const AIRSPEED: [f64; 2] = [0.6, 1.5];
/// Greatest pitch rate in the aircraft's units of time \[rad\]. It matters for airframes with lift by rates.
const PITCH_RATE: f64 = 6.0;

/// Bounds of state and control. A flight whose states and controls are all within them is a flight of the envelope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Angle of attack, least and greatest \[rad\].
    pub angle_of_attack: [f64; 2],
    /// Airspeed, least and greatest [m/s].
    pub airspeed: [f64; 2],
    /// Greatest pitch rate to either side [rad/s].
    pub pitch_rate: f64,
    /// Greatest thrust \[N\]; the least is 0.
    pub thrust: f64,
    /// The rate of the sine of the flight path angle per downrange distance, least and greatest [1/m]. It follows
    /// from the other bounds.
    pub turn: [f64; 2],
    /// What the angles of attack of the envelope turn the aircraft from level flight at cruise, to the side that turns less [1/m].
    pub level_turn: f64,
}

impl Envelope {
    /// The envelope of a scenario's aircraft.
    ///
    /// # Errors
    /// [`CeilingError::Unbounded`] if the bounds leave the turn unbounded.
    pub fn of(scenario: &Scenario) -> Result<Self, CeilingError> {
        let aircraft = &scenario.aircraft;
        let (units, limits) = (aircraft.units(), scenario.limits());
        let trim = aircraft.trim.state.angle_of_attack();
        let settings = aircraft.settings();
        let plans = settings
            .planner
            .plane()
            .ok_or(CeilingError::Unbounded("no flight planner"))?;
        let widest = ANGLE_OF_ATTACK * plans.attitude.angle_of_attack;
        let [below, above] = limits
            .angle_of_attack(&aircraft.known.airframe)
            .map(|balanced| (OVERSHOOT * balanced).min(widest));
        let above = above.min(aircraft.known.stall.unwrap_or(f64::INFINITY));
        let mut envelope = Self {
            angle_of_attack: [trim - below, trim + above],
            airspeed: AIRSPEED.map(|share| share * aircraft.known.cruise),
            pitch_rate: PITCH_RATE / units.time,
            thrust: limits
                .thrust_max
                .map_or(plans.thrust_max, |most| most.min(plans.thrust_max)),
            turn: [0.0; 2],
            level_turn: 0.0,
        };
        let own = aircraft.known.airframe.balanced();
        let per_radian = 0.5 * own.air_density * own.wing_area * own.lift_alpha / own.mass;
        envelope.level_turn = per_radian * below.min(above);
        let trim = aircraft.trim.control.elevator;
        let elevator = match (limits.elevator_below, limits.elevator_above) {
            (Some(below), Some(above)) => Some([trim - below, trim + above]),
            _ => None,
        };
        let rates = mpp_sim::dynamics::Aerodynamics::of(&aircraft.file).rates_airspeed;
        envelope.turn = envelope.turns(&aircraft.known.airframe, elevator, rates)?;
        Ok(envelope)
    }

    /// Whether a motion through the air is in the envelope and within the strict rule's angles.
    #[must_use]
    pub fn holds(&self, air: &AirState) -> bool {
        let within = |value: f64, [least, most]: [f64; 2]| (least..=most).contains(&value);
        within(air.angle_of_attack(), self.angle_of_attack)
            && within(air.airspeed, self.airspeed)
            && air.pitch_rate.abs() <= self.pitch_rate
            && air.pitch.abs() <= PITCH_LIMIT
            && air.flight_path.abs() <= FLIGHT_PATH_LIMIT
    }

    /// Bounds of `d sin(gamma) / dx`, which equals `gamma' / v`. Each term of the balance of forces, divided by
    /// `v^2`, is replaced by its bound over the envelope.
    fn turns(
        &self,
        airframe: &Airframe,
        elevator: Option<[f64; 2]>,
        rates_airspeed: Option<f64>,
    ) -> Result<[f64; 2], CeilingError> {
        let a = airframe;
        let elevator_lift = match elevator {
            Some(range) => range.map(|command| a.lift_elevator * command),
            None if a.lift_elevator == 0.0 => [0.0; 2],
            None => {
                return Err(CeilingError::Unbounded(
                    "the elevator has lift and no limits",
                ));
            }
        };
        let [slow, fast] = self.airspeed;
        // The derivatives by rates are constant, or they fall with 1 / v.
        let rate_share = |airspeed: f64| rates_airspeed.map_or(1.0, |cruise| cruise / airspeed);
        let per_rate = (a.lift_alpha_rate + a.lift_pitch_rate).abs()
            * self.pitch_rate
            * rate_share(slow).max(1.0);
        let lift = lift_range(a, self.angle_of_attack);
        let half = 0.5 * a.air_density * a.wing_area;
        let most_lift = half * (lift[1] + elevator_lift[0].max(elevator_lift[1]) + per_rate);
        let least_lift = half * (lift[0] + elevator_lift[0].min(elevator_lift[1]) - per_rate);
        // Thrust and weight count most or least at one of the two airspeeds.
        let [nose_down, nose_up] = self.angle_of_attack.map(libm::sin);
        let weight = a.mass * GRAVITY;
        let up = self.thrust * nose_up.max(0.0) - weight * libm::cos(FLIGHT_PATH_LIMIT);
        let down = self.thrust * nose_down.min(0.0) - weight;
        let by_square = |force: f64| [force / (slow * slow), force / (fast * fast)];
        let most = most_lift + by_square(up).into_iter().fold(f64::NEG_INFINITY, f64::max);
        let least = least_lift + by_square(down).into_iter().fold(f64::INFINITY, f64::min);
        let masses = self
            .airspeed
            .map(|v| a.mass + half * v * rate_share(v) * a.lift_alpha_rate);
        let (light, heavy) = (masses[0].min(masses[1]), masses[0].max(masses[1]));
        if light <= 0.0 {
            return Err(CeilingError::Unbounded(
                "the lift by the rate of the angle of attack exceeds the mass",
            ));
        }
        let turn = [
            least / if least < 0.0 { light } else { heavy },
            most / if most > 0.0 { light } else { heavy },
        ];
        if turn[0] < 0.0 && turn[1] > 0.0 {
            Ok(turn)
        } else {
            Err(CeilingError::Unbounded(
                "the aircraft cannot turn both ways",
            ))
        }
    }
}

/// Lift coefficients of a range of angles of attack [-]: those of the linear lift and, beyond a stall, of a flat plate,
/// which lies nearer to zero.
fn lift_range(airframe: &Airframe, angle_of_attack: [f64; 2]) -> [f64; 2] {
    let linear = angle_of_attack.map(|alpha| airframe.lift_zero + airframe.lift_alpha * alpha);
    let plate = angle_of_attack.map(|alpha| {
        let (sin, cos) = libm::sincos(alpha);
        2.0 * alpha.signum() * sin * sin * cos
    });
    [linear[0].min(plate[0]), linear[1].max(plate[1])]
}
