//! `budget`: measures and checks what the firmware needs from a flight computer.

use crate::counts::{Counts, median, plugin};
use crate::firmware::{self, Image};
use crate::flight::Harness;
use crate::folders::work;
use crate::limits::{self, budget};
use crate::qemu::{Emulator, Report, Run};
use crate::talk::{CONFIGURE, await_message, level, send};
use crate::{budget_table, stack};
use anyhow::{Result, bail, ensure};
use hil_protocol::Message;
use object::{Object, ObjectSection};
use std::fs::File;

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct BudgetArgs {
    /// Write the figures to docs/budgets.toml with a small margin, and the table to docs/validation/firmware.md
    #[arg(long)]
    save: bool,
}

/// A figure and its place in docs/budgets.toml, under `firmware`.
pub(crate) struct Figure {
    pub(crate) table: &'static str,
    pub(crate) name: &'static str,
    pub(crate) value: u64,
}

pub(crate) fn run(args: &BudgetArgs) -> Result<()> {
    let figures = measure()?;
    println!("{}", firmware::versions()?);
    let mut document = limits::read()?;
    if args.save {
        for figure in &figures {
            let budget = i64::try_from(with_air(figure.value))?;
            document["firmware"][figure.table][figure.name] = toml_edit::value(budget);
        }
        limits::write(&document)?;
        budget_table::write(&document)?;
    }
    let mut over = 0;
    for figure in &figures {
        let budget = budget(&document, figure.table, figure.name)?;
        let verdict = if figure.value > budget {
            "OVER BUDGET"
        } else {
            "ok"
        };
        over += u32::from(figure.value > budget);
        println!(
            "{:<21} {:<20} {:>11} of {budget:>11} {verdict}",
            figure.table, figure.name, figure.value
        );
    }
    if over > 0 {
        bail!("{over} figures are over budget; cargo xtask budget --save raises it on purpose");
    }
    budget_table::check(&document)
}

/// The budget for a figure. It is at least 2 % more, for another compiler, and rounded up to three
/// digits.
fn with_air(value: u64) -> u64 {
    let value = value + value / 50;
    let unit = 10_u64.pow(value.max(100).ilog10() - 2);
    value.div_ceil(unit) * unit
}

fn measure() -> Result<Vec<Figure>> {
    firmware::build(&[Image::Uart, Image::Fifo, Image::Comparison, Image::Space])?;
    let mut figures = Vec::new();
    let mut add = |table, name, value| figures.push(Figure { table, name, value });

    let (flash, static_ram) = sizes(Image::Uart)?;
    let flight = fly(Image::Fifo, "--preset flight --obstacles 20")?;
    let reference = fly(Image::Comparison, "--preset reference --obstacles 20")?;
    let dense = fly(Image::Fifo, "--preset flight --obstacles 40")?;
    let bound = stack::bound(&Image::Uart.path()?)?;
    let room = stack::room(&Image::Uart.path()?)?;
    ensure!(
        bound <= room,
        "the stack may need {bound} bytes, but memory.x gives it {room}"
    );
    let painted = [&flight, &dense].map(|flown| u64::from(flown.report.stack));
    let painted = painted.into_iter().max().unwrap_or_default();
    ensure!(
        painted <= bound,
        "{painted} bytes of stack were used, but the bound is {bound}"
    );

    add("bytes", "flash", flash);
    add("bytes", "static_ram", static_ram);
    add("bytes", "stack_painted", painted);
    add("bytes", "stack_bound", bound);
    add("bytes", "ram", static_ram + bound);
    add("step", "mean", flight.counts.step_mean());
    let worst = [&flight, &dense].map(|flown| flown.counts.step_worst());
    add("step", "worst", worst.into_iter().max().unwrap_or_default());
    add("step", "after_gap", step_after_gap()?);
    for (name, value) in flight.counts.stages_mean() {
        add("stage_mean_flight", name, value);
    }
    for (name, value) in reference.counts.stages_mean() {
        add("stage_mean_reference", name, value);
    }
    for (name, value) in dense.counts.slices_worst() {
        add("slice_worst_flight", name, value);
    }
    for (name, value) in reference.counts.slices_worst() {
        add("slice_worst_reference", name, value);
    }
    add("cycle", "flight_20_median", median(&flight.counts.cycles()));
    add(
        "cycle",
        "reference_20_median",
        median(&reference.counts.cycles()),
    );
    let cycles = dense.counts.cycles();
    add(
        "cycle",
        "flight_40_worst",
        cycles.last().copied().unwrap_or_default(),
    );
    figures.extend(in_space()?);
    Ok(figures)
}

/// The figures of the planner in space.
fn in_space() -> Result<[Figure; 7]> {
    let Flown { counts, report } = fly(Image::Space, "--preset space --density 0.02")?;
    let (flash, static_ram) = sizes(Image::Space)?;
    let slice = counts.slices_worst().map(|(_, count)| count).max();
    let cycles = counts.cycles();
    let figures = [
        ("flash", flash),
        ("static_ram", static_ram),
        ("stack_painted", u64::from(report.stack)),
        ("step_worst", counts.step_worst()),
        ("slice_worst", slice.unwrap_or_default()),
        ("cycle_median", median(&cycles)),
        ("cycle_worst", cycles.last().copied().unwrap_or_default()),
    ];
    Ok(figures.map(|(name, value)| Figure {
        table: "space",
        name,
        value,
    }))
}

/// Flash and static RAM of the image that flies \[bytes\].
pub(crate) fn sizes(image: Image) -> Result<(u64, u64)> {
    let bytes = std::fs::read(image.path()?)?;
    let file = object::File::parse(&*bytes)?;
    let size = |names: &[&str]| -> u64 {
        let sections = names.iter().filter_map(|name| file.section_by_name(name));
        sections.map(|section| section.size()).sum()
    };
    Ok((
        size(&[".vector_table", ".text", ".rodata", ".data"]),
        size(&[".data", ".bss", ".uninit", ".axisram", ".sram"]),
    ))
}

/// Number of frames that are lost before the step that is measured: the longest time that the estimator
/// predicts over, `LONGEST_PREDICTION` in mpp-core/src/tuning/watches.rs.
const LOST_FRAMES: u32 = 49;

/// The count of the step after lost frames, whose predictions it makes up for. There is no plan, so no other
/// step of this session is as long.
fn step_after_gap() -> Result<u64> {
    let folder = work("budget")?;
    let counter = plugin()?;
    let emulator = Emulator::fifo(
        &Run {
            image: &Image::Fifo.path()?,
            folder: &folder,
            shift: 0,
            counter: Some(&counter),
        },
        false,
    )?;
    // The image opens its input first.
    let mut to_core = File::create(folder.join("to-core"))?;
    let mut to_harness = File::open(folder.join("to-harness"))?;
    send(&mut to_core, &Message::Configure(CONFIGURE))?;
    await_message(&mut to_harness, |message| {
        matches!(message, Message::ConfigureReply(_)).then_some(())
    })?;
    for tick in (0..20).chain([20 + LOST_FRAMES]) {
        send(&mut to_core, &level(tick))?;
        await_message(&mut to_harness, |message| {
            matches!(message, Message::ActuatorCommand(_)).then_some(())
        })?;
    }
    drop((to_core, to_harness));
    emulator.report()?;
    let counts = Counts::read(&folder)?;
    ensure!(
        counts.step_worst() > 2 * counts.step_mean(),
        "the step after a gap took no longer than others"
    );
    Ok(counts.step_worst())
}

struct Flown {
    counts: Counts,
    report: Report,
}

/// Flies seed 1 over FIFOs and counts. Such a flight is repeatable to the instruction.
fn fly(image: Image, scenario: &str) -> Result<Flown> {
    let folder = work("budget")?;
    let (harness, counter) = (Harness::build(&folder)?, plugin()?);
    let mut emulator = Emulator::fifo(
        &Run {
            image: &image.path()?,
            folder: &folder,
            shift: 0,
            counter: Some(&counter),
        },
        false,
    )?;
    let arguments: Vec<String> = scenario.split(' ').map(str::to_owned).collect();
    harness.fly_emulated(&arguments, &mut emulator)?;
    let report = Report::of(&emulator.report()?)?;
    let counts = Counts::read(&folder)?;
    counts.check()?;
    Ok(Flown { counts, report })
}
