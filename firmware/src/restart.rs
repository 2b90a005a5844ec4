//! Drops the planner's thread wherever it hangs, and starts it anew.
//!
//! PendSV has the lowest priority, so when it runs there is nothing on the stack but the thread's
//! frames and its own. It throws all of them away and returns, not to where the thread was, but to
//! its beginning.

use core::arch::global_asm;
use cortex_m::peripheral::SCB;

/// Restarts the planner's thread as soon as the step has ended. An image defines `planner_thread`.
pub fn planner() {
    SCB::set_pendsv();
}

global_asm!(
    ".global PendSV",
    ".type PendSV, %function",
    ".thumb_func",
    "PendSV:",
    // Registers of the FPU that were to be saved lazily for the thread are saved for nobody now:
    // clear FPCCR.LSPACT.
    "ldr r0, =0xE000EF34",
    "ldr r1, [r0]",
    "bic r1, r1, #1",
    "str r1, [r0]",
    // A frame of eight words at the very top: r0 to r3, r12, lr, pc, xpsr.
    "ldr r0, =_stack_start",
    "sub r0, r0, #32",
    "mvn r1, #0",
    "str r1, [r0, #20]",
    "ldr r1, =planner_thread",
    "bic r1, r1, #1",
    "str r1, [r0, #24]",
    "mov r1, #0x01000000",
    "str r1, [r0, #28]",
    "msr msp, r0",
    // Return to the thread, main stack, frame without FPU registers.
    "mvn lr, #6",
    "bx lr",
    ".ltorg",
    ".size PendSV, . - PendSV",
);
