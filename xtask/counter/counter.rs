//! A plugin for QEMU's code generator that counts executed instructions between the marks of
//! `firmware/src/mark.rs`: `dbg #0` begins a region, `dbg #n` ends the innermost one as of kind n.
//! What an inner region took does not count for the outer one.
//!
//! Writes one line a region to the file given as `out=FILE`, in the order in which they ended: kind
//! and instructions; kinds in `skip=` are summed up only. Last come a line `unpaired`, the number of
//! marks without their other mark, and a line `total`.
//!
//! Built by `cargo xtask`: `rustc --crate-type cdylib`. The functions are those of version 1 of
//! QEMU's plugin interface, which the emulator exports.

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

#[unsafe(no_mangle)]
#[allow(non_upper_case_globals)]
pub static qemu_plugin_version: c_int = 1;

type Callback = extern "C" fn(c_uint, *mut c_void);

unsafe extern "C" {
    fn qemu_plugin_register_vcpu_tb_trans_cb(id: u64, callback: extern "C" fn(u64, *mut c_void));
    fn qemu_plugin_tb_n_insns(block: *const c_void) -> usize;
    fn qemu_plugin_tb_get_insn(block: *const c_void, index: usize) -> *mut c_void;
    fn qemu_plugin_insn_data(instruction: *const c_void) -> *const u8;
    fn qemu_plugin_insn_size(instruction: *const c_void) -> usize;
    fn qemu_plugin_register_vcpu_insn_exec_cb(
        instruction: *mut c_void,
        callback: Callback,
        flags: c_int,
        user: *mut c_void,
    );
    fn qemu_plugin_register_vcpu_insn_exec_inline(
        instruction: *mut c_void,
        operation: c_int,
        counter: *mut u64,
        add: u64,
    );
    fn qemu_plugin_register_atexit_cb(
        id: u64,
        callback: extern "C" fn(u64, *mut c_void),
        user: *mut c_void,
    );
}

/// Instructions executed. The emulator's generated code adds to it; only the emulated processor's thread runs that code.
static EXECUTED: AtomicU64 = AtomicU64::new(0);

struct State {
    out: Option<BufWriter<File>>,
    skipped: Vec<usize>,
    /// Of each open region: the count at its beginning, and what inner regions took.
    open: Vec<(u64, u64)>,
    /// Ends without a beginning.
    unpaired: usize,
}

static STATE: Mutex<State> = Mutex::new(State {
    out: None,
    skipped: Vec::new(),
    open: Vec::new(),
    unpaired: 0,
});

extern "C" fn mark(_: c_uint, kind: *mut c_void) {
    let executed = EXECUTED.load(Ordering::Relaxed);
    let kind = kind as usize;
    let Ok(mut state) = STATE.lock() else { return };
    if kind == 0 {
        state.open.push((executed, 0));
        return;
    }
    let Some((begin, inner)) = state.open.pop() else {
        state.unpaired += 1;
        return;
    };
    let all = executed - begin;
    if let Some(outer) = state.open.last_mut() {
        outer.1 += all;
    }
    if !state.skipped.contains(&kind)
        && let Some(out) = &mut state.out
    {
        let _ = writeln!(out, "{kind} {}", all - inner);
    }
}

extern "C" fn translate(_: u64, block: *mut c_void) {
    unsafe {
        for index in 0..qemu_plugin_tb_n_insns(block) {
            let instruction = qemu_plugin_tb_get_insn(block, index);
            // Not `== 4`: an instruction that ends two bytes before a page of 1 kB has the first half of
            // the next one behind it, because the emulator looks ahead there.
            if qemu_plugin_insn_size(instruction) >= 4 {
                let data = qemu_plugin_insn_data(instruction) as *const [u8; 4];
                // `dbg #n`: 0xF3AF 0x80Fn, each half little endian.
                if let [0xAF, 0xF3, low, 0x80] = data.read_unaligned()
                    && low & 0xF0 == 0xF0
                {
                    let kind = usize::from(low & 0x0F) as *mut c_void;
                    qemu_plugin_register_vcpu_insn_exec_cb(instruction, mark, 0, kind);
                }
            }
            qemu_plugin_register_vcpu_insn_exec_inline(instruction, 0, EXECUTED.as_ptr(), 1);
        }
    }
}

extern "C" fn finish(_: u64, _: *mut c_void) {
    let Ok(mut state) = STATE.lock() else { return };
    let unpaired = state.unpaired + state.open.len();
    if let Some(out) = &mut state.out {
        let _ = writeln!(out, "unpaired {unpaired}");
        let _ = writeln!(out, "total {}", EXECUTED.load(Ordering::Relaxed));
        let _ = out.flush();
    }
}

#[unsafe(no_mangle)]
pub extern "C" fn qemu_plugin_install(
    id: u64,
    _: *const c_void,
    count: c_int,
    arguments: *const *const c_char,
) -> c_int {
    let Ok(mut state) = STATE.lock() else {
        return 1;
    };
    for index in 0..count as usize {
        let text = unsafe { CStr::from_ptr(*arguments.add(index)) }.to_string_lossy();
        match text.split_once('=') {
            Some(("out", path)) => state.out = File::create(path).ok().map(BufWriter::new),
            Some(("skip", kinds)) => {
                state.skipped = kinds
                    .split(':')
                    .filter_map(|kind| kind.parse().ok())
                    .collect();
            }
            _ => {}
        }
    }
    if state.out.is_none() {
        eprintln!("counter: give out=FILE");
        return 1;
    }
    unsafe {
        qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
        qemu_plugin_register_atexit_cb(id, finish, std::ptr::null_mut());
    }
    0
}
