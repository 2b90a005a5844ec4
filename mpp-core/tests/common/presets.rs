//! The named presets.

use mpp_core::settings::Settings;

pub(crate) fn presets() -> [Settings; 3] {
    [Settings::reference(), Settings::paper(), Settings::flight()]
}
