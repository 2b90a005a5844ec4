//! The columns of every table: name, kind, unit, frame, meaning.
//!
//! Frames: `world` is the vertical plane of the flight, x downrange from the start, z up from the ground; `body` is fixed
//! to the aircraft; `air` is the motion relative to the air.

/// Version of all tables here. A new column at the end of a table keeps it; anything else raises it.
pub const VERSION: u32 = 1;

/// What kind of values a column holds. Every value may be null.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers, 64-bit floating point.
    Real,
    /// Whole numbers from 0 to 2^64 - 1.
    Whole,
    /// True or false.
    Truth,
    /// Text.
    Text,
}

/// A column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name, in every format.
    pub name: &'static str,
    /// Kind of its values.
    pub kind: Kind,
    /// Unit; 1 for pure numbers, and empty for what has none.
    pub unit: &'static str,
    /// Frame; empty for what has none.
    pub frame: &'static str,
    /// Meaning.
    pub about: &'static str,
}

/// A table's name and columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schema {
    /// Name of the table.
    pub name: &'static str,
    /// Its columns, in their order.
    pub columns: &'static [Column],
}

const fn column(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    frame: &'static str,
    about: &'static str,
) -> Column {
    Column {
        name,
        kind,
        unit,
        frame,
        about,
    }
}

/// The ticks of a flight, 100 in a second.
#[rustfmt::skip]
pub const TICKS: Schema = Schema {
    name: "ticks",
    columns: &[
        column("t", Kind::Real, "s", "", "time since the start"),
        column("x", Kind::Real, "m", "world", "true downrange distance"),
        column("z", Kind::Real, "m", "world", "true height"),
        column("airspeed", Kind::Real, "m/s", "air", "true airspeed"),
        column("pitch", Kind::Real, "rad", "world", "true pitch, nose up"),
        column("pitch_rate", Kind::Real, "rad/s", "body", "true pitch rate, nose up"),
        column("flight_path", Kind::Real, "rad", "air", "true flight path angle of the motion through the air, up"),
        column("measured_airspeed", Kind::Real, "m/s", "air", "measured airspeed"),
        column("measured_pitch", Kind::Real, "rad", "world", "measured pitch"),
        column("est_airspeed", Kind::Real, "m/s", "air", "estimated airspeed"),
        column("est_pitch", Kind::Real, "rad", "world", "estimated pitch"),
        column("est_pitch_rate", Kind::Real, "rad/s", "body", "estimated pitch rate"),
        column("est_flight_path", Kind::Real, "rad", "air", "estimated flight path angle"),
        column("est_x", Kind::Real, "m", "world", "estimated downrange distance"),
        column("est_z", Kind::Real, "m", "world", "estimated height"),
        column("est_wind_x", Kind::Real, "m/s", "world", "estimated motion of the air, downrange"),
        column("est_wind_z", Kind::Real, "m/s", "world", "estimated motion of the air, up"),
        column("est_lift", Kind::Real, "1", "", "estimated excess of the lift coefficient over that of the known airframe"),
        column("ref_x", Kind::Real, "m", "world", "downrange distance that the plan asks for; this and the other references are null without a plan"),
        column("ref_z", Kind::Real, "m", "world", "height that the plan asks for"),
        column("ref_airspeed", Kind::Real, "m/s", "air", "airspeed that the plan asks for"),
        column("ref_pitch", Kind::Real, "rad", "world", "pitch that the plan asks for"),
        column("ref_pitch_rate", Kind::Real, "rad/s", "body", "pitch rate that the plan asks for"),
        column("ref_flight_path", Kind::Real, "rad", "air", "flight path angle that the plan asks for"),
        column("thrust", Kind::Real, "N", "body", "commanded thrust"),
        column("elevator", Kind::Real, "1", "body", "commanded elevator, in units of the aircraft file"),
        column("applied_thrust", Kind::Real, "N", "body", "thrust that the actuators gave"),
        column("applied_elevator", Kind::Real, "1", "body", "elevator that the actuators gave"),
        column("wind_x", Kind::Real, "m/s", "world", "true motion of the air, downrange"),
        column("wind_z", Kind::Real, "m/s", "world", "true motion of the air, up"),
    ],
};

/// The lateral part of the ticks of a flight in space. Positive is to the right.
#[rustfmt::skip]
pub const LATERAL: Schema = Schema {
    name: "lateral",
    columns: &[
        column("t", Kind::Real, "s", "", "time since the start"),
        column("y", Kind::Real, "m", "world", "true position to the right of the start"),
        column("bank", Kind::Real, "rad", "air", "true bank about the direction of flight"),
        column("course", Kind::Real, "rad", "air", "true course through the air"),
        column("sideslip", Kind::Real, "rad", "air", "true sideslip"),
        column("roll_rate", Kind::Real, "rad/s", "body", "true roll rate"),
        column("yaw_rate", Kind::Real, "rad/s", "body", "true yaw rate"),
        column("est_y", Kind::Real, "m", "world", "estimated position to the right"),
        column("est_bank", Kind::Real, "rad", "air", "estimated bank"),
        column("est_course", Kind::Real, "rad", "air", "estimated course through the air"),
        column("est_wind_y", Kind::Real, "m/s", "world", "estimated motion of the air, to the right"),
        column("ref_y", Kind::Real, "m", "world", "position to the right that the plan asks for; this and the other references are null without a plan"),
        column("ref_bank", Kind::Real, "rad", "air", "bank that the plan asks for"),
        column("ref_course", Kind::Real, "rad", "air", "course through the air that the plan asks for"),
        column("aileron", Kind::Real, "rad", "body", "commanded aileron"),
        column("rudder", Kind::Real, "rad", "body", "commanded rudder"),
        column("applied_aileron", Kind::Real, "rad", "body", "aileron that the servo gave"),
        column("applied_rudder", Kind::Real, "rad", "body", "rudder that the servo gave"),
        column("wind_y", Kind::Real, "m/s", "world", "true motion of the air, to the right"),
    ],
};

/// The plans that the core delivered.
#[rustfmt::skip]
pub const PLANS: Schema = Schema {
    name: "plans",
    columns: &[
        column("tick", Kind::Whole, "tick", "", "tick of the scan from which the plan was made, or of the start of a cycle without a scan; a tick is 0.01 s"),
        column("used_from_tick", Kind::Whole, "tick", "", "first tick that flew the plan; null if no tick did"),
        column("outcome", Kind::Text, "", "", "verdict of the planner"),
        column("candidates", Kind::Whole, "1", "", "refined candidates"),
        column("feasible", Kind::Whole, "1", "", "candidates that met every constraint"),
        column("tree_runs", Kind::Whole, "1", "", "runs of the path search"),
        column("slices", Kind::Whole, "1", "", "slices of planning work"),
        column("cost", Kind::Real, "1", "", "cost of the chosen trajectory; null without one"),
        column("violation", Kind::Real, "m", "", "worst constraint violation of the chosen trajectory; null without one"),
        column("way_out", Kind::Real, "s", "", "time for which a plan in space has a way out, 4.5 s on it; null in the plane"),
    ],
};

/// The inputs that the core refused.
#[rustfmt::skip]
pub const REJECTIONS: Schema = Schema {
    name: "rejections",
    columns: &[
        column("tick", Kind::Whole, "tick", "", "tick of the input"),
        column("cause", Kind::Text, "", "", "cause of the refusal"),
    ],
};

/// The changes of the core's trust in a sensor.
#[rustfmt::skip]
pub const SENSORS: Schema = Schema {
    name: "sensors",
    columns: &[
        column("tick", Kind::Whole, "tick", "", "tick of the change"),
        column("sensor", Kind::Text, "", "", "airspeed, pitch, position, lidar, elevator or motor"),
        column("state", Kind::Text, "", "", "healthy, suspected, excluded or recovering, from this tick on"),
    ],
};

/// The flights of a campaign.
#[rustfmt::skip]
pub const ROWS: Schema = Schema {
    name: "rows",
    columns: &[
        column("preset", Kind::Text, "", "", "preset"),
        column("field", Kind::Text, "", "", "name of the field file; null without one"),
        column("generator", Kind::Text, "", "", "generator of the random obstacles"),
        column("obstacles", Kind::Whole, "1", "", "number of random obstacles"),
        column("paths", Kind::Whole, "1", "", "most candidate paths of a cycle"),
        column("replan_hz", Kind::Real, "Hz", "", "replanning rate"),
        column("oracle", Kind::Truth, "", "", "whether an oracle flew"),
        column("seed", Kind::Whole, "1", "", "seed"),
        column("success", Kind::Truth, "", "", "success by the paper's rule"),
        column("outcome", Kind::Text, "", "", "outcome: survived, or the event that ended the flight"),
        column("strict", Kind::Truth, "", "", "success that never left the altitude band"),
        column("class", Kind::Text, "", "", "class in which a campaign counts the flight"),
        column("failure_cause", Kind::Text, "", "", "cause of the failure; null without one"),
        column("failure_seen_before", Kind::Real, "s", "", "time from the first scan that met the obstacle until impact; null without one"),
        column("failure_plan_clearance", Kind::Real, "m", "", "least distance of the plan from the obstacle's edge, negative inside; null without one"),
        column("failure_off_plan", Kind::Real, "m", "", "distance of the aircraft from its plan at impact; null without one"),
        column("t_end", Kind::Real, "s", "", "time at the end"),
        column("x_end", Kind::Real, "m", "world", "downrange distance at the end"),
        column("min_clearance", Kind::Real, "m", "", "least distance to an obstacle's edge; null without obstacles"),
        column("max_altitude_deviation", Kind::Real, "m", "", "greatest distance from the initial altitude"),
        column("replans", Kind::Whole, "1", "", "plans delivered"),
        column("candidates", Kind::Whole, "1", "", "refined candidates over all plans"),
        column("feasible", Kind::Whole, "1", "", "feasible candidates over all plans"),
        column("slices", Kind::Whole, "1", "", "slices of planning work over all plans"),
        column("known_collision", Kind::Truth, "", "", "whether it hit an obstacle that a beam had met more than 1 s before"),
        column("log_hash", Kind::Text, "", "", "hash of the flight's log"),
        column("core_ms", Kind::Real, "ms", "", "wall time of the core's work; null unless the campaign measured it"),
        column("avoidable", Kind::Truth, "", "", "whether commands of the last 2 s could have avoided a known collision; null if undecided or without one"),
    ],
};

/// All tables.
pub const ALL: [&Schema; 5] = [&TICKS, &PLANS, &REJECTIONS, &SENSORS, &ROWS];
