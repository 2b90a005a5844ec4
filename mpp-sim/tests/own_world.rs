//! Worlds of one's own, flown through the same door as the scenario's: another plant, another field.

use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::{Control, VehicleState};
use mpp_sim::aircraft::Aircraft;
use mpp_sim::dynamics::{Aerodynamics, Dynamics};
use mpp_sim::field::{Field, Obstacle, Point};
use mpp_sim::flight::{fly, fly_in};
use mpp_sim::inquest::Cause;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::Ground;
use mpp_sim::outcome::Outcome;
use mpp_sim::pipe::PipeLink;
use mpp_sim::plant::{Plant, PlantError};
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::world::World;

struct Nobody;

impl Ground for Nobody {}

fn scenario() -> Scenario {
    Scenario {
        ticks: 1000,
        obstacles: 0,
        ..Scenario::new(Preset::Flight, 3)
    }
}

fn flown(world: &mut World, scenario: &Scenario) -> FlightLog {
    fly_in(world, scenario, &mut PipeLink::of(scenario), &mut Nobody).unwrap()
}

/// An aircraft that an open hatch brakes, in still air and without limits of its actuators.
struct Hatch {
    body: Dynamics,
    /// Deceleration per squared airspeed [1/m].
    drag: f64,
}

impl Plant for Hatch {
    fn state(&self) -> &VehicleState {
        &self.body.state
    }

    fn wind(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn step(&mut self, command: Control) -> Result<Control, PlantError> {
        self.body.step(command, TICK_PERIOD)?;
        let airspeed = &mut self.body.state.air.airspeed;
        *airspeed -= self.drag * *airspeed * *airspeed * TICK_PERIOD;
        Ok(command)
    }
}

fn with_hatch(scenario: &Scenario, drag: f64) -> FlightLog {
    let body = Dynamics {
        airframe: scenario.aircraft.known.airframe,
        more: Aerodynamics::NONE,
        state: scenario.start().unwrap(),
    };
    let mut world = World {
        plant: Box::new(Hatch { body, drag }),
        ..World::of(scenario).unwrap()
    };
    flown(&mut world, scenario)
}

#[test]
fn a_plant_of_ones_own_is_flown() {
    let scenario = scenario();
    let usual = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
    let shut = with_hatch(&scenario, 0.0);
    assert_eq!(shut.hash().unwrap(), usual.hash().unwrap());

    let open = with_hatch(&scenario, 0.004);
    assert_eq!(open.summary.outcome, Outcome::Survived);
    let mean = |thrust: &[f64]| thrust.iter().sum::<f64>() / thrust.len() as f64;
    let (more, usual) = (mean(&open.ticks.thrust), mean(&usual.ticks.thrust));
    assert!(more > usual + 0.3, "{more} N against {usual} N");
}

/// The usual aircraft, whose equations leave their domain after some ticks.
struct Stopping {
    aircraft: Aircraft,
    ticks: u32,
}

impl Plant for Stopping {
    fn state(&self) -> &VehicleState {
        self.aircraft.state()
    }

    fn wind(&self) -> (f64, f64) {
        self.aircraft.wind()
    }

    fn step(&mut self, command: Control) -> Result<Control, PlantError> {
        let left = self.ticks.checked_sub(1);
        self.ticks = left.ok_or(PlantError::NonFiniteState)?;
        self.aircraft.step(command)
    }
}

/// Such a flight is lost, with a log and an outcome: a campaign goes on with the next one.
#[test]
fn a_plant_without_a_state_ends_its_flight_and_no_more() {
    let scenario = scenario();
    let aircraft = Aircraft::new(&scenario).unwrap();
    let mut world = World {
        plant: Box::new(Stopping {
            aircraft,
            ticks: 150,
        }),
        ..World::of(&scenario).unwrap()
    };
    let log = flown(&mut world, &scenario);
    assert_eq!(log.summary.outcome, Outcome::FlightPathLimit);
    assert_eq!(log.ticks.thrust.len(), 150);
    assert!(!log.summary.strict && log.summary.t_end > 1.49);
}

#[test]
fn the_scenarios_own_world_is_its_flight() {
    let mut scenario = Scenario {
        obstacles: 20,
        ticks: 500,
        ..Scenario::new(Preset::Flight, 2)
    };
    scenario.faults.gusts.intensity = 1.0;
    scenario.faults.lidar.dropouts = 0.05;
    let usual = fly(&scenario, &mut PipeLink::of(&scenario), |_| {}).unwrap();
    let mut world = World::of(&scenario).unwrap();
    world.plant = Box::new(Aircraft::new(&scenario).unwrap());
    assert_eq!(flown(&mut world, &scenario), usual);
}

/// Two level sheets, with the air between them: a field that no circle makes.
struct Canyon {
    floor: f64,
    ceiling: f64,
    /// Where it is closed, downrange \[m\].
    end: f64,
}

impl Field for Canyon {
    fn clearance_of_motion(&self, from: Point, to: Point, _lasting: f64) -> f64 {
        (from.1.min(to.1) - self.floor)
            .min(self.ceiling - from.1.max(to.1))
            .min(self.end - from.0.max(to.0))
    }

    fn range(&self, from: Point, direction: Point) -> Option<f64> {
        if self.clearance_of_motion(from, from, 0.0) < 0.0 {
            return Some(0.0);
        }
        let along = |distance: f64, speed: f64| (distance / speed).max(0.0);
        let sheets = [
            along(self.floor - from.1, direction.1.min(-1e-12)),
            along(self.ceiling - from.1, direction.1.max(1e-12)),
            along(self.end - from.0, direction.0.max(1e-12)),
        ];
        sheets.into_iter().reduce(f64::min)
    }

    fn obstacles(&self) -> &[Obstacle] {
        &[]
    }
}

fn through(canyon: Canyon) -> FlightLog {
    let scenario = scenario();
    let mut world = World {
        field: Box::new(canyon),
        ..World::of(&scenario).unwrap()
    };
    flown(&mut world, &scenario)
}

#[test]
fn a_field_of_ones_own_is_seen_and_flown_through() {
    let log = through(Canyon {
        floor: 45.0,
        ceiling: 53.0,
        end: f64::INFINITY,
    });
    assert_eq!(log.summary.outcome, Outcome::Survived);
    let clearance = log.summary.min_clearance.unwrap();
    assert!(clearance > 0.5 && clearance < 4.0, "{clearance} m");
    assert!(log.header.field.is_empty());
}

/// What is hit is no circle: the inquest has nothing to ask about, and says so.
#[test]
fn a_field_without_circles_can_be_hit() {
    let log = through(Canyon {
        floor: 20.0,
        ceiling: 80.0,
        end: 60.0,
    });
    assert_eq!(log.summary.outcome, Outcome::Collision);
    let failure = log.summary.failure.unwrap();
    assert_eq!(failure.plan_clearance, None);
    assert!(matches!(failure.cause, Cause::Hidden | Cause::NoPlan));
}
