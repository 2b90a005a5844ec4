//! The report about an aircraft file.

use super::doubts::doubts;
use super::lateral_doubts::lateral_doubts;
use super::{Doubt, LateralReport, Modes, flown_cells};
use mpp_core::config::{STAGE_PERIOD, STAGES};
use mpp_core::vehicle::GRAVITY;
use mpp_sim::aircraft_file::AircraftModel;
use serde::Serialize;
use std::fmt;

/// What follows from an aircraft file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AircraftReport {
    /// Name of the aircraft.
    pub name: String,
    /// Where its numbers come from.
    pub source: String,
    /// Airspeed of level flight [m/s].
    pub airspeed: f64,
    /// Angle of attack of level flight \[deg\].
    pub angle_of_attack_deg: f64,
    /// Lift coefficient of level flight [-].
    pub lift: f64,
    /// Thrust of level flight \[N\].
    pub thrust: f64,
    /// Elevator of level flight, in the unit of its command.
    pub elevator: f64,
    /// The modes of level flight.
    pub modes: Modes,
    /// Pitch acceleration of a unit of the elevator's command [rad/s^2].
    pub elevator_authority: f64,
    /// Angle of attack that the elevator balances below and above level flight \[deg\]; null without limits.
    pub balanced_deg: [Option<f64>; 2],
    /// Radius of the tightest turn that a plan asks for \[m\].
    pub turn_radius: f64,
    /// Steepest steady climb at cruise \[deg\]; null without a limit of the thrust.
    pub climb_deg: Option<f64>,
    /// Length of the planner for one metre of the reference aircraft \[m\].
    pub length_unit: f64,
    /// Time of the planner for one second of the reference aircraft \[s\].
    pub time_unit: f64,
    /// Distance that plans keep from obstacles, beside the body \[m\].
    pub margin: f64,
    /// Radius of the body \[m\].
    pub body_radius: f64,
    /// Time and distance of the planning horizon \[s\], \[m\].
    pub horizon: [f64; 2],
    /// Range of the lidar that corresponds to the paper's 45 m \[m\].
    pub sight: f64,
    /// Replanning rates for sparse and for dense fields \[Hz\].
    pub replan_hz: [f64; 2],
    /// Radius of the obstacles, and mean distance downrange between two of them, in the densest field that the
    /// reference aircraft flies nine times of ten \[m\].
    pub densest: [f64; 2],
    /// What the lateral table says; null without one.
    pub lateral: Option<LateralReport>,
    /// What is implausible.
    pub doubts: Vec<Doubt>,
}

/// Density at which the reference aircraft succeeds in nine of ten flights: 160 obstacles over 215 m, with the
/// elevator that the authors gave it. Source: decision 16.
const DENSEST: f64 = 215.0 / 160.0;

impl AircraftReport {
    /// The report about an aircraft.
    #[must_use]
    pub fn new(model: &AircraftModel) -> Self {
        let (known, trim, units) = (&model.known, &model.trim, model.units());
        let a = &known.airframe;
        let balance = a.balanced();
        let modes = Modes::of(known, trim);
        let settings = model.settings();
        let own = settings.planner.plane();
        let allowed = own.map_or(0.0, |own| own.attitude.angle_of_attack);
        let balanced = model.actuators.angle_of_attack(a);
        let [down, up] = balanced;
        let stall = known.stall.unwrap_or(f64::INFINITY);
        let turning = allowed.min(down).min(up).min(stall);
        let pressure_area = 0.5 * a.air_density * known.cruise.powi(2) * a.wing_area;
        let weight = a.mass * GRAVITY;
        let climb = model.actuators.thrust_max.map(|thrust| {
            let excess = (thrust - trim.control.thrust) / weight;
            excess.clamp(-1.0, 1.0).asin().to_degrees()
        });
        let load = 1.0 + balance.lift_alpha * up.min(stall) / a.level_lift(known.cruise);
        let lateral = LateralReport::new(model, load);
        let mut doubts = doubts(model, &modes);
        // What follows from a roll loop is no table to doubt.
        if let (Some(file), Some(report)) = (&model.file.lateral, &lateral)
            && file.roll_loop.is_none()
        {
            doubts.extend(lateral_doubts(model, &file.airframe(), report));
        }
        let horizon = STAGES as f64 * STAGE_PERIOD * units.time;
        Self {
            name: model.file.name.clone(),
            source: model.file.source.clone(),
            airspeed: known.cruise,
            angle_of_attack_deg: trim.state.angle_of_attack().to_degrees(),
            lift: a.level_lift(known.cruise),
            thrust: trim.control.thrust,
            elevator: trim.control.elevator,
            modes,
            elevator_authority: pressure_area * a.moment_length * a.moment_elevator
                / a.pitch_inertia,
            balanced_deg: balanced.map(|side| side.is_finite().then(|| side.to_degrees())),
            turn_radius: a.mass * known.cruise.powi(2)
                / (pressure_area * balance.lift_alpha * turning)
                / balance.turn_gain(known.cruise),
            climb_deg: climb,
            length_unit: units.length,
            time_unit: units.time,
            margin: own.map_or(0.0, |own| own.margin),
            body_radius: known.body_radius,
            horizon: [horizon, horizon * known.cruise],
            sight: 45.0 * units.length,
            replan_hz: [20, 40].map(|count| flown_cells(&[count], units.time)[0].1),
            densest: [units.length, DENSEST * units.length],
            lateral,
            doubts,
        }
    }
}

impl fmt::Display for AircraftReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.name, self.source)?;
        writeln!(
            f,
            "level flight   {:.1} m/s, angle of attack {:.2} deg, lift coefficient {:.3}, thrust {:.2} N, elevator {:.4}",
            self.airspeed, self.angle_of_attack_deg, self.lift, self.thrust, self.elevator
        )?;
        writeln!(f, "short period   {}", self.modes.short_period)?;
        writeln!(f, "phugoid        {}", self.modes.phugoid)?;
        let side = |side: Option<f64>| side.map_or("any".to_owned(), |side| format!("{side:.1}"));
        let [down, up] = self.balanced_deg.map(side);
        writeln!(
            f,
            "elevator       {:.3} rad/s^2 a unit; balances {down} deg of angle of attack below level flight, {up} above",
            self.elevator_authority
        )?;
        self.lateral.iter().try_for_each(|it| write!(f, "{it}"))?;
        let climb = self
            .climb_deg
            .map_or("not limited".to_owned(), |it| format!("{it:.1} deg"));
        writeln!(
            f,
            "agility        turn radius {:.1} m, steady climb {climb}",
            self.turn_radius
        )?;
        writeln!(
            f,
            "planner        1 m of the reference aircraft is {:.3} m, 1 s is {:.3} s",
            self.length_unit, self.time_unit
        )?;
        let [time, distance] = self.horizon;
        writeln!(
            f,
            "               margin {:.2} m beside a body of {:.2} m, horizon {time:.1} s or {distance:.0} m",
            self.margin, self.body_radius
        )?;
        let ([sparse, dense], [radius, spacing]) = (self.replan_hz, self.densest);
        writeln!(
            f,
            "it needs       sight {:.0} m, replanning at {sparse} Hz in sparse and {dense} Hz in dense fields",
            self.sight
        )?;
        write!(
            f,
            "densest field  obstacles of {radius:.2} m radius, one each {spacing:.1} m downrange, if the elevator reaches what plans ask for"
        )?;
        for doubt in &self.doubts {
            write!(f, "\nimplausible    {doubt}")?;
        }
        Ok(())
    }
}
