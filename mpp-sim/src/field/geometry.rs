//! Distances and rays in the vertical plane.

/// A point in the vertical plane: downrange and height, `(x, z)` \[m\].
pub type Point = (f64, f64);

/// Least distance between a point and a segment \[m\].
pub(super) fn point_to_segment(point: Point, from: Point, to: Point) -> f64 {
    let (along_x, along_z) = (to.0 - from.0, to.1 - from.1);
    let (off_x, off_z) = (point.0 - from.0, point.1 - from.1);
    let length_squared = along_x * along_x + along_z * along_z;
    // Share of the segment at which it is nearest to the point. A segment of length 0 has no
    // direction.
    let share = if length_squared > 0.0 {
        ((off_x * along_x + off_z * along_z) / length_squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let (miss_x, miss_z) = (off_x - share * along_x, off_z - share * along_z);
    (miss_x * miss_x + miss_z * miss_z).sqrt()
}

/// Least distance between two segments \[m\]; 0 where they meet.
pub(super) fn between_segments(a: [Point; 2], b: [Point; 2]) -> f64 {
    if crossing(a, b).is_some() {
        return 0.0;
    }
    point_to_segment(a[0], b[0], b[1])
        .min(point_to_segment(a[1], b[0], b[1]))
        .min(point_to_segment(b[0], a[0], a[1]))
        .min(point_to_segment(b[1], a[0], a[1]))
}

/// Share of segment `a` at which it meets segment `b`. Returns `None` if they do not meet, or if
/// they are parallel.
pub(super) fn crossing(a: [Point; 2], b: [Point; 2]) -> Option<f64> {
    let along_a = minus(a[1], a[0]);
    let along_b = minus(b[1], b[0]);
    let off = minus(b[0], a[0]);
    let turn = cross(along_a, along_b);
    if turn == 0.0 {
        return None;
    }
    let (share_a, share_b) = (cross(off, along_b) / turn, cross(off, along_a) / turn);
    let within = (0.0..=1.0).contains(&share_a) && (0.0..=1.0).contains(&share_b);
    within.then_some(share_a)
}

/// Distance along a ray at which it meets a segment \[m\]. Returns `None` if it misses the segment,
/// or if it is parallel to it. `direction` is a unit vector.
pub(super) fn ray_to_segment(from: Point, direction: Point, segment: [Point; 2]) -> Option<f64> {
    let along = minus(segment[1], segment[0]);
    let off = minus(segment[0], from);
    let turn = cross(direction, along);
    if turn == 0.0 {
        return None;
    }
    let (range, share) = (cross(off, along) / turn, cross(off, direction) / turn);
    (range >= 0.0 && (0.0..=1.0).contains(&share)).then_some(range)
}

/// Distance along a ray at which it enters a circle \[m\]. It is 0 if the ray starts inside, where
/// the exit is not visible. Returns `None` if the ray misses the circle. `direction` is a unit
/// vector.
#[inline]
pub(super) fn ray_to_circle(
    from: Point,
    direction: Point,
    centre: Point,
    radius: f64,
) -> Option<f64> {
    let (dx, dz) = minus(centre, from);
    if dx * dx + dz * dz < radius * radius {
        return Some(0.0);
    }
    let ahead = dx * direction.0 + dz * direction.1;
    let aside = dx * direction.1 - dz * direction.0;
    let half_chord_squared = radius * radius - aside * aside;
    (ahead > 0.0 && half_chord_squared >= 0.0).then(|| (ahead - half_chord_squared.sqrt()).max(0.0))
}

/// Distance along a ray at which it enters the points within `radius` of a segment \[m\]. It is 0 if
/// the ray starts inside. `direction` is a unit vector.
pub(super) fn ray_to_capsule(
    from: Point,
    direction: Point,
    segment: [Point; 2],
    radius: f64,
) -> Option<f64> {
    let [a, b] = segment;
    if point_to_segment(from, a, b) < radius {
        return Some(0.0);
    }
    let (x, z) = minus(b, a);
    let length = (x * x + z * z).sqrt();
    let aside = (-z / length * radius, x / length * radius);
    let sides = [1.0, -1.0].map(|sign| {
        let aside = (sign * aside.0, sign * aside.1);
        let side = [plus(a, aside), plus(b, aside)];
        // A segment of length 0 has no sides.
        ray_to_segment(from, direction, side).filter(|_| length > 0.0)
    });
    let ends = [a, b].map(|end| ray_to_circle(from, direction, end, radius));
    sides.into_iter().chain(ends).flatten().reduce(f64::min)
}

/// Whether a point is inside of a simple polygon. Points of its edges may count either way.
pub(super) fn is_inside(point: Point, corners: &[Point]) -> bool {
    let mut inside = false;
    for [a, b] in edges(corners) {
        // The edges that a ray from the point in direction x crosses. A corner belongs to the edge
        // above it.
        if (a.1 > point.1) != (b.1 > point.1) {
            let x = a.0 + (b.0 - a.0) * ((point.1 - a.1) / (b.1 - a.1));
            inside ^= point.0 < x;
        }
    }
    inside
}

/// The edges of a polygon, from each corner to the next and from the last to the first.
pub(super) fn edges(corners: &[Point]) -> impl Iterator<Item = [Point; 2]> {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// The legs of a line, from each point to the next.
pub(super) fn legs(points: &[Point]) -> impl Iterator<Item = [Point; 2]> {
    points.windows(2).map(|pair| [pair[0], pair[1]])
}

pub(super) fn plus(a: Point, b: Point) -> Point {
    (a.0 + b.0, a.1 + b.1)
}

pub(super) fn minus(a: Point, b: Point) -> Point {
    (a.0 - b.0, a.1 - b.1)
}

/// Twice the area that two vectors span \[m^2\], positive where the second turns left of the first.
pub(super) fn cross(a: Point, b: Point) -> f64 {
    a.0 * b.1 - a.1 * b.0
}
