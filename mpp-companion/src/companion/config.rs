//! What a companion flies.

use crate::autopilot::Kind;
use crate::lidar::{ScanSource, Wanted};
use hil_protocol::{Configure, MAX_BEAMS};
use mpp_sim::aircraft_file::AircraftModel;

/// What a companion flies.
#[derive(Clone, Debug)]
pub struct Config {
    /// The kind of autopilot; without it the heartbeat says it.
    pub kind: Option<Kind>,
    /// The aircraft.
    pub model: AircraftModel,
    /// What sends scans.
    pub source: ScanSource,
    /// Beams of a scan.
    pub beams: u16,
    /// Longest range of the lidar \[m\].
    pub range: f32,
    /// Ticks from one plan to the next.
    pub replan_ticks: u32,
    /// Ticks from the start of a cycle until its plan is flown.
    pub latency_ticks: u32,
    /// Slices of planning work in a tick.
    pub slices: u32,
    /// Time by which the wanted pitch leads the command \[s\].
    pub lead: f64,
}

impl Config {
    /// The usual flight of an aircraft: 100 beams, 2 Hz.
    #[must_use]
    pub fn new(model: AircraftModel, range: f32) -> Self {
        Self {
            kind: None,
            source: ScanSource::Frames,
            beams: 100,
            range,
            replan_ticks: 50,
            latency_ticks: 5,
            slices: u32::MAX,
            // The command is pitch above the path, and the path turns on until the command acts.
            lead: model.actuators.elevator_delay.unwrap_or(0.0),
            model,
        }
    }

    /// The scan that the core wants.
    pub(crate) fn wanted(&self) -> Wanted {
        Wanted {
            body: self.model.known.body_radius,
            range: f64::from(self.range),
            beams: usize::from(self.beams).clamp(2, MAX_BEAMS),
        }
    }

    /// The core's configuration at a height \[m\].
    pub(crate) fn configure(&self, altitude: f64) -> Configure {
        Configure {
            preset: hil_protocol::Preset::Flight,
            aircraft: self.model.known,
            paths: 25,
            replan_period_ticks: self.replan_ticks,
            latency_ticks: self.latency_ticks,
            slices_per_tick: self.slices,
            seed: 1,
            beams: self.beams.min(MAX_BEAMS as u16),
            range_max: self.range,
            altitude,
            actuators: self.model.actuators,
        }
    }
}
