//! The phases from the scan to the paths: the occupancy grid, its distance field, and the lattice.

use super::workspace::{Intake, Workspace};
use super::{Phase, PlanePlanner};
use crate::lattice::{CLIMB, Lattice, LatticeTask};
use crate::map::{RollingGrid, ScanVerdict, has_return, sees_below};
use crate::tuning::candidates::BEAMS_PER_SLICE;
use crate::tuning::grid::CELL;
use crate::tuning::leave::{CEILING, DARK, DIP, HEIGHT};
use crate::vehicle::Trim;

/// Height of the middle of the map's window above an aircraft that leaves the band \[m\]: half of its reach.
const LOOK_UP: f64 = 0.25 * CELL * RollingGrid::SHAPE[0] as f64;

impl PlanePlanner {
    /// Takes some beams of the scan into the map. After the last beam it builds the distance field, proposes
    /// the previous plan, and starts the search of the lattice.
    #[inline(never)]
    pub(super) fn remember(&mut self) {
        self.judge_scan();
        let Workspace::Scan(Intake {
            scan,
            beams,
            isolated,
            ..
        }) = &mut self.workspace
        else {
            return self.end_inconsistent();
        };
        if *beams < scan.ranges.len() {
            let next = *beams..*beams + BEAMS_PER_SLICE;
            *beams = next.end;
            let sight = self.monitor.sight(self.settings.sight);
            let pose = self.monitor.pose(&self.poses);
            (self.map).insert_beams(scan, next, sight, pose, isolated);
            return;
        }
        // Slowly the nose is high, and a climb needs the lift.
        if self.summary.blind && !self.summary.leaves {
            self.slow_down();
        }
        self.field.build(&self.map, self.settings.body_radius);
        self.limits
            .widen(self.settings.margin, self.field.openness());
        self.warm_start();
        let (run, rise) = self.wind.ground_velocity(&self.state.air);
        let task = LatticeTask {
            x: self.state.x,
            z: self.state.z,
            slope: rise / run.max(1.0),
            altitude: self.altitude,
            band: self.band,
            curvature: self.limits.curvature,
            room: self.limits.wanted_room,
            room_weight: self.limits.room_weight,
            unknown_ahead: self.limits.unknown_ahead,
        };
        self.workspace = Workspace::Lattice(Lattice::new());
        if let Workspace::Lattice(lattice) = &mut self.workspace {
            lattice.start(&task, &self.field);
        }
        self.phase = Phase::Lattice;
    }

    /// Decides once what of the scan is believed, and moves the map along with the aircraft.
    fn judge_scan(&mut self) {
        let Workspace::Scan(Intake {
            scan,
            beams: 0,
            isolated,
            predictions,
        }) = &mut self.workspace
        else {
            return;
        };
        let (age, sight) = (self.monitor.age(), self.settings.sight);
        let pose = self.monitor.pose(&self.poses);
        // Whoever gives no scan may ask for level flight without a lidar.
        let none = self.summary.blind;
        // A lidar that was distrusted once stays so until a beam returns.
        let empty = !has_return(scan, sight);
        self.lidar_distrusted =
            empty && (self.lidar_distrusted || self.map.contradicts(scan, sight, pose));
        let verdict = self.monitor.check(scan, sight, &self.poses, predictions);
        let pose = self.monitor.pose(&self.poses);
        self.summary.aged = self.monitor.age() != age;
        self.lidar_distrusted |= empty && verdict == ScanVerdict::Silent;
        if verdict == ScanVerdict::ReversedBefore || self.summary.aged {
            self.map.clear();
        }
        self.summary.blind |= self.lidar_distrusted || verdict != ScanVerdict::Agrees;
        if none || !self.summary.blind || sees_below(scan, sight) {
            self.seen = self.time;
        }
        self.summary.leaves = verdict == ScanVerdict::Silent && self.monitor.hides_below(scan)
            || self.time - self.seen > DARK * self.units.time;
        let [middle, half] = self.band;
        let mut window = middle;
        if self.summary.leaves {
            let above = self.destination + self.settings.band + HEIGHT;
            let (ceiling, dip) = (above + CEILING, (self.state.z - DIP).min(above));
            let floor = dip.max(middle - half);
            self.band = [0.5 * (ceiling + floor), 0.5 * (ceiling - floor)];
            self.altitude = above.min(self.state.z + CLIMB);
            self.solver.problem.target[1] = self.altitude - self.state.z;
            window = middle.max(self.state.z + LOOK_UP);
        }
        self.map.roll(pose.x, window);
        if self.lidar_distrusted {
            scan.ranges.clear();
        }
        self.map.write_isolated_hits(scan, sight, pose, isolated);
    }

    /// Plans the slowest flight that the limits of the angle of attack and of the thrust allow, because no scan shows what
    /// comes. The aircraft then leaves later what the map knows.
    fn slow_down(&mut self) {
        let [down, up] = self.limits.angle_of_attack;
        let Some(trim) = self.slowest() else {
            return;
        };
        self.trim = trim;
        self.bound_thrust();
        // The limits stay where they are. They count from trim.
        self.limits.angle_of_attack = [down + up, 0.0];
        let [down, most] = self.limits.rolled_out;
        self.limits.rolled_out = [down + up, (most - up).max(0.0)];
    }

    /// Trim of the slowest flight of plans, if the motor carries it.
    pub(super) fn slowest(&self) -> Option<Trim> {
        let [_, up] = self.limits.angle_of_attack;
        let alpha = self.trim.state.angle_of_attack() + up;
        let slow = Trim::at_angle_of_attack(&self.airframe, alpha).ok();
        slow.filter(|it| it.control.thrust < self.limits.thrust_max)
    }

    /// Searches one station of the lattice. After the last one it proposes its paths.
    pub(super) fn search_lattice(&mut self) {
        let Workspace::Lattice(lattice) = &mut self.workspace else {
            return self.end_inconsistent();
        };
        if !lattice.advance(&self.field) {
            self.take_lattice_paths();
        }
    }

    /// Makes the paths of the lattice candidates, and frees its memory for the first program.
    #[inline(never)]
    fn take_lattice_paths(&mut self) {
        let mut paths = heapless::Vec::new();
        if let Workspace::Lattice(lattice) = &self.workspace {
            lattice.paths(&mut paths);
            lattice.write_cost_to_go(&mut self.cost_to_go);
        }
        for path in &paths {
            let candidate = self.along(path);
            self.propose(candidate);
        }
        self.workspace = Workspace::NEW;
        self.phase = Phase::Faces;
    }
}
