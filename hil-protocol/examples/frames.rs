//! Prints the MAVLink frames in a stream: `frames < bytes`, one line of hexadecimal digits each.

use hil_protocol::mavlink::Framer;
use std::io::{Read, Write};

fn main() -> std::io::Result<()> {
    let mut bytes = Vec::new();
    std::io::stdin().read_to_end(&mut bytes)?;
    let mut lines = String::new();
    let mut framer = Framer::new();
    let mut print = |frame: &[u8]| {
        lines.extend(frame.iter().map(|byte| format!("{byte:02x}")));
        lines.push('\n');
    };
    framer.receive(&bytes, |frame| print(frame.bytes));
    framer.end(|frame| print(frame.bytes));
    std::io::stdout().write_all(lines.as_bytes())
}
