//! Normally distributed numbers.

use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::Rng;

/// A number with the standard deviation 1.
pub(crate) fn gaussian(random: &mut Pcg64Mcg) -> f64 {
    let mut uniform = || ((random.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64;
    (-2.0 * libm::log(uniform())).sqrt() * libm::cos(core::f64::consts::TAU * uniform())
}
