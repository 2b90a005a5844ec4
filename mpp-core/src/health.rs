//! Counters of rejected inputs, limited commands and results of planning cycles. The counters only grow,
//! so a ground station reads their changes.

/// One counter for each cause. A full counter stays at its maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Health {
    /// Measured values that were not finite.
    pub measurements_not_finite: u32,
    /// Measured values that the sensor only repeated.
    pub measurements_frozen: u32,
    /// Measured values that came later than the ones before.
    pub measurements_late: u32,
    /// Measured values of a sensor that was not trusted.
    pub measurements_distrusted: u32,
    /// Measured values beyond the innovation gate.
    pub measurements_gated: u32,
    /// Steps that came before the previous step, or later after it than the loop believes.
    pub time_jumps: u32,
    /// Predictions that were not finite. The filter kept its last estimate.
    pub predictions_diverged: u32,
    /// Positions that were not finite. The step moved the last position on.
    pub positions_not_finite: u32,
    /// Positions that repeated the one before. The loop moved the last one on.
    pub positions_held: u32,
    /// Positions that were older than the history or than the position before. The filter did not use them.
    pub positions_late: u32,
    /// Positions beyond the innovation gate. The filter did not use them.
    pub positions_gated: u32,
    /// Positions from which the filter restarted, after it had refused all positions for some time.
    pub positions_restarted: u32,
    /// Commands that were not finite. The step commanded trim instead.
    pub commands_not_finite: u32,
    /// Thrust commands outside the range of the motor. The step limited them to that range.
    pub thrust_limited: u32,
    /// Elevator commands beyond the elevator's range or rate. The step limited them to range and rate.
    pub elevator_limited: u32,
    /// Cycles that gave a feasible trajectory.
    pub plans_feasible: u32,
    /// Cycles that gave no trajectory, after which the vehicle continued the last trajectory.
    pub plans_kept: u32,
    /// Cycles whose best trajectory was not feasible. The vehicle flew this least-violating trajectory.
    pub plans_least_violating: u32,
    /// Cycles that gave no trajectory, while there was also no last trajectory to continue.
    pub plans_trim_hold: u32,
    /// Cycles that the planner ended early, because its phase and its workspace did not belong together. More than 0 is a
    /// defect of the planner.
    pub planner_inconsistent: u32,
    /// Cycles whose plan with the lowest price the gate refused.
    pub plans_refused: u32,
    /// Cycles after which the vehicle flew a path of the lattice by pursuit, because no plan passed the gate.
    pub plans_pursuit: u32,
    /// Cycles after which the vehicle flew a reserve, because no plan and no path passed the gate.
    pub plans_reserve: u32,
    /// Cycles in which nothing passed the gate. The vehicle flew what strikes latest.
    pub plans_latest: u32,
}

impl Health {
    /// The counters, in the order of the fields.
    #[must_use]
    pub const fn counters(&self) -> [u32; 24] {
        [
            self.measurements_not_finite,
            self.measurements_frozen,
            self.measurements_late,
            self.measurements_distrusted,
            self.measurements_gated,
            self.time_jumps,
            self.predictions_diverged,
            self.positions_not_finite,
            self.positions_held,
            self.positions_late,
            self.positions_gated,
            self.positions_restarted,
            self.commands_not_finite,
            self.thrust_limited,
            self.elevator_limited,
            self.plans_feasible,
            self.plans_kept,
            self.plans_least_violating,
            self.plans_trim_hold,
            self.planner_inconsistent,
            self.plans_refused,
            self.plans_pursuit,
            self.plans_reserve,
            self.plans_latest,
        ]
    }

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
