//! What the vehicle tells persons: texts for stations, and lines for whoever started it.

use super::severity::Severity;
use super::stations::Change;
use super::vehicle::{COMPONENT, Vehicle};
use hil_protocol::mavlink::messages::STATUSTEXT_DATA;
use hil_protocol::mavlink::{Frame, text};
use mpp_sim::scenario::Scenario;

impl Vehicle {
    pub(super) fn note_station(&mut self, system: u8, change: Change) {
        let (severity, what) = match change {
            Change::Came => (Severity::Info, "connected"),
            Change::Lost => (Severity::Warning, "lost, flying on"),
            Change::Returned => (Severity::Notice, "is back"),
        };
        let line = format!("Ground station {system} {what}");
        self.say(severity, &line);
        let seconds = Scenario::time(self.now);
        self.notes.push(format!("{seconds:.2} s: {line}"));
    }

    /// Tells once of another vehicle with the same number. Stations cannot tell the two apart.
    pub(super) fn note_twin(&mut self, frame: &Frame<'_>) {
        if frame.system == self.system && frame.component == COMPONENT && !self.twin {
            self.twin = true;
            self.notes.push(format!(
                "another vehicle is system {} too: start one of them with --instance",
                self.system
            ));
        }
    }

    /// Tells a fault of the core itself. Refused inputs are only counted.
    pub(super) fn note_fault(&mut self, cause: &str) {
        let name = cause.split(' ').next().unwrap_or_default();
        let what = match name {
            "Trapped" => "Core trapped and recovered",
            "PlannerRestarted" => "Planner restarted",
            // Each scan tells it.
            "ScanSilentBelow" if !self.climbs => {
                self.climbs = true;
                "Lidar silent beneath: climbing"
            }
            "PlannerOff" => "Planner stays off: land",
            "CoreRestarted" => "Core restarted in flight",
            _ => return,
        };
        self.say(Severity::Warning, what);
    }

    pub(super) fn say(&mut self, severity: Severity, line: &str) {
        self.send_event(&STATUSTEXT_DATA {
            severity: severity as u8,
            text: text(line),
            ..STATUSTEXT_DATA::DEFAULT
        });
    }
}
