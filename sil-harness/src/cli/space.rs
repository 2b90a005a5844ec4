//! `space`: the lateral regulator holds a bank in six degrees of freedom, perhaps in a world.

use super::answer::{Failure, print};
use super::courses::courses;
use super::values::{bank, seed, whole, wind};
use super::worlds::{Flown, WorldArgs};
use crate::files::{read_aircraft, write_whole};
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::GRAVITY;
use mpp_sim::aircraft_file::AircraftModel;
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::{SpaceAircraft, SpaceState, WindConfig, regulator};
use serde::Serialize;
use std::fmt::{self, Write as _};
use std::path::PathBuf;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::SPACE)]
pub(super) struct SpaceArgs {
    /// Name of an aircraft that comes with the project, or a file, with a lateral table
    #[arg(long, value_name = "NAME|FILE")]
    aircraft: String,
    /// Bank to take at once and to hold, to the right positive, -60 to 60 \[deg\] [default: 30, and 0 in a world]
    #[arg(long, value_name = "DEG", value_parser = bank)]
    bank: Option<f64>,
    /// Steady wind ahead, to the right and up [m/s]
    #[arg(long, value_name = "X,Y,Z", value_parser = wind, allow_hyphen_values = true)]
    wind: Option<[f64; 3]>,
    /// Turbulence of MIL-F-8785C at low altitude
    #[arg(long)]
    gusts: Option<Turbulence>,
    /// Seed of the gusts and of the world
    #[arg(long, default_value_t = 1, value_parser = seed)]
    seed: u64,
    /// Let the planner fly this number of flights in its vertical plane, with the course held, past 20 and 40 scaled obstacles
    #[arg(long, default_value_t = 0, conflicts_with_all = ["bank", "wind", "world", "stems", "terrain", "json", "out"], value_parser = whole::<u32>())]
    flights: u32,
    #[command(flatten)]
    world: WorldArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// File to write: a CSV table of the ticks
    #[arg(long)]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Turbulence {
    /// Wind of 15 knots, vertical gusts of 0.77 m/s
    Light,
    /// Wind of 30 knots, vertical gusts of 1.54 m/s
    Moderate,
    /// Wind of 45 knots, vertical gusts of 2.31 m/s
    Severe,
}

impl Turbulence {
    /// Standard deviation of the vertical gusts: a tenth of the wind [m/s].
    fn intensity(self) -> f64 {
        match self {
            Self::Light => 0.77,
            Self::Moderate => 1.54,
            Self::Severe => 2.31,
        }
    }
}

/// Bank without a world \[deg\].
const USUAL_BANK: f64 = 30.0;
/// Duration of the flight, and of its end over which the turn is measured \[ticks\].
const TICKS: usize = 2000;
const MEASURED: usize = 1000;
/// Exit code of a flight that ends in an extreme state.
const EXTREME: u8 = 4;

/// What the flight did, over its last 10 s where nothing else stands.
#[derive(Debug, Serialize)]
struct Turned {
    aircraft: String,
    bank_deg: f64,
    /// Root of the mean squared bank error.
    bank_rms_deg: f64,
    /// Over the whole flight.
    most_sideslip_deg: f64,
    /// Over the whole flight.
    altitude_change: f64,
    /// Mean airspeed over mean turn rate, through the air; null without a bank.
    radius: Option<f64>,
    /// `v^2 / (g tan bank)` with the mean airspeed and the wanted bank.
    radius_level: Option<f64>,
    /// Only in a world.
    #[serde(skip_serializing_if = "Option::is_none")]
    world: Option<Flown>,
}

impl fmt::Display for Turned {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "aircraft            {}", self.aircraft)?;
        writeln!(f, "bank                {:8.1} deg", self.bank_deg)?;
        writeln!(
            f,
            "bank error, RMS     {:8.2} deg, last 10 s",
            self.bank_rms_deg
        )?;
        writeln!(f, "greatest sideslip   {:8.2} deg", self.most_sideslip_deg)?;
        write!(f, "change of altitude  {:8.1} m", self.altitude_change)?;
        if let (Some(flown), Some(level)) = (self.radius, self.radius_level) {
            write!(
                f,
                "\nradius of the turn  {flown:8.1} m, v^2 / (g tan bank) is {level:.1} m"
            )?;
        }
        self.world.iter().try_for_each(|it| write!(f, "\n{it}"))
    }
}

pub(super) fn run(args: &SpaceArgs) -> Result<u8, Failure> {
    if args.flights > 0 {
        let intensity = args.gusts.map_or(0.0, Turbulence::intensity);
        return courses(&args.aircraft, args.flights, args.seed, intensity);
    }
    let world = args.world.build(args.seed)?;
    let (states, span) = fly(args)?;
    let flown = world.map(|world| Flown::of(&world, span, &states));
    let turned = Turned {
        world: flown.transpose()?,
        ..Turned::of(args, &states)
    };
    if let Some(out) = &args.out {
        write_whole(out, table(&states).as_bytes())?;
    }
    print(&turned, args.json)?;
    Ok(0)
}

/// The states of the flight after each tick, and the span. Elevator and thrust stay those of level flight.
fn fly(args: &SpaceArgs) -> Result<(Vec<SpaceState>, f64), Failure> {
    let file = read_aircraft(&args.aircraft)?;
    let aircraft = AircraftModel::new(file).map_err(Failure::usage)?;
    let mut scenario = Scenario {
        aircraft,
        ..Scenario::new(Preset::Flight, args.seed)
    };
    let intensity = args.gusts.map_or(0.0, Turbulence::intensity);
    scenario.faults.gusts.intensity = intensity;
    let wind = WindConfig {
        steady: args.wind.unwrap_or_default(),
        lateral_gusts: intensity,
        ..WindConfig::default()
    };
    let mut plant = SpaceAircraft::new(&scenario, wind).map_err(Failure::usage)?;
    let model = &scenario.aircraft;
    let mut regulator = regulator(&scenario).map_err(Failure::usage)?;
    let bank = args.bank().to_radians();
    let mut states = Vec::with_capacity(TICKS);
    for tick in 0..TICKS {
        let command = regulator.step(&plant.state().lateral_motion(), bank);
        plant.step(model.trim.control, command).map_err(|error| {
            let after = tick as f64 * TICK_PERIOD;
            Failure::new(EXTREME, format!("after {after:.2} s {error}"))
        })?;
        states.push(*plant.state());
    }
    let span = model.file.lateral.as_ref().map_or(0.0, |it| it.span);
    Ok((states, span))
}

impl SpaceArgs {
    fn bank(&self) -> f64 {
        let usual = if self.world.is_given() {
            0.0
        } else {
            USUAL_BANK
        };
        self.bank.unwrap_or(usual)
    }
}

impl Turned {
    fn of(args: &SpaceArgs, states: &[SpaceState]) -> Self {
        let measured = &states[states.len().saturating_sub(MEASURED)..];
        let mean = |of: &dyn Fn(&SpaceState) -> f64| {
            measured.iter().map(of).sum::<f64>() / measured.len() as f64
        };
        let bank = args.bank().to_radians();
        let slips = states.iter().map(|it| it.lateral.sideslip.abs());
        let altitude = |state: Option<&SpaceState>| state.map_or(0.0, |it| it.plane.z);
        // Courses wrap at 180 deg, steps between ticks do not.
        let turns = measured.windows(2).map(|pair| match pair {
            [from, to] => libm::remainder(to.course() - from.course(), std::f64::consts::TAU),
            _ => 0.0,
        });
        let turn_rate = turns.sum::<f64>().abs() / ((measured.len() - 1) as f64 * TICK_PERIOD);
        let speed = mean(&|it| it.plane.air.airspeed);
        let turning = args.bank() != 0.0;
        Self {
            aircraft: args.aircraft.clone(),
            bank_deg: args.bank(),
            bank_rms_deg: mean(&|it| (it.bank() - bank).powi(2)).sqrt().to_degrees(),
            most_sideslip_deg: slips.fold(0.0, f64::max).to_degrees(),
            altitude_change: altitude(states.last()) - altitude(states.first()),
            radius: turning.then_some(speed / turn_rate),
            radius_level: turning.then_some(speed * speed / (GRAVITY * libm::tan(bank).abs())),
            world: None,
        }
    }
}

/// The ticks as CSV.
fn table(states: &[SpaceState]) -> String {
    let mut text =
        "t,x,y,z,airspeed,bank_deg,course_deg,sideslip_deg,roll_rate_deg,yaw_rate_deg\n".to_owned();
    for (tick, state) in states.iter().enumerate() {
        let (plane, side) = (&state.plane, &state.lateral);
        let angles = [
            state.bank(),
            state.course(),
            side.sideslip,
            side.roll_rate,
            side.yaw_rate,
        ];
        let t = (tick + 1) as f64 * TICK_PERIOD;
        let _ = write!(
            text,
            "{t:.2},{},{},{},{}",
            plane.x, side.y, plane.z, plane.air.airspeed
        );
        angles.iter().for_each(|angle| {
            let _ = write!(text, ",{}", angle.to_degrees());
        });
        text.push('\n');
    }
    text
}
