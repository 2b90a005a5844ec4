//! Aircraft that must fly alike: one aircraft in several units of its command, and in several sizes.

use mpp_sim::aircraft_file::{AircraftFile, ElevatorUnit};
use mpp_sim::scenario::TICKS_PER_SECOND;
use std::f64::consts::PI;

/// An aircraft, and what is special about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// Its name in tables.
    pub name: String,
    /// The aircraft.
    pub file: AircraftFile,
}

/// One aircraft with its elevator's command in five units. A command without a unit counts as radians.
#[must_use]
pub fn in_units(file: &AircraftFile) -> Vec<Variant> {
    let present = match file.elevator.unit {
        ElevatorUnit::Deg => PI / 180.0,
        ElevatorUnit::Rad | ElevatorUnit::Command => 1.0,
    };
    let units = [
        ("1 rad", 1.0),
        ("1/5 rad", 1.0 / 5.0),
        ("1/20 rad", 1.0 / 20.0),
        ("1 deg", PI / 180.0),
        ("1/200 rad", 1.0 / 200.0),
    ];
    let variant = |(name, unit): (&str, f64)| Variant {
        name: format!("{}, command in {name}", file.name),
        file: file.with_command(present / unit),
    };
    units.into_iter().map(variant).collect()
}

/// One aircraft in four sizes that are similar by Froude's law.
#[must_use]
pub fn in_sizes(file: &AircraftFile) -> Vec<Variant> {
    let variant = |scale: f64| Variant {
        name: format!("{}, {scale} times as long", file.name),
        file: file.similar(scale),
    };
    [0.25, 1.0, 4.0, 16.0].into_iter().map(variant).collect()
}

/// Numbers of obstacles, each with the replanning rate \[Hz\] at which an aircraft with this unit of time \[s\]
/// flies past them: 1 Hz past 20, 4 Hz past more, for the reference aircraft.
#[must_use]
pub fn flown_cells(obstacles: &[usize], time_unit: f64) -> Vec<(usize, f64)> {
    let rate = |obstacles: usize| {
        let rate = if obstacles <= 20 { 1.0 } else { 4.0 };
        let ticks = (f64::from(TICKS_PER_SECOND) * time_unit / rate)
            .round()
            .max(1.0);
        six_digits(f64::from(TICKS_PER_SECOND) / ticks)
    };
    obstacles
        .iter()
        .map(|count| (*count, rate(*count)))
        .collect()
}

/// A rate with six significant digits: short to read, and enough that a scenario takes it.
fn six_digits(rate: f64) -> f64 {
    format!("{rate:.5e}").parse().unwrap_or(rate)
}
