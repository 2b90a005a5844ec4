//! Aircraft that make little sense.

use super::draw::Draw;
use hil_protocol::{Aircraft, Airframe};

/// The reference aircraft, often with one number that makes little sense.
pub(super) fn aircraft(draw: &mut Draw) -> Aircraft {
    let mut aircraft = Aircraft::REFERENCE;
    let mut numbers = aircraft.airframe.numbers();
    let places = numbers
        .iter_mut()
        .chain([&mut aircraft.cruise, &mut aircraft.body_radius]);
    let mut places: Vec<&mut f64> = places.collect();
    let place = draw.below(2 * places.len());
    if let Some(number) = places.get_mut(place) {
        **number = draw.number(**number);
    }
    aircraft.airframe = Airframe::of_numbers(numbers);
    aircraft
}
