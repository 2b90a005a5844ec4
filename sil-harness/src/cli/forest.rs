//! `forest`: the planner in space flies through worlds on the plant in six degrees of freedom.

use super::answer::{Failure, data};
use super::values::{clock, gusts, seed, wind};
use crate::files::read_aircraft;
use mpp_analysis::campaign::wilson;
use mpp_core::planner::space::{Keep, SPACE_CANDIDATES};
use mpp_sim::aircraft_file::AircraftModel;
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::lidar::LidarName;
use mpp_sim::space::world::{WorldConfig, WorldName};
use mpp_sim::space::{
    Deskew, Hull, SensorErrors, SpaceConfig, SpaceEnd, SpaceOutcome, WindConfig, fly_through,
};
use std::fmt;

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::FOREST)]
pub(super) struct ForestArgs {
    /// Name of an aircraft that comes with the project, or a file, with a lateral table
    #[arg(long, default_value = "ultrastick", value_name = "NAME|FILE")]
    aircraft: String,
    /// Airspeed of level flight [m/s]; by default that of the aircraft's file
    #[arg(long, value_name = "M/S", value_parser = clap::value_parser!(f64))]
    airspeed: Option<f64>,
    /// World: forest, grid, disc, spheres, walls or slalom
    #[arg(long, default_value = "forest", value_name = "NAME")]
    world: WorldName,
    /// Density of the world: trunks per m^2, share of spheres, walls or rows per metre; by default the usual one of the world
    #[arg(long, value_name = "D")]
    density: Option<f64>,
    /// Radius of a sphere that stands for the aircraft \[m\], instead of its wing and fuselage
    #[arg(long, value_name = "M")]
    sphere: Option<f64>,
    /// Least distance of the body from the centres of occupied voxels \[m\]; by default 0.45 and the radius of the sphere, or 0.6
    /// with a wing, whose half span counts besides
    #[arg(long, value_name = "M")]
    margin: Option<f64>,
    /// Lidar: grid-90x16, mid-360, avia, os1-32, puck-hi-res, depth or pushbroom; each cycle takes one whole sweep
    #[arg(long, default_value = "grid-90x16", value_name = "NAME")]
    lidar: LidarName,
    /// Rate of the cycles \[Hz\], 1 to 10
    #[arg(long, default_value_t = 4, value_name = "HZ", value_parser = clap::value_parser!(u32).range(1..=10))]
    replan_hz: u32,
    /// Candidates of a cycle, the previous plan included
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=SPACE_CANDIDATES as i64))]
    candidates: u8,
    /// Fly the best candidate as it is, without a program
    #[arg(long)]
    no_programs: bool,
    /// Know the true motion, instead of estimating it from sensors with errors
    #[arg(long)]
    exact: bool,
    /// Steady wind ahead, to the right and up [m/s]
    #[arg(long, value_name = "X,Y,Z", value_parser = wind, allow_hyphen_values = true)]
    wind: Option<[f64; 3]>,
    /// Standard deviation of the vertical gusts [m/s], 0 to 5; those along and across are 1.6 times as strong. Light turbulence of
    /// MIL-F-8785C has 0.77
    #[arg(long, default_value_t = 0.0, value_name = "M/S", value_parser = gusts)]
    gusts: f64,
    /// Place all beams of a sweep by the pose of its end, not by that of their own time
    #[arg(long)]
    no_deskew: bool,
    /// Error of the lidar's clock \[ms\], -20 to 100: beams seem so much older than they are
    #[arg(long, default_value_t = 0.0, value_name = "MS", value_parser = clock, allow_negative_numbers = true)]
    lidar_clock: f64,
    /// Number of flights
    #[arg(long, default_value_t = 20, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    flights: u32,
    /// Seed of the first flight; each one has its own world
    #[arg(long, default_value_t = 1, value_parser = seed, allow_negative_numbers = true)]
    seed: u64,
    /// Print each flight
    #[arg(long)]
    each: bool,
}

/// Greatest bank of plans, and its rate [deg, deg/s]. Source: decision 46.
const BANK: [f64; 2] = [60.0, 90.0];
/// Time by which plans are followed ahead \[s\]. Source: decision 46.
const AHEAD: f64 = 0.12;
/// Ticks from the start of a cycle until its plan is flown.
const LATENCY: u32 = 10;
/// Half the diagonal of a voxel \[m\], which every margin includes.
const HALF_DIAGONAL: f64 = 0.45;
const WING_MARGIN: f64 = 0.6;
/// Part of a fuselage that reaches below its wing, and room to ceiling and sides \[m\].
const BELOW: f64 = 0.5;
const ROOM: f64 = 0.3;
const SIDE_ROOM: f64 = 0.5;
/// Altitude of the start and of plans, as a share of the ceiling [-].
const ALTITUDE: f64 = 0.5;
/// Fuselage \[m\]: half its length as a share of the span, and its radius.
const HALF_LENGTH: f64 = 0.4;
const FUSELAGE: f64 = 0.08;

fn usage(error: impl fmt::Display) -> Failure {
    Failure::usage(error)
}

pub(super) fn run(args: &ForestArgs) -> Result<u8, Failure> {
    // The workspaces of planner and map are larger than the usual stack of a thread.
    let args = args.clone();
    let thread = std::thread::Builder::new().stack_size(32 << 20);
    let flights = thread.spawn(move || fly(&args)).map_err(Failure::failed)?;
    flights
        .join()
        .unwrap_or_else(|_| Err(Failure::failed("a flight ended with a panic")))
}

fn fly(args: &ForestArgs) -> Result<u8, Failure> {
    let mut file = read_aircraft(&args.aircraft).map_err(usage)?;
    if let Some(airspeed) = args.airspeed {
        file.cruise = airspeed;
    }
    let model = AircraftModel::new(file).map_err(usage)?;
    let lateral = model.file.lateral.as_ref();
    let span = lateral.map_or(0.0, |lateral| lateral.span);
    let hull = match args.sphere {
        Some(radius) => Hull {
            half_span: 0.0,
            half_length: 0.0,
            radius,
        },
        None => Hull {
            half_span: 0.5 * span,
            half_length: HALF_LENGTH * span,
            radius: FUSELAGE,
        },
    };
    let margin = match args.sphere {
        Some(radius) => HALF_DIAGONAL + radius,
        None => WING_MARGIN,
    };
    let mut arrived = 0;
    let mut ends = [0_u32; 4];
    let mut clearances = Vec::new();
    let mut tracking = 0.0;
    for seed in (args.seed..).take(args.flights as usize) {
        let mut world = WorldConfig::usual(args.world, seed);
        world.density = args.density.unwrap_or(world.density);
        let world = world.build().map_err(usage)?;
        let extent = *world.extent();
        let mut scenario = Scenario {
            aircraft: model.clone(),
            ..Scenario::new(Preset::Flight, seed)
        };
        scenario.faults.gusts.intensity = args.gusts;
        let lidar = args.lidar.config();
        let low = args.sphere.unwrap_or(hull.radius) + BELOW;
        let config = SpaceConfig {
            keep: Keep {
                margin: args.margin.unwrap_or(margin),
                half_span: hull.half_span,
                heights: [low, extent.ceiling - ROOM],
                half_width: extent.half_width - SIDE_ROOM,
                altitude: ALTITUDE * extent.ceiling,
            },
            bank: BANK.map(f64::to_radians),
            replan_ticks: 100 / args.replan_hz,
            latency_ticks: LATENCY,
            candidates: usize::from(args.candidates),
            programs: !args.no_programs,
            sight: lidar.range[1],
            sweep: lidar.period,
            deskew: Deskew {
                active: !args.no_deskew,
                clock: 0.001 * args.lidar_clock,
            },
            ahead: AHEAD,
            errors: (!args.exact).then_some(SensorErrors::RTK),
            wind: WindConfig {
                steady: args.wind.unwrap_or_default(),
                lateral_gusts: args.gusts,
                ..WindConfig::default()
            },
        };
        let outcome = fly_through(&world, &hull, args.lidar, &scenario, config).map_err(usage)?;
        if args.each {
            data(told(seed, &outcome))?;
        }
        tracking += outcome.tracking;
        match outcome.end {
            SpaceEnd::Arrived => {
                arrived += 1;
                clearances.push(outcome.clearance);
            }
            SpaceEnd::Hit => ends[0] += 1,
            SpaceEnd::Left => ends[1] += 1,
            SpaceEnd::Extreme => ends[2] += 1,
            SpaceEnd::Time => ends[3] += 1,
        }
    }
    clearances.sort_by(f64::total_cmp);
    let (low, high) = wilson(arrived, args.flights);
    let median = clearances.get(clearances.len() / 2).copied().unwrap_or(0.0);
    let [hit, left, extreme, time] = ends;
    data(format_args!(
        "{} of {} flights arrived [{:.1}, {:.1} %]; {hit} hit, {left} left the band, {extreme} ended in an extreme state, {time} ran out of time\nmedian of the least clearance {median:.2} m, mean distance from the plan {:.3} m",
        arrived,
        args.flights,
        100.0 * low,
        100.0 * high,
        tracking / f64::from(args.flights)
    ))?;
    Ok(0)
}

fn told(seed: u64, outcome: &SpaceOutcome) -> String {
    format!(
        "seed {seed}: {} after {:.2} s at {:.1} m, least clearance {:.2} m",
        outcome.end, outcome.time, outcome.way, outcome.clearance
    )
}
