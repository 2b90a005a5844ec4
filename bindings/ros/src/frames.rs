//! The one place where frames change: from ROS, z up and x forward, y left, z up in the body (REP-103), to the core's
//! vertical plane of the track, x along it, z up, angles nose-up positive, and back.

use crate::messages::{Odometry, Pose, PoseStamped, Quaternion, Vector};

/// The line of the track in the frame of the odometry, and the height to fly at.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Track {
    /// The frame.
    pub(crate) frame: String,
    origin: [f64; 2],
    /// Direction of the track, counted from x to y \[rad\].
    heading: f64,
    /// Height \[m\].
    pub(crate) altitude: f64,
}

/// Where an aircraft is, in the plane of the track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placed {
    /// Along the track from the goal's point on \[m\].
    pub(crate) x: f64,
    /// Up \[m\].
    pub(crate) z: f64,
    /// To the left of the track \[m\].
    pub(crate) aside: f64,
    /// Velocity over ground, along the track and up [m/s].
    pub(crate) velocity: [f64; 2],
    /// Length of the velocity [m/s].
    pub(crate) speed: f64,
    /// Pitch, nose up positive \[rad\].
    pub(crate) pitch: f64,
    /// Angle between nose and track, without its sign \[rad\].
    pub(crate) askew: f64,
}

impl Track {
    /// The track of a goal: through its position in the direction of its yaw. `None` if a number is not finite, or the
    /// quaternion is none.
    pub(crate) fn of(goal: &PoseStamped) -> Option<Self> {
        let at = &goal.pose.position;
        let nose = goal.pose.orientation.turn([1.0, 0.0, 0.0])?;
        [at.x, at.y, at.z]
            .iter()
            .all(|value| value.is_finite())
            .then(|| Self {
                frame: goal.header.frame_id.clone(),
                origin: [at.x, at.y],
                heading: libm::atan2(nose[1], nose[0]),
                altitude: at.z,
            })
    }

    /// Whether the other track is the same line in the same frame.
    pub(crate) fn is_line_of(&self, other: &Self) -> bool {
        (&self.frame, self.origin, self.heading) == (&other.frame, other.origin, other.heading)
    }

    /// Places an aircraft. `None` if a number is not finite, or the quaternion is none.
    pub(crate) fn place(&self, odometry: &Odometry) -> Option<Placed> {
        let pose = &odometry.pose.pose;
        let own = &odometry.twist.twist.linear;
        let nose = pose.orientation.turn([1.0, 0.0, 0.0])?;
        let velocity = pose.orientation.turn([own.x, own.y, own.z])?;
        let (sin, cos) = libm::sincos(self.heading);
        let split = |x: f64, y: f64| (x * cos + y * sin, y * cos - x * sin);
        let (x, aside) = split(
            pose.position.x - self.origin[0],
            pose.position.y - self.origin[1],
        );
        let (along, _) = split(velocity[0], velocity[1]);
        let (ahead, left) = split(nose[0], nose[1]);
        let placed = Placed {
            x,
            z: pose.position.z,
            aside,
            velocity: [along, velocity[2]],
            speed: libm::hypot(libm::hypot(velocity[0], velocity[1]), velocity[2]),
            pitch: libm::atan2(nose[2], libm::hypot(nose[0], nose[1])),
            askew: libm::fabs(libm::atan2(left, ahead)),
        };
        let sum = x + placed.z + aside + placed.speed + placed.pitch + placed.askew;
        sum.is_finite().then_some(placed)
    }

    /// A point of the plane in the frame of the odometry.
    pub(crate) fn point(&self, x: f64, z: f64) -> Vector {
        let (sin, cos) = libm::sincos(self.heading);
        Vector {
            x: self.origin[0] + x * cos,
            y: self.origin[1] + x * sin,
            z,
        }
    }

    /// A velocity in the plane in the frame of the odometry.
    pub(crate) fn velocity(&self, along: f64, up: f64) -> Vector {
        let (sin, cos) = libm::sincos(self.heading);
        Vector {
            x: along * cos,
            y: along * sin,
            z: up,
        }
    }

    /// The pose of a body at a point of the plane with this angle, nose up positive.
    pub(crate) fn pose(&self, x: f64, z: f64, angle: f64) -> Pose {
        // About y, which points to the left, nose up is negative.
        let (sin, cos) = libm::sincos(-0.5 * angle);
        Pose {
            position: self.point(x, z),
            orientation: self.turned(0.0, sin, cos),
        }
    }

    /// The pose of a map of the plane whose first corner is at this point: its x along the track, its y up.
    pub(crate) fn upright(&self, x: f64, z: f64) -> Pose {
        let half = core::f64::consts::FRAC_1_SQRT_2;
        Pose {
            position: self.point(x, z),
            orientation: self.turned(half, 0.0, half),
        }
    }

    /// The heading, after a rotation about x or y with this quaternion.
    fn turned(&self, x: f64, y: f64, w: f64) -> Quaternion {
        let (sin, cos) = libm::sincos(0.5 * self.heading);
        Quaternion {
            x: cos * x - sin * y,
            y: cos * y + sin * x,
            z: sin * w,
            w: cos * w,
        }
    }
}

impl Quaternion {
    /// The vector turned. `None` unless this is a quaternion of length 1.
    fn turn(&self, [a, b, c]: [f64; 3]) -> Option<[f64; 3]> {
        let Self { x, y, z, w } = *self;
        let length = x * x + y * y + z * z + w * w;
        if !(0.98..=1.02).contains(&length) {
            return None;
        }
        // Twice the cross product of the vector part with the vector.
        let t = [
            2.0 * (y * c - z * b),
            2.0 * (z * a - x * c),
            2.0 * (x * b - y * a),
        ];
        Some([
            a + w * t[0] + y * t[2] - z * t[1],
            b + w * t[1] + z * t[0] - x * t[2],
            c + w * t[2] + x * t[1] - y * t[0],
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

    /// A track to the north, along y, at 50 m.
    fn north() -> Track {
        let mut goal = PoseStamped::default();
        goal.pose.position = Vector {
            x: 10.0,
            y: 20.0,
            z: 50.0,
        };
        goal.pose.orientation = Quaternion {
            z: FRAC_1_SQRT_2,
            w: FRAC_1_SQRT_2,
            ..Quaternion::default()
        };
        Track::of(&goal).unwrap()
    }

    fn close(found: [f64; 3], wanted: [f64; 3]) -> bool {
        (0..3).all(|axis| (found[axis] - wanted[axis]).abs() < 1e-12)
    }

    #[test]
    fn a_climbing_aircraft_north_of_the_goal_and_west_of_the_track_is_where_it_is() {
        let track = north();
        assert!((track.heading - FRAC_PI_2).abs() < 1e-15);
        let mut odometry = Odometry::default();
        odometry.pose.pose = track.pose(100.0, 60.0, 0.3);
        odometry.pose.pose.position.x -= 4.0;
        odometry.twist.twist.linear.x = 12.0;
        let placed = track.place(&odometry).unwrap();
        assert!(close(
            [placed.x, placed.z, placed.aside],
            [100.0, 60.0, 4.0]
        ));
        assert!(close(
            [placed.pitch, placed.askew, placed.speed],
            [0.3, 0.0, 12.0]
        ));
        let [along, up] = placed.velocity;
        assert!(close(
            [along, up, 0.0],
            [12.0 * libm::cos(0.3), 12.0 * libm::sin(0.3), 0.0]
        ));
        let back = track.point(placed.x, placed.z);
        assert!(close([back.x, back.y, back.z], [10.0, 120.0, 60.0]));
    }

    #[test]
    fn nose_up_is_a_negative_turn_about_the_axis_to_the_left() {
        let quaternion = north().pose(0.0, 0.0, 0.2).orientation;
        let nose = quaternion.turn([1.0, 0.0, 0.0]).unwrap();
        assert!(close(nose, [0.0, libm::cos(0.2), libm::sin(0.2)]));
        let left = quaternion.turn([0.0, 1.0, 0.0]).unwrap();
        assert!(close(left, [-1.0, 0.0, 0.0]));
    }

    #[test]
    fn the_map_stands_upright_in_the_track() {
        let quaternion = north().upright(0.0, 0.0).orientation;
        let turn = |vector| quaternion.turn(vector).unwrap();
        assert!(close(turn([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]));
        assert!(close(turn([0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]));
    }

    #[test]
    fn what_is_no_pose_is_refused() {
        let mut odometry = Odometry::default();
        assert_eq!(north().place(&odometry), None);
        odometry.pose.pose = north().pose(0.0, 0.0, 0.0);
        assert!(north().place(&odometry).is_some());
        odometry.pose.pose.position.y = f64::NAN;
        assert_eq!(north().place(&odometry), None);
        assert_eq!(Track::of(&PoseStamped::default()), None);
    }
}
