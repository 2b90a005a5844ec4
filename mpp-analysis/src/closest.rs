//! The closest approach of a flight to an obstacle.

use mpp_sim::field::{Field, ObstacleField};
use mpp_sim::log::FlightLog;
use mpp_sim::orders::Order;
use mpp_sim::scenario::Scenario;
use serde::Serialize;

/// Distances that differ by less are the same \[m\].
const SAME: f64 = 1e-6;

/// The least distance to an obstacle.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct Closest {
    /// Tick at whose beginning, or after which, the distance was least.
    pub(crate) tick: usize,
    /// Where the aircraft was then \[m\].
    pub(crate) x: f64,
    pub(crate) z: f64,
    /// The distance \[m\]; negative inside an obstacle.
    pub(crate) clearance: f64,
}

/// Where and when the flight came closest to an obstacle; `None` without obstacles.
pub(crate) fn closest(log: &FlightLog) -> Option<Closest> {
    let clearance = log.summary.min_clearance?;
    let ticks = &log.ticks;
    let mut field = ObstacleField::new(log.header.field.obstacles());
    let mut orders = log.orders.iter().peekable();
    let mut least = (f64::INFINITY, 0);
    let places: Vec<_> = ticks
        .x
        .iter()
        .copied()
        .zip(ticks.z.iter().copied())
        .collect();
    for (tick, motion) in (0_u32..).zip(places.windows(2)) {
        while let Some(entry) = orders.next_if(|entry| entry.tick <= u64::from(tick)) {
            if let Order::Obstacles { field: added } = &entry.order {
                field.add(added.obstacles());
            }
        }
        field.move_to(Scenario::time(tick));
        let lasting = Scenario::time(1);
        let apart =
            field.clearance_of_motion(motion[0], motion[1], lasting) - log.header.body_radius;
        if apart < least.0 {
            least = (apart, tick as usize);
        }
    }
    // The log has no state after the last tick. What no other motion explains happened then.
    let tick = if least.0 > clearance + SAME {
        places.len().checked_sub(1)?
    } else {
        least.1
    };
    let (x, z) = *places.get(tick)?;
    Some(Closest {
        tick,
        x,
        z,
        clearance,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mpp_sim::flight::fly;
    use mpp_sim::pipe::PipeLink;
    use mpp_sim::scenario::Preset;

    #[test]
    fn the_closest_approach_is_where_the_log_has_it() {
        let scenario = Scenario::new(Preset::Flight, 1);
        let log = fly(&scenario, &mut PipeLink::new(), |_| {}).unwrap();
        let found = closest(&log).unwrap();
        assert!(Some(found.clearance) == log.summary.min_clearance);
        let apart = |one: &mpp_sim::field::Obstacle| one.clearance((found.x, found.z), 0.0);
        let there = log.header.field.obstacles();
        let there = there.iter().map(apart).fold(f64::INFINITY, f64::min);
        // A tick is 0.12 m long.
        assert!((there - found.clearance).abs() < 0.13, "{there}");
    }

    #[test]
    fn a_collision_is_closest_at_its_end() {
        let mut log = fly(
            &Scenario::new(Preset::Flight, 1),
            &mut PipeLink::new(),
            |_| {},
        )
        .unwrap();
        log.summary.min_clearance = Some(-0.01);
        assert_eq!(closest(&log).unwrap().tick, log.ticks.t.len() - 1);
    }
}
