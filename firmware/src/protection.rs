//! The memory protection unit. What no region allows traps: a write to code and constants, execution from
//! RAM, and every access elsewhere. The stack lies at the beginning of RAM, so that one that grows too large
//! leaves all regions, whatever the size of its last frame.

use cortex_m::peripheral::MPU;

/// A region: its start, the logarithm of its size, and its rights.
pub struct Region {
    start: u32,
    log_size: u32,
    rights: u32,
}

impl Region {
    /// Code and constants.
    #[must_use]
    pub const fn code(start: u32, log_size: u32) -> Self {
        Self {
            start,
            log_size,
            rights: READ | NORMAL,
        }
    }

    /// Memory for data.
    #[must_use]
    pub const fn data(start: u32, log_size: u32) -> Self {
        Self {
            start,
            log_size,
            rights: WRITE | NORMAL | NEVER_EXECUTE,
        }
    }

    /// Registers of the board.
    #[must_use]
    pub const fn device(start: u32, log_size: u32) -> Self {
        Self {
            start,
            log_size,
            rights: WRITE | DEVICE | NEVER_EXECUTE,
        }
    }
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

/// Switches the protection on. It is off in the handlers of traps. `regions` has all that the image uses.
pub fn start(unit: &mut MPU, regions: &[Region]) {
    for (number, region) in regions.iter().enumerate() {
        // SAFETY: the regions contain all memory that the image uses, with the rights that it needs.
        unsafe {
            unit.rbar.write(region.start | WITH_NUMBER | number as u32);
            unit.rasr
                .write(region.rights | (region.log_size.wrapping_sub(1)) << 1 | ENABLE);
        }
    }
    // SAFETY: as above.
    unsafe { unit.ctrl.write(1) };
    cortex_m::asm::dsb();
    cortex_m::asm::isb();
}
