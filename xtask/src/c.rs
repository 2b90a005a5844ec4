//! `c`: the core's C interface. Flies the example under sanitizers, and on an emulated Cortex-M7.

use crate::flight::{Harness, await_end};
use crate::folders::{root, work};
use crate::qemu::{Emulator, Run};
use crate::release::{cortex_m, lay_out, try_out};
use crate::toolchain::{cargo, install, output, succeed};
use anyhow::{Context, Result, bail, ensure};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

const WARNINGS: [&str; 4] = ["-std=c11", "-Wall", "-Wextra", "-Werror"];

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct CArgs {
    /// Number of seeds that the example flies under sanitizers
    #[arg(long, default_value_t = 3)]
    flights: u64,
    /// Number of seeds that it flies on the Cortex-M7
    #[arg(long, default_value_t = 1)]
    emulated: u64,
}

pub(crate) fn run(args: &CArgs) -> Result<()> {
    let folder = work("c")?;
    let host = Harness::build(&folder)?;
    let plant = plant(&host)?;
    let example = Example {
        program: example(&plant, &folder)?,
        plant,
        host,
    };
    for seed in 1..=args.flights {
        let mut fly = example.command(seed);
        println!("this machine: {}", example.check(seed, &output(&mut fly)?)?);
    }
    let prefix = folder.join("prefix");
    lay_out(&prefix, &example.plant)?;
    let mut installed = Command::new(try_out(&prefix, &folder)?);
    let said = output(installed.args(["1", "20"]))?;
    println!("find_package(mpp): {}", example.check(1, &said)?);
    let image = flight_computer(&folder)?;
    for seed in 1..=args.emulated {
        emulated(&example, seed, &image, &folder)?;
    }
    Ok(())
}

/// The host's example, and the harness that knows the right hashes.
struct Example {
    program: PathBuf,
    /// The archive of core and simulated aircraft.
    plant: PathBuf,
    host: Harness,
}

impl Example {
    fn command(&self, seed: u64) -> Command {
        let mut command = Command::new(&self.program);
        command.args([&seed.to_string(), "20"]);
        command
    }

    /// Compares what the example said with the harness's flight, and gives it back.
    fn check<'a>(&self, seed: u64, said: &'a str) -> Result<&'a str> {
        let own = self.host.fly(&["--seed".to_owned(), seed.to_string()])?;
        ensure!(
            said.contains(own.hash()),
            "{said}the harness has {}: the flights differ",
            own.hash()
        );
        Ok(said.trim_end())
    }
}

/// Builds the archive of core and simulated aircraft.
fn plant(host: &Harness) -> Result<PathBuf> {
    // With an example, features are those of the workspace's tests, whose builds are used again.
    succeed(&mut cargo(
        "build --quiet --locked --workspace --lib --example frames",
    ))?;
    // The harness stands in the folder beside.
    let built = host
        .program()
        .ancestors()
        .nth(2)
        .context("no target folder")?;
    Ok(built.join("debug/libmpp_c_plant.a"))
}

/// Builds the example under the sanitizers of addresses and undefined behaviour.
fn example(plant: &Path, folder: &Path) -> Result<PathBuf> {
    install(&[("/usr/bin/cc", "gcc")])?;
    let program = folder.join("fly");
    let mut cc = Command::new("cc");
    cc.current_dir(root().join("bindings/c"))
        .args(WARNINGS)
        .args(["-O1", "-g"])
        .args(["-fsanitize=address,undefined", "-fno-sanitize-recover=all"])
        .args(["-I", "include", "example/fly.c", "example/autopilot.c"])
        .arg(plant)
        .args(["-lm", "-lpthread", "-ldl", "-o"])
        .arg(&program);
    succeed(&mut cc)?;
    Ok(program)
}

/// Builds the example for a Cortex-M7. It uses every call of the library, and does not link if one of them can panic.
fn flight_computer(folder: &Path) -> Result<PathBuf> {
    let library = cortex_m("cortex-m7")?;
    install(&[("/usr/bin/arm-none-eabi-gcc", "gcc-arm-none-eabi")])?;
    let image = folder.join("flight-computer.elf");
    let mut gcc = Command::new("arm-none-eabi-gcc");
    gcc.current_dir(root().join("bindings/c"))
        .args(WARNINGS)
        .args([
            "-O2",
            "-ffreestanding",
            "-nostdlib",
            "-Wl,--gc-sections,-z,noexecstack",
        ])
        .args(["-mcpu=cortex-m7", "-mfpu=fpv5-d16", "-mfloat-abi=hard"])
        .args(["-T", "example/flight_computer.ld", "-I", "include"])
        .args(["example/flight_computer.c", "example/autopilot.c"])
        .arg(&library)
        .args(["-lgcc", "-o"])
        .arg(&image);
    succeed(&mut gcc).context("the library can panic, or lacks an export")?;
    Ok(image)
}

/// Flies the example's core on the emulated flight computer.
fn emulated(example: &Example, seed: u64, image: &Path, folder: &Path) -> Result<()> {
    let run = Run {
        image,
        folder,
        shift: 0,
        counter: None,
    };
    let mut emulator = Emulator::fifo(&run, false)?;
    let mut fly = example.command(seed);
    fly.arg(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let flown = await_end(fly.spawn()?, &mut emulator)?;
    let said = String::from_utf8_lossy(&flown.stdout);
    ensure!(
        flown.status.success(),
        "the flight failed:\n{said}{}",
        String::from_utf8_lossy(&flown.stderr)
    );
    let words = emulator.report()?;
    let [storage, init, wrong, set_up, flight] = words[..] else {
        bail!("the report has {} words", words.len());
    };
    println!(
        "Cortex-M7: {}, storage {storage} bytes, stack of mpp_init {init}, of mpp_set_up {set_up}, in flight {flight} bytes",
        example.check(seed, &said)?
    );
    ensure!(
        wrong == 0,
        "{wrong} calls that make no sense were not refused as the header says"
    );
    Ok(())
}
