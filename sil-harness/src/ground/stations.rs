//! The ground stations that are connected.

/// A change in a station's connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Change {
    Came,
    Lost,
    Returned,
}

struct Station {
    system: u8,
    last: u32,
    lost: bool,
}

/// Stations that were heard. Their heartbeats count, in simulated time.
pub(super) struct Stations {
    /// Ticks of silence after which a station is lost; `None` means never.
    patience: Option<u32>,
    heard: Vec<Station>,
}

impl Stations {
    pub(super) fn new(patience: Option<u32>) -> Self {
        Self {
            patience,
            heard: Vec::new(),
        }
    }

    /// Sets another patience, which begins at this tick.
    pub(super) fn patience(&self) -> Option<u32> {
        self.patience
    }

    pub(super) fn set_patience(&mut self, patience: Option<u32>, tick: u32) {
        self.patience = patience;
        for station in &mut self.heard {
            station.last = tick;
        }
    }

    /// Records a station's heartbeat. Returns the change, if there is one.
    pub(super) fn hear(&mut self, system: u8, tick: u32) -> Option<Change> {
        let Some(station) = self.heard.iter_mut().find(|s| s.system == system) else {
            self.heard.push(Station {
                system,
                last: tick,
                lost: false,
            });
            return Some(Change::Came);
        };
        station.last = tick;
        std::mem::take(&mut station.lost).then_some(Change::Returned)
    }

    /// Finds the stations that are lost from this tick on.
    pub(super) fn missing(&mut self, tick: u32) -> Vec<(u8, Change)> {
        let Some(patience) = self.patience else {
            return Vec::new();
        };
        let mut missing = Vec::new();
        for station in self.heard.iter_mut().filter(|station| !station.lost) {
            if tick.saturating_sub(station.last) > patience {
                station.lost = true;
                missing.push((station.system, Change::Lost));
            }
        }
        missing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_station_comes_is_lost_once_and_returns() {
        let mut stations = Stations::new(Some(500));
        assert_eq!(stations.hear(255, 0), Some(Change::Came));
        assert_eq!(stations.hear(255, 100), None);
        assert!(stations.missing(600).is_empty());
        assert_eq!(stations.missing(601), [(255, Change::Lost)]);
        assert!(stations.missing(602).is_empty());
        assert_eq!(stations.hear(255, 700), Some(Change::Returned));
        assert!(stations.missing(1200).is_empty());
        assert_eq!(stations.missing(1201), [(255, Change::Lost)]);
    }

    /// Ticks that passed without a patience do not count.
    #[test]
    fn a_new_patience_begins_when_it_is_set() {
        let mut stations = Stations::new(None);
        stations.hear(255, 0);
        stations.set_patience(Some(500), 9000);
        assert!(stations.missing(9500).is_empty());
        assert_eq!(stations.missing(9501), [(255, Change::Lost)]);
    }

    #[test]
    fn without_patience_none_is_lost() {
        let mut stations = Stations::new(None);
        stations.hear(255, 0);
        assert!(stations.missing(u32::MAX).is_empty());
    }
}
