//! The memory protection unit. What no region allows traps: a write to code and constants, execution from
//! RAM, and every access elsewhere. The stack lies at the beginning of RAM, so that one that grows too large
//! leaves all regions, whatever the size of its last frame.

use cortex_m::peripheral::MPU;

/// End of the flash.
pub const FLASH_END: u32 = 2 << 20;

/// A region: its start, the logarithm of its size, and its rights.
struct Region {
    start: u32,
    log_size: u32,
    rights: u32,
}

/// Bits of RASR. Access for privileged code: read and write, or read only.
const WRITE: u32 = 0b001 << 24;
const READ: u32 = 0b101 << 24;
const NEVER_EXECUTE: u32 = 1 << 28;
/// Type of the memory: normal and cached, or a device.
const NORMAL: u32 = 0b001_011 << 16;
const DEVICE: u32 = 0b000_001 << 16;
const ENABLE: u32 = 1;
/// Bit of RBAR: the register also has the region's number.
const WITH_NUMBER: u32 = 1 << 4;

/// The regions of `memory.x`, and the board's timer, UART and watchdog.
const REGIONS: [Region; 4] = [
    Region {
        start: 0,
        log_size: FLASH_END.ilog2(),
        rights: READ | NORMAL,
    },
    Region {
        start: 0x2000_0000,
        log_size: 17,
        rights: WRITE | NORMAL | NEVER_EXECUTE,
    },
    Region {
        start: 0x6000_0000,
        log_size: 19,
        rights: WRITE | NORMAL | NEVER_EXECUTE,
    },
    Region {
        start: 0x4000_0000,
        log_size: 16,
        rights: WRITE | DEVICE | NEVER_EXECUTE,
    },
];

/// Switches the protection on. It is off in the handlers of traps.
pub fn start(unit: &mut MPU) {
    for (number, region) in REGIONS.iter().enumerate() {
        // SAFETY: the regions contain all memory that the image uses, with the rights that it needs.
        unsafe {
            unit.rbar.write(region.start | WITH_NUMBER | number as u32);
            unit.rasr
                .write(region.rights | (region.log_size - 1) << 1 | ENABLE);
        }
    }
    // SAFETY: as above.
    unsafe { unit.ctrl.write(1) };
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}
