//! The tuning of the planner in space. All numbers are in SI units, of aircraft that cruise at 12 to 16 m/s. The source S is the
//! trial of a prototype that decision 46 names. The map and the price of the unknown have the numbers of the plane.

/// The map in space.
pub mod space_map {
    /// Share of the range of earlier hits below which a hit begins the box of its column anew, and above the inverse of which it
    /// does not count [-]. Less keeps the errors of many hits, more forgets flanks. Source: D75.
    pub const CLOSER: f64 = 0.96;
}

/// The state in which a plan begins.
pub mod space_take_over {
    /// Share of the deviation from the last plan by which the next one begins beside it [-]. With 1 the errors of the estimate
    /// shake each plan, with 0 it leaves the aircraft behind. Source: decision 47.
    pub const TRUST: f64 = 0.3;
}

/// The pursuit of paths.
pub mod space_pursuit {
    /// Distances ahead at which the pursuit aims, in seconds of cruise \[s\]; the cheapest roll-out counts. Less swings, more
    /// cuts corners, and more of them cost roll-outs. Source: decision 47.
    pub const AIMS: [f64; 3] = [0.75, 0.5, 1.0];
}

/// The refinement of the cheapest trajectory.
pub mod space_refinement {
    /// Change of the bank in the first round \[rad\]; each further round halves it. More finds other ways, less polishes. Source:
    /// decision 47.
    pub const SIZE: f64 = 0.35;
    /// Change of the lift upwards in the first such round [m/s^2]. Source: D70.
    pub const LIFT: f64 = 4.0;
    /// Share of the squared lack of room that lies above or below from which on moves of the lift are tried [-]. Source: D70.
    pub const STEEP: f64 = 0.2;
    /// Rounds of 96 moves [-]. More find cheaper plans and cost roll-outs. Source: decision 58.
    pub const ROUNDS: usize = 8;
    /// Work after which a cycle tries no more moves [-]: a stage that is flown counts 1 and takes about 1,900 instructions on a
    /// Cortex-M7, one that is judged 2. Less ends searches early, at first those of plans that lead back. Source: D65.
    pub const MOST_WORK: usize = 20_000;
    /// Number of sizes of moves [-]. More polish, fewer find other ways. Source: decision 58.
    pub const SIZES: usize = 4;
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
    /// Weight of the squared distance of a plan's end from the wanted height [1/m^2]. Source: S.
    pub const END_HEIGHT: f64 = 0.2;
    /// Cost of the squared lack of airspeed at each knot of a plan over terrain [s^2/m^2]. With less, plans climb by their airspeed
    /// and not by thrust, and stall on the slope. Source: D72.
    pub const SLOW: f64 = 0.3;
    /// Weight of the squared runaway of the nose at the end of a plan [1/rad^2]. Source: D67.
    pub const RUNAWAY: f64 = 10.0;
    /// Cost of a plan that does not reach the line from which the cost-to-go counts [-]. Source: S.
    pub const SHORT: f64 = 100.0;
    /// Weight of a point beyond that line [-]: it will be planned again. With more, plans hit what is near to avoid what is far.
    /// Source: D75.
    pub const LATER: f64 = 0.1;
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

/// Shares of the limits of an aircraft.
pub mod space_limits {
    /// Share of the greatest bank and of its rate that pursuit and programs use [-]; the rest is for what goes beyond soft rows.
    /// Source: S.
    pub const BANK: f64 = 0.92;
    /// See [`BANK`]. Source: S.
    pub const RATE: f64 = 0.9;
}
