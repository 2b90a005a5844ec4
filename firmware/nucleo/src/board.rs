//! Supply, clocks, caches and watchdog of an STM32H743 on a Nucleo board. The sections are those of the reference
//! manual RM0433.

use cortex_m::peripheral::SCB;
use firmware::protection::Region;
use firmware::trap;
use hil_protocol::{CoreFault, CoreTask};
use stm32h7::stm32h743v::{FLASH, IWDG, PWR, Peripherals, RCC};

/// Frequency of the processor \[Hz\].
const CLOCK: u32 = 400_000_000;
/// Number of the processor's cycles in 10 ms.
pub const TICK: u32 = CLOCK / 100;

/// What the image may use: the regions of `memory.x`, the serial line in the second domain, and the watchdog in the
/// fourth.
pub const REGIONS: [Region; 5] = [
    Region::code(0x0800_0000, 21),
    Region::data(0x2000_0000, 17),
    Region::data(0x2400_0000, 19),
    Region::device(0x4000_0000, 16),
    Region::device(0x5800_0000, 16),
];

/// Looks at a state of the hardware before the board is reset. The slowest state takes a millisecond, which is less
/// than 100,000 looks.
const LOOKS: u32 = 1_000_000;
/// Prescaler 4 makes 8 kHz of the watchdog's 32 kHz; it resets the core if the core does not feed it for 100 ms.
const PATIENCE: u16 = 800;

/// Keys of the watchdog: write its registers, start, feed.
const UNLOCK: u16 = 0x5555;
const START: u16 = 0xCCCC;
const FEED: u16 = 0xAAAA;

/// The registers of the board.
fn registers() -> Peripherals {
    // SAFETY: this module and the serial line use different registers, and set them before any interrupt is enabled.
    unsafe { Peripherals::steal() }
}

/// Waits for the hardware. A board that does not become ready starts again.
fn wait(mut ready: impl FnMut() -> bool) {
    for _ in 0..LOOKS {
        if ready() {
            return;
        }
    }
    SCB::sys_reset();
}

/// Raises the processor to 400 MHz and switches its caches on.
pub fn start(core: &mut cortex_m::Peripherals) {
    let board = registers();
    supply(&board.PWR);
    clocks(&board.RCC, &board.FLASH);
    core.SCB.enable_icache();
    core.SCB.enable_dcache(&mut core.CPUID);
}

/// The board feeds the core from the linear regulator of the chip. Voltage scale 1 carries 400 MHz.
fn supply(power: &PWR) {
    // This register takes one write after power comes.
    power
        .cr3
        .modify(|_, w| w.scuen().clear_bit().ldoen().set_bit().bypass().clear_bit());
    wait(|| power.csr1.read().actvosrdy().bit_is_set());
    // SAFETY: 3 is voltage scale 1.
    power.d3cr.modify(|_, w| unsafe { w.vos().bits(3) });
    wait(|| power.d3cr.read().vosrdy().bit_is_set());
}

/// The internal oscillator of 64 MHz, by 4, times 50, by 2, is 400 MHz. The bus of the memories runs at half of it, and
/// those of the peripherals at a quarter, 100 MHz.
fn clocks(clock: &RCC, flash: &FLASH) {
    clock
        .pllckselr
        .modify(|_, w| w.pllsrc().bits(0).divm1().bits(4));
    // The input is 8 to 16 MHz, the oscillator of the loop is the wide one, and only output P is on.
    clock.pllcfgr.modify(|_, w| {
        w.pll1rge().bits(3).pll1vcosel().bit(false);
        w.pll1fracen().bit(false).divp1en().bit(true);
        w.divq1en().bit(false).divr1en().bit(false)
    });
    // Each divider counts from 0.
    // SAFETY, here and below: the values are those of the manual for these frequencies.
    clock
        .pll1divr
        .modify(|_, w| unsafe { w.divn1().bits(50 - 1).divp1().bits(2 - 1) });
    clock.cr.modify(|_, w| w.pll1on().set_bit());
    wait(|| clock.cr.read().pll1rdy().bit_is_set());
    // 8 halves a bus, 4 halves it for its peripherals.
    clock
        .d1cfgr
        .modify(|_, w| unsafe { w.d1cpre().bits(0).hpre().bits(8).d1ppre().bits(4) });
    clock
        .d2cfgr
        .modify(|_, w| unsafe { w.d2ppre1().bits(4).d2ppre2().bits(4) });
    clock.d3cfgr.modify(|_, w| unsafe { w.d3ppre().bits(4) });
    // At 200 MHz and voltage scale 1 the flash takes two cycles more.
    flash
        .acr
        .modify(|_, w| unsafe { w.latency().bits(2).wrhighfreq().bits(2) });
    wait(|| flash.acr.read().latency().bits() == 2);
    clock.cfgr.modify(|_, w| unsafe { w.sw().bits(3) });
    wait(|| clock.cfgr.read().sws().bits() == 3);
}

/// Notes a reset by the watchdog, which leaves no place: the step hung.
pub fn note_watchdog() {
    let clock = registers().RCC;
    if clock.rsr.read().iwdg1rstf().bit_is_set() {
        trap::record(CoreTask::Step, CoreFault::Hang, 0);
    }
    clock.rsr.modify(|_, w| w.rmvf().set_bit());
}

/// Starts the watchdog. Nothing but a reset stops it.
pub fn start_watchdog() {
    let watchdog = registers().IWDG;
    key(&watchdog, START);
    key(&watchdog, UNLOCK);
    // 0 is prescaler 4.
    watchdog.pr.write(|w| w.pr().bits(0));
    watchdog.rlr.write(|w| w.rl().bits(PATIENCE));
    wait(|| watchdog.sr.read().bits() == 0);
    feed_watchdog();
}

/// Feeds the watchdog.
pub fn feed_watchdog() {
    key(&registers().IWDG, FEED);
}

fn key(watchdog: &IWDG, key: u16) {
    // SAFETY: the keys are those of the manual.
    watchdog.kr.write(|w| unsafe { w.key().bits(key) });
}
