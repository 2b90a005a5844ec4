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

mod aircraft;
mod counters;
mod flying;
mod refusal;
mod status;
mod types;

pub use aircraft::MppAircraft;
use core::mem::{align_of, size_of};
pub use counters::MppCounter;
pub use flying::MppCore;
pub use refusal::{MPP_TEXT, MppRefusal};
pub use status::{MppStatus, mpp_text};
pub use types::{
    MPP_BEAMS, MPP_COUNTERS, MPP_KNOTS, MppConfig, MppOutput, MppPlan, MppScan, MppSensors,
    MppState,
};

/// Alignment that the storage needs [bytes].
pub const MPP_ALIGNMENT: usize = 16;

const _: () = assert!(align_of::<MppCore>() <= MPP_ALIGNMENT);

/// The library's version, as `MPP_VERSION` is that of the header: "0.2.0".
#[unsafe(no_mangle)]
pub extern "C" fn mpp_version() -> *const core::ffi::c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

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
/// without one. If a number was out of its range, `mpp_refused` gives its name and range.
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

/// Writes which number `mpp_set_up` refused the last time, and the range that it must be in.
///
/// # Safety
/// `core` is null or comes from `mpp_init`; `refused` is null or points to its value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn mpp_refused(core: *const MppCore, refused: *mut MppRefusal) -> MppStatus {
    // SAFETY: the caller's promises.
    let (Some(core), Some(refused)) = (unsafe { core.as_ref() }, unsafe { refused.as_mut() })
    else {
        return MppStatus::Null;
    };
    given(Ok(core.refused()), refused)
}

/// Makes the 100 Hz step at a time [s], which grows by 0.01 from step to step.
///
/// A step never fails because of its sensors. It does not use values that are not finite, negative standard deviations, and
/// values that only repeat; it returns `MPP_STATUS_OK`, and `mpp_counters` tells of them.
///
/// A step drops the planning cycle that is under way if the estimates jump, because its plan no longer fits:
/// `output.cycle_dropped` is true then. `mpp_advance` and `mpp_finish` return `MPP_STATUS_IDLE` from then on, and the
/// next scan begins a new cycle.
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

/// Begins a planning cycle from a scan and the estimate of the last step. Its plan starts `latency_ticks` after that step.
///
/// Give each scan once. The core refuses one that is not newer than the last one, or whose returns repeat those of the last one to
/// the last bit, because the lidar is frozen then. It also refuses one while it does not know where the aircraft is, because the
/// time has jumped: `MPP_STATUS_LOST`.
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
/// earlier scans have left. Call it when a scan is late by a few ticks. It returns `MPP_STATUS_LOST` when `mpp_begin` does.
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

/// Ends the cycle and takes its best plan over at a time [s]: that of the step that follows. The plan starts `latency_ticks`
/// after the step before `mpp_begin`. Before that time the call returns `MPP_STATUS_EARLY`, and the cycle goes on; call it
/// again then.
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

/// Writes the counters of events. `mpp_counter` names their places.
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
