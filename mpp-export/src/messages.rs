//! Messages and JSON schemas for MCAP: our tables, and Foxglove's schemas by their names.
//!
//! Frames: `world` with x downrange and z up, `body` with x along the nose. The plane of the flight is y = 0.

use crate::schema::{Column, Kind, Schema};
use serde_json::{Map, Value, json};

/// Name of the frame of the ground.
pub(crate) const WORLD: &str = "world";
/// Name of the frame of the aircraft.
pub(crate) const BODY: &str = "body";

/// The JSON schema of a table's messages.
pub(crate) fn table_schema(schema: &Schema) -> Value {
    let property = |column: &Column| {
        let kind = match column.kind {
            Kind::Real => "number",
            Kind::Whole => "integer",
            Kind::Truth => "boolean",
            Kind::Text => "string",
        };
        let about = format!("{} [{}] {}", column.about, column.unit, column.frame);
        let property = json!({ "type": [kind, "null"], "description": about.trim_end() });
        (column.name.to_owned(), property)
    };
    let properties: Map<String, Value> = schema.columns.iter().map(property).collect();
    object(&format!("mpp.{}", schema.name), &Value::from(properties))
}

pub(crate) fn object(title: &str, properties: &Value) -> Value {
    json!({ "title": title, "type": "object", "properties": properties })
}

pub(crate) fn array(items: &Value) -> Value {
    json!({ "type": "array", "items": items })
}

fn numbers(title: &str, names: &[&str]) -> Value {
    let number = |name: &&str| ((*name).to_owned(), json!({ "type": "number" }));
    object(
        title,
        &names
            .iter()
            .map(number)
            .collect::<Map<String, Value>>()
            .into(),
    )
}

fn moment(title: &str) -> Value {
    let whole = json!({ "type": "integer", "minimum": 0 });
    object(title, &json!({ "sec": whole, "nsec": whole }))
}

pub(crate) fn text() -> Value {
    json!({ "type": "string" })
}

pub(crate) fn pose_schema() -> Value {
    let position = numbers("foxglove.Vector3", &["x", "y", "z"]);
    let orientation = numbers("foxglove.Quaternion", &["x", "y", "z", "w"]);
    object(
        "foxglove.Pose",
        &json!({ "position": position, "orientation": orientation }),
    )
}

/// The JSON schema of `foxglove.FrameTransform`.
pub(crate) fn frame_transform_schema() -> Value {
    let properties = json!({
        "timestamp": moment("time"), "parent_frame_id": text(), "child_frame_id": text(),
        "translation": numbers("foxglove.Vector3", &["x", "y", "z"]),
        "rotation": numbers("foxglove.Quaternion", &["x", "y", "z", "w"]),
    });
    object("foxglove.FrameTransform", &properties)
}

/// The JSON schema of `foxglove.PoseInFrame`.
pub(crate) fn pose_in_frame_schema() -> Value {
    let properties =
        json!({ "timestamp": moment("time"), "frame_id": text(), "pose": pose_schema() });
    object("foxglove.PoseInFrame", &properties)
}

/// The JSON schema of `foxglove.LaserScan`.
pub(crate) fn laser_scan_schema() -> Value {
    let number = json!({ "type": "number" });
    let properties = json!({
        "timestamp": moment("time"), "frame_id": text(), "pose": pose_schema(), "start_angle": number,
        "end_angle": number, "ranges": array(&number), "intensities": array(&number),
    });
    object("foxglove.LaserScan", &properties)
}

/// The JSON schema of `foxglove.SceneUpdate`, of which we write lines, and in space cylinders, spheres and cubes.
pub(crate) fn scene_update_schema() -> Value {
    let point = numbers("foxglove.Point3", &["x", "y", "z"]);
    let colour = numbers("foxglove.Color", &["r", "g", "b", "a"]);
    let line = json!({
        "type": { "type": "integer", "description": "0 strip, 1 loop, 2 list" }, "pose": pose_schema(),
        "thickness": { "type": "number" }, "scale_invariant": { "type": "boolean" },
        "points": array(&point), "color": colour, "colors": array(&colour),
        "indices": array(&json!({ "type": "integer" })),
    });
    let scale = json!({ "type": "number" });
    let shape = json!({
        "pose": pose_schema(), "size": numbers("foxglove.Vector3", &["x", "y", "z"]), "color": colour,
        "bottom_scale": scale, "top_scale": scale,
    });
    let solid = |kind: &str| array(&object(&format!("foxglove.{kind}Primitive"), &shape));
    let entity = json!({
        "timestamp": moment("time"), "frame_id": text(), "id": text(), "lifetime": moment("duration"),
        "frame_locked": { "type": "boolean" }, "metadata": array(&json!({ "type": "object" })),
        "lines": array(&object("foxglove.LinePrimitive", &line)),
        "cylinders": solid("Cylinder"), "spheres": solid("Sphere"), "cubes": solid("Cube"),
    });
    let deletion =
        json!({ "timestamp": moment("time"), "type": { "type": "integer" }, "id": text() });
    let properties = json!({
        "deletions": array(&object("foxglove.SceneEntityDeletion", &deletion)),
        "entities": array(&object("foxglove.SceneEntity", &entity)),
    });
    object("foxglove.SceneUpdate", &properties)
}

/// A time since the start \[ns\].
pub(crate) fn stamp(nanoseconds: u64) -> Value {
    json!({ "sec": nanoseconds / 1_000_000_000, "nsec": nanoseconds % 1_000_000_000 })
}

/// Turned nose up by an angle \[rad\]: about -y.
fn nose_up(pitch: f64) -> Value {
    let (sin, cos) = libm::sincos(pitch / 2.0);
    json!({ "x": 0.0, "y": -sin, "z": 0.0, "w": cos })
}

fn place(x: f64, z: f64) -> Value {
    json!({ "x": x, "y": 0.0, "z": z })
}

/// Place \[m\] and attitude of the aircraft.
pub(crate) struct Stance {
    place: Value,
    rotation: Value,
}

impl Stance {
    /// In the vertical plane, at a pitch \[rad\].
    pub(crate) fn plane((x, z): (f64, f64), pitch: f64) -> Self {
        Self {
            place: place(x, z),
            rotation: nose_up(pitch),
        }
    }

    /// In space, `y` to the right, with bank, pitch and course \[rad\]. Foxglove's y axis points to the left.
    pub(crate) fn space([x, y, z]: [f64; 3], [bank, pitch, course]: [f64; 3]) -> Self {
        let half = |angle: f64| libm::sincos(angle / 2.0);
        let ((sr, cr), (sp, cp), (sy, cy)) = (half(bank), half(-pitch), half(-course));
        Self {
            place: json!({ "x": x, "y": -y, "z": z }),
            rotation: json!({
                "x": cy * cp * sr - sy * sp * cr, "y": cy * sp * cr + sy * cp * sr,
                "z": sy * cp * cr - cy * sp * sr, "w": cy * cp * cr + sy * sp * sr,
            }),
        }
    }
}

/// A `foxglove.FrameTransform` of the aircraft.
pub(crate) fn frame_transform(time: u64, at: &Stance) -> Value {
    json!({
        "timestamp": stamp(time), "parent_frame_id": WORLD, "child_frame_id": BODY,
        "translation": at.place, "rotation": at.rotation,
    })
}

/// A `foxglove.PoseInFrame` of the aircraft.
pub(crate) fn pose_in_frame(time: u64, at: &Stance) -> Value {
    let pose = json!({ "position": at.place, "orientation": at.rotation });
    json!({ "timestamp": stamp(time), "frame_id": WORLD, "pose": pose })
}

/// A `foxglove.LaserScan`. Its plane is x and y of its pose, so the pose is turned about x until y is up.
pub(crate) fn laser_scan(time: u64, scan: &hil_protocol::LidarScan) -> Value {
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let first = f64::from(scan.angle_min);
    let steps = scan.ranges.len().saturating_sub(1) as f64;
    let pose = json!({
        "position": place(0.0, 0.0), "orientation": { "x": half, "y": 0.0, "z": 0.0, "w": half },
    });
    json!({
        "timestamp": stamp(time), "frame_id": BODY, "pose": pose, "start_angle": first,
        "end_angle": first + steps * f64::from(scan.angle_increment),
        "ranges": scan.ranges.as_slice(), "intensities": [],
    })
}

/// How the points of a line are joined.
#[derive(Clone, Copy)]
pub(crate) enum Joined {
    Strip = 0,
    Loop = 1,
}

/// A `foxglove.LinePrimitive` through these places of the flight's plane \[m\].
pub(crate) fn line(
    joined: Joined,
    thickness: f64,
    colour: [f64; 4],
    points: impl IntoIterator<Item = (f64, f64)>,
) -> Value {
    let points = points.into_iter().map(|(x, z)| [x, 0.0, z]);
    line_in_space(joined, thickness, colour, points)
}

/// A `foxglove.LinePrimitive` through these places in Foxglove's axes \[m\].
pub(crate) fn line_in_space(
    joined: Joined,
    thickness: f64,
    [r, g, b, a]: [f64; 4],
    points: impl IntoIterator<Item = [f64; 3]>,
) -> Value {
    let place = |[x, y, z]: [f64; 3]| json!({ "x": x, "y": y, "z": z });
    let points: Vec<Value> = points.into_iter().map(place).collect();
    json!({
        "type": joined as u8, "pose": upright([0.0; 3]),
        "thickness": thickness, "scale_invariant": false, "points": points,
        "color": { "r": r, "g": g, "b": b, "a": a }, "colors": [], "indices": [],
    })
}

/// A `foxglove.Pose` at a place \[m\], not turned.
pub(crate) fn upright([x, y, z]: [f64; 3]) -> Value {
    json!({ "position": { "x": x, "y": y, "z": z }, "orientation": nose_up(0.0) })
}

/// A `foxglove.SceneUpdate` that replaces the entity of this name.
pub(crate) fn scene_update(time: u64, id: &str, lines: &[Value]) -> Value {
    scene_of(time, id, &json!({ "lines": lines }))
}

/// The same of any shapes, lists by kind.
pub(crate) fn scene_of(time: u64, id: &str, shapes: &Value) -> Value {
    let mut entity = json!({
        "timestamp": stamp(time), "frame_id": WORLD, "id": id, "lifetime": { "sec": 0, "nsec": 0 },
        "frame_locked": false, "metadata": [],
    });
    for (kind, shapes) in shapes.as_object().into_iter().flatten() {
        entity[kind] = shapes.clone();
    }
    json!({ "deletions": [], "entities": [entity] })
}
