//! The phases from the scan to the paths: the map with memory, its clearance field, the lattice, and the
//! grid of the tree.

use super::{FlightPlanner, Phase};
use crate::Rules;
use crate::config::{GRID_COLS, GRID_ROWS};
use crate::map::{GridPoint, rounded_down};
use crate::paths::LatticeTask;
use crate::tuning::candidates::BEAMS_PER_SLICE;

impl FlightPlanner {
    /// Takes some beams of the scan into the map. After the last beam it builds the clearance field, proposes
    /// the previous plan, and starts the search of the lattice.
    #[inline(never)]
    pub(super) fn remember(&mut self) {
        let pose = self.pose;
        let beams = self.beams..self.beams + BEAMS_PER_SLICE;
        if beams.start == 0 {
            self.map.roll(pose.x, self.altitude);
            if self.map.contradicts(&self.scan, self.settings.sight, &pose) {
                self.summary.blind = true;
                self.scan.ranges.clear();
            }
        }
        if beams.start < self.scan.ranges.len() {
            self.beams = beams.end;
            self.map
                .insert_beams(&self.scan, beams, self.settings.sight, &pose);
            return;
        }
        self.field.build(&self.map, self.settings.body_radius);
        self.limits
            .widen(self.settings.margin, self.field.openness());
        self.take_up_previous();
        let (run, rise) = self.wind.ground_velocity(&self.state.air);
        self.lattice.start(&LatticeTask {
            x: self.state.x,
            z: self.state.z,
            slope: rise / run.max(1.0),
            altitude: self.altitude,
            band: self.settings.band,
            curvature: self.limits.curvature,
            room: self.limits.wanted_room,
            room_price: self.limits.room_price,
        });
        self.phase = Phase::Lattice;
    }

    /// Searches one station of the lattice. After the last one a tree starts in the same map.
    pub(super) fn search_lattice(&mut self) {
        if !self.lattice.advance(&self.field) {
            self.take_lattice_paths();
        }
    }

    /// Makes the paths of the lattice candidates, and starts a tree.
    #[inline(never)]
    fn take_lattice_paths(&mut self) {
        let mut paths = heapless::Vec::new();
        self.lattice.paths(&mut paths);
        for path in &paths {
            let candidate = self.along(path);
            self.propose(candidate);
        }
        self.project_map();
        self.summary.tree_runs += 1;
        self.search.restart(Rules::Corrected);
        self.phase = Phase::Tree;
    }

    /// Writes the map with memory to the grid that the tree grows in.
    fn project_map(&mut self) {
        let (x, z) = (self.state.x, self.state.z);
        let low = [x - GridPoint::AIRCRAFT.col, z - GridPoint::AIRCRAFT.row];
        let window = [
            [low[0], low[0] + GRID_COLS as f64],
            [low[1], low[1] + GRID_ROWS as f64],
        ];
        self.grid.clear();
        let grid = &mut self.grid;
        self.field.surface(window[0], window[1], |x0, z0| {
            let row = rounded_down(z0 - z + GridPoint::AIRCRAFT.row);
            let col = rounded_down(x0 - x + GridPoint::AIRCRAFT.col);
            grid.mark(row, col);
        });
    }
}
