//! Traps: what happens when the processor cannot go on with an instruction, or when the watchdog barks.
//!
//! A trap of the planner's thread drops the thread, and starts it anew; the step flies on. A trap anywhere
//! else resets the core. Cause, address and number are kept in memory that survives the reset, and the step
//! tells them over the link. After [`MOST`] faults in a row the planner is not started any more until the
//! power goes off, and the step flies on without plans.

use core::arch::global_asm;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use cortex_m::peripheral::SCB;
use hil_protocol::{CoreFault as Fault, CoreTask as Task, RejectionCause};

/// Number of faults in a row after which the planner stays off. The first two may be upsets of the memory,
/// which a restart repairs. A third is a defect that comes again and again.
pub const MOST: u32 = 3;

// The stack may be the cause of the trap, and nothing on it is needed any more: the handler takes the
// address of the trap from it, if it lies on it, and then begins at its top. The protection unit is off in
// these handlers. `trapped` returns only if the planner alone is dropped; PendSV does that.
global_asm!(
    ".global HardFault",
    ".type HardFault, %function",
    ".global NonMaskableInt",
    ".type NonMaskableInt, %function",
    ".thumb_func",
    "NonMaskableInt:",
    ".thumb_func",
    "HardFault:",
    "mov r0, lr",
    "mov r1, #0",
    "mrs r2, msp",
    "ldr r3, =_stack_end",
    "cmp r2, r3",
    "blo 1f",
    "ldr r3, =_stack_start",
    "sub r3, r3, #32",
    "cmp r2, r3",
    "bhi 1f",
    "ldr r1, [r2, #24]",
    "1:",
    "ldr r3, =_stack_start",
    "msr msp, r3",
    "mrs r2, ipsr",
    "bl trapped",
    "b PendSV",
    ".ltorg",
    ".size HardFault, . - HardFault",
);

/// Configurable, hard fault status registers, and address of the memory fault.
const CFSR: *mut u32 = 0xE000_ED28 as *mut u32;
const HFSR: *mut u32 = 0xE000_ED2C as *mut u32;
const MMFAR: *mut u32 = 0xE000_ED34 as *mut u32;

/// Number of the exception that the watchdog raises.
const WATCHDOG: u32 = 2;
/// Bit of the return code of an exception: it came in thread mode.
const THREAD: u32 = 1 << 3;

/// Bits of CFSR: a fault while the processor stacked registers for a handler.
const STACKING: u32 = 1 << 4 | 1 << 5 | 1 << 12 | 1 << 13;
const ADDRESS_VALID: u32 = 1 << 7;
const MEMORY: u32 = 0xFF;
const BUS: u32 = 0xFF << 8;
const USAGE: u32 = 0xFFFF << 16;

/// The last fault. It survives a reset, and means nothing unless its check is right.
#[unsafe(link_section = ".uninit.trap")]
static RECORD: Record = Record {
    what: AtomicU32::new(0),
    address: AtomicU32::new(0),
    count: AtomicU32::new(0),
    told: AtomicU32::new(0),
    check: AtomicU32::new(0),
};

/// Whether the thread has become the planner's. Before this the thread sets the image up.
static PLANNING: AtomicBool = AtomicBool::new(false);

struct Record {
    /// Task and fault.
    what: AtomicU32,
    address: AtomicU32,
    /// Number of faults in a row.
    count: AtomicU32,
    /// Whether the fault was told over the link.
    told: AtomicU32,
    check: AtomicU32,
}

impl Record {
    fn sum(&self) -> u32 {
        [&self.what, &self.address, &self.count, &self.told]
            .iter()
            .fold(0x5EED_F00D_u32, |sum, word| {
                (sum ^ word.load(Ordering::Relaxed))
                    .wrapping_mul(0x9E37_79B1)
                    .rotate_left(15)
            })
    }

    fn is_valid(&self) -> bool {
        self.check.load(Ordering::Relaxed) == self.sum()
    }

    fn count(&self) -> u32 {
        if self.is_valid() {
            self.count.load(Ordering::Relaxed)
        } else {
            0
        }
    }

    fn write(&self, what: u32, address: u32, count: u32, told: bool) {
        self.what.store(what, Ordering::Relaxed);
        self.address.store(address, Ordering::Relaxed);
        self.count.store(count, Ordering::Relaxed);
        self.told.store(u32::from(told), Ordering::Relaxed);
        self.check.store(self.sum(), Ordering::Relaxed);
    }
}

/// Records a fault.
pub fn record(task: Task, fault: Fault, address: u32) {
    let what = (task as u32) << 8 | fault as u32;
    RECORD.write(what, address, RECORD.count().saturating_add(1), false);
}

/// The recorded fault, if it was not told yet. It counts as told from now on.
#[must_use]
pub fn untold() -> Option<RejectionCause> {
    if !RECORD.is_valid() || RECORD.told.load(Ordering::Relaxed) != 0 {
        return None;
    }
    let (what, count) = (RECORD.what.load(Ordering::Relaxed), RECORD.count());
    let address = RECORD.address.load(Ordering::Relaxed);
    RECORD.write(what, address, count, true);
    Some(RejectionCause::Trapped {
        task: if what >> 8 == Task::Planner as u32 {
            Task::Planner
        } else {
            Task::Step
        },
        fault: fault_of(what & 0xFF),
        address,
        count: count as u8,
    })
}

fn fault_of(number: u32) -> Fault {
    [
        Fault::Stack,
        Fault::Memory,
        Fault::Bus,
        Fault::Instruction,
        Fault::Hang,
    ]
    .into_iter()
    .find(|fault| *fault as u32 == number)
    .unwrap_or(Fault::Other)
}

/// Whether there were so many faults in a row that the planner stays off.
#[must_use]
pub fn planner_stays_off() -> bool {
    RECORD.count() >= MOST
}

/// Forgets the faults so far, because the core has run well for a while since.
pub fn forget() {
    if (1..MOST).contains(&RECORD.count()) {
        RECORD.write(0, 0, 0, true);
    }
}

/// Records that the planner hung. The step tells it.
pub fn record_hang() {
    record(Task::Planner, Fault::Hang, 0);
    let _ = untold();
}

/// Says that from now on a trap in thread mode is one of the planner.
pub fn planner_runs() {
    PLANNING.store(true, Ordering::Relaxed);
}

/// Continues the handler. It returns if the planner's thread alone is to be dropped, and otherwise resets
/// the core.
#[unsafe(no_mangle)]
extern "C" fn trapped(exception_return: u32, address: u32, exception: u32) {
    // The watchdog barks if the step does not run, whoever holds the processor.
    if exception == WATCHDOG {
        record(Task::Step, Fault::Hang, address);
        SCB::sys_reset();
    }
    if exception_return & THREAD != 0 && PLANNING.load(Ordering::Relaxed) {
        record(Task::Planner, fault(), address);
    } else {
        record(Task::Step, fault(), address);
        SCB::sys_reset();
    }
}

/// The fault that the processor's registers tell, which this function clears.
fn fault() -> Fault {
    unsafe extern "C" {
        static _stack_end: u32;
        static _flash_end: u32;
    }
    // SAFETY: the registers exist on every Cortex-M7. A write of ones clears the bits that are set.
    let (status, at) = unsafe {
        let status = CFSR.read_volatile();
        let at = MMFAR.read_volatile();
        CFSR.write_volatile(status);
        HFSR.write_volatile(HFSR.read_volatile());
        (status, at)
    };
    let below_stack = status & ADDRESS_VALID != 0 && at < (&raw const _stack_end) as u32;
    // Flash lies below the stack too, and is allowed to read.
    let below_stack = below_stack && at >= (&raw const _flash_end) as u32;
    if status & STACKING != 0 || below_stack {
        Fault::Stack
    } else if status & MEMORY != 0 {
        Fault::Memory
    } else if status & BUS != 0 {
        Fault::Bus
    } else if status & USAGE != 0 {
        Fault::Instruction
    } else {
        Fault::Other
    }
}
