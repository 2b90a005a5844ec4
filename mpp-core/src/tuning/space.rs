//! The tuning of the planner in space. All numbers are in SI units, of aircraft that cruise at 12 to 16 m/s. The source S is the
//! trial of a prototype that decision 46 names.

/// The map in space. The log-odds of a voxel are a whole number from `-MOST` to `MOST`, and 0 where no beam has been.
pub mod voxels {
    /// Change by a hit [-]. One hit makes a voxel occupied. Source: S.
    pub const HIT: i8 = 60;
    /// Greatest log-odds [-]: more takes longer to forget. Source: S.
    pub const MOST: i8 = 100;
    /// Log-odds from which a voxel is occupied [-]. Source: S.
    pub const OCCUPIED: i8 = 25;
    /// Change by a beam that passes and returns from beyond [-]. Two such beams take back a hit. Source: S.
    pub const PASS: i8 = 30;
    /// Change by a beam that does not return [-]: it may have been lost. Source: S.
    pub const MISS: i8 = 10;
    /// Length before a return that a beam does not clear: a part of its range [-] and a length \[m\]. An error of the attitude of
    /// 0.5 deg moves a hit by 0.4 m at 45 m. Source: derived.
    pub const PASS_SHARE: f64 = 0.03;
    /// See [`PASS_SHARE`]. Source: S.
    pub const PASS_SHORT: f64 = 1.0;
    /// Share of the lidar's reach that a beam without return has passed [-]: dark bark returns later. Source: S.
    pub const SIGHT: f64 = 8.0 / 9.0;
}

/// The lattice in space.
pub mod space_lattice {
    /// Cost of a square metre of missing clearance at a node [1/m^2]. Source: S.
    pub const LACK: f64 = 20.0;
    /// Clearance that paths keep beyond that of plans \[m\]: a path is not yet flown. Source: S.
    pub const MORE_MARGIN: f64 = 0.25;
    /// Cost of a square metre off the altitude, and off the middle of the band [1/m^2]. Source: S.
    pub const HEIGHT: f64 = 0.01;
    /// See [`HEIGHT`]. Source: S.
    pub const SIDE: f64 = 0.0005;
    /// Cost of a squared step to the side, of a change of it, of a climb, and of a change of it [-]. Source: S.
    pub const SLOPE: f64 = 0.1;
    /// See [`SLOPE`]. Source: S.
    pub const BEND: f64 = 0.5;
    /// See [`SLOPE`]. Source: S.
    pub const CLIMB: f64 = 0.3;
    /// See [`SLOPE`]. Source: S.
    pub const PULL: f64 = 0.5;
}

/// Prices of plans in space.
pub mod space_judgement {
    /// Cost of a square metre of missing clearance at a point [1/m^2]; there are four points a stage. Source: S.
    pub const LACK: f64 = 200.0;
    /// Clearance beyond the margin that a plan should have where there is room \[m\], and the cost of a square metre less [1/m^2].
    /// Source: S.
    pub const ROOM: f64 = 0.6;
    /// See [`ROOM`]. Source: S.
    pub const ROOM_WEIGHT: f64 = 0.8;
    /// Cost of a point of which the map knows nothing, at the aircraft [-]; it falls to zero at [`AHEAD`]. Source: S.
    pub const UNKNOWN: f64 = 5.0;
    /// Distance at which an unknown point costs nothing \[m\]: two seconds of flight. Source: as in the plane.
    pub const AHEAD: f64 = 26.0;
    /// Cost of a plan that does not reach the line from which the cost-to-go counts [-]. Source: S.
    pub const SHORT: f64 = 100.0;
    /// Weight of a point beyond that line [-]: it will be planned again. Source: S.
    pub const LATER: f64 = 0.5;
}

/// Programs in space.
pub mod space_program {
    /// Weights of the squares of rate of the bank, rate of the angle of attack [s^2/rad^2] and thrust [1/N^2]. Source: S.
    pub const CONTROL: [f64; 3] = [0.3, 1.0, 0.02];
    /// Weights of the squared misses of the last state: x, y, z, airspeed, angle of attack, bank, flight path, course. Source: S.
    pub const TERMINAL: [f64; 8] = [0.0, 0.05, 0.5, 1.0, 5.0, 10.0, 20.0, 10.0];
    /// Price of a metre beyond a face and of a radian beyond a limit [1/m, 1/rad], linear, and quadratic the same a square. Source:
    /// S.
    pub const PRICE: f64 = 1000.0;
    /// Cost at which the solver gives a program up [-]; its controls are flown out all the same. Source: S.
    pub const COST_LIMIT: f64 = 600.0;
    /// Greatest distance of a voxel that gives a face \[m\]. Source: S.
    pub const REACH: f64 = 3.3;
    /// Most faces of a segment [-]. Source: S.
    pub const FACES: usize = 8;
    /// Depth in which a voxel counts as behind a face \[m\]. Source: S.
    pub const BEHIND: f64 = 0.35;
}
