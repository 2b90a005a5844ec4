//! The emulated flight computer.

use crate::toolchain::{install, succeed};
use anyhow::{Context, Result, bail};
use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};

/// The parameters of an emulator's run.
pub(crate) struct Run<'a> {
    pub(crate) image: &'a Path,
    /// Folder for FIFOs, report and counts.
    pub(crate) folder: &'a Path,
    /// Sets the virtual time of an instruction to `1 << shift` ns. 1 means 500 million instructions
    /// a second.
    pub(crate) shift: u32,
    /// The counting plugin.
    pub(crate) counter: Option<&'a Path>,
}

/// A running emulator. It ends when this value is dropped.
pub(crate) struct Emulator {
    child: Child,
    link: String,
    folder: PathBuf,
}

/// The report of an image about itself, at the end of a flight over FIFOs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Report {
    /// Bytes of stack that were used.
    pub(crate) stack: u32,
    /// Ticks of the timer.
    pub(crate) ticks: u32,
    /// Ticks that came more than half a period late.
    pub(crate) missed: u32,
    /// Longest time between two ticks [counts of 40 ns].
    pub(crate) longest: u32,
    /// Shortest time between two ticks [counts of 40 ns].
    pub(crate) shortest: u32,
    /// Number of restarts of the planner.
    pub(crate) restarts: u32,
}

impl Emulator {
    /// Runs the image `uart`. The serial line is a loopback TCP socket.
    pub(crate) fn uart(run: &Run<'_>) -> Result<Self> {
        let port = TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
        let mut command = machine(run)?;
        command
            .arg("-serial")
            .arg(format!("tcp:127.0.0.1:{port},server=on,wait=on,nodelay=on"))
            .stderr(Stdio::piped());
        let mut child = command.spawn().context("running qemu-system-arm")?;
        let stderr = child.stderr.take();
        let emulator = Self {
            child,
            link: format!("tcp:127.0.0.1:{port}"),
            folder: run.folder.to_owned(),
        };
        wait_for_socket(stderr)?;
        Ok(emulator)
    }

    /// Runs the image `fifo`, in lockstep or by its timer.
    pub(crate) fn fifo(run: &Run<'_>, timer: bool) -> Result<Self> {
        for name in ["to-core", "to-harness", "report"] {
            let path = run.folder.join(name);
            if path.exists() {
                std::fs::remove_file(&path)?;
            }
            if name != "report" {
                succeed(Command::new("mkfifo").arg(&path))?;
            }
        }
        let pace = if timer { "timer" } else { "lockstep" };
        let mut command = machine(run)?;
        command
            .args(["-serial", "null", "-semihosting-config"])
            .arg(format!("enable=on,target=native,arg=fifo,arg={pace}"));
        Ok(Self {
            child: command.spawn().context("running qemu-system-arm")?,
            link: format!("fifo:{}", run.folder.display()),
            folder: run.folder.to_owned(),
        })
    }

    /// The value for the harness's `--link`.
    pub(crate) fn link(&self) -> &str {
        &self.link
    }

    /// Whether the emulator has ended.
    pub(crate) fn has_ended(&mut self) -> Result<bool> {
        Ok(self.child.try_wait()?.is_some())
    }

    /// Ends the emulator in order, so that it writes the counts. The image `fifo` ends by itself.
    pub(crate) fn end(mut self) -> Result<()> {
        self.wait()
    }

    fn wait(&mut self) -> Result<()> {
        if self.link.starts_with("tcp") {
            // This is the shell's own `kill`: a bare machine has no other.
            let kill = format!("kill -TERM {}", self.child.id());
            succeed(Command::new("sh").args(["-c", &kill]))?;
        }
        let status = self.child.wait()?;
        if !status.success() {
            bail!("the emulator failed: {status}");
        }
        Ok(())
    }

    /// Waits for an image over FIFOs to end, and reads the words of its report.
    pub(crate) fn report(mut self) -> Result<Vec<u32>> {
        self.wait()?;
        let bytes = std::fs::read(self.folder.join("report")).context("the image's report")?;
        let (words, _) = bytes.as_chunks::<4>();
        Ok(words.iter().map(|word| u32::from_le_bytes(*word)).collect())
    }
}

impl Report {
    /// The report of the image `fifo`, from its words.
    pub(crate) fn of(words: &[u32]) -> Result<Self> {
        let [stack, ticks, missed, longest, shortest, restarts] = words[..] else {
            bail!("the image's report has {} words", words.len());
        };
        Ok(Self {
            stack,
            ticks,
            missed,
            longest,
            shortest,
            restarts,
        })
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        // The emulator may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn machine(run: &Run<'_>) -> Result<Command> {
    install(&[("/usr/bin/qemu-system-arm", "qemu-system-arm")])?;
    let mut command = Command::new("qemu-system-arm");
    command
        .current_dir(run.folder)
        .args(["-M", "mps2-an500", "-cpu", "cortex-m7"])
        .args(["-display", "none", "-monitor", "none"])
        .arg("-icount")
        .arg(format!("shift={}", run.shift))
        .arg("-kernel")
        .arg(run.image)
        .stdin(Stdio::null());
    if let Some(counter) = run.counter {
        let out = run.folder.join("counts");
        // Regions of bytes, idling and interrupts of the UART only count in the total.
        let plugin = format!("{},out={},skip=9:10:11", counter.display(), out.display());
        command.arg("-plugin").arg(plugin);
    }
    Ok(command)
}

/// Waits until the emulator says that it listens. A trial connection would take the only
/// connection.
fn wait_for_socket(stderr: Option<ChildStderr>) -> Result<()> {
    let mut lines = BufReader::new(stderr.context("no stderr")?);
    let mut said = String::new();
    while lines.read_line(&mut said)? > 0 {
        if said.contains("waiting for connection") {
            // The emulator's later output is not needed, but the pipe must be emptied.
            std::thread::spawn(move || std::io::copy(&mut lines, &mut std::io::sink()));
            return Ok(());
        }
    }
    bail!("the emulator does not listen:\n{said}")
}
