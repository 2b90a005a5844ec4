//! `faults`: tests that the firmware survives when something hangs or traps, and that its clock holds.

mod traps;

use crate::firmware::{self, Image};
use crate::flight::{Harness, Outcome, PATIENCE};
use crate::folders::work;
use crate::qemu::{Emulator, Report, Run};
use crate::talk::{CONFIGURE, HELLO, await_message, send};
use crate::{contents, limits};
use anyhow::{Result, ensure};
use hil_protocol::{Message, RejectionCause, Role};
use std::io::Write;
use std::net::TcpStream;
use std::path::{Path, PathBuf};

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct FaultsArgs {
    /// Length of the flights by the timer, in seconds
    #[arg(long, default_value_t = 60)]
    duration: u32,
}

/// Counts of the board's timer in a tick of 10 ms.
const TICK: u32 = 250_000;
/// A tick after which something hangs. A cycle is under way then.
const HANG: u32 = 410;

pub(crate) fn run(args: &FaultsArgs) -> Result<()> {
    firmware::build(&[Image::Uart, Image::UartFaults, Image::FifoFaults])?;
    let folder = work("faults")?;
    let bench = Bench {
        harness: Harness::build(&folder)?,
        folder,
    };
    bench.timer_holds(args.duration)?;
    bench.longest_slice_holds_no_step(args.duration)?;
    bench.stuck_planner_is_restarted()?;
    bench.stuck_step_is_reset()?;
    bench.late_plans_hold_no_step()?;
    bench.planner_that_traps_stays_off()?;
    bench.every_trap_is_told()?;
    bench.step_that_traps_is_reset()?;
    bench.damaged_image_refuses_to_fly()?;
    bench.flood_is_counted()
}

struct Bench {
    harness: Harness,
    folder: PathBuf,
}

/// A flight whose cycles take several ticks: 300 ms from scan to plan.
fn spread(duration: u32, obstacles: u32) -> Vec<String> {
    format!("--seed 1 --obstacles {obstacles} --duration {duration} --latency-ms 300 --slices-per-tick 37")
        .split(' ')
        .map(str::to_owned)
        .collect()
}

impl Bench {
    /// Runs 500 million instructions a second, which is about the rate of an STM32H743 at 480 MHz.
    fn run<'a>(&'a self, image: &'a Path) -> Run<'a> {
        Run {
            image,
            folder: &self.folder,
            shift: 1,
            counter: None,
        }
    }

    fn fly_by_timer(&self, image: &Path, arguments: &[String]) -> Result<(Outcome, Report)> {
        let mut emulator = Emulator::fifo(&self.run(image), true)?;
        let outcome = self.harness.fly_emulated(arguments, &mut emulator)?;
        Ok((outcome, Report::of(&emulator.report()?)?))
    }

    /// The step comes every 10 ms, whatever the planner does, and the flight is that of the host.
    fn timer_holds(&self, duration: u32) -> Result<()> {
        self.fly_without_jitter("by the timer", &Image::FifoFaults.path()?, duration)
    }

    /// Repeats this test with one slice of each cycle longer by the budget of the longest slice.
    fn longest_slice_holds_no_step(&self, duration: u32) -> Result<()> {
        let longest = u32::try_from(limits::longest_slice(&limits::read()?)?)?;
        let image = self.folder.join("long-slices");
        contents::patched(
            &Image::FifoFaults.path()?,
            &[("FAULT_SLICE_LONGER_BY", longest)],
            &image,
        )?;
        let name = format!("a slice of each cycle longer by {longest} instructions");
        self.fly_without_jitter(&name, &image, duration)
    }

    fn fly_without_jitter(&self, name: &str, image: &Path, duration: u32) -> Result<()> {
        let arguments = spread(duration, 20);
        let host = self.harness.fly(&arguments)?;
        let (target, report) = self.fly_by_timer(image, &arguments)?;
        println!(
            "{name}, {duration} s: {} ticks, {} missed, {} to {} counts apart; {}; hash {} (host {})",
            report.ticks,
            report.missed,
            report.shortest,
            report.longest,
            target.outcome(),
            target.hash(),
            host.hash(),
        );
        ensure!(report.missed == 0, "ticks were missed");
        ensure!(report.ticks > 100, "the timer did not run");
        ensure!(
            report
                .shortest
                .abs_diff(TICK)
                .max(report.longest.abs_diff(TICK))
                < TICK / 100,
            "the step's jitter is more than 0.1 ms"
        );
        ensure!(
            target.hash() == host.hash(),
            "the flight differs from the host's"
        );
        Ok(())
    }

    /// The planner hangs for ever. It is dropped and restarted, no step is missed, and later cycles
    /// are planned again.
    fn stuck_planner_is_restarted(&self) -> Result<()> {
        let image = self.folder.join("planner-hangs");
        contents::patched(
            &Image::FifoFaults.path()?,
            &[("FAULT_PLANNER_HANGS_AFTER", HANG)],
            &image,
        )?;
        let (outcome, report) = self.fly_by_timer(&image, &spread(12, 20))?;
        let plans = outcome.log["plans"]
            .as_array()
            .map_or(&[][..], Vec::as_slice);
        let lost = |plan: &serde_json::Value| plan["candidates"] == 0;
        let good_after = plans
            .iter()
            .filter(|plan| plan["tick"].as_u64() > Some(u64::from(HANG)) && !lost(plan))
            .count();
        println!(
            "stuck planner: {} ticks, {} missed, {} restart, {} plans, {good_after} after it; {}; {}",
            report.ticks,
            report.missed,
            report.restarts,
            plans.len(),
            outcome.outcome(),
            outcome.rejections().join(" "),
        );
        ensure!(report.missed == 0, "ticks were missed");
        ensure!(report.restarts == 1, "the planner was not restarted once");
        ensure!(
            outcome.rejections() == ["PlannerRestarted"],
            "the restart was not reported, or more was"
        );
        ensure!(plans.iter().any(lost), "no cycle was lost");
        ensure!(good_after >= 5, "the restarted planner does not plan");
        Ok(())
    }

    /// The step hangs for ever. The watchdog resets the core. The core says hello, is configured
    /// again and flies on.
    fn stuck_step_is_reset(&self) -> Result<()> {
        let image = self.folder.join("step-hangs");
        contents::patched(
            &Image::UartFaults.path()?,
            &[("FAULT_STEP_HANGS_AFTER", HANG)],
            &image,
        )?;
        let mut emulator = Emulator::uart(&self.run(&image))?;
        let arguments = "--seed 1 --duration 10".split(' ').map(str::to_owned);
        let outcome = self
            .harness
            .fly_emulated(&arguments.collect::<Vec<_>>(), &mut emulator)?;
        println!(
            "stuck step: {}, {} replans; {}",
            outcome.outcome(),
            outcome.count("replans"),
            outcome.rejections().join(" ")
        );
        ensure!(
            outcome.rejections().len() == 2
                && outcome.has("CoreRestarted")
                && outcome.has("Trapped { task: Step, fault: Hang"),
            "the core was not restarted once, or did not say why"
        );
        let plans = outcome.log["plans"].as_array().map_or(0, Vec::len);
        ensure!(plans >= 9, "the restarted core does not plan");
        Ok(())
    }

    /// The flight image over UART, whose ticks come as fast as the host can: far too fast for the planner. The
    /// step answers each of them and takes over each plan when it comes.
    fn late_plans_hold_no_step(&self) -> Result<()> {
        let image = Image::Uart.path()?;
        let mut emulator = Emulator::uart(&self.run(&image))?;
        let arguments = "--seed 1 --obstacles 0 --duration 30"
            .split(' ')
            .map(str::to_owned);
        let outcome = self
            .harness
            .fly_emulated(&arguments.collect::<Vec<_>>(), &mut emulator)?;
        let plans = outcome.log["plans"].as_array().cloned().unwrap_or_default();
        let late = plans.iter().filter(|plan| {
            let tick = |name: &str| plan[name].as_u64().unwrap_or_default();
            tick("used_from_tick") > tick("tick") + 1
        });
        let late = late.count();
        println!(
            "flight image, ticks faster than its planner: {}, {late} of {} plans late; {}",
            outcome.outcome(),
            plans.len(),
            outcome.rejections().join(" "),
        );
        ensure!(late > 0, "no plan was late");
        ensure!(
            outcome.outcome() == "survived",
            "the flight did not end well"
        );
        Ok(())
    }

    /// More bytes come than fit, while the core cannot take any. The core counts and reports the
    /// lost bytes, and is ready for the next session.
    fn flood_is_counted(&self) -> Result<()> {
        let image = self.folder.join("set-up-awaits-loss");
        contents::patched(
            &Image::UartFaults.path()?,
            &[("FAULT_SET_UP_AWAITS_LOSS", 0)],
            &image,
        )?;
        let emulator = Emulator::uart(&self.run(&image))?;
        let address = emulator.link().trim_start_matches("tcp:").to_owned();
        let mut stream = TcpStream::connect(address)?;
        stream.set_read_timeout(Some(PATIENCE))?;
        // The configuration occupies the planner, and the step waits for it until bytes are lost.
        send(&mut stream, &Message::Configure(CONFIGURE))?;
        stream.write_all(&[0x55; 20_000])?;
        stream.write_all(&[0])?;
        let lost = await_message(&mut stream, |message| match message {
            Message::Rejection(rejection) => match rejection.cause {
                RejectionCause::BytesLost { count } => Some(count),
                _ => None,
            },
            _ => None,
        })?;
        println!("flood of 20001 bytes: the core reports {lost} lost, and says hello again");
        ensure!((1..=20_001).contains(&lost), "a count that cannot be");
        // This byte ends the rest of the flood, because its own end may be among the lost bytes.
        stream.write_all(&[0])?;
        send(&mut stream, &Message::Hello(HELLO))?;
        await_message(&mut stream, |message| {
            matches!(message, Message::Hello(hello) if hello.role == Role::Core).then_some(())
        })
    }
}
