//! The figures of the documentation, by one command.

use super::{Fault, Flight, StandIn};
use crate::{CompanionError, Kind, ScanSource, State, Told};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Flies sets of flights with this source of scans from a first seed on, and gives a table.
///
/// # Errors
/// [`CompanionError`].
pub fn figures(
    kind: Kind,
    source: ScanSource,
    flights: u64,
    seed: u64,
) -> Result<String, CompanionError> {
    let of = |flight| Flight {
        kind,
        source,
        ..flight
    };
    let base = of(Flight::new(seed));
    let untold = Flight {
        told: false,
        ..base.clone()
    };
    let forty = of(Flight::forty(seed));
    let windy = Flight {
        wind: -4.33,
        gusts: 0.5,
        ..base.clone()
    };
    let sets = [
        ("20 obstacles, dead time 0.1 s told", base),
        ("20 obstacles, dead time 0.1 s untold", untold),
        ("40 obstacles at 4 Hz", forty),
        (
            "20 obstacles, wind 5 m/s from 30 deg ahead, gusts 0.5 m/s",
            windy,
        ),
    ];
    let mut text = String::from("| set | strict | touched | given back |\n|---|---|---|---|\n");
    for (name, set) in sets {
        let scenario = set.scenario()?;
        let outcomes = (seed..seed + flights)
            .into_par_iter()
            .map(|seed| {
                Flight {
                    seed,
                    ..set.clone()
                }
                .fly(None)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let count = |test: &dyn Fn(&super::Outcome) -> bool| {
            outcomes.iter().filter(|outcome| test(outcome)).count()
        };
        let strict = count(&|one| one.is_strict(&scenario));
        let touched = count(&|one| one.clearance <= 0.0);
        let back = count(&|one| !one.flown);
        text += &format!("| {name} | {strict} of {flights} | {touched} | {back} |\n");
    }
    text += &faults(kind, source, (flights / 8).max(1), seed)?;
    text += &format!(
        "\nCompanion dies at -15 deg of pitch and 10 % of throttle: {:.1} m lost\n",
        lost(kind)?
    );
    Ok(text)
}

/// The faults of the exchange.
fn faults(
    kind: Kind,
    source: ScanSource,
    flights: u64,
    seed: u64,
) -> Result<String, CompanionError> {
    let mut text = format!(
        "\n| fault, {flights} flights each | setpoints after a take-over | not finite or beyond limits | last setpoint after a \
         take-over, ms | ends as |\n|---|---|---|---|---|\n"
    );
    for fault in Fault::ALL {
        let outcomes = (seed..seed + flights)
            .into_par_iter()
            .map(|seed| {
                let fault = Some(fault);
                Flight {
                    kind,
                    fault,
                    source,
                    ..Flight::new(seed)
                }
                .fly(None)
            })
            .collect::<Result<Vec<_>, _>>()?;
        let sum = |part: fn(&super::Outcome) -> u32| outcomes.iter().map(part).sum::<u32>();
        let last = outcomes.iter().map(|one| one.last_after).max().unwrap_or(0);
        let mut ends: BTreeMap<String, u32> = BTreeMap::new();
        for outcome in &outcomes {
            *ends.entry(end(&outcome.told)).or_default() += 1;
        }
        let ends: Vec<_> = ends
            .iter()
            .map(|(end, count)| format!("{end} {count}"))
            .collect();
        let (late, unsound) = (sum(|one| one.late), sum(|one| one.unsound));
        text += &format!(
            "| {fault:?} | {late} | {unsound} | {last} | {} |\n",
            ends.join("; ")
        );
    }
    Ok(text)
}

/// The last state. An aircraft that PX4 has back is verified again, so that what came before is told.
fn end(told: &[Told]) -> String {
    let mut states = told.iter().rev().filter_map(|told| match told {
        Told::State(state, reason) => Some((*state, *reason)),
        _ => None,
    });
    let last = states.next();
    let back = states
        .take_while(|(state, _)| *state != State::Flying)
        .find(|(state, _)| *state == State::GiveBack)
        .filter(|_| last.is_some_and(|(state, _)| state == State::Ready));
    match back.or(last) {
        Some((State::Flying, _)) => "Flying".to_owned(),
        Some((state, reason)) => format!("{state:?}, {reason:?}"),
        None => String::new(),
    }
}

/// The height that is lost when the companion dies in a dive \[m\].
///
/// # Errors
/// [`CompanionError`].
pub(crate) fn lost(kind: Kind) -> Result<f64, CompanionError> {
    let mut scenario = Flight::new(1).scenario()?;
    scenario.aircraft.actuators.elevator_delay = None;
    let failed = |error: String| mpp_sim::scenario::ScenarioError::Value("aircraft", error);
    let mut autopilot =
        StandIn::new(kind, &scenario, 0.0, 10).map_err(|error| failed(error.to_string()))?;
    let start = autopilot.state().z;
    autopilot.obey_last(-15_f64.to_radians(), 0.1);
    let mut least = start;
    for _ in 0..1500 {
        autopilot
            .step()
            .map_err(|error| failed(error.to_string()))?;
        least = least.min(autopilot.state().z);
    }
    Ok(start - least)
}
