//! Counters of everything that was rejected, replaced or given up. They only ever grow; the ground
//! reads what changed.

/// One counter a cause; a full counter stays at its maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Health {
    /// Measured values that were not finite.
    pub measurements_not_finite: u32,
    /// Measured values beyond the innovation gate.
    pub measurements_gated: u32,
    /// Predictions that were not finite; the last estimate was kept.
    pub predictions_diverged: u32,
    /// Positions that were not finite; the last one was kept.
    pub positions_not_finite: u32,
    /// Positions that stood for more wind than is believed; the wind's estimate was kept.
    pub winds_refused: u32,
    /// Commands that were not finite; trim was commanded.
    pub commands_not_finite: u32,
    /// Thrust commands beyond what the motor gives, taken back to it.
    pub thrust_limited: u32,
    /// Elevator commands beyond its range or its rate, taken back to them.
    pub elevator_limited: u32,
    /// Cycles that gave a feasible trajectory.
    pub plans_feasible: u32,
    /// Cycles without one that flew on along the last trajectory.
    pub plans_kept: u32,
    /// Cycles without one that took the least-violating trajectory.
    pub plans_least_violating: u32,
    /// Cycles that had nothing to offer and no trajectory to keep.
    pub plans_trim_hold: u32,
}

impl Health {
    /// Adds one to a counter.
    pub(crate) fn count(counter: &mut u32) {
        *counter = counter.saturating_add(1);
    }
}

#[cfg(test)]
mod tests {
    use super::Health;

    #[test]
    fn counting_adds_one_to_its_counter_alone() {
        let mut health = Health::default();
        Health::count(&mut health.plans_kept);
        Health::count(&mut health.plans_kept);
        let expected = Health {
            plans_kept: 2,
            ..Health::default()
        };
        assert_eq!(health, expected);
    }

    #[test]
    fn a_full_counter_stays_full() {
        let mut health = Health {
            thrust_limited: u32::MAX - 1,
            ..Health::default()
        };
        for _ in 0..3 {
            Health::count(&mut health.thrust_limited);
            assert_eq!(health.thrust_limited, u32::MAX);
        }
    }
}
