//! Solves exported programs on an emulated Cortex-M7 and reports instructions by semihosting.
//!
//! QEMU with `-icount shift=0` takes one virtual nanosecond an instruction; SysTick runs at 25 MHz,
//! so a tick is 40 instructions.
#![no_std]
#![no_main]

use core::arch::asm;
use core::fmt::{self, Write};
use core::panic::PanicInfo;
use mpp_core::corridor::Corridor;
use mpp_core::qp::{
    Bounds, Condensed, Dynamics, POSITION, Penalty, Problem, Solution, Solver, Status, Weights,
};
use nalgebra::{Matrix6, Matrix6x2};

type Real = f64;
const INFINITY: Real = Real::INFINITY;
include!(concat!(env!("OUT_DIR"), "/programs.rs"));

const INSTRUCTIONS_PER_TICK: u32 = 40;
/// Control, reload and current value of SysTick.
const SYSTICK: *mut u32 = 0xE000_E010 as *mut u32;
/// Switches the FPU on.
const CPACR: *mut u32 = 0xE000_ED88 as *mut u32;

/// First stack pointer, then where to start.
#[used]
#[unsafe(link_section = ".vectors")]
static VECTORS: (usize, unsafe extern "C" fn() -> !) = (0x2040_0000, reset);

#[unsafe(no_mangle)]
unsafe extern "C" fn reset() -> ! {
    // SAFETY: registers of this processor.
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
        text.bytes()
            .for_each(|byte| host(0x03, &raw const byte as u32));
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

static mut CONDENSED: Condensed = Condensed::new();
static mut VARYING: Condensed = Condensed::new();
static mut SOLVER: Solver = Solver::new();
static mut COUNTS: [[u32; PROGRAMS.len()]; 3] = [[0; PROGRAMS.len()]; 3];

/// Not inlined: the FPU is off where it is called from at first.
#[inline(never)]
#[expect(static_mut_refs, reason = "one thread")]
fn run() {
    // SAFETY: the only references, taken once.
    let (shared, varying, solver, counts) =
        unsafe { (&mut CONDENSED, &mut VARYING, &mut SOLVER, &mut COUNTS) };
    let mut solution = Solution::new();
    let (mut optimal, mut infeasible) = (0, 0);
    for (index, numbers) in PROGRAMS.iter().enumerate() {
        let (model, weights, problem) = program(numbers);
        let stages = [model; 18];
        counts[0][index] = count(|| assert!(shared.condense(&model, &weights).is_ok()));
        counts[1][index] = count(|| assert!(varying.condense_varying(&weights, |model| *model = stages).is_ok()));
        let mut status = Status::NumericalFailure;
        counts[2][index] = count(|| {
            status = solver.solve(shared, &problem);
            if status == Status::Optimal {
                status = solver.solution(shared, &mut solution);
            }
        });
        optimal += u32::from(status == Status::Optimal);
        infeasible += u32::from(matches!(status, Status::Infeasible | Status::TooDear));
    }
    let all = PROGRAMS.len();
    let _ = writeln!(
        Host,
        "{all} programs, {optimal} optimal, {infeasible} infeasible"
    );
    let bytes =
        size_of::<Condensed>() + size_of::<Solver>() + size_of::<Problem>() + size_of::<Solution>();
    let _ = writeln!(Host, "workspace, problem and solution: {bytes} bytes");
    let names = ["condense", "condense_varying", "candidate"];
    for (name, counts) in names.iter().zip(counts) {
        counts.sort_unstable();
        let [median, p99] = [50, 99].map(|part| counts[(all * part).div_ceil(100).max(1) - 1]);
        let mean = counts.iter().map(|count| u64::from(*count)).sum::<u64>() / all as u64;
        let max = counts[all - 1];
        let _ = writeln!(
            Host,
            "{name:<17} instructions: mean {mean:>8}  median {median:>8}  p99 {p99:>8}  max {max:>8}"
        );
    }
}

/// The next numbers of a program.
fn take<const N: usize>(rest: &mut &[Real]) -> [Real; N] {
    let (head, tail) = rest.split_first_chunk().expect("a whole program");
    *rest = tail;
    *head
}

fn program(mut rest: &[Real]) -> (Dynamics, Weights, Problem) {
    let rest = &mut rest;
    let model = Dynamics {
        motion: Matrix6::from_row_slice(&take::<36>(rest))
            .fixed_columns(POSITION)
            .into_owned(),
        b: Matrix6x2::from_row_slice(&take::<12>(rest)),
        ..Dynamics::at_rest()
    };
    let control = take(rest);
    let [terminal] = take(rest);
    let (initial, target) = (take(rest), take(rest));
    let mut corridor = Corridor::new();
    corridor.bounds.fill_with(|| take(rest));
    let mut bounds = Bounds::none();
    bounds.set_corridor(&corridor);
    bounds.set_thrust(take(rest));
    let [attack, path, least_attack, least_path] = take(rest);
    if attack < INFINITY {
        bounds.set_attitude([attack, path], [least_attack, least_path]);
    }
    let [linear, quadratic] = take(rest);
    let problem = Problem {
        initial,
        target,
        bounds,
        penalty: (linear < INFINITY).then_some(Penalty { linear, quadratic }),
        hard_angle_of_attack: [false; 2],
        cost_limit: INFINITY,
    };
    (model, Weights { control, terminal }, problem)
}
