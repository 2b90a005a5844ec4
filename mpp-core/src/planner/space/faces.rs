//! The corridor of a candidate: planes between its segments and the voxels around them.

use super::candidate::{SpacePlan, dot};
use super::keep::Keep;
use crate::map::VoxelField;
use crate::qp::space::Faces;
use crate::tuning::space_program::{BEHIND, FACES, REACH};
use crate::vehicle::between;

/// Distance of a voxel from a segment below which the normal is not told by it \[m\].
const TOUCHES: f64 = 0.05;
/// Distance from floor, ceiling and sides from which they are faces \[m\].
const NEAR_BAND: f64 = 8.0;

/// Separates the segment of a stage from the obstacles around it. A plane holds at both ends of its segment. Its normal points
/// from the segment to the nearest voxel, and the voxels behind it give no planes of their own.
pub(super) fn separate(
    field: &VoxelField,
    plan: &SpacePlan,
    keep: &Keep,
    stage: usize,
    faces: &mut Faces,
) {
    let (Some(from), Some(to)) = (plan.knots.get(stage), plan.knots.get(stage + 1)) else {
        return;
    };
    if field.covers(from.position[0].min(to.position[0]) - REACH) {
        let wings = [from.wing(), to.wing()];
        separate_segment(
            field,
            [&from.position, &to.position],
            &wings,
            keep,
            |boundary, normal, bound| {
                faces.push(stage + boundary, normal, bound);
            },
        );
    }
    let [_, y, z] = to.position;
    let [low, high] = keep.heights;
    if z - low < NEAR_BAND {
        faces.push(stage + 1, [0.0, 0.0, -1.0], -low);
    }
    if high - z < NEAR_BAND {
        faces.push(stage + 1, [0.0, 0.0, 1.0], high);
    }
    if keep.half_width - libm::fabs(y) < NEAR_BAND {
        let side = if y < 0.0 { -1.0 } else { 1.0 };
        faces.push(stage + 1, [0.0, side, 0.0], keep.half_width);
    }
}

/// Calls `face` with 0 or 1 for the end of the segment, a normal, and the bound at that end.
fn separate_segment(
    field: &VoxelField,
    [from, to]: [&[f64; 3]; 2],
    wings: &[[f64; 3]; 2],
    keep: &Keep,
    mut face: impl FnMut(usize, [f64; 3], f64),
) {
    let low = core::array::from_fn(|axis| from[axis].min(to[axis]) - REACH);
    let high = core::array::from_fn(|axis| from[axis].max(to[axis]) + REACH);
    let along: [f64; 3] = core::array::from_fn(|axis| to[axis] - from[axis]);
    let length_squared = dot(&along, &along).max(1e-6);
    let mut planes: heapless::Vec<([f64; 3], f64), FACES> = heapless::Vec::new();
    for _ in 0..FACES {
        let mut nearest = (REACH * REACH, [0.0; 3], [0.0; 3]);
        field.surface(&low, &high, |[least, most]| {
            let centre: [f64; 3] = core::array::from_fn(|axis| 0.5 * (least[axis] + most[axis]));
            let behind = |(normal, level): &([f64; 3], f64)| dot(normal, &centre) >= level - BEHIND;
            let way: [f64; 3] = core::array::from_fn(|axis| centre[axis] - from[axis]);
            let share = between(dot(&way, &along) / length_squared, [0.0, 1.0]);
            let at: [f64; 3] = core::array::from_fn(|axis| from[axis] + share * along[axis]);
            let place: [f64; 3] =
                core::array::from_fn(|axis| between(at[axis], [least[axis], most[axis]]));
            let off: [f64; 3] = core::array::from_fn(|axis| place[axis] - at[axis]);
            let square = dot(&off, &off);
            if square < nearest.0 && !planes.iter().any(behind) {
                nearest = (square, place, off);
            }
        });
        let (square, centre, off) = nearest;
        if square >= REACH * REACH {
            break;
        }
        let distance = libm::sqrt(square);
        let normal: [f64; 3] = if distance > TOUCHES {
            off.map(|it| it / distance)
        } else {
            // The segment goes through the voxel: to the side.
            let length = libm::hypot(along[0], along[1]).max(1e-3);
            [-along[1] / length, along[0] / length, 0.0]
        };
        let level = dot(&normal, &centre);
        let _ = planes.push((normal, level));
        for (end, wing) in wings.iter().enumerate() {
            face(end, normal, level - keep.distance(&normal, wing));
        }
    }
}
