//! Solves exported programs on an emulated Cortex-M7 and reports instructions by semihosting.
//!
//! QEMU with `-icount shift=0` takes one virtual nanosecond an instruction; SysTick runs at 25 MHz,
//! so a tick is 40 instructions.
#![no_std]
#![no_main]

use core::arch::asm;
use core::fmt::{self, Write};
use core::panic::PanicInfo;
use mpp_core::config::{DIRECTIONS, STAGES};
use mpp_core::corridor::Corridor;
use mpp_core::qp::{
    Bounds, Condensed, Dynamics, Penalty, Problem, Solution, Solver, StageModel, Status, Weights,
};
use nalgebra::{Matrix6, Matrix6x2};

type Real = f64;
const INFINITY: Real = Real::INFINITY;
const INSTRUCTIONS_PER_TICK: u32 = 40;

struct Program {
    a: [Real; 36],
    b: [Real; 12],
    control_weight: [Real; 2],
    terminal_weight: [Real; 1],
    initial: [Real; 6],
    target: [Real; 6],
    position_bounds: [Real; 152],
    thrust_reserve: [Real; 1],
    attitude: [Real; 4],
    penalty: [Real; 2],
}
include!(concat!(env!("OUT_DIR"), "/programs.rs"));

/// Control, reload and current value of SysTick.
const SYSTICK: *mut u32 = 0xE000_E010 as *mut u32;
/// Switches the FPU on.
const CPACR: *mut u32 = 0xE000_ED88 as *mut u32;

#[unsafe(link_section = ".vectors")]
#[used]
static VECTORS: (usize, unsafe extern "C" fn() -> !) = (0x2040_0000, reset);

#[unsafe(no_mangle)]
unsafe extern "C" fn reset() -> ! {
    // SAFETY: registers of this processor; no code that needs the FPU is inlined here.
    unsafe {
        CPACR.write_volatile(0xF << 20);
        asm!("dsb", "isb");
        SYSTICK.add(1).write_volatile(0xFF_FFFF);
        SYSTICK.add(2).write_volatile(0);
        SYSTICK.write_volatile(0b101);
    }
    run();
    exit(0x20026)
}

/// A semihosting call.
fn host(operation: u32, argument: u32) {
    // SAFETY: the debugger, here QEMU, serves it and returns.
    unsafe { asm!("bkpt 0xAB", inout("r0") operation => _, in("r1") argument) }
}

fn exit(reason: u32) -> ! {
    host(0x18, reason);
    loop {}
}

struct Host;

impl Write for Host {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            host(0x03, &raw const byte as u32);
        }
        Ok(())
    }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    let _ = writeln!(Host, "{info}");
    exit(0x20023)
}

/// Instructions of a call.
fn count(call: impl FnOnce()) -> u32 {
    // SAFETY: reading a counter.
    let now = || unsafe { SYSTICK.add(2).read_volatile() };
    let begin = now();
    call();
    (begin.wrapping_sub(now()) & 0xFF_FFFF) * INSTRUCTIONS_PER_TICK
}

/// Too large for the stack of a small machine; initialised at compile time.
static mut CONDENSED: Condensed = Condensed::new();
static mut VARYING: Condensed = Condensed::new();
static mut SOLVER: Solver = Solver::new();
static mut COUNTS: [[u32; 2048]; 3] = [[0; 2048]; 3];

#[inline(never)]
fn run() {
    // SAFETY: one thread, called once.
    let (condensed, varying, solver, counts) = unsafe {
        (&mut *(&raw mut CONDENSED), &mut *(&raw mut VARYING), &mut *(&raw mut SOLVER), &mut *(&raw mut COUNTS))
    };
    let mut solution = Solution::new();
    let (mut solved, mut infeasible) = (0, 0);
    for (index, program) in PROGRAMS.iter().enumerate() {
        let (model, weights, problem) = program.parts();
        let dynamics: [Dynamics; STAGES] = [model.dynamics(); STAGES];
        counts[0][index] = count(|| assert!(condensed.condense(&model, &weights).is_ok()));
        counts[1][index] = count(|| assert!(varying.condense_varying(&dynamics, &weights).is_ok()));
        let mut status = Status::NumericalFailure;
        counts[2][index] = count(|| {
            status = solver.solve(condensed, &problem);
            if status == Status::Optimal {
                status = solver.solution(condensed, &mut solution);
            }
        });
        solved += u32::from(status == Status::Optimal);
        infeasible += u32::from(status == Status::Infeasible);
    }
    let all = PROGRAMS.len();
    let _ = writeln!(Host, "{all} programs, {solved} optimal, {infeasible} infeasible; instructions:");
    for (name, counts) in ["condense", "condense_varying", "candidate"].iter().zip(counts) {
        let counts = &mut counts[..all];
        counts.sort_unstable();
        let [median, p99] = [50, 99].map(|percent| counts[(all * percent).div_ceil(100).max(1) - 1]);
        let _ = writeln!(Host, "{name:<17} median {median:>8}  p99 {p99:>8}  max {:>8}", counts[all - 1]);
    }
}

impl Program {
    fn parts(&self) -> (StageModel, Weights, Problem) {
        let model = StageModel {
            a: Matrix6::from_row_slice(&self.a),
            b: Matrix6x2::from_row_slice(&self.b),
            initial: Matrix6::identity(),
        };
        let weights = Weights { control: self.control_weight, terminal: self.terminal_weight[0] };
        let mut corridor = Corridor::new();
        for (ours, theirs) in corridor.bounds.iter_mut().zip(self.position_bounds.as_chunks::<DIRECTIONS>().0) {
            *ours = *theirs;
        }
        let mut bounds = Bounds::none();
        bounds.set_corridor(&corridor);
        bounds.set_thrust(self.thrust_reserve[0]);
        let [attack, path, least_attack, least_path] = self.attitude;
        if attack.is_finite() {
            bounds.set_attitude([attack, path], [least_attack, least_path]);
        }
        let [linear, quadratic] = self.penalty;
        let penalty = (quadratic > 0.0).then_some(Penalty { linear, quadratic });
        let problem = Problem { initial: self.initial, target: self.target, bounds, penalty, cost_limit: INFINITY };
        (model, weights, problem)
    }
}
