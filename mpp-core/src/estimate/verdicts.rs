//! Counts what the filters say about each input.

use super::{MeasurementStatus, PositionVerdict};
use crate::health::Health;

/// Counts the verdict on an airspeed or a pitch.
pub(super) fn count_verdict(verdict: MeasurementStatus, health: &mut Health) {
    let counter = match verdict {
        MeasurementStatus::Accepted | MeasurementStatus::Missing => return,
        MeasurementStatus::Gated => &mut health.measurements_gated,
        MeasurementStatus::Frozen => &mut health.measurements_frozen,
        MeasurementStatus::NotFinite => &mut health.measurements_not_finite,
        MeasurementStatus::Late => &mut health.measurements_late,
        MeasurementStatus::Distrusted => &mut health.measurements_distrusted,
    };
    Health::count(counter);
}

/// Counts the verdict on a position.
pub(super) fn count_position(verdict: Option<PositionVerdict>, health: &mut Health) {
    let counter = match verdict {
        None | Some(PositionVerdict::Accepted) => return,
        Some(PositionVerdict::NotFinite) => &mut health.positions_not_finite,
        Some(PositionVerdict::Held) => &mut health.positions_held,
        Some(PositionVerdict::Late) => &mut health.positions_late,
        Some(PositionVerdict::Gated) => &mut health.positions_gated,
        Some(PositionVerdict::Restarted) => &mut health.positions_restarted,
    };
    Health::count(counter);
}
