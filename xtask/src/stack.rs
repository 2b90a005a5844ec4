//! A bound of the stack, from the compiler's frame sizes and the calls in the image.
//!
//! The bound is the sum of three parts: the deepest path of the thread, the deepest path of each
//! interrupt that can come on top of it, and the frames that the processor stacks, for a trap too. Recursion and
//! indirect calls have no bound and are errors.

use crate::toolchain::{install, output};
use anyhow::{Context, Result, bail};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// The thread, and the handlers that interrupt it and each other.
const ROOTS: [&str; 4] = ["Reset", "PendSV", "SysTick", "DefaultHandler"];
/// Bytes that the processor stacks for a handler: 26 words with those of the FPU, and 4 bytes to
/// align.
const EXCEPTION_FRAME: u64 = 26 * 4 + 4;

/// Functions of an image by address.
#[derive(Default)]
struct Program {
    names: BTreeMap<u64, String>,
    frames: BTreeMap<u64, u64>,
    calls: BTreeMap<u64, BTreeSet<u64>>,
}

/// The bound of an image \[bytes\].
pub(crate) fn bound(image: &Path) -> Result<u64> {
    let bytes = std::fs::read(image)?;
    let file = object::File::parse(&*bytes)?;
    let mut program = Program::default();
    for symbol in file.symbols() {
        if symbol.kind() == SymbolKind::Text && symbol.size() > 0 || symbol.name() == Ok("PendSV") {
            let name = rustc_demangle::demangle(symbol.name()?).to_string();
            program.names.insert(symbol.address() & !1, name);
        }
    }
    let table = file
        .section_by_name(".stack_sizes")
        .context("the image has no .stack_sizes")?;
    program.frames = frame_sizes(table.data()?);
    install(&[("/usr/bin/arm-none-eabi-objdump", "binutils-arm-none-eabi")])?;
    let mut objdump = Command::new("arm-none-eabi-objdump");
    program.read_calls(&output(
        objdump.args(["-d", "--no-show-raw-insn"]).arg(image),
    )?)?;

    let mut sum = 0;
    for root in ROOTS {
        let address = program.names.iter().find(|(_, name)| *name == root);
        let (address, _) = address.with_context(|| format!("no function {root}"))?;
        sum += program.depth(*address, &mut BTreeMap::new(), &mut Vec::new())?;
    }
    // A trap or the watchdog may come on top of all of them. Their handler begins at the top of the stack.
    Ok(sum + EXCEPTION_FRAME * ROOTS.len() as u64)
}

/// The memory for the stack \[bytes\].
pub(crate) fn room(image: &Path) -> Result<u64> {
    let bytes = std::fs::read(image)?;
    let file = object::File::parse(&*bytes)?;
    let address = |name: &str| {
        let symbol = file.symbol_by_name(name);
        symbol
            .map(|symbol| symbol.address())
            .with_context(|| format!("no symbol {name}"))
    };
    Ok(address("_stack_start")? - address("_stack_end")?)
}

/// Reads the compiler's table: an address of four bytes, then the size in groups of seven bits.
fn frame_sizes(mut table: &[u8]) -> BTreeMap<u64, u64> {
    let mut frames = BTreeMap::new();
    while let Some((address, rest)) = table.split_first_chunk::<4>() {
        let (mut size, mut shift) = (0, 0);
        table = rest;
        while let Some((byte, rest)) = table.split_first() {
            size |= u64::from(byte & 0x7F) << shift;
            shift += 7;
            table = rest;
            if byte & 0x80 == 0 {
                break;
            }
        }
        frames.insert(u64::from(u32::from_le_bytes(*address)) & !1, size);
    }
    frames
}

impl Program {
    /// Reads calls and jumps out of a function. Also reads the frames of functions that are not in
    /// the table (assembly, the compiler's own library).
    fn read_calls(&mut self, listing: &str) -> Result<()> {
        let known: BTreeSet<u64> = self.frames.keys().copied().collect();
        let mut inside = None;
        for line in listing.lines() {
            if let Some((address, _)) = line.split_once(" <").filter(|_| line.ends_with(">:")) {
                let address = u64::from_str_radix(address, 16)?;
                if self.names.contains_key(&address) {
                    inside = Some(address);
                }
                continue;
            }
            let mut fields = line.trim().split('\t');
            let (Some(_), Some(operation), Some(function)) = (fields.next(), fields.next(), inside)
            else {
                continue;
            };
            let operands = fields.next().unwrap_or_default();
            self.read_instruction(
                function,
                operation.trim(),
                operands,
                known.contains(&function),
            )?;
        }
        Ok(())
    }

    fn read_instruction(
        &mut self,
        function: u64,
        operation: &str,
        operands: &str,
        framed: bool,
    ) -> Result<()> {
        if !framed {
            *self.frames.entry(function).or_default() += pushed(operation, operands);
        }
        let target = operands
            .split_once(" <")
            .and_then(|(before, _)| before.rsplit([' ', ',']).next())
            .and_then(|text| u64::from_str_radix(text, 16).ok())
            .map(|address| address & !1);
        let is_call = matches!(operation, "bl" | "blx" | "bl.w");
        let is_branch = operation.starts_with('b') && !operation.starts_with("bi")
            || operation.starts_with("cb");
        match target {
            Some(target)
                if (is_call || is_branch && target != function)
                    && self.names.contains_key(&target) =>
            {
                self.calls.entry(function).or_default().insert(target);
            }
            Some(target) if is_call => {
                bail!(
                    "{} calls {target:x}, which is no function",
                    self.name(function)
                );
            }
            None if operation == "blx" || operation == "bx" && operands.trim() != "lr" => {
                bail!(
                    "an indirect call in {}: {operation} {operands}",
                    self.name(function)
                );
            }
            _ => {}
        }
        Ok(())
    }

    fn name(&self, function: u64) -> &str {
        self.names.get(&function).map_or("?", String::as_str)
    }

    /// The size of the deepest path from a function \[bytes\].
    fn depth(
        &self,
        function: u64,
        known: &mut BTreeMap<u64, u64>,
        path: &mut Vec<u64>,
    ) -> Result<u64> {
        if let Some(depth) = known.get(&function) {
            return Ok(*depth);
        }
        if path.contains(&function) {
            bail!("recursion through {}", self.name(function));
        }
        path.push(function);
        let mut deepest = 0;
        for callee in self.calls.get(&function).into_iter().flatten() {
            deepest = deepest.max(self.depth(*callee, known, path)?);
        }
        path.pop();
        let depth = deepest + self.frames.get(&function).copied().unwrap_or_default();
        known.insert(function, depth);
        Ok(depth)
    }
}

/// Bytes that an instruction takes from the stack.
fn pushed(operation: &str, operands: &str) -> u64 {
    let registers = || operands.trim_matches(['{', '}', ' ']).split(',').count() as u64;
    let is_stack = operands.starts_with("sp,") || operands.starts_with("sp!,");
    match operation.trim_end_matches(".w") {
        "push" | "stmdb" if operation == "push" || is_stack => 4 * registers(),
        "vpush" => 16 * 8,
        "sub" if is_stack => operands
            .rsplit('#')
            .next()
            .and_then(|text| text.split_whitespace().next()?.parse().ok())
            .unwrap_or_default(),
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::{Program, frame_sizes, pushed};
    use std::collections::BTreeMap;

    const LISTING: &str = "\
00000100 <top>:
 100:\tpush\t{r4, lr}
 102:\tbl\t200 <middle>
 106:\tbl\t300 <leaf>
 10a:\tpop\t{r4, pc}
00000200 <middle>:
 200:\tb.w\t300 <leaf>
00000300 <leaf>:
 300:\tbx\tlr
";

    fn program(listing: &str) -> anyhow::Result<Program> {
        let names = [(0x100, "top"), (0x200, "middle"), (0x300, "leaf")];
        let mut program = Program {
            names: names.map(|(at, name)| (at, name.to_owned())).into(),
            frames: [(0x200, 16), (0x300, 24)].into(),
            calls: BTreeMap::new(),
        };
        program.read_calls(listing)?;
        Ok(program)
    }

    fn depth(listing: &str) -> anyhow::Result<u64> {
        program(listing)?.depth(0x100, &mut BTreeMap::new(), &mut Vec::new())
    }

    #[test]
    fn the_deepest_path_counts() {
        // `top` is not in the table, so its push of two registers is read from the listing.
        assert!(depth(LISTING).is_ok_and(|depth| depth == 8 + 16 + 24));
    }

    #[test]
    fn recursion_and_calls_of_what_is_not_known_have_no_bound() {
        for callee in ["100 <top>", "300 <leaf>", "400 <nothing>"] {
            let recursive = LISTING.replace("bx\tlr", &format!("bl\t{callee}"));
            assert!(depth(&recursive).is_err(), "{callee}");
        }
        let indirect = LISTING.replace("bx\tlr", "blx\tr3");
        assert!(depth(&indirect).is_err());
    }

    #[test]
    fn frame_sizes_are_read_in_groups_of_seven_bits() {
        let table = [1, 2, 0, 0, 0xAC, 0x02, 4, 3, 0, 0, 8];
        assert_eq!(frame_sizes(&table), [(0x200, 300), (0x304, 8)].into());
    }

    #[test]
    fn pushes_of_assembly_are_counted() {
        assert_eq!(pushed("push", "{r4, r5, r6, lr}"), 16);
        assert_eq!(pushed("sub", "sp, #40\t@ 0x28"), 40);
        assert_eq!(pushed("sub", "r0, #40"), 0);
    }
}
