//! The link as two files of the emulator's host, by semihosting: `to-core` and `to-harness` in its
//! working directory, usually FIFOs.

use crate::owned::Owned;
use cortex_m_semihosting::{nr, syscall};

const FAILED: usize = usize::MAX;

static HOST: Owned<Host> = Owned::uninit();

/// Both files and what was read and not yet used, or written and not yet sent.
pub struct Host {
    to_core: usize,
    to_harness: usize,
    input: [u8; 512],
    used: usize,
    filled: usize,
    output: [u8; 512],
    waiting: usize,
}

/// Opens both files.
///
/// # Safety
/// Called once, before any interrupt is enabled.
pub unsafe fn open() {
    let (to_core, to_harness) = (
        open_file(c"to-core", nr::open::R_BINARY),
        open_file(c"to-harness", nr::open::W_TRUNC_BINARY),
    );
    let host = Host {
        to_core,
        to_harness,
        input: [0; 512],
        used: 0,
        filled: 0,
        output: [0; 512],
        waiting: 0,
    };
    // SAFETY: nothing else runs yet.
    unsafe { HOST.write(host) };
}

/// The link.
///
/// # Safety
/// Only from the step's interrupt, or before it is enabled.
pub unsafe fn get() -> &'static mut Host {
    // SAFETY: written by `open`; one user at a time, as the caller promises.
    unsafe { HOST.get() }
}

impl Host {
    /// Whether bytes are there without reading.
    #[must_use]
    pub fn has_bytes(&self) -> bool {
        self.used < self.filled
    }

    /// The next byte that was read.
    pub fn next(&mut self) -> Option<u8> {
        if !self.has_bytes() {
            return None;
        }
        let byte = self.input.get(self.used).copied();
        self.used = self.used.saturating_add(1);
        byte
    }

    /// Waits for bytes; false when the harness has closed its end.
    pub fn read(&mut self) -> bool {
        let size = self.input.len();
        // SAFETY: the buffer is as long as said. The answer is how much of it was not used.
        let unused = unsafe { syscall!(READ, self.to_core, self.input.as_mut_ptr(), size) };
        self.used = 0;
        self.filled = size.saturating_sub(unused);
        self.filled > 0
    }

    /// Puts bytes in the buffer, after sending it if it is full.
    pub fn send(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if self.waiting >= self.output.len() {
                self.flush();
            }
            if let Some(place) = self.output.get_mut(self.waiting) {
                *place = *byte;
                self.waiting = self.waiting.saturating_add(1);
            }
        }
    }

    /// Sends the buffer.
    pub fn flush(&mut self) {
        if self.waiting > 0 {
            write(self.to_harness, self.output.get(..self.waiting));
            self.waiting = 0;
        }
    }
}

/// Writes a file of words, little endian.
pub fn write_file(name: &core::ffi::CStr, words: &[u32]) {
    let file = open_file(name, nr::open::W_TRUNC_BINARY);
    for word in words {
        write(file, Some(&word.to_le_bytes()));
    }
}

/// Writes until all is written, or no more is taken: the reader is gone, and reading says so.
fn write(file: usize, bytes: Option<&[u8]>) {
    let mut rest = bytes.filter(|_| file != FAILED).unwrap_or(&[]);
    while !rest.is_empty() {
        // SAFETY: the buffer is as long as said. The answer is how much of it was not taken.
        let left = unsafe { syscall!(WRITE, file, rest.as_ptr(), rest.len()) };
        let taken = rest.len().checked_sub(left).filter(|taken| *taken > 0);
        rest = taken.and_then(|taken| rest.get(taken..)).unwrap_or(&[]);
    }
}

fn open_file(name: &core::ffi::CStr, mode: usize) -> usize {
    // SAFETY: the name ends with a zero, which does not count.
    unsafe { syscall!(OPEN, name.as_ptr(), mode, name.count_bytes()) }
}

/// Whether the emulator's command line for the image ends with a word.
#[must_use]
pub fn command_line_ends_with(word: &[u8]) -> bool {
    let mut line = [0_u8; 64];
    let mut block = [line.as_mut_ptr() as usize, line.len()];
    // SAFETY: the block names a buffer and its length; the answer is 0 if it was filled.
    let failed =
        unsafe { cortex_m_semihosting::syscall1(nr::GET_CMDLINE, block.as_mut_ptr() as usize) };
    let text = line.split(|byte| *byte == 0).next();
    failed == 0 && text.is_some_and(|text| text.ends_with(word))
}
