//! The flight core for C. `bindings/c/include/mpp.h` is made from this crate; docs/c.md explains it.
//!
//! The caller gives the storage and owns the loop. No call uses a heap, blocks or panics. A null pointer, a
//! number that is out of range and a call at the wrong time get a code. A core may be used by one thread at a
//! time; the caller sees to that, as it sees to the size that pointers promise.
//!
#![no_std]
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "the texts stand in the header too, where a bracket needs no escape"
)]
#![expect(
    unsafe_code,
    reason = "a C interface takes pointers; each use says what the caller promises"
)]

mod flying;
mod status;
mod types;

use core::mem::{align_of, size_of};
pub use flying::MppCore;
pub use status::{MppStatus, mpp_text};
pub use types::{
    MPP_BEAMS, MPP_COUNTERS, MPP_KNOTS, MppAircraft, MppConfig, MppOutput, MppPlan, MppScan,
    MppSensors, MppState,
};

/// Alignment that the storage needs [bytes].
pub const MPP_ALIGNMENT: usize = 16;

const _: () = assert!(align_of::<MppCore>() <= MPP_ALIGNMENT);

/// Bytes that the storage of a core needs.
#[unsafe(no_mangle)]
pub extern "C" fn mpp_storage_size() -> usize {
    size_of::<MppCore>()
}

/// Makes a core in the caller's storage, aligned to `MPP_ALIGNMENT`. The storage must stay where it is for as
/// long as the core is used. A core needs no end; the storage is free when nobody uses it.
///
/// # Safety
/// `storage` is null or points to `size` bytes that nobody else uses; `made` is null or points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_init(
    storage: *mut core::ffi::c_void,
    size: usize,
    made: *mut *mut MppCore,
) -> MppStatus {
    if storage.is_null() || made.is_null() {
        return MppStatus::Null;
    }
    if size < size_of::<MppCore>() {
        return MppStatus::Storage;
    }
    let place = storage.cast::<MppCore>();
    if !storage.addr().is_multiple_of(MPP_ALIGNMENT) {
        return MppStatus::Alignment;
    }
    // SAFETY: the storage is large enough, aligned, and by the caller's promise nobody else's; `made` points to
    // a pointer.
    unsafe {
        MppCore::write_to(place);
        made.write(place);
    }
    MppStatus::Ok
}

/// Writes the usual configuration: the reference aircraft, the paper's lidar, 25 paths.
///
/// # Safety
/// `config` is null or points to a configuration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_usual(config: *mut MppConfig) -> MppStatus {
    // SAFETY: the caller's promise.
    match unsafe { config.as_mut() } {
        Some(config) => {
            *config = MppConfig::USUAL;
            MppStatus::Ok
        }
        None => MppStatus::Null,
    }
}

/// Sets the core up, or anew, for a flight that begins with its next step. A refused configuration leaves it
/// without one.
///
/// # Safety
/// `core` is null or comes from `mpp_init`; `config` is null or points to a configuration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_set_up(core: *mut MppCore, config: *const MppConfig) -> MppStatus {
    // SAFETY: the caller's promises.
    let (Some(core), Some(config)) = (unsafe { core.as_mut() }, unsafe { config.as_ref() }) else {
        return MppStatus::Null;
    };
    core.set_up(config)
}

/// Makes the 100 Hz step at a time [s], which grows by 0.01 from step to step.
///
/// # Safety
/// `core` is null or comes from `mpp_init`; the others are null or point to their values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_step(
    core: *mut MppCore,
    time: f64,
    sensors: *const MppSensors,
    output: *mut MppOutput,
) -> MppStatus {
    // SAFETY: the caller's promises.
    let all = unsafe { (core.as_mut(), sensors.as_ref(), output.as_mut()) };
    let (Some(core), Some(sensors), Some(output)) = all else {
        return MppStatus::Null;
    };
    given(core.step(time, sensors), output)
}

/// Begins a planning cycle from a scan and the estimate of the last step.
///
/// # Safety
/// `core` is null or comes from `mpp_init`; `scan` is null or points to a scan whose `ranges` are null or `count`
/// numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_begin(core: *mut MppCore, scan: *const MppScan) -> MppStatus {
    // SAFETY: the caller's promises.
    let (Some(core), Some(scan)) = (unsafe { core.as_mut() }, unsafe { scan.as_ref() }) else {
        return MppStatus::Null;
    };
    if scan.ranges.is_null() {
        return MppStatus::Null;
    }
    if scan.count > MPP_BEAMS {
        return MppStatus::ScanLength;
    }
    // SAFETY: by the caller's promise there are `count` ranges; they are not many.
    let ranges = unsafe { core::slice::from_raw_parts(scan.ranges, scan.count) };
    let angles = [scan.angle_min, scan.angle_increment];
    given(core.begin(scan.age, angles, ranges), &mut ())
}

/// Begins a planning cycle without a scan, because the lidar is silent or its scans are refused: slow flight in the map that
/// earlier scans have left. Call it when a scan is late by a few ticks.
///
/// # Safety
/// `core` is null or comes from `mpp_init`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_begin_blind(core: *mut MppCore) -> MppStatus {
    // SAFETY: the caller's promise.
    let Some(core) = (unsafe { core.as_mut() }) else {
        return MppStatus::Null;
    };
    given(core.begin_blind(), &mut ())
}

/// Does one bounded slice of the cycle. `more` says whether there is another one to do.
///
/// # Safety
/// `core` is null or comes from `mpp_init`; `more` is null or points to a value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_advance(core: *mut MppCore, more: *mut bool) -> MppStatus {
    // SAFETY: the caller's promises.
    let (Some(core), Some(more)) = (unsafe { core.as_mut() }, unsafe { more.as_mut() }) else {
        return MppStatus::Null;
    };
    given(core.advance(), more)
}

/// Ends the cycle and takes its best plan over at a time [s]: that of the step that follows.
///
/// # Safety
/// `core` is null or comes from `mpp_init`; `plan` is null or points to a plan.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_finish(
    core: *mut MppCore,
    time: f64,
    plan: *mut MppPlan,
) -> MppStatus {
    // SAFETY: the caller's promises.
    let (Some(core), Some(plan)) = (unsafe { core.as_mut() }, unsafe { plan.as_mut() }) else {
        return MppStatus::Null;
    };
    given(core.finish(time), plan)
}

/// Writes the counters of events, in the order of `hil_protocol::HealthReport::NAMES`.
///
/// # Safety
/// `core` is null or comes from `mpp_init`; `counters` is null or points to `MPP_COUNTERS` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_counters(
    core: *const MppCore,
    counters: *mut [u32; MPP_COUNTERS],
) -> MppStatus {
    // SAFETY: the caller's promises.
    let (Some(core), Some(counters)) = (unsafe { core.as_ref() }, unsafe { counters.as_mut() })
    else {
        return MppStatus::Null;
    };
    given(core.counters(), counters)
}

/// Writes a result to its place.
fn given<T>(result: Result<T, MppStatus>, place: &mut T) -> MppStatus {
    match result {
        Ok(value) => {
            *place = value;
            MppStatus::Ok
        }
        Err(status) => status,
    }
}
