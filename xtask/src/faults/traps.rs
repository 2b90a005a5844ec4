//! Traps of the processor, and a damaged image.

use super::{Bench, HANG, spread};
use crate::contents;
use crate::firmware::Image;
use crate::flight::{Outcome, PATIENCE};
use crate::qemu::{Emulator, Report};
use crate::talk::{CONFIGURE, await_message, send};
use anyhow::{Result, ensure};
use hil_protocol::{ConfigureVerdict, Message};
use std::net::TcpStream;

/// The ways in which `FAULT_TRAP` makes a task trap, and the fault that the core must tell.
const TRAPS: [(&str, &str); 4] = [
    ("an instruction that does not exist", "Instruction"),
    ("a stack that grows too large", "Stack"),
    ("a write to a constant", "Memory"),
    ("execution from RAM", "Memory"),
];

/// A number of faults in a row after which the planner stays off, as in firmware/src/trap.rs.
const MOST: u32 = 3;

impl Bench {
    fn trap(&self, words: &[(&str, u32)], arguments: &[String]) -> Result<(Outcome, Report)> {
        let image = self.folder.join("traps");
        contents::patched(&Image::FifoFaults.path()?, words, &image)?;
        self.fly_by_timer(&image, arguments)
    }

    /// The planner traps again and again. Each time it is dropped and restarted while the step flies on, and
    /// each trap is told with its number. After the third it stays off, and the step flies on without plans.
    pub(super) fn planner_that_traps_stays_off(&self) -> Result<()> {
        let words = [("FAULT_PLANNER_TRAPS_AFTER", HANG), ("FAULT_TRAP", 0)];
        let (outcome, report) = self.trap(&words, &spread(12, 0))?;
        println!(
            "planner that traps for ever: {} ticks, {} missed; {}; {}",
            report.ticks,
            report.missed,
            outcome.outcome(),
            outcome.rejections().join(" "),
        );
        ensure!(report.missed == 0, "ticks were missed");
        ensure!(
            outcome.outcome() == "survived",
            "the flight did not end well"
        );
        for count in 1..=MOST {
            let cause = format!("count: {count} }}");
            let causes = outcome.rejections();
            let told = causes.iter().filter(|found| found.ends_with(&cause));
            ensure!(told.count() == 1, "trap {count} was not told once");
        }
        ensure!(
            outcome.has("PlannerOff"),
            "the planner was not switched off"
        );
        ensure!(
            !outcome.has("CoreRestarted"),
            "a trap of the planner restarted the core"
        );
        Ok(())
    }

    /// Each way to trap is told as what it is: the memory is protected.
    pub(super) fn every_trap_is_told(&self) -> Result<()> {
        for (kind, (what, fault)) in (0_u32..).zip(TRAPS) {
            let words = [("FAULT_PLANNER_TRAPS_AFTER", HANG), ("FAULT_TRAP", kind)];
            let (outcome, report) = self.trap(&words, &spread(6, 0))?;
            let causes = outcome.rejections();
            println!("the planner traps by {what}: {}", causes.join(" "));
            ensure!(report.missed == 0, "ticks were missed");
            let told = format!("Trapped {{ task: Planner, fault: {fault}, ");
            ensure!(outcome.has(&told), "the trap was not told as {fault}");
        }
        Ok(())
    }

    /// The step traps. The core restarts, tells why, is configured again and flies on.
    pub(super) fn step_that_traps_is_reset(&self) -> Result<()> {
        for (kind, (what, fault)) in (0_u32..).zip(TRAPS) {
            let image = self.folder.join("step-traps");
            let words = [("FAULT_STEP_TRAPS_AFTER", HANG), ("FAULT_TRAP", kind)];
            contents::patched(&Image::UartFaults.path()?, &words, &image)?;
            let mut emulator = Emulator::uart(&self.run(&image))?;
            let arguments = ["--seed", "1", "--duration", "6"].map(str::to_owned);
            let outcome = self.harness.fly_emulated(&arguments, &mut emulator)?;
            println!(
                "the step traps by {what}: {}; {}",
                outcome.outcome(),
                outcome.rejections().join(" ")
            );
            let told = format!("Trapped {{ task: Step, fault: {fault}, ");
            ensure!(outcome.has("CoreRestarted"), "the core was not restarted");
            ensure!(outcome.has(&told), "the trap was not told as {fault}");
            ensure!(
                outcome.outcome() == "survived",
                "the flight did not end well"
            );
        }
        Ok(())
    }

    /// One bit of the flight image is another one. The core refuses to fly, and says why.
    pub(super) fn damaged_image_refuses_to_fly(&self) -> Result<()> {
        for (symbol, bit) in [("PendSV", 3), ("HardFault", 0), ("IMAGE_CHECKSUM", 7)] {
            let image = self.folder.join("damaged");
            contents::damaged(&Image::Uart.path()?, symbol, bit, &image)?;
            let emulator = Emulator::uart(&self.run(&image))?;
            let address = emulator.link().trim_start_matches("tcp:").to_owned();
            let mut stream = TcpStream::connect(address)?;
            stream.set_read_timeout(Some(PATIENCE))?;
            send(&mut stream, &Message::Configure(CONFIGURE))?;
            let verdict = await_message(&mut stream, |message| match message {
                Message::ConfigureReply(reply) => Some(reply.verdict),
                _ => None,
            })?;
            println!("a flipped bit of {symbol} in the image: {verdict}");
            ensure!(
                verdict == ConfigureVerdict::ImageDamaged,
                "the core accepted a configuration"
            );
        }
        Ok(())
    }
}
