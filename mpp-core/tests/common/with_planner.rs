//! Settings with another planner.

use mpp_core::settings::{PlannerSettings, Settings};

pub(crate) fn with_planner(settings: Settings, planner: PlannerSettings) -> Settings {
    Settings {
        planner,
        ..settings
    }
}
