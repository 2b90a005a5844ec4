//! One flight on one page.

use super::detail::{Inspector, PlanDetail};
use super::page;
use crate::ground::{Again, Ground, Order, Refused};
use crate::link::PipeLink;
use crate::log::{FlightLog, LogError, ObstacleEntry};
use crate::run::{Moment, fly_with};
use crate::scenario::{AirframeName, Preset, Scenario, TICKS_PER_SECOND};
use crate::world::Obstacle;
use clap::ValueEnum;
use flight_node::parameters::Tuning;
use mpp_core::vehicle::VehicleState;
use serde::Serialize;

/// What the page is made of.
#[derive(Serialize)]
struct Data<'a> {
    log: &'a FlightLog,
    hash: String,
    details: &'a [PlanDetail],
}

/// The page of a flight, and whether it shows what the planner considered: for that the flight is
/// flown again, and only if it comes out the same to the last byte.
///
/// # Errors
/// [`LogError`] when the log holds what cannot be written.
pub fn replay(log: &FlightLog) -> Result<(String, bool), LogError> {
    let details = details(log).unwrap_or_default();
    let data = Data {
        log,
        hash: log.hash()?,
        details: &details,
    };
    Ok((page(&serde_json::to_string(&data)?), !details.is_empty()))
}

/// The planning cycles of a flight; none if it cannot be flown again.
pub fn details(log: &FlightLog) -> Option<Vec<PlanDetail>> {
    let scenario = scenario(log)?;
    let witness = Witness {
        inspector: None,
        tuning: None,
        details: Vec::new(),
    };
    let mut again = Again::new(Some(log.orders.clone()), witness);
    let flown = fly_with(&scenario, &mut PipeLink::new(), &mut again).ok()?;
    (flown.hash().ok()? == log.hash().ok()?).then_some(again.ground.details)
}

/// The scenario that a log's header describes.
fn scenario(log: &FlightLog) -> Option<Scenario> {
    let header = &log.header;
    let preset = Preset::from_str(&header.preset, true).ok()?;
    let ticks = |seconds: f64| (seconds * f64::from(TICKS_PER_SECOND)).round() as u32;
    let mut scenario = Scenario {
        obstacles: header.obstacles,
        scene: header.scene,
        airframe: AirframeName::from_str(&header.airframe, true).ok()?,
        paths: u16::try_from(header.paths).ok()?,
        replan_ticks: ticks(1.0 / header.replan_hz),
        latency_ticks: ticks(header.latency),
        slices_per_tick: header.slices_per_tick.unwrap_or(u32::MAX),
        ticks: ticks(header.duration),
        lidar: header.lidar,
        air_data: header.air_data,
        faults: header.faults,
        ..Scenario::new(preset, header.seed)
    };
    // What stands in the field besides was placed there.
    let drawn = scenario.field().obstacles.len();
    let placed = header.field.iter().skip(drawn);
    scenario.placed = placed
        .map(|&ObstacleEntry { x, z, radius }| Obstacle { x, z, radius })
        .collect();
    Some(scenario)
}

/// Looks at every cycle of a flight.
struct Witness {
    inspector: Option<Inspector>,
    tuning: Option<Tuning>,
    details: Vec<PlanDetail>,
}

impl Ground for Witness {
    fn begin(&mut self, tuning: &Tuning, _: &VehicleState) {
        self.tuning = Some(*tuning);
    }

    fn settled(&mut self, _: &Order, _: Result<(), Refused>, tuning: &Tuning) {
        self.tuning = Some(*tuning);
    }

    fn watch(&mut self, moment: &Moment<'_>) {
        let Some(tuning) = &self.tuning else {
            return;
        };
        // Not before the first tick: until then any parameter may change.
        if self.inspector.is_none() {
            self.inspector = Inspector::new(tuning).ok();
        }
        let inspector = self.inspector.as_mut();
        self.details
            .extend(inspector.and_then(|inspector| inspector.look(moment, tuning)));
    }
}
