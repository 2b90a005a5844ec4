//! One planning cycle: scan in, trajectory out, in slices that a scheduler may interrupt at any time.

use mpp_core::planner::{Planner, SetupError};
use mpp_core::sense::LidarScan;
use mpp_core::settings::Settings;
use mpp_core::vehicle::{Conditions, VehicleState};

fn main() -> Result<(), SetupError> {
    let mut planner = Box::new(Planner::new());
    planner.set_up(&Settings::flight())?;
    let state = VehicleState {
        x: 0.0,
        z: 50.0,
        air: planner.trim().state,
    };

    // A wall from 49 m to 53 m of height, 30 m ahead.
    let mut scan = LidarScan::new();
    (scan.angle_min, scan.angle_increment) = (-0.5, 0.01);
    for beam in 0..100 {
        let angle = state.air.pitch + scan.beam_angle(beam);
        let height = 50.0 + 30.0 * libm::tan(angle);
        let range = if (49.0..53.0).contains(&height) {
            30.0 / libm::cos(angle)
        } else {
            0.0
        };
        let _ = scan.ranges.push(range as f32);
    }

    planner.begin(0.0, &state, &Conditions::STILL, &scan);
    let mut slices = 0;
    // The deadline of a flight computer may end this loop earlier: `finish` then gives the best plan so far.
    while planner.advance() {
        slices += 1;
    }
    let verdict = planner.finish();
    println!(
        "{verdict:?} after {slices} slices, {} programs",
        planner.summary().candidates
    );
    for stage in [0, 6, 10, 14, 18] {
        let knot = &planner.best().knots[stage].state;
        println!(
            "stage {stage:2}: x {:5.1} m, z {:5.2} m, airspeed {:5.2} m/s",
            knot.x, knot.z, knot.air.airspeed
        );
    }
    let passes = planner.best().knots.iter().all(|knot| {
        let (x, z) = (knot.state.x, knot.state.z);
        !(29.5..30.5).contains(&x) || !(48.7..53.3).contains(&z)
    });
    assert!(passes, "the plan hits the wall");
    Ok(())
}
