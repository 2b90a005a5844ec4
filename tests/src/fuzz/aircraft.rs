//! Aircraft that make little sense.

use super::draw::Draw;
use hil_protocol::Aircraft;

/// The reference aircraft, often with one number that makes little sense.
pub(super) fn aircraft(draw: &mut Draw) -> Aircraft {
    let mut aircraft = Aircraft::REFERENCE;
    let places = [
        &mut aircraft.mass,
        &mut aircraft.pitch_inertia,
        &mut aircraft.wing_area,
        &mut aircraft.moment_length,
        &mut aircraft.air_density,
        &mut aircraft.lift_zero,
        &mut aircraft.lift_alpha,
        &mut aircraft.lift_alpha_rate,
        &mut aircraft.lift_pitch_rate,
        &mut aircraft.lift_elevator,
        &mut aircraft.drag_zero,
        &mut aircraft.drag_induced,
        &mut aircraft.moment_zero,
        &mut aircraft.moment_alpha,
        &mut aircraft.moment_alpha_rate,
        &mut aircraft.moment_pitch_rate,
        &mut aircraft.moment_elevator,
        &mut aircraft.cruise,
        &mut aircraft.body_radius,
    ];
    let place = draw.below(2 * places.len());
    if let Some(number) = places.into_iter().nth(place) {
        *number = draw.number(*number);
    }
    aircraft
}
