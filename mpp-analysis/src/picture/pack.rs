//! What a page needs of a flight, small: columns as whole multiples of a unit, each as its step from the one before,
//! all of it through gzip.

use crate::closest::{Closest, closest};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use mpp_sim::entries::{Columns, LateralColumns, PlanEntry};
use mpp_sim::inspector::PlanDetail;
use mpp_sim::log::{FlightLog, Header, LogError, Summary};
use mpp_sim::orders::OrderEntry;
use mpp_sim::space::Look;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;

/// Units of the columns: of lengths, speeds, thrust and elevator, and of angles \[rad\].
const FINE: f64 = 1e-4;
const ANGLE: f64 = 1e-4;

/// What the pages of all flights get of a log.
#[derive(Serialize)]
struct Logged<'a> {
    header: &'a Header,
    summary: &'a Summary,
    plans: &'a [PlanEntry],
    orders: &'a [OrderEntry],
    hash: String,
}

impl<'a> Logged<'a> {
    fn of(log: &'a FlightLog) -> Result<Self, LogError> {
        Ok(Self {
            header: &log.header,
            summary: &log.summary,
            plans: &log.plans,
            orders: &log.orders,
            hash: log.hash()?,
        })
    }
}

/// A flight as its page gets it.
#[derive(Serialize)]
pub(super) struct Packed<'a> {
    #[serde(flatten)]
    logged: Logged<'a>,
    details: Vec<PlanDetail>,
    closest: Option<Closest>,
    ticks: BTreeMap<&'static str, (f64, Steps)>,
}

/// A column in whole units: each value as its difference from the value before it.
type Steps = Vec<Option<i64>>;

impl<'a> Packed<'a> {
    pub(super) fn of(log: &'a FlightLog, details: Vec<PlanDetail>) -> Result<Self, LogError> {
        Ok(Self {
            logged: Logged::of(log)?,
            details,
            closest: closest(log),
            ticks: columns(&log.ticks),
        })
    }
}

/// A flight in space as its page gets it.
#[derive(Serialize)]
pub(super) struct PackedSpace<'a> {
    #[serde(flatten)]
    logged: Logged<'a>,
    look: Look,
    ticks: BTreeMap<&'static str, (f64, Steps)>,
}

impl<'a> PackedSpace<'a> {
    pub(super) fn of(log: &'a FlightLog, look: Look) -> Result<Self, LogError> {
        Ok(Self {
            logged: Logged::of(log)?,
            look,
            ticks: (columns(&log.ticks).into_iter().chain(lateral(&log.lateral))).collect(),
        })
    }
}

/// Flights as text of 64 letters.
pub(super) fn packed(flights: &impl Serialize) -> Result<String, LogError> {
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    let written = gzip.write_all(&serde_json::to_vec(flights)?);
    let bytes = written.and_then(|()| gzip.finish());
    Ok(BASE64_STANDARD.encode(bytes.map_err(serde_json::Error::io)?))
}

fn lateral(side: &LateralColumns) -> [(&'static str, (f64, Steps)); 2] {
    let bank = steps(side.bank.iter().copied().map(Some), ANGLE);
    let wanted = steps(side.ref_bank.iter().copied(), ANGLE);
    [("bank", (ANGLE, bank)), ("ref_bank", (ANGLE, wanted))]
}

fn columns(ticks: &Columns) -> BTreeMap<&'static str, (f64, Steps)> {
    let known = |values: &[f64], unit: f64| (unit, steps(values.iter().copied().map(Some), unit));
    let perhaps = |values: &[Option<f64>], unit: f64| (unit, steps(values.iter().copied(), unit));
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
    let mut before = 0_i64;
    let mut step = |value: f64| {
        // A log may hold any number; one that is too great for its unit becomes the greatest that fits.
        let step = ((value / unit).round() as i64).saturating_sub(before);
        before += step;
        step
    };
    values.map(|value| value.map(&mut step)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_beyond_all_bounds_are_packed_without_harm() {
        let values = [Some(1e300), Some(-1e300), Some(0.0)];
        assert_eq!(steps(values.into_iter(), FINE).len(), 3);
    }

    #[test]
    fn steps_add_up_to_the_values_and_gaps_stay_gaps() {
        let values = [Some(1.00004), None, Some(-2.00006), Some(-2.00006)];
        assert_eq!(
            steps(values.into_iter(), FINE),
            [Some(10_000), None, Some(-30_001), Some(0)]
        );
    }
}
