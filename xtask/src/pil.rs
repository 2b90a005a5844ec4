//! `pil`: flies the firmware in the emulator and compares the flights with the host's.

use crate::counts::{Counts, median, plugin};
use crate::firmware::{self, Image};
use crate::flight::{Harness, Outcome};
use crate::folders::work;
use crate::qemu::{Emulator, Run};
use anyhow::{Result, bail};
use serde_json::json;

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Transport {
    /// Bytes over the emulated UART, on a loopback TCP socket
    Uart,
    /// Semihosting over FIFOs, several times faster
    Fifo,
}

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct PilArgs {
    /// Seed of the first flight
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of seeds to fly
    #[arg(long, default_value_t = 1)]
    flights: u64,
    /// Number of obstacles in the field
    #[arg(long, default_value_t = 20)]
    obstacles: u16,
    /// Preset, which is a set of parameters and rules
    #[arg(long, default_value = "flight")]
    preset: String,
    /// Aircraft, a name or a file
    #[arg(long, default_value = "reference")]
    aircraft: String,
    /// Length of each flight, in seconds
    #[arg(long, default_value_t = 20)]
    duration: u32,
    /// Transport of the bytes to the emulated core
    #[arg(long, value_enum, default_value_t = Transport::Uart)]
    transport: Transport,
    /// Print one JSON object per flight
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &PilArgs) -> Result<()> {
    let image = match args.transport {
        Transport::Uart => Image::Lockstep,
        Transport::Fifo => Image::Fifo,
    };
    firmware::build(&[image])?;
    let folder = work("pil")?;
    let (harness, counter) = (Harness::build(&folder)?, plugin()?);
    if !args.json {
        println!(
            "{:>6} {:<22} {:<17} {:<17} {:>13} {:>12} {:>14}",
            "seed",
            "outcome",
            "host_hash",
            "target_hash",
            "instructions",
            "step worst",
            "cycle median"
        );
    }
    let mut unequal = 0;
    for seed in args.seed..args.seed.saturating_add(args.flights) {
        let arguments = scenario(args, seed);
        let host = harness.fly(&arguments)?;
        let path = image.path()?;
        let run = Run {
            image: &path,
            folder: &folder,
            shift: 0,
            counter: Some(&counter),
        };
        let mut emulator = match args.transport {
            Transport::Uart => Emulator::uart(&run)?,
            Transport::Fifo => Emulator::fifo(&run, false)?,
        };
        let target = harness.fly_emulated(&arguments, &mut emulator)?;
        emulator.end()?;
        unequal += u32::from(host.hash() != target.hash());
        print_flight(args, seed, &host, &target, &Counts::read(&folder)?);
    }
    if unequal > 0 {
        bail!("{unequal} flights differ from the host's");
    }
    Ok(())
}

fn scenario(args: &PilArgs, seed: u64) -> Vec<String> {
    let PilArgs {
        obstacles,
        preset,
        duration,
        aircraft,
        ..
    } = args;
    let flags =
        format!("--seed {seed} --obstacles {obstacles} --preset {preset} --duration {duration}");
    let mut arguments: Vec<String> = flags.split(' ').map(str::to_owned).collect();
    arguments.extend(["--aircraft".to_owned(), aircraft.clone()]);
    arguments
}

fn print_flight(args: &PilArgs, seed: u64, host: &Outcome, target: &Outcome, counts: &Counts) {
    let (step, cycle) = (counts.step_worst(), median(&counts.cycles()));
    if args.json {
        let object = json!({
            "seed": seed,
            "obstacles": args.obstacles,
            "preset": args.preset,
            "outcome": host.outcome(),
            "host_hash": host.hash(),
            "target_hash": target.hash(),
            "equal": host.hash() == target.hash(),
            "instructions": counts.total,
            "step_mean": counts.step_mean(),
            "step_worst": step,
            "cycle_median": cycle,
        });
        println!("{object}");
    } else {
        println!(
            "{seed:>6} {:<22} {:<17} {:<17} {:>13} {step:>12} {cycle:>14}",
            host.outcome(),
            host.hash(),
            target.hash(),
            counts.total,
        );
    }
}
