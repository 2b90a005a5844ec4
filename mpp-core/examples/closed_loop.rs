//! A closed loop: the 100 Hz step flies the aircraft back to its altitude, with one plan a second. The plant is the core's own
//! model without noise; `mpp-sim` has a real one.

use mpp_core::config::TICK_PERIOD;
use mpp_core::flight::FlightLoop;
use mpp_core::planner::{Planner, SetupError};
use mpp_core::sense::{AirData, LidarScan, Measurement, Position, SensorFrame};
use mpp_core::settings::Settings;
use mpp_core::vehicle::{AirState, VehicleState, vehicle_rate};

/// The measurements of a state. The last digits change, as those of a sensor do; values that repeat are of a stuck one.
fn measured(state: &VehicleState, tick: u32) -> SensorFrame {
    let noise = f64::from(tick % 7) * 1e-6;
    SensorFrame {
        air: Some(AirData {
            age: 0,
            measurement: Measurement {
                airspeed: state.air.airspeed + noise,
                pitch: state.air.pitch + noise,
            },
        }),
        position: tick.is_multiple_of(10).then_some(Position {
            age: 0,
            x: state.x + noise,
            z: state.z + noise,
            sigma: 0.02,
            velocity: None,
        }),
    }
}

fn main() -> Result<(), SetupError> {
    let mut settings = Settings::flight();
    if let Some(own) = settings.planner.plane_mut() {
        own.latency = TICK_PERIOD;
    }
    let mut flight = FlightLoop::new(&settings)?;
    let mut planner = Box::new(Planner::new());
    planner.set_up(&settings)?;
    let mut state = VehicleState {
        x: 0.0,
        z: 44.0,
        air: planner.trim().state,
    };
    // A clear sky: 100 beams, and nothing returns.
    let mut scan = LidarScan::new();
    (scan.angle_min, scan.angle_increment) = (-0.5, 0.01);
    for _ in 0..100 {
        let _ = scan.ranges.push(0.0);
    }
    for tick in 0..1500_u32 {
        let time = f64::from(tick) * TICK_PERIOD;
        let output = flight.step(time, &measured(&state, tick));
        match tick % 100 {
            0 => {
                planner.begin(time, &flight.state(), &flight.conditions(), &scan);
                while planner.advance() {}
            }
            1 => {
                flight.adopt(time, planner.finish(), planner.best());
            }
            _ => {}
        }
        if tick % 300 == 0 {
            println!(
                "{time:4.1} s: z {:.2} m, elevator {:.3}",
                state.z, output.control.elevator
            );
        }
        let rate = vehicle_rate(&settings.airframe, &state, output.control);
        state.x += rate.x * TICK_PERIOD;
        state.z += rate.z * TICK_PERIOD;
        state.air =
            AirState::from_vector(&(state.air.to_vector() + rate.air.to_vector() * TICK_PERIOD));
    }
    println!("15.0 s: z {:.2} m, asked 50", state.z);
    assert!((state.z - 50.0).abs() < 2.0);
    Ok(())
}
