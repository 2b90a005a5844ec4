//! Drops the planner's thread at any point where it hangs, and starts it anew.
//!
//! PendSV has the lowest priority, so when it runs the stack holds only the frames of the thread and its
//! own frame. It drops all of them, and returns to the beginning of the thread.

use core::arch::global_asm;
use cortex_m::peripheral::SCB;

/// Restarts the planner's thread as soon as the step has ended. Each image defines `planner_thread`.
pub fn planner() {
    SCB::set_pendsv();
}

global_asm!(
    ".global PendSV",
    ".type PendSV, %function",
    ".thumb_func",
    "PendSV:",
    // The lazy save of the FPU registers of the dropped thread must not happen any more: clear
    // FPCCR.LSPACT.
    "ldr r0, =0xE000EF34",
    "ldr r1, [r0]",
    "bic r1, r1, #1",
    "str r1, [r0]",
    // Write a frame of eight words at the top of the stack: r0 to r3, r12, lr, pc, xpsr.
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
    // Return to thread mode, on the main stack, with a frame without FPU registers.
    "mvn lr, #6",
    "bx lr",
    ".ltorg",
    ".size PendSV, . - PendSV",
);
