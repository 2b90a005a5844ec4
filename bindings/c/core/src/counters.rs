//! The counters of events, by their place in what `mpp_counters` writes.

/// A counter of events: its place in what `mpp_counters` writes. Counters only grow, and a full one stays full.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MppCounter {
    /// Measured values of airspeed or pitch that were not finite.
    MeasurementsNotFinite = 0,
    /// Those that the sensor only repeated.
    MeasurementsFrozen = 1,
    /// Those that came later than the ones before.
    MeasurementsLate = 2,
    /// Those of a sensor that was not trusted.
    MeasurementsDistrusted = 3,
    /// Those that were too far from the estimate.
    MeasurementsGated = 4,
    /// Times between two steps that were longer than 0.5 s.
    TimeJumps = 5,
    /// Predictions that were not finite.
    PredictionsDiverged = 6,
    /// Positions with a value that was not finite, or with a negative standard deviation.
    PositionsNotFinite = 7,
    /// Positions that repeated the one before.
    PositionsHeld = 8,
    /// Positions that were too old, or older than the one before.
    PositionsLate = 9,
    /// Positions that were too far from the estimate.
    PositionsGated = 10,
    /// Positions from which the estimate began anew.
    PositionsRestarted = 11,
    /// Commands that were not finite; trim was commanded instead.
    CommandsNotFinite = 12,
    /// Commands of thrust that were limited.
    ThrustLimited = 13,
    /// Commands of the elevator that were limited.
    ElevatorLimited = 14,
    /// Cycles that gave a feasible plan.
    PlansFeasible = 15,
    /// Cycles without a plan, after which the last plan was kept.
    PlansKept = 16,
    /// Cycles that gave a plan that lacks margin.
    PlansLeastViolating = 17,
    /// Cycles without a plan, after which there was no last plan either.
    PlansTrimHold = 18,
    /// Cycles that the planner ended early because of a defect of the planner. Report one that is not 0.
    PlannerInconsistent = 19,
    /// Cycles whose best plan the gate refused.
    PlansRefused = 20,
    /// Cycles after which a path of the lattice was flown, because no plan passed the gate.
    PlansPursuit = 21,
    /// Cycles after which a reserve was flown, because no plan and no path passed the gate.
    PlansReserve = 22,
    /// Cycles in which nothing passed the gate.
    PlansLatest = 23,
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::MppCounter as C;
    use std::{format, string::String};

    #[test]
    fn every_counter_has_its_name_and_place() {
        let all = [
            C::MeasurementsNotFinite,
            C::MeasurementsFrozen,
            C::MeasurementsLate,
            C::MeasurementsDistrusted,
            C::MeasurementsGated,
            C::TimeJumps,
            C::PredictionsDiverged,
            C::PositionsNotFinite,
            C::PositionsHeld,
            C::PositionsLate,
            C::PositionsGated,
            C::PositionsRestarted,
            C::CommandsNotFinite,
            C::ThrustLimited,
            C::ElevatorLimited,
            C::PlansFeasible,
            C::PlansKept,
            C::PlansLeastViolating,
            C::PlansTrimHold,
            C::PlannerInconsistent,
            C::PlansRefused,
            C::PlansPursuit,
            C::PlansReserve,
            C::PlansLatest,
        ];
        assert_eq!(all.map(name), hil_protocol::HealthReport::NAMES);
        assert!(
            (0..)
                .zip(all)
                .all(|(place, counter)| counter as usize == place)
        );
    }

    /// The variant's name in small letters, with bars between the words.
    fn name(counter: C) -> String {
        let mut name = String::new();
        for letter in format!("{counter:?}").chars() {
            if letter.is_ascii_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.push(letter.to_ascii_lowercase());
        }
        name
    }
}
