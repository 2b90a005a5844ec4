//! From the autopilot's frames (north, east, down) to the core's: x along the course, z up, and across it to the right.

use mavlink::dialects::common::{ATTITUDE_DATA, LOCAL_POSITION_NED_DATA};

/// A position that is so far from the one that the velocity foretells is a jump of the autopilot's estimate \[m\].
const JUMP: f64 = 2.0;
/// Density of the air to which an airspeed sensor is calibrated [kg/m^3].
const CALIBRATED: f64 = 1.225;

/// True airspeed from the equivalent airspeed of an autopilot, in air of this density [kg/m^3].
pub(crate) fn true_airspeed(equivalent: f64, density: f64) -> f64 {
    equivalent * (CALIBRATED / density).sqrt()
}

/// A position and velocity in the frame of the course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placed {
    /// Time since the autopilot's start \[ms\].
    pub(crate) time: u32,
    /// Along the course \[m\].
    pub(crate) x: f64,
    /// Across it, to the right \[m\].
    pub(crate) cross: f64,
    /// Up \[m\].
    pub(crate) z: f64,
    /// Upwards [m/s].
    pub(crate) climb: f64,
    /// Along the course [m/s].
    pub(crate) speed: f64,
}

/// Course over ground \[rad\], clockwise from north, and speed over ground [m/s].
pub(crate) fn over_ground(position: &LOCAL_POSITION_NED_DATA) -> (f64, f64) {
    let [north, east] = [position.vx, position.vy].map(f64::from);
    (libm::atan2(east, north), libm::hypot(north, east))
}

/// The frame that is fixed at hand-over, and what the autopilot's estimate has jumped since.
#[derive(Clone, Debug)]
pub(crate) struct CourseFrame {
    origin: [f64; 2],
    /// The course, clockwise from north \[rad\].
    pub(crate) course: f64,
    jumped: [f64; 3],
    last: LOCAL_POSITION_NED_DATA,
}

impl CourseFrame {
    /// The frame of an aircraft that is here and flies this course; `None` unless it moves.
    pub(crate) fn at(position: &LOCAL_POSITION_NED_DATA) -> Option<Self> {
        let (course, speed) = over_ground(position);
        (is_sound(position) && speed > 1.0).then(|| Self {
            origin: [f64::from(position.x), f64::from(position.y)],
            course,
            jumped: [0.0; 3],
            last: position.clone(),
        })
    }

    /// The frame on the same line that begins abreast of this position.
    pub(crate) fn abreast(&self, position: &LOCAL_POSITION_NED_DATA) -> Option<Self> {
        let begun = Self::at(position)?;
        let (sin, cos) = libm::sincos(self.course);
        let [north, east] = begun.origin;
        let cross = (east - self.origin[1]) * cos - (north - self.origin[0]) * sin;
        Some(Self {
            origin: [north + cross * sin, east - cross * cos],
            course: self.course,
            ..begun
        })
    }

    /// Places a newer position; `None` if it is not newer, or not finite.
    pub(crate) fn place(&mut self, position: &LOCAL_POSITION_NED_DATA) -> Option<Placed> {
        let age = position.time_boot_ms.checked_sub(self.last.time_boot_ms);
        let age = age.filter(|age| *age > 0)?;
        if !is_sound(position) {
            return None;
        }
        let seconds = f64::from(age) * 1e-3;
        let last = ned(&self.last);
        let moved = [self.last.vx, self.last.vy, self.last.vz].map(|v| f64::from(v) * seconds);
        let now = ned(position);
        let jump: [f64; 3] = std::array::from_fn(|axis| now[axis] - last[axis] - moved[axis]);
        let length = jump.iter().map(|part| part * part).sum::<f64>().sqrt();
        // An aircraft bends its path by 20 m/s^2 at most.
        if length > JUMP + 10.0 * seconds * seconds {
            for (sum, part) in self.jumped.iter_mut().zip(jump) {
                *sum += part;
            }
        }
        self.last = position.clone();
        Some(self.placed(position))
    }

    fn placed(&self, position: &LOCAL_POSITION_NED_DATA) -> Placed {
        let [north, east, down] = ned(position);
        let [dn, de] = [
            north - self.jumped[0] - self.origin[0],
            east - self.jumped[1] - self.origin[1],
        ];
        let (sin, cos) = libm::sincos(self.course);
        let [vn, ve] = [position.vx, position.vy].map(f64::from);
        Placed {
            time: position.time_boot_ms,
            x: dn * cos + de * sin,
            cross: de * cos - dn * sin,
            z: self.jumped[2] - down,
            climb: -f64::from(position.vz),
            speed: vn * cos + ve * sin,
        }
    }
}

/// Roll and pitch of an attitude quaternion \[rad\].
pub(crate) fn roll_pitch(q: [f32; 4]) -> (f64, f64) {
    let [w, x, y, z] = q.map(f64::from);
    let roll = libm::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y));
    (roll, libm::asin((2.0 * (w * y - z * x)).clamp(-1.0, 1.0)))
}

fn ned(position: &LOCAL_POSITION_NED_DATA) -> [f64; 3] {
    [position.x, position.y, position.z].map(f64::from)
}

fn is_sound(p: &LOCAL_POSITION_NED_DATA) -> bool {
    [p.x, p.y, p.z, p.vx, p.vy, p.vz]
        .iter()
        .all(|value| value.is_finite())
}

/// Whether each angle and rate is a number.
pub(crate) fn is_finite(it: &ATTITUDE_DATA) -> bool {
    let angles = [it.roll, it.pitch, it.yaw];
    let rates = [it.rollspeed, it.pitchspeed, it.yawspeed];
    angles.iter().chain(&rates).all(|it| it.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(time_boot_ms: u32, [x, y, z]: [f32; 3]) -> LOCAL_POSITION_NED_DATA {
        LOCAL_POSITION_NED_DATA {
            time_boot_ms,
            x,
            y,
            z,
            vx: 0.0,
            vy: 15.0,
            vz: 0.0,
        }
    }

    #[test]
    fn an_aircraft_that_flies_east_is_downrange_and_a_jump_is_none() {
        let mut frame = CourseFrame::at(&at(0, [100.0, 0.0, -50.0])).unwrap();
        let placed = frame.place(&at(20, [99.0, 0.3, -50.0])).unwrap();
        assert!((placed.x - 0.3).abs() < 1e-6 && (placed.cross - 1.0).abs() < 1e-6);
        assert!((placed.z - 50.0).abs() < 1e-9 && (placed.speed - 15.0).abs() < 1e-9);
        let jumped = frame.place(&at(40, [99.0, 8.6, -57.0])).unwrap();
        assert!((jumped.x - 0.6).abs() < 1e-5 && (jumped.z - 50.0).abs() < 1e-5);
        let next = frame.place(&at(60, [99.0, 8.9, -57.0])).unwrap();
        assert!((next.x - 0.9).abs() < 1e-5 && (next.z - 50.0).abs() < 1e-5);
        assert_eq!(frame.place(&at(60, [99.0, 8.9, -57.0])), None);
        assert_eq!(frame.place(&at(80, [f32::NAN, 8.9, -57.0])), None);
    }

    #[test]
    fn a_frame_abreast_keeps_the_line() {
        let line = CourseFrame::at(&at(0, [100.0, 0.0, -50.0])).unwrap();
        let mut turned = at(900, [98.0, 13.0, -50.0]);
        turned.vx = 2.0;
        let mut frame = line.abreast(&turned).unwrap();
        let placed = frame.place(&at(920, [98.0, 13.3, -50.0])).unwrap();
        assert!((placed.x - 0.3).abs() < 1e-6 && (placed.cross - 2.0).abs() < 1e-6);
        assert!((placed.speed - 15.0).abs() < 1e-9);
    }

    #[test]
    fn who_stands_has_no_course() {
        let still = LOCAL_POSITION_NED_DATA {
            vy: 0.0,
            ..at(0, [0.0; 3])
        };
        assert!(CourseFrame::at(&still).is_none());
    }

    #[test]
    fn thin_air_needs_more_true_airspeed() {
        assert!((true_airspeed(15.0, 1.225) - 15.0).abs() < 1e-12);
        assert!((true_airspeed(15.0, 0.90925) - 17.41).abs() < 0.01);
    }
}
