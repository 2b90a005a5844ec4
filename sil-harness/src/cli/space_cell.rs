//! A cell of a campaign in space, from its flights.

use mpp_analysis::campaign::wilson;
use mpp_sim::inquest::Cause;
use mpp_sim::outcome::Outcome;
use serde::Serialize;
use std::collections::BTreeMap;

/// One flight of a campaign.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SpaceRow {
    pub(super) world: String,
    pub(super) density: Option<f64>,
    pub(super) seed: u64,
    pub(super) outcome: Outcome,
    /// Of a collision: its cause, and the time for which beams had met what was hit \[s\].
    pub(super) cause: Option<Cause>,
    pub(super) seen_before: Option<f64>,
    pub(super) t_end: f64,
    pub(super) x_end: f64,
    pub(super) min_clearance: Option<f64>,
    pub(super) replans: u32,
    /// Share of the cycles that know a way out [-].
    pub(super) way_out: f64,
    pub(super) log_hash: String,
}

/// The flights of a density.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SpaceCell {
    world: String,
    density: Option<f64>,
    flights: u32,
    arrived: u32,
    /// Wilson's interval of 95 % [-].
    interval: (f64, f64),
    collisions: u32,
    /// How many of them have each cause.
    causes: BTreeMap<Cause, u32>,
    not_arrived: u32,
    extreme: u32,
    /// Median of the least clearance of those that arrived \[m\], where it is less than 5 m.
    median_clearance: Option<f64>,
    /// Mean share of the cycles that know a way out [-].
    way_out: f64,
}

impl SpaceCell {
    /// Of its rows.
    pub(super) fn of(rows: &[SpaceRow]) -> Self {
        let count = |outcome: &[Outcome]| {
            rows.iter()
                .filter(|row| outcome.contains(&row.outcome))
                .count() as u32
        };
        let (flights, arrived) = (rows.len() as u32, count(&[Outcome::Survived]));
        let through = rows.iter().filter(|row| row.outcome == Outcome::Survived);
        let mut clearances: Vec<f64> = through.filter_map(|row| row.min_clearance).collect();
        clearances.sort_by(f64::total_cmp);
        let mut causes = BTreeMap::new();
        for cause in rows.iter().filter_map(|row| row.cause) {
            *causes.entry(cause).or_insert(0) += 1;
        }
        let first = rows.first();
        Self {
            world: first.map_or_else(String::new, |row| row.world.clone()),
            density: first.and_then(|row| row.density),
            flights,
            arrived,
            interval: wilson(arrived, flights),
            collisions: count(&[Outcome::Collision]),
            causes,
            not_arrived: count(&[Outcome::NotArrived]),
            extreme: count(&[Outcome::FlightPathLimit, Outcome::PitchLimit]),
            median_clearance: clearances.get(clearances.len() / 2).copied(),
            way_out: rows.iter().map(|row| row.way_out).sum::<f64>() / f64::from(flights.max(1)),
        }
    }
}

impl std::fmt::Display for SpaceCell {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (low, high) = self.interval;
        write!(f, "{}", self.world)?;
        if let Some(density) = self.density {
            write!(f, " {density}")?;
        }
        write!(
            f,
            ": {} of {} flights arrived [{:.1}, {:.1} %]; {} collisions",
            self.arrived,
            self.flights,
            100.0 * low,
            100.0 * high,
            self.collisions,
        )?;
        if !self.causes.is_empty() {
            let causes = self.causes.iter();
            let told: Vec<_> = causes
                .map(|(cause, count)| format!("{count} {}", cause.name()))
                .collect();
            write!(f, " ({})", told.join(", "))?;
        }
        write!(
            f,
            ", {} not arrived, {} extreme",
            self.not_arrived, self.extreme
        )?;
        if let Some(clearance) = self.median_clearance {
            write!(f, "; median clearance {clearance:.2} m")?;
        }
        write!(
            f,
            "; a way out in {:.0} % of the cycles",
            100.0 * self.way_out
        )
    }
}
