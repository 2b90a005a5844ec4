//! What a flight in space looks like: clouds of the lidar, what stands there, and the paths of each cycle.

use crate::messages::{
    Joined, WORLD, array, line_in_space, object, pose_schema, scene_of, stamp, text, upright,
};
use crate::scene::{CANDIDATE, CHOSEN, OBSTACLE};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use mpp_sim::log::FlightLog;
use mpp_sim::orders::Order;
use mpp_sim::space::world::Body;
use mpp_sim::space::{Look, SpaceCycle};
use serde_json::{Value, json};

/// Nanoseconds of a tick.
const TICK: u64 = 10_000_000;
/// Bytes of a point, and Foxglove's number for a float of 32 bits.
const STRIDE: u32 = 12;
const FLOAT32: u32 = 7;
/// How much higher than the ceiling bodies without an end are drawn \[m\].
const ABOVE: f64 = 3.0;

/// A message: its time \[ns\], and its JSON.
type Timed = (u64, Value);

/// The JSON schema of `foxglove.PointCloud`.
pub(crate) fn points_schema() -> Value {
    let whole = json!({ "type": "integer", "minimum": 0 });
    let field = json!({ "name": text(), "offset": whole, "type": whole });
    let properties = json!({
        "timestamp": object("time", &json!({ "sec": whole, "nsec": whole })), "frame_id": text(),
        "pose": pose_schema(), "point_stride": whole,
        "fields": array(&object("foxglove.PackedElementField", &field)),
        "data": { "type": "string", "contentEncoding": "base64" },
    });
    object("foxglove.PointCloud", &properties)
}

/// The cloud of each sweep, and the paths of its cycle.
pub(crate) fn cycles(look: &Look) -> [Vec<Timed>; 2] {
    let timed = |message: fn(u64, &SpaceCycle) -> Value| {
        let of = |cycle: &SpaceCycle| {
            let time = u64::from(cycle.tick) * TICK;
            (time, message(time, cycle))
        };
        look.cycles.iter().map(of).collect()
    };
    [timed(points), timed(paths)]
}

fn points(time: u64, cycle: &SpaceCycle) -> Value {
    let parts = cycle.hits.chunks_exact(3).flat_map(place);
    let bytes: Vec<u8> = parts.flat_map(|part| (part as f32).to_le_bytes()).collect();
    let field = |(number, name): (u32, &str)| json!({ "name": name, "offset": 4 * number, "type": FLOAT32 });
    let fields: Vec<Value> = (0..).zip(["x", "y", "z"]).map(field).collect();
    json!({
        "timestamp": stamp(time), "frame_id": WORLD, "pose": upright([0.0; 3]),
        "point_stride": STRIDE, "fields": fields, "data": BASE64_STANDARD.encode(bytes),
    })
}

/// Ahead, right and up [0.01 m] in Foxglove's axes \[m\].
fn place(hundredths: &[i32]) -> [f64; 3] {
    let part = |axis: usize| hundredths.get(axis).map_or(0.0, |it| 0.01 * f64::from(*it));
    [part(0), -part(1), part(2)]
}

fn paths(time: u64, cycle: &SpaceCycle) -> Value {
    let last = cycle.paths.len().saturating_sub(1);
    let path = |(number, knots): (usize, &Vec<[i32; 4]>)| {
        let (thickness, colour) = if number == last {
            (0.15, CHOSEN)
        } else {
            (0.05, CANDIDATE)
        };
        line_in_space(
            Joined::Strip,
            thickness,
            colour,
            knots.iter().map(|knot| place(knot)),
        )
    };
    let lines: Vec<Value> = cycle.paths.iter().enumerate().map(path).collect();
    scene_of(time, "plan", &json!({ "lines": lines }))
}

/// What stands there from the start, and each trunk that was planted.
pub(crate) fn bodies(log: &FlightLog, look: &Look) -> Vec<Timed> {
    let space = log.header.space.as_ref();
    let top = space.map_or(0.0, |space| space.extent[2]) + ABOVE;
    let planted = |(number, entry): (usize, &mpp_sim::orders::OrderEntry)| {
        let Order::Trunk { x, y, radius } = entry.order else {
            return None;
        };
        let height = f64::INFINITY;
        let trunk = Body::Cylinder {
            x,
            y,
            radius,
            height,
        };
        let time = entry.tick * TICK;
        Some((
            time,
            solid(time, &format!("planted {number}"), &[trunk], top),
        ))
    };
    let orders = log.orders.iter().enumerate().filter_map(planted);
    core::iter::once((0, solid(0, "field", &look.bodies, top)))
        .chain(orders)
        .collect()
}

fn solid(time: u64, id: &str, bodies: &[Body], top: f64) -> Value {
    let [r, g, b, a] = OBSTACLE;
    let colour = json!({ "r": r, "g": g, "b": b, "a": a });
    let [mut cylinders, mut spheres, mut cubes, mut lines] = [const { Vec::new() }; 4];
    let shape = |centre: [f64; 3], [x, y, z]: [f64; 3]| json!({ "pose": upright(centre), "size": { "x": x, "y": y, "z": z }, "color": colour });
    for body in bodies {
        match *body {
            Body::Cylinder {
                x,
                y,
                radius,
                height,
            } => {
                let (wide, high) = (2.0 * radius, height.min(top));
                let mut cylinder = shape([x, -y, 0.5 * high], [wide, wide, high]);
                cylinder["top_scale"] = 1.0.into();
                cylinder["bottom_scale"] = 1.0.into();
                cylinders.push(cylinder);
            }
            Body::Sphere {
                centre: [x, y, z],
                radius,
            } => {
                spheres.push(shape([x, -y, z], [2.0 * radius; 3]));
            }
            Body::Box { least, most } => {
                let most = [most[0], most[1], most[2].min(top)];
                let [x, y, z] = [0, 1, 2].map(|axis| 0.5 * (least[axis] + most[axis]));
                let size = [0, 1, 2].map(|axis| most[axis] - least[axis]);
                cubes.push(shape([x, -y, z], size));
            }
            Body::Capsule { from, to, radius } => {
                let ends = [from, to].map(|[x, y, z]| [x, -y, z]);
                lines.push(line_in_space(Joined::Strip, 2.0 * radius, OBSTACLE, ends));
            }
        }
    }
    let shapes =
        json!({ "cylinders": cylinders, "spheres": spheres, "cubes": cubes, "lines": lines });
    scene_of(time, id, &shapes)
}
