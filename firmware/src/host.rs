//! The link over two files of the emulator's host, by semihosting. The files `to-core` and `to-harness` are
//! in the working directory of the emulator, and are usually FIFOs.

use crate::owned::Owned;
use cortex_m_semihosting::{nr, syscall};

const FAILED: usize = usize::MAX;

static HOST: Owned<Host> = Owned::uninit();

/// Both files, with the bytes that were read but not yet used.
pub struct Host {
    to_core: usize,
    to_harness: usize,
    input: [u8; 512],
    used: usize,
    filled: usize,
}

/// Opens both files.
///
/// # Safety
/// The caller calls this function once, before it enables any interrupt.
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
    };
    // SAFETY: nothing else runs yet.
    unsafe { HOST.write(host) };
}

/// The link.
///
/// # Safety
/// Only the step's interrupt may call this function, or code that runs before it is enabled.
pub unsafe fn get() -> &'static mut Host {
    // SAFETY: `open` has written the value. There is one user at a time, as the caller promises.
    unsafe { HOST.get() }
}

impl Host {
    /// Whether there are unused bytes from the last read.
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

    /// Waits for bytes. Returns false if the harness has closed its end.
    pub fn read(&mut self) -> bool {
        let size = self.input.len();
        // SAFETY: the buffer has the given length. The result is the number of bytes that were not read.
        let unused = unsafe { syscall!(READ, self.to_core, self.input.as_mut_ptr(), size) };
        self.used = 0;
        self.filled = size.saturating_sub(unused);
        self.filled > 0
    }

    /// Sends a frame.
    pub fn send(&self, frame: &[u8]) {
        write(self.to_harness, frame);
    }
}

/// Writes words to a file in little-endian order.
pub fn write_file(name: &core::ffi::CStr, words: &[u32]) {
    let file = open_file(name, nr::open::W_TRUNC_BINARY);
    for word in words {
        write(file, &word.to_le_bytes());
    }
}

/// Writes until the host has taken all bytes, or takes no more. In the latter case the reader is gone, and
/// the next read reports the end of the link.
fn write(file: usize, bytes: &[u8]) {
    let mut rest = if file == FAILED { &[] } else { bytes };
    while !rest.is_empty() {
        // SAFETY: the buffer has the given length. The result is the number of bytes not written.
        let left = unsafe { syscall!(WRITE, file, rest.as_ptr(), rest.len()) };
        let taken = rest.len().checked_sub(left).filter(|taken| *taken > 0);
        rest = taken.and_then(|taken| rest.get(taken..)).unwrap_or(&[]);
    }
}

fn open_file(name: &core::ffi::CStr, mode: usize) -> usize {
    // SAFETY: the name ends with a zero, which the length does not include.
    unsafe { syscall!(OPEN, name.as_ptr(), mode, name.count_bytes()) }
}

/// Whether the emulator's command line for the image ends with a word.
#[must_use]
pub fn command_line_ends_with(word: &[u8]) -> bool {
    let mut line = [0_u8; 64];
    let mut block = [line.as_mut_ptr() as usize, line.len()];
    // SAFETY: the block contains the address and length of a buffer. The result is 0 on success.
    let failed =
        unsafe { cortex_m_semihosting::syscall1(nr::GET_CMDLINE, block.as_mut_ptr() as usize) };
    let text = line.split(|byte| *byte == 0).next();
    failed == 0 && text.is_some_and(|text| text.ends_with(word))
}
