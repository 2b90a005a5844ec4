//! The closest approach of a flight to an obstacle.

use mpp_sim::field::{Field, FieldFile, Obstacle, ObstacleField};
use mpp_sim::log::{FlightLog, Header};
use mpp_sim::orders::Order;
use mpp_sim::scenario::Scenario;
use serde::Serialize;

/// Distances that differ by less are the same \[m\].
const SAME: f64 = 1e-6;

/// The least distance to an obstacle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Closest {
    /// Tick at whose beginning, or after which, the distance was least.
    pub tick: u32,
    /// Downrange distance of the aircraft then \[m\].
    pub x: f64,
    /// Its height \[m\].
    pub z: f64,
    /// The distance \[m\]; negative inside an obstacle.
    pub clearance: f64,
}

/// Looks for the closest approach while a flight goes on.
pub struct Approach {
    field: ObstacleField,
    /// Obstacles that are there from the last place on.
    added: Vec<Obstacle>,
    body_radius: f64,
    /// The number of places so far, and the last of them \[m\].
    ticks: u32,
    last: Option<(f64, f64)>,
    nearest: Option<Closest>,
}

impl Approach {
    /// The approach at the start of a flight.
    #[must_use]
    pub fn new(header: &Header) -> Self {
        Self {
            field: ObstacleField::new(header.field.obstacles()),
            added: Vec::new(),
            body_radius: header.body_radius,
            ticks: 0,
            last: None,
            nearest: None,
        }
    }

    /// Adds obstacles that are there from the next place on.
    pub fn add(&mut self, field: &FieldFile) {
        self.added.extend(field.obstacles());
    }

    /// Takes the aircraft's place at the beginning of the next tick: downrange distance and height \[m\].
    pub fn reach(&mut self, place: (f64, f64)) {
        if let Some(last) = self.last {
            let tick = self.ticks - 1;
            self.field.move_to(Scenario::time(tick));
            let apart = self
                .field
                .clearance_of_motion(last, place, Scenario::time(1));
            let clearance = apart - self.body_radius;
            let least = (self.nearest.as_ref()).map_or(f64::INFINITY, |found| found.clearance);
            if clearance < least {
                let (x, z) = last;
                self.nearest = Some(Closest {
                    tick,
                    x,
                    z,
                    clearance,
                });
            }
        }
        self.field.add(std::mem::take(&mut self.added));
        self.last = Some(place);
        self.ticks += 1;
    }

    /// The number of places so far.
    #[must_use]
    pub fn ticks(&self) -> u32 {
        self.ticks
    }

    /// The closest approach so far; `None` without obstacles.
    #[must_use]
    pub fn nearest(&self) -> Option<&Closest> {
        self.nearest.as_ref()
    }
}

/// Where and when the flight came closest to an obstacle; `None` without obstacles.
#[must_use]
pub fn closest(log: &FlightLog) -> Option<Closest> {
    let clearance = log.summary.min_clearance?;
    let mut approach = Approach::new(&log.header);
    let mut orders = log.orders.iter().peekable();
    for (tick, (x, z)) in (0..).zip(log.ticks.x.iter().zip(&log.ticks.z)) {
        while let Some(entry) = orders.next_if(|entry| entry.tick <= tick) {
            if let Order::Obstacles { field } = &entry.order {
                approach.add(field);
            }
        }
        approach.reach((*x, *z));
    }
    // The log has no state after the last tick. What no other motion explains happened then.
    let last = || {
        let (x, z) = approach.last?;
        let tick = approach.ticks - 1;
        Some(Closest {
            tick,
            x,
            z,
            clearance,
        })
    };
    match approach.nearest {
        Some(found) if found.clearance <= clearance + SAME => Some(Closest { clearance, ..found }),
        _ => last(),
    }
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
        assert_eq!(closest(&log).unwrap().tick as usize, log.ticks.t.len() - 1);
    }
}
