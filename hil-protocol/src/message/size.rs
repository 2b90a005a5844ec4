//! The greatest number of bytes that postcard needs for one value of a type.

use mpp_data::Airframe;

/// Size of a `bool`, and of the variant of an enum with at most 128 variants.
pub(crate) const BYTE: usize = 1;
/// Size of a `u16`: each byte holds seven bits. The length of a list below 2^14 needs two bytes.
pub(crate) const U16: usize = 3;
/// Size of a `u32`.
pub(crate) const U32: usize = 5;
/// Size of a `u64`.
pub(crate) const U64: usize = 10;
/// Size of an `f32`.
pub(crate) const F32: usize = 4;
/// Size of an `f64`.
pub(crate) const F64: usize = 8;

/// Size of an `Aircraft`: airframe, cruise, body and stall.
pub(crate) const AIRCRAFT: usize = (Airframe::COUNT + 2) * F64 + (BYTE + F64);
/// Size of `ActuatorLimits`.
pub(crate) const ACTUATOR_LIMITS: usize = 5 * (BYTE + F64) + 2 * F64;
