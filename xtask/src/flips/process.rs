//! A core in a process of this machine, whose memory is changed from outside. Linux only.

use super::flip::{Draw, FLIGHT_SEED, Flip, PATIENCE};
use crate::flight::{Harness, Outcome};
use anyhow::{Context, Result, bail};
use hil_protocol::{Decoder, Message};
use std::fs::File;
use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::os::unix::fs::FileExt;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A process that ends with this value.
struct Core(Child);

impl Drop for Core {
    fn drop(&mut self) {
        // The process may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Flies with one flip.
pub(super) fn fly(
    harness: &Harness,
    arguments: &[String],
    draw: &mut Draw,
) -> (String, Result<Outcome>) {
    let flip = draw.flip(u64::MAX);
    match through_proxy(harness, arguments, flip) {
        Ok((what, outcome)) => (what, outcome),
        Err(error) => (format!("{flip:?}"), Err(error)),
    }
}

fn through_proxy(
    harness: &Harness,
    arguments: &[String],
    flip: Flip,
) -> Result<(String, Result<Outcome>)> {
    let port = TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let child = Command::new(harness.program())
        .args(["core", "--once", "--listen", &format!("127.0.0.1:{port}")])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()?;
    let core = Core(child);
    let id = core.0.id();
    let to_core = connect(port)?;
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let link = format!("tcp:{}", listener.local_addr()?);
    let relay = std::thread::spawn(move || relay(&listener, to_core, id, flip));
    let outcome = harness.fly_linked(arguments, &link);
    drop(core);
    let what = match relay.join() {
        Ok(Ok(what)) => what,
        Ok(Err(error)) => format!("{error:#}"),
        Err(_) => bail!("the relay failed"),
    };
    Ok((what, outcome))
}

fn connect(port: u16) -> Result<TcpStream> {
    let begin = Instant::now();
    loop {
        match TcpStream::connect(("127.0.0.1", port)) {
            Ok(stream) => return Ok(stream),
            Err(error) if begin.elapsed() > PATIENCE => return Err(error.into()),
            Err(_) => std::thread::sleep(Duration::from_millis(2)),
        }
    }
}

/// Passes bytes between harness and core, and flips the bit before the sensor frame of its tick. The core
/// waits then, because the harness is in lockstep with it. Returns what flipped.
fn relay(listener: &TcpListener, to_core: TcpStream, id: u32, flip: Flip) -> Result<String> {
    let (mut to_harness, _) = listener.accept()?;
    to_harness.set_nodelay(true)?;
    to_core.set_nodelay(true)?;
    let (mut from_core, mut back) = (to_core.try_clone()?, to_harness.try_clone()?);
    let answers = std::thread::spawn(move || {
        // An end of the link on either side ends the other side too.
        let _ = std::io::copy(&mut from_core, &mut back);
        let _ = back.shutdown(Shutdown::Both);
    });
    let mut to_core = to_core;
    let (mut decoder, mut bytes, mut what) = (Decoder::new(), [0; 4096], String::new());
    loop {
        let count = to_harness.read(&mut bytes).unwrap_or(0);
        let bytes = bytes.get(..count).unwrap_or_default();
        for message in bytes.iter().filter_map(|byte| decoder.push(*byte)) {
            if let Ok(Message::SensorFrame(frame)) = message
                && frame.tick == flip.tick
                && what.is_empty()
            {
                what = flip_bit(id, flip)?;
            }
        }
        if count == 0 || to_core.write_all(bytes).is_err() {
            break;
        }
    }
    let _ = to_core.shutdown(Shutdown::Both);
    let _ = answers.join();
    Ok(what)
}

/// Flips a bit of a process, in the mapping of its core.
fn flip_bit(id: u32, flip: Flip) -> Result<String> {
    let memory = File::options()
        .read(true)
        .write(true)
        .open(format!("/proc/{id}/mem"))?;
    let (start, size) = core_of(id, &memory)?;
    let at = flip.place % size;
    let mut byte = [0];
    memory.read_exact_at(&mut byte, start + at)?;
    let [value] = byte;
    memory.write_all_at(&[value ^ 1 << flip.bit], start + at)?;
    Ok(format!(
        "tick {}, byte {at} of {size}, bit {}",
        flip.tick, flip.bit
    ))
}

/// The mapping that contains the core: the one with the seed of the flight in it.
fn core_of(id: u32, memory: &File) -> Result<(u64, u64)> {
    let maps = std::fs::read_to_string(format!("/proc/{id}/maps"))?;
    for line in maps.lines() {
        let fields: Vec<&str> = line.split_whitespace().collect();
        // A mapping without a name: neither a file nor a stack.
        let [range, "rw-p", _, _, _] = fields[..] else {
            continue;
        };
        let (start, end) = range.split_once('-').context("a range of addresses")?;
        let start = u64::from_str_radix(start, 16)?;
        let size = u64::from_str_radix(end, 16)? - start;
        let mut bytes = vec![0; usize::try_from(size)?];
        if memory.read_exact_at(&mut bytes, start).is_ok()
            && bytes
                .windows(8)
                .any(|window| window == FLIGHT_SEED.to_le_bytes())
        {
            return Ok((start, size));
        }
    }
    bail!("the core is nowhere in the memory of its process")
}
