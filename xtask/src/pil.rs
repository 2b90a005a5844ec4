//! `pil`: flies the firmware in the emulator and compares the flights with the host's.

use crate::counts::{Counts, median, plugin};
use crate::firmware::{self, Image};
use crate::flight::{Harness, Outcome, flags, in_space};
use crate::folders::work;
use crate::qemu::{Emulator, Run};
use anyhow::{Result, bail};
use serde_json::json;
use std::collections::BTreeMap;

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
    /// Fly in space, through a forest with so many trunks per square metre
    #[arg(long, conflicts_with_all = ["obstacles", "preset", "duration", "transport"])]
    density: Option<f64>,
    /// Preset, which is a set of parameters and rules
    #[arg(long, default_value = "flight")]
    preset: String,
    /// Length of each flight, in seconds
    #[arg(long, default_value_t = 20)]
    duration: u32,
    /// Transport of the bytes to the emulated core; in space by FIFOs
    #[arg(long, value_enum, default_value_t = Transport::Uart)]
    transport: Transport,
    /// Print one JSON object per flight
    #[arg(long)]
    json: bool,
    /// More flags of `sil-harness fly`, such as `-- --aircraft aerosonde`
    #[arg(last = true)]
    more: Vec<String>,
}

pub(crate) fn run(args: &PilArgs) -> Result<()> {
    let (image, transport) = match args.transport {
        _ if args.density.is_some() => (Image::Space, Transport::Fifo),
        Transport::Uart => (Image::Lockstep, Transport::Uart),
        Transport::Fifo => (Image::Fifo, Transport::Fifo),
    };
    firmware::build(&[image])?;
    let folder = work("pil")?;
    let (harness, counter) = (Harness::build(&folder)?, plugin()?);
    if !args.json {
        println!(
            "{:>6} {:<22} {:<17} {:<17} {:>13} {:>12} {:>14} {:>12} {:>12}",
            "seed",
            "outcome",
            "host_hash",
            "target_hash",
            "instructions",
            "step worst",
            "cycle median",
            "cycle worst",
            "slice worst"
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
        let mut emulator = match transport {
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
        density,
        ..
    } = args;
    let mut arguments = match density {
        Some(density) => in_space(seed, *density),
        None => flags(&format!(
            "--seed {seed} --obstacles {obstacles} --preset {preset} --duration {duration}"
        )),
    };
    arguments.extend_from_slice(&args.more);
    arguments
}

fn print_flight(args: &PilArgs, seed: u64, host: &Outcome, target: &Outcome, counts: &Counts) {
    let cycles = counts.cycles();
    let (step, cycle) = (counts.step_worst(), median(&cycles));
    let worst = cycles.last().copied().unwrap_or_default();
    let slices: BTreeMap<_, _> = counts.slices_worst().collect();
    let slice = slices.values().copied().max().unwrap_or_default();
    if args.json {
        let object = json!({
            "seed": seed,
            "flags": scenario(args, seed).join(" "),
            "outcome": host.outcome(),
            "host_hash": host.hash(),
            "target_hash": target.hash(),
            "equal": host.hash() == target.hash(),
            "instructions": counts.total,
            "step_mean": counts.step_mean(),
            "step_worst": step,
            "cycle_median": cycle,
            "cycle_worst": worst,
            "stages_mean": counts.stages_mean().collect::<BTreeMap<_, _>>(),
            "slices_worst": slices,
        });
        println!("{object}");
    } else {
        println!(
            "{seed:>6} {:<22} {:<17} {:<17} {:>13} {step:>12} {cycle:>14} {worst:>12} {slice:>12}",
            host.outcome(),
            host.hash(),
            target.hash(),
            counts.total,
        );
    }
}
