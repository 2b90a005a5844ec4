//! Tests that each parameter's value, alone, is refused or flown: level flight in still air stays level.

#![expect(clippy::expect_used, reason = "the helpers of tests fail as tests do")]

use mpp_core::config::TICK_PERIOD;
use mpp_core::settings::Cruise;
use mpp_core::vehicle::{Control, VehicleState};
use mpp_node::parameters::{PARAMETERS, Parameter, Tuning};
use mpp_sim::dynamics::{Aerodynamics, Dynamics};
use mpp_sim::flight::fly_in;
use mpp_sim::log::FlightLog;
use mpp_sim::navigation::NavigationConfig;
use mpp_sim::orders::{Ground, Order, Refused};
use mpp_sim::pipe::PipeLink;
use mpp_sim::plant::{Plant, PlantError};
use mpp_sim::scenario::{ALTITUDE, Preset, Scenario};
use mpp_sim::world::World;

/// Greatest pitch of level flight \[rad\], and greatest distance from its height \[m\].
const MOST: (f64, f64) = (std::f64::consts::FRAC_PI_4, 3.0);
/// Part of the way to another height that five seconds take at least \[m\].
const LEAST_WAY: f64 = 10.0;

/// A ground that sets one parameter before the flight.
struct Setter {
    order: Option<Order>,
    result: Option<Result<(), Refused>>,
}

impl Ground for Setter {
    fn orders(&mut self, _: u32) -> Vec<Order> {
        self.order.take().into_iter().collect()
    }

    fn settled(&mut self, _: &Order, result: Result<(), Refused>, _: &Tuning) {
        self.result = Some(result);
    }
}

/// The aircraft of the settings, which may start at another airspeed than the scenario's.
struct Body(Dynamics);

impl Plant for Body {
    fn state(&self) -> &VehicleState {
        &self.0.state
    }

    fn wind(&self) -> (f64, f64) {
        (0.0, 0.0)
    }

    fn step(&mut self, command: Control) -> Result<Control, PlantError> {
        self.0.step(command, TICK_PERIOD)?;
        Ok(command)
    }
}

/// Five seconds without obstacles, with one parameter set before; or the reason why the core refuses it.
fn flown(name: &str, value: f64) -> Result<FlightLog, Refused> {
    let scenario = Scenario {
        obstacles: 0,
        ticks: 500,
        // The parameters are on trial here, not the source of positions.
        navigation: NavigationConfig::IDEAL,
        ..Scenario::new(Preset::Flight, 1)
    };
    let mut ground = Setter {
        order: Some(Order::Parameter {
            name: name.to_owned(),
            value,
        }),
        result: None,
    };
    let settings = Preset::Flight.settings();
    let cruise = if name == "MPP_CRUISE_MS" {
        Cruise::Airspeed(value)
    } else {
        settings.cruise
    };
    let start = VehicleState {
        x: 0.0,
        z: ALTITUDE,
        air: cruise.trim(&settings.airframe).expect("it flies").state,
    };
    let mut world = World {
        plant: Box::new(Body(Dynamics {
            airframe: settings.airframe,
            more: Aerodynamics::NONE,
            state: start,
        })),
        ..World::of(&scenario).expect("it flies")
    };
    let log = fly_in(&mut world, &scenario, &mut PipeLink::new(), &mut ground)
        .expect("the flight has an end");
    ground.result.expect("the order was settled").map(|()| log)
}

/// Both ends of a range, and values between: five of them evenly and one of each order of magnitude.
fn values(parameter: &Parameter) -> Vec<f64> {
    let [least, most] = parameter.range;
    let step = parameter.step.unwrap_or(0.0);
    let even = (0..=6).map(|part| least + (most - least) * f64::from(part) / 6.0);
    let orders = (-9..=6).map(|power| 10.0_f64.powi(power));
    let mut values: Vec<_> = even
        .chain(orders.filter(|value| (least..=most).contains(value)))
        .map(|value| {
            if step > 0.0 {
                (value / step).round() * step
            } else {
                value
            }
        })
        .collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// Greatest pitch that a plan may have on the way to another height \[rad\]: its greatest flight path and angle of attack.
fn steepest() -> f64 {
    let settings = Preset::Flight.settings();
    let limits = settings
        .planner
        .plane()
        .expect("it is preset flight")
        .attitude;
    let trim = settings.cruise.trim(&settings.airframe).expect("it flies");
    limits.flight_path + limits.angle_of_attack + trim.state.angle_of_attack()
}

#[test]
fn every_value_of_a_parameter_is_refused_or_flown() {
    let (mut fallen, steepest) = (vec![], steepest());
    let (mut flights, mut refusals) = (0, 0);
    for parameter in &PARAMETERS {
        for value in values(parameter) {
            let log = match flown(parameter.name, value) {
                Ok(log) => log,
                Err(Refused::Parameter(_)) => {
                    refusals += 1;
                    continue;
                }
                Err(refused) => panic!("{}: {refused}", parameter.name),
            };
            flights += 1;
            let furthest = |values: &[f64], from: f64| {
                let off = values.iter().map(|value| (value - from).abs());
                off.fold(0.0, f64::max)
            };
            let pitch = furthest(&log.ticks.pitch, 0.0);
            let height = furthest(&log.ticks.z, ALTITUDE);
            // The aircraft is meant to leave its height for another one.
            let meant = parameter.name == "MPP_ALT_M" && (value - ALTITUDE).abs() > LEAST_WAY;
            // A planner with a slice a tick ends no cycle: what it offers instead may climb out of the band.
            let starved = parameter.name == "MPP_SLICES" && value < 2.0;
            let flies = if starved {
                pitch <= steepest
            } else if meant {
                pitch <= steepest && height >= LEAST_WAY
            } else {
                pitch <= MOST.0 && height <= MOST.1
            };
            if log.ticks.z.len() < 500 || !flies {
                fallen.push(format!(
                    "{} {value}: pitch {pitch:.2} height {height:.2} after {} ticks",
                    parameter.name,
                    log.ticks.z.len()
                ));
            }
        }
    }
    assert!(fallen.is_empty(), "{fallen:#?}");
    assert!(flights > 400 && refusals > 0, "{flights} {refusals}");
}
