//! What `fly --verbose` says of a flight: what is flown, and what became of its plans.

use mpp_sim::faults::Faults;
use mpp_sim::log::FlightLog;
use mpp_sim::scenario::{Scenario, TICK_MS};
use std::collections::BTreeMap;

/// The conditions of a flight that is about to begin.
pub(super) fn flown_conditions(scenario: &Scenario) -> String {
    let Scenario {
        lidar, navigation, ..
    } = scenario;
    let slices = match scenario.slices_per_tick {
        u32::MAX => "all slices in one tick".to_owned(),
        slices => format!("{slices} slices in a tick"),
    };
    let scene = scenario
        .scene
        .map_or(String::new(), |scene| format!(", scene {scene}"));
    let faults = if scenario.faults == Faults::default() {
        "none".to_owned()
    } else {
        serde_json::to_string(&scenario.faults).unwrap_or_default()
    };
    format!(
        "aircraft {}, lengths of the world x {:.3}\n\
         generator {}{scene}, {} random and {} placed obstacles\n\
         lidar: {} beams over {:.0} deg, {:.1} m\n\
         navigation: {:.0} Hz, {} ms late, errors {} m white and {} m wandering\n\
         replans: {} Hz, plans are flown {} ms after their scan, {slices}\n\
         duration {} s, faults and disturbances: {faults}",
        scenario.aircraft.file.name,
        scenario.world_scale,
        scenario.generator.name,
        scenario.obstacles,
        scenario.placed.len(),
        lidar.beams,
        lidar.field_of_view.to_degrees(),
        lidar.range_max,
        100.0 / f64::from(navigation.period_ticks),
        navigation.delay_ticks * TICK_MS,
        navigation.sigma,
        navigation.wander,
        scenario.replan_hz(),
        scenario.latency_ticks * TICK_MS,
        scenario.duration(),
    )
}

/// The verdicts of a flight's plans, the causes of its rejections, and its extremes.
pub(super) fn told_plans(log: &FlightLog) -> String {
    let verdicts = counted(log.plans.iter().map(|plan| plan.outcome.as_str()));
    let causes = counted(log.rejections.iter().map(|entry| entry.cause.as_str()));
    let sensors = counted(log.sensors.iter().map(|entry| entry.sensor.as_str()));
    format!(
        "plans by verdict: {verdicts}\nrejections by cause: {causes}\nchanges of trust by sensor: {sensors}\n\
         {:.1} m downrange, {:.2} m at most from the initial altitude",
        log.summary.x_end, log.summary.max_altitude_deviation
    )
}

/// How often each name comes, such as `Optimal 18, KeptPrevious 2`.
fn counted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut counts = BTreeMap::new();
    for name in names {
        *counts.entry(name).or_insert(0_u32) += 1;
    }
    let parts: Vec<String> = counts
        .iter()
        .map(|(name, count)| format!("{name} {count}"))
        .collect();
    if parts.is_empty() {
        "none".to_owned()
    } else {
        parts.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_counted_in_order() {
        assert_eq!(counted(["b", "a", "b"].into_iter()), "a 1, b 2");
        assert_eq!(counted([].into_iter()), "none");
    }
}
