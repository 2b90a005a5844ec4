//! An aircraft of one's own: from its numbers to trim, to the planner's scaled (Froude) units and to settings that fly it.

use mpp_core::planner::{Planner, SetupError};
use mpp_core::settings::{Aircraft, Settings};
use mpp_core::vehicle::{ActuatorLimits, Airframe};

fn main() -> Result<(), SetupError> {
    // A glider-like aircraft of 1.2 kg. Rates are per second: the usual coefficient times chord / (2 cruise).
    let aircraft = Aircraft {
        airframe: Airframe {
            mass: 1.2,
            pitch_inertia: 0.06,
            wing_area: 0.32,
            moment_length: 0.2,
            lift_zero: 0.3,
            lift_alpha: 5.0,
            drag_zero: 0.04,
            drag_induced: 0.06,
            moment_zero: 0.02,
            moment_alpha: -0.6,
            moment_alpha_rate: 0.0,
            moment_pitch_rate: -0.09,
            moment_elevator: 0.9,
            ..Airframe::REFERENCE
        },
        cruise: 10.0,
        body_radius: 0.15,
        stall: Some(0.15),
    };
    let actuators = ActuatorLimits {
        thrust_max: Some(6.0),
        ..ActuatorLimits::NONE
    };
    let settings = Settings::flight_of(&aircraft, &actuators);
    let mut planner = Box::new(Planner::new());
    planner.set_up(&settings)?;
    let (trim, units) = (planner.trim(), settings.units);
    println!(
        "unit of length {:.3} m, of time {:.3} s",
        units.length, units.time
    );
    println!(
        "trim in these units: angle of attack {:.3} rad, thrust {:.2}",
        trim.state.angle_of_attack(),
        trim.control.thrust
    );

    // What cannot fly is refused with a sentence.
    let heavy = Aircraft {
        airframe: Airframe {
            mass: 12.0,
            ..aircraft.airframe
        },
        ..aircraft
    };
    match planner.set_up(&Settings::flight_of(&heavy, &actuators)) {
        Err(error) => println!("12 kg: {error}"),
        Ok(()) => unreachable!("6 N do not carry 12 kg"),
    }
    Ok(())
}
