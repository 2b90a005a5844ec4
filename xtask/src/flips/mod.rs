//! `flips`: flips random bits of the core's memory during flights, and says what came of each.
//!
//! In the emulator the image itself flips a bit of its RAM, by a fault for tests. On this machine the core
//! runs as a process of its own, and this command changes a byte of its memory from outside, while the core
//! waits for a sensor frame: no rule of the language covers either, as none covers radiation.

mod flip;
mod process;

use crate::contents;
use crate::firmware::{self, Image};
use crate::flight::{Harness, Outcome};
use crate::folders::work;
use crate::qemu::{Emulator, Run};
use anyhow::{Context, Result, ensure};
use flip::{Draw, FLIGHT_SEED, PATIENCE};
use object::{Object, ObjectSection, ObjectSymbol};
use std::collections::BTreeMap;

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct FlipsArgs {
    /// Number of bits to flip in a process of this machine, one for each flight
    #[arg(long, default_value_t = 1000)]
    host: u32,
    /// Number of bits to flip in the emulator, one for each flight
    #[arg(long, default_value_t = 50)]
    emulated: u32,
    /// Seed of the bits and of the ticks
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Length of the flights \[s\].
const DURATION: u32 = 5;
/// The limits of the commands in these flights: thrust \[N\], and elevator on either side of level trim.
const THRUST_MAX: f64 = 15.0;
const ELEVATOR: (f64, f64) = (3.749, 2.0);

/// What came of a flip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Effect {
    /// The flight is the same to the last bit.
    Nothing,
    /// The core told a fault, or restarted and told it.
    Told,
    /// The link was lost or fell silent, which ended the flight with an error that says so.
    LinkLost,
    /// The flight is another one, nothing was told, and the estimate is right at the end.
    Sound,
    /// The flight is another one, nothing was told, and the estimate is wrong at the end.
    Wrong,
    /// A command is outside the limits of the actuators.
    OutsideLimits,
}

pub(crate) fn run(args: &FlipsArgs) -> Result<()> {
    let folder = work("flips")?;
    let scenario = folder.join("scenario.toml");
    std::fs::write(
        &scenario,
        format!(
            "[faults.actuators]\nthrust_max = {THRUST_MAX:?}\nelevator_range = {:?}\n",
            ELEVATOR.1
        ),
    )?;
    let mut arguments: Vec<String> =
        format!("--seed {FLIGHT_SEED} --duration {DURATION} --scenario")
            .split(' ')
            .map(str::to_owned)
            .collect();
    arguments.push(scenario.display().to_string());
    let bench = Bench {
        harness: Harness::build(&folder)?.with_patience(PATIENCE),
        arguments,
    };
    let undisturbed = bench.harness.fly(&bench.arguments)?;
    ensure!(
        effect(&undisturbed, Ok(&undisturbed)) == Effect::Nothing,
        "the undisturbed flight is not sound"
    );
    let mut bad = 0;
    let mut draw = Draw(args.seed);
    if args.host > 0 {
        bad += bench.count("a process of this machine", args.host, &undisturbed, || {
            process::fly(&bench.harness, &bench.arguments, &mut draw)
        });
    }
    let mut draw = Draw(args.seed);
    if args.emulated > 0 {
        firmware::build(&[Image::UartFaults])?;
        bad += bench.count("the emulator", args.emulated, &undisturbed, || {
            bench.emulated(&mut draw)
        });
    }
    ensure!(
        bad == 0,
        "{bad} flips led to commands outside the limits, or to a wrong state that lasts"
    );
    Ok(())
}

struct Bench {
    harness: Harness,
    arguments: Vec<String>,
}

impl Bench {
    /// Flies with one flip after the other and prints the effects. Returns the number of those that must not
    /// be.
    fn count(
        &self,
        place: &str,
        flips: u32,
        undisturbed: &Outcome,
        mut fly: impl FnMut() -> (String, Result<Outcome>),
    ) -> u32 {
        let mut effects = BTreeMap::<Effect, u32>::new();
        for _ in 0..flips {
            let (what, outcome) = fly();
            let effect = effect(undisturbed, outcome.as_ref());
            *effects.entry(effect).or_default() += 1;
            if effect != Effect::Nothing {
                println!("{what}: {effect:?}; {}", words(&outcome));
            }
        }
        println!("{flips} flips in {place}, seed {FLIGHT_SEED:#x}: {effects:?}");
        let of = |effect| effects.get(&effect).copied().unwrap_or_default();
        of(Effect::Wrong) + of(Effect::OutsideLimits)
    }

    /// Flies the image that flips a bit of its own RAM.
    fn emulated(&self, draw: &mut Draw) -> (String, Result<Outcome>) {
        let flown = || -> Result<(String, Result<Outcome>)> {
            let folder = work("flips")?;
            let ranges = memory(Image::UartFaults)?;
            let flip = draw.flip(ranges.iter().map(|(_, size)| size).sum());
            let mut place = flip.place;
            let mut address = 0;
            for (start, size) in ranges {
                if place < size {
                    address = start + place;
                    break;
                }
                place -= size;
            }
            let image = folder.join("flips");
            let words = [
                ("FAULT_FLIP_AFTER", flip.tick),
                ("FAULT_FLIP_ADDRESS", u32::try_from(address)?),
                ("FAULT_FLIP_BIT", flip.bit),
            ];
            contents::patched(&Image::UartFaults.path()?, &words, &image)?;
            let mut emulator = Emulator::uart(&Run {
                image: &image,
                folder: &folder,
                shift: 1,
                counter: None,
            })?;
            let outcome = self.harness.fly_emulated(&self.arguments, &mut emulator);
            let what = format!("tick {}, {address:#010x} bit {}", flip.tick, flip.bit);
            Ok((what, outcome))
        };
        let mut flown = flown;
        flown().unwrap_or_else(|error| (String::new(), Err(error)))
    }
}

/// The memory in which bits flip: static RAM, and the part of the stack that a flight uses.
fn memory(image: Image) -> Result<Vec<(u64, u64)>> {
    /// Bytes of the stack that a flight uses, rounded up (docs/budgets.toml).
    const STACK: u64 = 17_000;
    let bytes = std::fs::read(image.path()?)?;
    let file = object::File::parse(&*bytes)?;
    let mut ranges: Vec<(u64, u64)> = [".data", ".bss", ".uninit", ".axisram"]
        .iter()
        .filter_map(|name| file.section_by_name(name))
        .map(|section| (section.address(), section.size()))
        .collect();
    let top = file
        .symbol_by_name("_stack_start")
        .context("no symbol _stack_start")?;
    ranges.push((top.address() - STACK, STACK));
    Ok(ranges)
}

/// What the log shows of a flip.
fn effect(undisturbed: &Outcome, outcome: Result<&Outcome, &anyhow::Error>) -> Effect {
    let Ok(outcome) = outcome else {
        return Effect::LinkLost;
    };
    if !commands_within_limits(outcome) {
        Effect::OutsideLimits
    } else if outcome.rejections() != undisturbed.rejections() {
        Effect::Told
    } else if !estimate_is_right(outcome) {
        Effect::Wrong
    } else if outcome.hash() == undisturbed.hash() {
        Effect::Nothing
    } else {
        Effect::Sound
    }
}

fn words(outcome: &Result<Outcome>) -> String {
    match outcome {
        Ok(outcome) => format!("{} {}", outcome.outcome(), outcome.rejections().join(" ")),
        Err(error) => format!("{error:#}").replace('\n', " "),
    }
}

/// A column of the log. A number that is not finite counts as NaN.
fn column(outcome: &Outcome, name: &str) -> Vec<f64> {
    let column = outcome.log["ticks"][name].as_array();
    column.map_or_else(Vec::new, |column| {
        column
            .iter()
            .map(|value| value.as_f64().unwrap_or(f64::NAN))
            .collect()
    })
}

fn commands_within_limits(outcome: &Outcome) -> bool {
    let thrust = column(outcome, "thrust");
    let elevator = column(outcome, "elevator");
    let (trim, range) = ELEVATOR;
    thrust
        .iter()
        .all(|thrust| (0.0..=THRUST_MAX).contains(thrust))
        && elevator
            .iter()
            .all(|elevator| (elevator - trim).abs() <= range + 1e-3)
}

/// Whether the estimate is near the truth in the last half second. The bounds are several times the noise of
/// an undisturbed flight.
fn estimate_is_right(outcome: &Outcome) -> bool {
    let near = |estimate: &str, truth: &str, bound: f64| {
        let pairs = column(outcome, estimate)
            .into_iter()
            .zip(column(outcome, truth));
        let last: Vec<f64> = pairs.rev().take(50).map(|(a, b)| (a - b).abs()).collect();
        !last.is_empty() && last.iter().sum::<f64>() <= bound * last.len() as f64
    };
    near("est_airspeed", "airspeed", 1.0)
        && near("est_pitch", "pitch", 0.05)
        && near("est_flight_path", "flight_path", 0.05)
}
