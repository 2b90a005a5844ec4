//! The tuning of the plane planner and of the flight loop: their numbers, in the order of the data flow. The
//! settings that a user chooses before a flight are in [`crate::settings`]; sizes and rates are in
//! [`crate::config`].
//!
//! Each comment gives the unit of the number, its effect, its trade-off and its source. The source is the
//! decision record (D) in `docs/decisions` with the measurement, or the derivation of the number.
//! `CONTRIBUTING.md` describes how to change a number: the golden flights show at once which flights
//! changed.

pub mod scan_match;
mod space;
mod space_estimate;
mod watches;

pub use space::{
    space_judgement, space_lattice, space_limits, space_map, space_program, space_pursuit,
    space_refinement, space_take_over,
};
pub use space_estimate::{space_air, space_inertial};
pub use watches::{
    airspeed_bias, calm_flight, elevator, leave, motor, pitch_bias, pitch_monitor, sensors,
};

/// Clearance that an aircraft which turns little should have where there is room for it \[m\]. The lack of
/// this clearance costs something in lattice and judgement. More room costs longer ways; with 1.6 m fewer
/// flights succeed under all conditions together (757 against 768 of 800). Source: D13.
pub const ROOM: f64 = 2.0;

/// Room in open country.
pub mod open {
    /// Clearance that every aircraft should have in open country \[m\]. It is the greatest distance that the map
    /// tells. Source: D21.
    pub const ROOM: f64 = 3.0;
    /// Weight of the squared lack of [`ROOM`] where all is open [1/m^2]. Half of it gave 0.1 m less clearance past 20
    /// obstacles. Source: D21.
    pub const WEIGHT: f64 = 4.0;
    /// Power of the share of open cells with which weight and margins fall [-]. With 4, past 120 obstacles 773 of 800
    /// flights succeeded against 783 without room; with 6 as many as without. Source: D21.
    pub const POWER: f64 = 6.0;
    /// Margins that programs keep beyond the first one where all is open and the candidate has the room [-]. With 3
    /// instead of 6, and the power of 4, the clearance past 20 obstacles was 1.8 m instead of 2.3 m. Source: D21.
    pub const MARGINS: f64 = 10.0;
    /// Greatest distance that programs keep in open country, in margins [-]: 3.2 m, somewhat more than [`ROOM`].
    /// Source: derived.
    pub const MOST_MARGINS: f64 = 4.0;
    /// Distance ahead within which open cells are counted \[cells\]: 26 m, as in [`super::UNKNOWN_AHEAD`].
    /// Source: derived.
    pub const AHEAD: u32 = 52;
}

/// Cost of a point of which the map knows nothing, at the aircraft [-]. It falls linearly to zero at
/// the distance of [`UNKNOWN_AHEAD`]. With a higher cost plans stay in the cells that the lidar has seen, and so turn
/// away from ways that would have been open. Source: D8, D10 (other costs gave no gain).
pub const UNKNOWN_COST: f64 = 5.0;

/// Distance ahead beyond which an unknown point costs an agile aircraft nothing \[m\]. It is two seconds of
/// flight; until then the lidar has looked again. 18, 20 and 36 m gave no gain. Source: D10.
pub const UNKNOWN_AHEAD: f64 = 26.0;

/// Greatest factor on [`UNKNOWN_AHEAD`] for an aircraft that turns little [-], which leads to 45 m, the usual range of a
/// lidar. What such an aircraft sees late it cannot dodge. With 1 instead of 1.75, 38.7 instead of 44.0 % of 1,500 flights with
/// limited actuators past 160 obstacles succeeded. Source: D38.
pub const UNKNOWN_STRETCH: f64 = 1.75;

/// The rolling occupancy grid. The log-odds of a cell are a whole number from `-FREE` to `LIMIT`, and 0 where no beam
/// has been.
pub mod grid {
    /// Edge of a cell \[m\]. Smaller cells show gaps better and cost time by their square; 0.25 m gave no
    /// gain. Source: D8.
    pub const CELL: f64 = 0.5;
    /// Number of columns of the window that stay behind the aircraft \[cells\]. They are 8 m, which is more
    /// than an obstacle's radius and the reach of a face together. Source: derived.
    pub const BEHIND: i32 = 16;
    /// Log-odds that one hit adds. One hit makes any cell occupied; two passing beams make the cell free again. Source: D8.
    pub const HIT: i8 = 60;
    /// Least log-odds at which a cell counts as occupied. Source: chosen.
    pub const OCCUPIED: i8 = 25;
    /// Log-odds that a beam takes away where it passes on its way to a hit. Source: chosen.
    pub const PASSED: i8 = 30;
    /// Log-odds that a beam without a return takes away where it passes. Its return may have been lost, so
    /// it takes away a third of [`PASSED`]. Source: chosen.
    pub const PASSED_UNANSWERED: i8 = 10;
    /// Greatest number of cells hit by one scan within a metre at which a hit is isolated [-]. Other beams
    /// of the scan do not clear isolated hits. With a greater number beams leave cells beside the rims of
    /// obstacles that are not occupied. Source: D15.
    pub const ISOLATED_CELLS: u32 = 2;
    /// Greatest log-odds for an obstacle. Three passing beams make such a cell free. Source: chosen.
    pub const LIMIT: i8 = 100;
    /// Greatest log-odds against an obstacle. However many beams have passed a cell, one hit makes it occupied. With a
    /// greater one the map does not take in a plate edge-on or a wire, past which more beams pass than hit it. Source: D15.
    pub const FREE: i8 = HIT - OCCUPIED;
    /// Distance between the points along a beam at which the map visits cells \[m\]. It is less than a
    /// cell's edge divided by the square root of two, so that the points skip no cell. Source: derived.
    pub const STEP: f64 = 0.35;
    /// Distance of the first of these points from the lidar \[m\]: half a cell, within the aircraft's own cell. Source: derived.
    pub const FIRST_STEP: f64 = 0.25;
    /// Share of its range by which a hit may be too far [-]: three standard deviations of a range error of
    /// 1 %. This last part of a beam before its hit shows nothing. Source: derived.
    pub const RANGE_DOUBT: f64 = 0.03;
    /// Length before a hit that shows nothing at any range \[m\]: two cells, for beams that graze a rim.
    /// Source: chosen.
    pub const HIT_DOUBT: f64 = 1.0;
    /// Number of occupied cells in the fan of a scan without returns at which the lidar counts as blind [-]. One
    /// false hit occupies one cell; the near side of a circle of 1 m radius occupies four or more. With 8 a lidar that
    /// shows nothing for 3 s past 20 obstacles was found in 240 of 400 flights at 1 Hz, with 4 in 368. Source: D37.
    pub const BLIND_CELLS: u32 = 4;
    /// Share of the fan and of the range in which [`BLIND_CELLS`] are counted [-]. Near the edges an error of the
    /// pose moves a cell out of sight. Source: chosen.
    pub const BLIND_SHARE: f64 = 0.8;
    /// Share of the lidar's range over which a beam without a return shows free space [-]: 40 m of 45 m. Source: chosen.
    pub const UNANSWERED_SHARE: f64 = 8.0 / 9.0;
}

/// Candidates of a cycle.
pub mod candidates {
    /// Number of beams that one slice takes in. This slice then takes less than half of the time of the
    /// longest slice. Source: derived.
    pub const BEAMS_PER_SLICE: usize = 16;
    /// Cost of a program, in prices of the best roll-out so far, from which on its candidate is given up [-]. The
    /// solver then makes a third fewer steps past 40 obstacles. With 100 and 50 instead of 200, 1,065 and 1,015 of
    /// 1,200 flights past 160 obstacles succeeded, against 1,077 without a limit and 1,081. Source: D24.
    pub const HOPELESS: f64 = 200.0;
    /// Thrust that counts in a program's last state like a metre \[N\], so 15 N cost as much as 0.15 m. A smaller one pulls
    /// the end of a plan to the thrust of trim. Source: chosen.
    pub const THRUST_SCALE: f64 = 100.0;
}

/// The lattice of stations downrange, heights and slopes. Its costs have the units of the judgement.
pub mod lattice {
    /// Distance between heights \[m\]: half a cell of the map. Source: derived.
    pub const RISE: f64 = 0.25;
    /// Distance between stations for an agile aircraft \[m\]. Over it the slope changes by one step at most: a
    /// curvature of 0.087 per metre, 1.6 times [`AGILE`]; roll-outs reach 1.75 times. With 3 m, the curvature of
    /// programs, 1,040 of 1,200 flights past 160 obstacles succeeded, and 1,077 with 2.4 m. Source: D22.
    pub const SPACING: f64 = 2.4;
    /// Curvature of an aircraft's programs from which on its stations stand at [`SPACING`] [1/m]: that of the
    /// reference aircraft with 0.2 rad. Source: derived.
    pub const AGILE: f64 = 0.5 / 9.0;
    /// Greatest factor on the distance between stations for an aircraft that turns little [-]. With 2.0,
    /// 19 of 800 flights more failed than with 1.5. Source: D12.
    pub const STRETCH: f64 = 1.5;
    /// Clearance that a path keeps \[m\]. It is more than the margin of programs, because a path is straight
    /// where the aircraft turns. Source: D8, D10, D11.
    pub const MARGIN: f64 = 1.2;
    /// Weight of the squared lack of [`MARGIN`] [1/m^2]. Source: chosen.
    pub const MARGIN_WEIGHT: f64 = 10.0;
    /// Cost of a change of the slope by one step, per station [-]. Source: chosen.
    pub const TURN_COST: f64 = 1.0;
    /// Weight of the squared slope in steps, per station [-]. Source: chosen.
    pub const SLOPE_WEIGHT: f64 = 0.05;
    /// Weight of the squared distance from the altitude, per station [1/m^2]. Source: D11.
    pub const ALTITUDE_WEIGHT: f64 = 0.01;
    /// Distance from floor and ceiling that a path keeps \[m\]. Source: chosen.
    pub const BAND_MARGIN: f64 = 0.5;
    /// Greatest cost of a point, in sixteenths [-]. Costs then stay finite whole numbers. Source: derived.
    pub const MOST_POINT_COST: f64 = 1e7;
    /// Greatest cost-to-go from the via station [-]. It also applies to places from which no path
    /// leads on. Source: chosen.
    pub const MOST_COST_TO_GO: f64 = 2000.0;
}

/// Faces between a candidate's segments and the obstacles around them.
pub mod faces {
    /// Distance from a segment beyond which obstacles do not matter to it \[m\]. A program moves a segment by
    /// less than this. Source: derived.
    pub const REACH: f64 = 4.0;
    /// Room that a program may use up on its way to a cheaper trajectory \[m\]. With 0.3 and 0.4 m fewer
    /// flights succeed under all conditions together (758 and 765 against 768 of 800). Source: D13.
    pub const GIVE: f64 = 0.2;
    /// Distance by which a trajectory may move where no obstacle is in the way \[m\]. It is finite, but no
    /// bound in practice. Source: derived.
    pub const FREE: f64 = 60.0;
    /// Distance that programs keep in addition to the margin \[m\], so that their roll-outs still keep the
    /// margin. Roll-outs differ from programs by a few centimetres after the first SQP iteration. Source: derived.
    pub const ROUNDING: f64 = 0.05;
    /// Greatest distance that programs keep where a candidate has the room, in margins [-]. Source: D13.
    pub const MOST_MARGINS: f64 = 2.0;
}

/// Limits of plans.
pub mod limits {
    /// Share of the elevator's range of angles of attack that plans use [-]. The regulator needs the rest.
    /// With 0.5 and 0.7, 133 and 138 of 200 flights succeeded, against 145 of 200. Source: D10, D11.
    pub const PLANNED_SHARE: f64 = 0.9;
    /// Share of the way from level flight to the stall that plans and the regulator may use [-]. At the stall half of the
    /// lift is gone. Gusts and errors of the estimate need the rest. Source: D40.
    pub const STALL_SHARE: f64 = 0.8;
    /// Least room to the stall that plans and the regulator keep \[rad\]. The flow separates gradually: some 0.05 rad before the
    /// stall the lift stops to grow, and an elevator that asks for more gets less. More room turns less tightly. With 0.075 rad
    /// the Cessna 310 flew 46 of 50 past 40, with 0.06 rad 48. Source: D40.
    pub const STALL_ROOM: f64 = 0.06;
    /// Share of the way to the stall that a wing with little room may use all the same [-]. Source: chosen.
    pub const STALL_LEAST_SHARE: f64 = 0.3;
    /// Lead of the regulator's guard against the stall [-]: the elevator may balance an angle of attack beyond the limit by
    /// this share of the room that is left, so that it can turn the aircraft there quickly. Source: D40.
    pub const STALL_LEAD: f64 = 1.0;
    /// Share of the elevator's rate that roll-outs use [-]. With a rate of 20 per second at 120 obstacles
    /// 0.5 flew 45 and 0.9 flew 48 of 60. Source: D15.
    pub const PLANNED_RATE_SHARE: f64 = 0.9;
    /// Time in which the elevator's rate reaches the greatest angle of attack of a plan \[s\]. More time
    /// allows tighter turns, but then the regulator meets the rate's limit: 0.1, 0.15 and 0.2 s flew 43, 48
    /// and 42 of 60. Source: D15.
    pub const REACH_TIME: f64 = 0.15;
    /// Factor on the limit of the angle of attack for roll-outs [-]. Soft rows may exceed that limit, and a
    /// roll-out follows up to this factor times the limit plus [`SOFT_EXTRA`]. Source: chosen.
    pub const SOFT_SHARE: f64 = 1.5;
    /// Addition to the limit of the angle of attack for roll-outs \[rad\]; see [`SOFT_SHARE`]. Beyond it a
    /// roll-out would stall. Source: chosen.
    pub const SOFT_EXTRA: f64 = 0.05;
}

/// The price of a roll-out.
pub mod judgement {
    /// Number of points in a stage at which the judgement takes the clearance: 0.75 m apart at 12 m/s.
    /// Source: derived.
    pub const SAMPLES: usize = 4;
    /// Weight of the squared lack of margin [1/m^2]. With a lower weight plans fly too close to obstacles to
    /// save effort; with a higher weight they make violent motions to gain centimetres. Source: D8.
    pub const LACK_WEIGHT: f64 = 100.0;
    /// Discount of the last stage against the first [-]. The vehicle plans the last stage again before it
    /// flies there. Source: chosen.
    pub const LAST_STAGE: f64 = 0.5;
    /// Weight of the squared lack of [`super::ROOM`] [1/m^2] for an aircraft that cannot turn at all. With
    /// half of this weight as many flights succeeded (769 against 768 of 800). Source: D13.
    pub const ROOM_WEIGHT: f64 = 2.0;
    /// Share of the costs of clearance and of the unknown that counts beyond the lattice's via station [-]. When the aircraft is there, it
    /// flies another plan. The judgement adds the cost-to-go of the lattice from there on.
    /// Source: D11.
    pub const FAR_SHARE: f64 = 0.5;
}

/// The gate before adoption, in the planner's own units. With these spares no plan of 300 clean flights past 160 obstacles was
/// refused as no motion of the aircraft, and a knot half a metre off is (test `gate.rs`).
pub mod gate {
    /// Distance within which no centre of an occupied cell may be, beside the body's radius \[m\]: half the diagonal of a
    /// cell, so that no point lies in an occupied one. The margin of plans is the planner's matter. Source: derived.
    pub const REACH: f64 = 0.36;
    /// Time from the beginning of a trajectory within which no command moves the aircraft by more than [`REACH`] \[s\]: at 1.4 g
    /// beyond level flight it moves 0.36 m in 0.23 s. What is struck before is struck by every trajectory. Source: derived.
    pub const REACTION: f64 = 0.25;
    /// Greatest distance between two points that are looked up \[m\]: half a cell. Source: derived.
    pub const STEP: f64 = 0.25;
    /// Most points looked up within an eighth of a second [-]; they bound the work. 16 reach 4 m, or 32 m/s. Source: derived.
    pub const MOST_POINTS: u16 = 16;
    /// Most cells to either side of a point that are looked up [-]; they bound the work. Source: derived.
    pub const MOST_CELLS: i32 = 4;
    /// Greatest distance of a trajectory's beginning from where the aircraft will be \[m\]. A previous plan is off by the
    /// error of tracking. Source: chosen.
    pub const START: f64 = 3.0;
    /// Distance that a trajectory may leave the band by \[m\]: rows of the band are soft. Source: chosen.
    pub const BAND_SPARE: f64 = 2.0;
    /// Time within which a reserve stays in cells that beams have seen free \[s\]: the way to the next two scans of a
    /// lidar at 1 Hz. Source: derived.
    pub const KNOWN_TIME: f64 = 2.0;
    /// Rest that a previous plan must have to be flown on \[s\]: two periods of a planner at 1 Hz. Source: derived.
    pub const REST: f64 = 2.0;
    /// Distance downrange of the place on a path at which a pursuit aims \[m\]. Nearer it weaves, farther it cuts corners.
    /// Source: chosen.
    pub const LOOK_AHEAD: f64 = 4.0;
    /// Thrust for a lack of airspeed in a pursuit [N s/m]. Source: chosen.
    pub const SPEED_GAIN: f64 = 4.0;
    /// Load beyond that of level flight at cruise that an angle of attack may stand for \[g\]. Roll-outs reach 1.4.
    /// Source: derived.
    pub const MOST_LOAD: f64 = 2.0;
    /// Least airspeed, as a share of cruise [-]. Source: chosen.
    pub const LEAST_SPEED: f64 = 0.4;
    /// Greatest airspeed, as a multiple of cruise [-]. Source: chosen.
    pub const MOST_SPEED: f64 = 2.5;
    /// Greatest angle of the path \[rad\]: twice that of programs. Source: chosen.
    pub const MOST_PATH: f64 = 1.2;
    /// Thrust beyond the motor's that is rounding \[N\]. Source: chosen.
    pub const THRUST_SPARE: f64 = 0.01;
    /// Greatest error of a place against the mean of its speeds \[m\]. Source: chosen.
    pub const PLACE: f64 = 0.15;
    /// Greatest error of the balance of forces \[g\]. Source: chosen.
    pub const LOAD_SPARE: f64 = 0.3;
}

/// The estimate of position and wind.
pub mod navigation {
    /// Greatest accepted innovation of a position, in standard deviations [-]. A healthy source exceeds it
    /// once in 5e8 positions. Source: derived.
    pub const GATE: f64 = 6.0;
    /// Least standard deviation of a position \[m\] and of a velocity over ground [m/s] that the filter
    /// believes. It keeps the covariance regular. With 1 mm at 100 Hz the wind follows within two ticks.
    /// Source: derived.
    pub const LEAST_SIGMA: f64 = 1e-3;
    /// Standard deviation of the wind before the first position [m/s]. Source: derived; it covers a fresh
    /// breeze along and a thermal across.
    pub const FIRST_WIND: f64 = 3.0;
    /// Greatest plausible wind along an axis [m/s]. Source: D10.
    pub const MOST_WIND: f64 = 10.0;
    /// Standard deviation of the wind below which the estimate of the lift begins [m/s]. Source: derived.
    pub const SETTLED_WIND: f64 = 1.0;
    /// Share of the greatest change of the wind that the filter for plans assumes [-]. A smaller share lets less noise of
    /// the positions into the start of a plan, and follows strong gusts later. Source: D34.
    pub const SMOOTH_SHARE: f64 = 0.5;
    /// Time without an accepted position after which the filter restarts from a refused one \[s\]. Before
    /// it a jump of the source does no harm; after it the source is believed again. Source: chosen.
    pub const RESTART_TIME: f64 = 1.0;
}

/// The estimate of the lift.
pub mod lift {
    /// Time of observation after which the observed lift and the known airframe have equal weight \[s\]. Over
    /// a shorter time gusts change the mean acceleration by more than errors of the airframe do. Source: D12.
    pub const TRUST_TIME: f64 = 0.7;
    /// Time of observation beyond which the estimator slowly forgets older observations \[s\]. Source: chosen.
    pub const MEMORY: f64 = 6.0;
    /// Greatest plausible offset of the lift coefficient of the reference aircraft [-]: somewhat more than a
    /// quarter of the lift of level flight. Source: derived.
    pub const MOST: f64 = 0.4;
    /// Greatest rate of the answer to the elevator that the estimator follows [rad/s]. A faster one is over while a tenth of
    /// the offset is learnt. With 70 rad/s `skywalker_2013`, whose plans ask for more than its elevator can damp, flew 20 of 50
    /// past 40, and 32 with a balance. Source: D51.
    pub const SLOW_ANSWER: f64 = 10.0;
}

/// Tracking of a trajectory at 100 Hz.
pub mod tracking {
    /// Least ground speed ahead in the computation of a course [m/s]. It keeps the divisor away from zero.
    /// Source: derived.
    pub const LEAST_ADVANCE: f64 = 1.0;
    /// Greatest angle by which the regulator turns a reference back to its path \[rad\]. With 0.08 rad/m the
    /// angle reaches this value 1.9 m from the path. Source: derived.
    pub const MOST_TURN: f64 = 0.15;
}

/// The least stability of the regulator, which is checked before the flight.
pub mod stability {
    /// Factor on the gains of the regulator with which the loop must still be stable, with commands that come
    /// a tick late [-]. It stands for what the check leaves out: the estimator's delay and noise, the lag of
    /// actuators and errors of the airframe. With 2 the check accepts weights that pitch the aircraft by 45
    /// degrees in level flight; a greater factor refuses firm regulators that fly. Source: the test
    /// `flyable.rs`.
    pub const GAIN_MARGIN: f64 = 2.5;
    /// Greatest growth of a motion within a tick [-]. It lets slow motions grow e-fold in 10 s, which the
    /// planner corrects, and a height that nothing holds stand still. Source: derived.
    pub const MOST_GROWTH: f64 = 1.001;
}

/// The lateral regulator. Its weights count a radian of bank error as 1.
pub mod lateral {
    /// Bandwidth with which the reference aircraft reaches a bank [rad/s]; others have it in their own unit of time. More
    /// holds the bank better in gusts, and needs faster servos. Source: `mpp-sim/tests/bank.rs`.
    pub const BANDWIDTH: f64 = 6.0;
    /// Weight of the squared sideslip [-]. More damps the yaw more, and uses more rudder. Source: `mpp-sim/tests/bank.rs`.
    pub const SIDESLIP: f64 = 1.0;
    /// Weight of the squared rudder [-]. Less damps the yaw more. Source: `mpp-sim/tests/bank.rs`.
    pub const RUDDER: f64 = 1.0;
    /// Time in which the integral of a bank error equals the error's own aileron \[s\]. Less takes away slow gusts sooner, and
    /// overshoots. Source: `mpp-sim/tests/bank.rs`.
    pub const INTEGRAL_TIME: f64 = 1.0;
    /// Share of the aileron that the integral may use [-]. More holds stronger asymmetries, and leaves less against gusts.
    /// Source: chosen.
    pub const INTEGRAL_SHARE: f64 = 1.0 / 3.0;
}
