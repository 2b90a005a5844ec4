//! What a page needs of a flight, small: columns as whole multiples of a unit, each as its step from the one before,
//! all of it through gzip.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use mpp_sim::entries::{Columns, PlanEntry};
use mpp_sim::field::{Field, ObstacleField};
use mpp_sim::inspector::PlanDetail;
use mpp_sim::log::{FlightLog, Header, LogError, Summary};
use mpp_sim::orders::{Order, OrderEntry};
use mpp_sim::scenario::Scenario;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;

/// Units of the columns: of lengths, speeds, thrust and elevator, and of angles \[rad\].
const FINE: f64 = 1e-4;
const ANGLE: f64 = 1e-4;

/// A flight as its page gets it.
#[derive(Serialize)]
pub(super) struct Packed<'a> {
    header: &'a Header,
    summary: &'a Summary,
    plans: &'a [PlanEntry],
    orders: &'a [OrderEntry],
    hash: String,
    details: Vec<PlanDetail>,
    closest: Option<Closest>,
    ticks: BTreeMap<&'static str, (f64, Steps)>,
}

/// A column in whole units: each value as its difference from the value before it.
type Steps = Vec<Option<i64>>;

/// The least distance to an obstacle.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Closest {
    /// Tick at whose beginning, or after which, the distance was least.
    pub(super) tick: usize,
    x: f64,
    z: f64,
    clearance: f64,
}

impl<'a> Packed<'a> {
    pub(super) fn of(log: &'a FlightLog, details: Vec<PlanDetail>) -> Result<Self, LogError> {
        Ok(Self {
            header: &log.header,
            summary: &log.summary,
            plans: &log.plans,
            orders: &log.orders,
            hash: log.hash()?,
            details,
            closest: closest(log),
            ticks: columns(&log.ticks),
        })
    }
}

/// The flights as text of 64 letters.
pub(super) fn packed(flights: &[Packed<'_>]) -> Result<String, LogError> {
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    let written = gzip.write_all(&serde_json::to_vec(flights)?);
    let bytes = written.and_then(|()| gzip.finish());
    Ok(BASE64_STANDARD.encode(bytes.map_err(serde_json::Error::io)?))
}

fn columns(ticks: &Columns) -> BTreeMap<&'static str, (f64, Steps)> {
    let known = |values: &[f64], unit: f64| (unit, steps(values.iter().copied().map(Some), unit));
    let perhaps =
        |values: &[Option<f64>], unit: f64| (unit, steps(values.iter().copied(), unit));
    BTreeMap::from([
        ("x", known(&ticks.x, FINE)),
        ("z", known(&ticks.z, FINE)),
        ("airspeed", known(&ticks.airspeed, FINE)),
        ("pitch", known(&ticks.pitch, ANGLE)),
        ("flight_path", known(&ticks.flight_path, ANGLE)),
        ("ref_x", perhaps(&ticks.ref_x, FINE)),
        ("ref_z", perhaps(&ticks.ref_z, FINE)),
        ("ref_airspeed", perhaps(&ticks.ref_airspeed, FINE)),
        ("ref_pitch", perhaps(&ticks.ref_pitch, ANGLE)),
        ("ref_flight_path", perhaps(&ticks.ref_flight_path, ANGLE)),
        ("thrust", known(&ticks.thrust, FINE)),
        ("elevator", known(&ticks.elevator, FINE)),
    ])
}

fn steps(values: impl Iterator<Item = Option<f64>>, unit: f64) -> Steps {
    let mut before = 0;
    let step = |value: f64| {
        let whole = (value / unit).round() as i64;
        let step = whole - before;
        before = whole;
        step
    };
    let mut step = step;
    values.map(|value| value.map(&mut step)).collect()
}

/// Where and when the flight came closest to an obstacle; `None` without obstacles.
pub(super) fn closest(log: &FlightLog) -> Option<Closest> {
    let clearance = log.summary.min_clearance?;
    let ticks = &log.ticks;
    let mut field = ObstacleField::new(log.header.field.obstacles());
    let mut orders = log.orders.iter().peekable();
    let mut least = (f64::INFINITY, 0);
    let places: Vec<_> = ticks.x.iter().copied().zip(ticks.z.iter().copied()).collect();
    for (tick, motion) in (0_u32..).zip(places.windows(2)) {
        while let Some(entry) = orders.next_if(|entry| entry.tick <= u64::from(tick)) {
            if let Order::Obstacles { field: added } = &entry.order {
                field.add(added.obstacles());
            }
        }
        field.move_to(Scenario::time(tick));
        let lasting = Scenario::time(1);
        let apart = field.clearance_of_motion(motion[0], motion[1], lasting) - log.header.body_radius;
        if apart < least.0 {
            least = (apart, tick as usize);
        }
    }
    // The log has no state after the last tick. What no other motion explains happened then.
    let tick = if least.0 > clearance + FINE {
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
    fn steps_add_up_to_the_values_and_gaps_stay_gaps() {
        let values = [Some(1.00004), None, Some(-2.00006), Some(-2.00006)];
        assert_eq!(
            steps(values.into_iter(), FINE),
            [Some(10_000), None, Some(-30_001), Some(0)]
        );
    }

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
        assert_eq!(
            closest(&log).unwrap().tick,
            log.ticks.t.len() - 1
        );
    }
}
