//! `identity`: flies the same seeds on every machine that the core runs on, and compares the logs' hashes.

use crate::firmware::{self, Image};
use crate::flight::{Harness, flags, in_space};
use crate::folders::work;
use crate::qemu::{Emulator, Run};
use crate::toolchain::output;
use crate::{aarch64, wasm};
use anyhow::{Context, Result, anyhow, bail, ensure};
use serde_json::json;
use std::process::Command;
use std::time::Instant;

#[derive(Clone, Debug, clap::Args)]
pub(crate) struct IdentityArgs {
    /// Number of seeds to fly
    #[arg(long, default_value_t = 20)]
    flights: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Length of each flight, in seconds
    #[arg(long, default_value_t = 20)]
    duration: u32,
    /// Number of obstacles in the field
    #[arg(long, default_value_t = 20)]
    obstacles: u16,
    /// Fly in space, through a forest with so many trunks per square metre
    #[arg(long, conflicts_with_all = ["duration", "obstacles"])]
    density: Option<f64>,
    /// Python that has the module `mppflight`
    #[arg(long, default_value = "python3")]
    python: String,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// A machine, or a language, that flies.
struct Target {
    name: String,
    /// The core's processor, and who runs it.
    how: &'static str,
    /// The hash of each flight, or why there is none.
    hashes: Result<Vec<String>, String>,
    /// Time of the flights \[s\].
    seconds: f64,
}

impl Target {
    /// Flies and notes the time.
    fn fly(
        name: &str,
        how: &'static str,
        fly: impl FnOnce() -> Result<Vec<String>>,
    ) -> Result<Self> {
        let begin = Instant::now();
        let hashes = fly().with_context(|| name.to_owned())?;
        Ok(Self {
            name: name.to_owned(),
            how,
            hashes: Ok(hashes),
            seconds: begin.elapsed().as_secs_f64(),
        })
    }
}

/// The scenario of a seed.
struct Flights<'a>(&'a IdentityArgs);

impl Flights<'_> {
    fn seeds(&self) -> std::ops::Range<u64> {
        self.0.seed..self.0.seed.saturating_add(self.0.flights)
    }

    fn image(&self) -> Image {
        match self.0.density {
            Some(_) => Image::Space,
            None => Image::Fifo,
        }
    }

    /// Its flags for the harness.
    fn flags(&self, seed: u64) -> Vec<String> {
        let IdentityArgs {
            duration,
            obstacles,
            density,
            ..
        } = self.0;
        match density {
            Some(density) => in_space(seed, *density),
            None => flags(&format!(
                "--seed {seed} --obstacles {obstacles} --duration {duration}"
            )),
        }
    }

    /// Its keys of a scenario file.
    fn scenario(&self, seed: u64) -> String {
        let IdentityArgs {
            duration,
            obstacles,
            density,
            ..
        } = self.0;
        match density {
            Some(density) => json!({ "seed": seed, "preset": "space", "density": density }),
            None => json!({ "seed": seed, "obstacles": obstacles, "duration": duration }),
        }
        .to_string()
    }

    fn with(&self, fly: impl Fn(&[String]) -> Result<String>) -> Result<Vec<String>> {
        self.seeds().map(|seed| fly(&self.flags(seed))).collect()
    }
}

pub(crate) fn run(args: &IdentityArgs) -> Result<()> {
    ensure!(args.flights > 0, "give at least one flight");
    let flights = Flights(args);
    let folder = work("identity")?;
    let host = Harness::build(&folder)?;
    firmware::build(&[flights.image()])?;
    let emulated = aarch64::harness(&work("aarch64")?)?;
    let module = wasm::build(args.density.is_some())?;
    let on_m7 = || {
        Target::fly("cortex-m7", "harness, core in QEMU's mps2-an500", || {
            flights.with(|flags| cortex_m7(&host, flights.image(), flags))
        })
    };
    let on_aarch64 = || {
        Target::fly("aarch64", "harness and core in QEMU's user mode", || {
            flights.with(|flags| Ok(emulated.fly(flags)?.hash().to_owned()))
        })
    };
    // The two that take long fly at the same time.
    let (m7, aarch64) = std::thread::scope(|scope| {
        let m7 = scope.spawn(on_m7);
        let aarch64 = on_aarch64();
        (m7.join(), aarch64)
    });
    let targets = [
        Target::fly(
            std::env::consts::ARCH,
            "harness, core in its process",
            || flights.with(|flags| Ok(host.fly(flags)?.hash().to_owned())),
        )?,
        m7.map_err(|_| anyhow!("the flights on cortex-m7 broke"))??,
        aarch64?,
        Target::fly("wasm32", "simulation and core in Node", || {
            let scenarios: Vec<String> =
                flights.seeds().map(|seed| flights.scenario(seed)).collect();
            wasm::fly(&module, &scenarios)
        })?,
        python(&flights)?,
    ];
    report(args, &targets)
}

fn cortex_m7(host: &Harness, image: Image, flags: &[String]) -> Result<String> {
    let folder = work("identity")?;
    let path = image.path()?;
    let mut emulator = Emulator::fifo(
        &Run {
            image: &path,
            folder: &folder,
            shift: 0,
            counter: None,
        },
        false,
    )?;
    let flown = host.fly_emulated(flags, &mut emulator)?;
    emulator.end()?;
    Ok(flown.hash().to_owned())
}

/// The flights of the Python module, if it is installed.
fn python(flights: &Flights<'_>) -> Result<Target> {
    const HOW: &str = "Python module `mppflight`";
    let interpreter = &flights.0.python;
    let is_there = Command::new(interpreter)
        .args(["-c", "import mppflight; mppflight.fly"])
        .output();
    if !is_there.is_ok_and(|output| output.status.success()) {
        return Ok(Target {
            name: "python".to_owned(),
            how: HOW,
            hashes: Err(format!("skipped: {interpreter} cannot import mppflight")),
            seconds: 0.0,
        });
    }
    Target::fly("python", HOW, || {
        let mut python = Command::new(interpreter);
        python.args([
            "-c",
            "import json, sys, mppflight\nfor keys in sys.argv[1:]: print(mppflight.fly(**json.loads(keys)).log_hash)",
        ]);
        let text = output(python.args(flights.seeds().map(|seed| flights.scenario(seed))))?;
        Ok(text.lines().map(str::to_owned).collect())
    })
}

fn report(args: &IdentityArgs, targets: &[Target]) -> Result<()> {
    let own = targets
        .first()
        .and_then(|target| target.hashes.as_ref().ok())
        .context("the host did not fly")?;
    let mut all_equal = true;
    let mut rows = Vec::new();
    for target in targets {
        let Ok(hashes) = &target.hashes else {
            let why = target.hashes.as_ref().err();
            rows.push(
                json!({ "name": target.name, "how": target.how, "flights": 0, "skipped": why }),
            );
            continue;
        };
        let equal = own.iter().zip(hashes).filter(|(a, b)| a == b).count();
        all_equal &= equal == own.len() && hashes.len() == own.len();
        let different: Vec<u64> = (args.seed..)
            .zip(own.iter().zip(hashes))
            .filter(|(_, (a, b))| a != b)
            .map(|(seed, _)| seed)
            .collect();
        rows.push(json!({
            "name": target.name,
            "how": target.how,
            "flights": hashes.len(),
            "equal": equal,
            "different": different,
            "first_hash": hashes.first(),
            "seconds": (target.seconds * 10.0).round() / 10.0,
        }));
    }
    if args.json {
        let object = json!({ "flights": args.flights, "targets": rows, "equal": all_equal });
        println!("{object}");
    } else {
        table(args, &rows);
    }
    if !all_equal {
        bail!("flights differ: the table says which");
    }
    Ok(())
}

fn table(args: &IdentityArgs, rows: &[serde_json::Value]) {
    let IdentityArgs {
        flights,
        seed,
        duration,
        obstacles,
        density,
        ..
    } = args;
    match density {
        Some(density) => {
            println!("{flights} flights in space, {density} trunks per m^2, from seed {seed}");
        }
        None => println!(
            "{flights} flights of {duration} s past {obstacles} obstacles, from seed {seed}"
        ),
    }
    println!(
        "{:<10} {:<37} {:>7} {:>7} {:<17} {:>8}",
        "target", "how", "flights", "equal", "first hash", "seconds"
    );
    for row in rows {
        let text = |key: &str| row[key].as_str().unwrap_or_default();
        let number = |key: &str| row[key].as_u64().unwrap_or_default();
        let (name, how) = (text("name"), text("how"));
        if row["skipped"].is_string() {
            println!("{name:<10} {how:<37} {}", text("skipped"));
            continue;
        }
        println!(
            "{name:<10} {how:<37} {:>7} {:>7} {:<17} {:>8}",
            number("flights"),
            number("equal"),
            text("first_hash"),
            row["seconds"].as_f64().unwrap_or_default()
        );
        if row["flights"] != row["equal"] {
            println!("{:<10} differs at seeds {}", "", row["different"]);
        }
    }
}
