//! Whether the regulator holds the aircraft although it acts only once in a tick.

use super::Lqr;
use crate::config::TICK_PERIOD;
use crate::settings::Settings;
use crate::tuning::stability::{GAIN_MARGIN, MOST_GROWTH};
use crate::vehicle::{JacobianForm, Trim, linearize};
use nalgebra::SMatrix;

/// Motion, height and controls: `(v, theta, theta', gamma, z, T, delta_e)`.
type Joint = SMatrix<f64, 7, 7>;

/// Number of halvings of a tick, so that the series of the exponential converges quickly.
const HALVINGS: i32 = 4;
/// Terms of the series. With a sixteenth of a tick the rest is below 1e-9 for modes of up to 300 rad/s.
const TERMS: i32 = 6;
/// Number of squarings: the loop is looked at after `2^SQUARINGS` ticks, about 5 minutes.
const SQUARINGS: i32 = 15;

/// Whether the closed loop about level flight is stable when each command comes one tick late, at the
/// regulator's gain and at [`GAIN_MARGIN`] times the gain. Between two ticks the controls stand still. The
/// estimate is taken for the true motion, and the limits of the actuators do not count.
#[inline(never)]
pub(crate) fn holds(settings: &Settings, trim: &Trim, lqr: &Lqr) -> bool {
    let moves = sampled(&open(settings, trim));
    [1.0, GAIN_MARGIN]
        .iter()
        .all(|factor| decays(&closed(settings, &moves, lqr, *factor)))
}

/// The linear aircraft with constant controls.
fn open(settings: &Settings, trim: &Trim) -> Joint {
    let linear = linearize(
        &settings.airframe,
        &trim.state,
        trim.control,
        JacobianForm::Exact,
    );
    let mut open = Joint::zeros();
    open.fixed_view_mut::<4, 4>(0, 0).copy_from(&linear.a);
    open.fixed_view_mut::<4, 2>(0, 5).copy_from(&linear.b);
    // z' = v gamma
    open[(4, 3)] = trim.state.airspeed;
    open
}

/// The exponential of a tick.
fn sampled(open: &Joint) -> Joint {
    let piece = over(open, libm::exp2(f64::from(HALVINGS)) / TICK_PERIOD);
    let mut term = Joint::identity();
    let mut sum = term;
    for order in 1..=TERMS {
        term = over(&product(&term, &piece), f64::from(order));
        sum = plus(&sum, &term);
    }
    for _ in 0..HALVINGS {
        sum = product(&sum, &sum);
    }
    sum
}

/// One tick with the regulator, whose gains are multiplied by a factor. The command that follows from the
/// state at the start of the tick acts from its end on.
fn closed(settings: &Settings, moves: &Joint, lqr: &Lqr, factor: f64) -> Joint {
    let mut answer = SMatrix::<f64, 2, 7>::zeros();
    answer[(0, 0)] = -settings.airspeed_hold;
    answer.fixed_view_mut::<1, 4>(1, 0).copy_from(&-lqr.gain);
    // The reference turns down by `cross_track` for each metre above the path.
    answer[(1, 4)] = -settings.cross_track * (lqr.gain[1] + lqr.gain[3]);
    let mut closed = *moves;
    closed
        .fixed_view_mut::<2, 7>(5, 0)
        .copy_from(&(answer * factor));
    closed
}

/// Whether no motion of the loop grows faster than by [`MOST_GROWTH`] a tick.
fn decays(closed: &Joint) -> bool {
    let mut power = over(closed, MOST_GROWTH);
    for _ in 0..SQUARINGS {
        power = product(&power, &power);
        if power.norm() < 1e-6 {
            return true;
        }
    }
    // A number that is not finite is not below any bound.
    false
}

/// The product of two matrices.
// This and the next two are not inlined, because the image would hold several copies of each.
#[inline(never)]
fn product(left: &Joint, right: &Joint) -> Joint {
    left * right
}

#[inline(never)]
fn plus(left: &Joint, right: &Joint) -> Joint {
    left + right
}

#[inline(never)]
fn over(matrix: &Joint, divisor: f64) -> Joint {
    let mut quotient = *matrix;
    quotient.iter_mut().for_each(|value| *value /= divisor);
    quotient
}
