//! Flies the harness, with its own core or with an emulated one.

use crate::qemu::Emulator;
use crate::toolchain::{cargo, output, succeed};
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// The time that emulator and harness wait for each other. It is far more than they need.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// The results of a flight.
pub(crate) struct Outcome {
    /// The result line.
    pub(crate) line: Value,
    /// The log.
    pub(crate) log: Value,
}

impl Outcome {
    /// The log's hash.
    pub(crate) fn hash(&self) -> &str {
        self.line["log_hash"].as_str().unwrap_or_default()
    }

    /// A counter of the result line.
    pub(crate) fn count(&self, name: &str) -> u64 {
        self.line[name].as_u64().unwrap_or_default()
    }

    /// The outcome of the flight.
    pub(crate) fn outcome(&self) -> &str {
        self.line["outcome"].as_str().unwrap_or_default()
    }

    /// Whether the log has a rejection whose cause begins with a text.
    pub(crate) fn has(&self, cause: &str) -> bool {
        self.rejections()
            .iter()
            .any(|found| found.starts_with(cause))
    }

    /// Causes of the rejections in the log, in order.
    pub(crate) fn rejections(&self) -> Vec<&str> {
        let entries = self.log["rejections"].as_array();
        entries.map_or_else(Vec::new, |entries| {
            entries
                .iter()
                .filter_map(|entry| entry["cause"].as_str())
                .collect()
        })
    }
}

/// The words of a line of flags.
pub(crate) fn flags(line: &str) -> Vec<String> {
    line.split(' ').map(str::to_owned).collect()
}

/// The flags of a flight in space, through a forest with so many trunks per square metre.
pub(crate) fn in_space(seed: u64, density: f64) -> Vec<String> {
    flags(&format!("--seed {seed} --preset space --density {density}"))
}

/// The built harness.
pub(crate) struct Harness {
    program: PathBuf,
    out: PathBuf,
}

impl Harness {
    /// Builds the harness. Its logs go to a folder.
    pub(crate) fn build(out: &Path) -> Result<Self> {
        succeed(&mut cargo(
            "build --quiet --release --locked -p sil-harness",
        ))?;
        let metadata = output(&mut cargo(
            "metadata --no-deps --format-version 1 --offline",
        ))?;
        let metadata: Value = serde_json::from_str(&metadata)?;
        let target = metadata["target_directory"]
            .as_str()
            .context("no target folder")?;
        Ok(Self {
            program: Path::new(target).join("release/sil-harness"),
            out: out.to_owned(),
        })
    }

    /// A harness that is already built.
    pub(crate) fn with_program(program: PathBuf, out: &Path) -> Self {
        Self {
            program,
            out: out.to_owned(),
        }
    }

    /// The harness's program.
    pub(crate) fn program(&self) -> &Path {
        &self.program
    }

    fn command(&self, arguments: &[String], out: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command
            .arg("fly")
            .args(arguments)
            .arg("--json")
            .arg("--out")
            .arg(out);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Flies with the harness's own core.
    pub(crate) fn fly(&self, arguments: &[String]) -> Result<Outcome> {
        outcome(&self.command(arguments, &self.out.join("host")).output()?)
    }

    fn linked(&self, arguments: &[String], link: &str) -> Command {
        let mut command = self.command(arguments, &self.out.join("target"));
        command.args(["--link", link]);
        if link.starts_with("tcp:") {
            // An emulator on a busy machine is slow. FIFOs wait as long as it takes.
            let patience = PATIENCE.as_secs().to_string();
            command.args(["--patience", &patience]);
        }
        command
    }

    /// Flies with an emulated core.
    pub(crate) fn fly_emulated(
        &self,
        arguments: &[String],
        emulator: &mut Emulator,
    ) -> Result<Outcome> {
        let harness = self.linked(arguments, emulator.link()).spawn()?;
        outcome(&await_end(harness, emulator)?)
    }
}

/// Waits until a program that flies with an emulated core has ended.
pub(crate) fn await_end(mut program: Child, emulator: &mut Emulator) -> Result<Output> {
    let mut died = None;
    // The program notices a core that died, unless it died before the link was up.
    while program.try_wait()?.is_none() {
        if died.is_none() && emulator.has_ended()? {
            died = Some(Instant::now());
        }
        if died.is_some_and(|when| when.elapsed() > PATIENCE) {
            program.kill()?;
            program.wait()?;
            bail!("the emulator ended before the flight did");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    Ok(program.wait_with_output()?)
}

fn outcome(output: &Output) -> Result<Outcome> {
    let text = str::from_utf8(&output.stdout)?;
    // Codes 3, 4 and 5 (collision, extreme state, not arrived) are results of flights too.
    if !matches!(output.status.code(), Some(0 | 3 | 4 | 5)) {
        bail!(
            "the flight failed:\n{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
    let line: Value = serde_json::from_str(text.trim()).context("the harness's result line")?;
    let path = line["log"].as_str().context("no log in the result line")?;
    let log = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    Ok(Outcome { line, log })
}
