//! `OBSTACLE_DISTANCE` of MAVLink's dialect `common`: up to 72 distances in one plane, about the axis of the sensor and
//! clockwise as seen from its top.

use super::packet_error::PacketError;
use mavlink::dialects::common::{MavFrame, OBSTACLE_DISTANCE_DATA};

/// What stands for a distance without an obstacle \[m\]: beyond any lidar.
const AIR: f64 = 1e4;
/// Widest step \[deg\].
const WIDEST: f32 = 90.0;

/// Gives a point in each direction that a message tells of, by the sensor's axes: ahead, right, down \[m\]. A distance covers
/// its whole step: points are `step` apart at most \[rad\].
///
/// # Errors
/// [`PacketError::Field`], [`PacketError::Angles`].
pub(crate) fn points(
    told: &OBSTACLE_DISTANCE_DATA,
    step: f64,
    mut give: impl FnMut([f64; 3]),
) -> Result<(), PacketError> {
    if told.frame != MavFrame::MAV_FRAME_BODY_FRD {
        let wanted = "12 (MAV_FRAME_BODY_FRD)";
        return Err(PacketError::Field("the frame", told.frame as u8, wanted));
    }
    let width = match told.increment_f {
        0.0 => f32::from(told.increment),
        width => width,
    };
    let is_sound = width.abs() > 0.0 && width.abs() <= WIDEST && told.angle_offset.is_finite();
    if !is_sound {
        return Err(PacketError::Angles(width, told.angle_offset));
    }
    let (first, width) = (f64::from(told.angle_offset), f64::from(width));
    let parts = (width.abs().to_radians() / step).ceil().max(1.0);
    for (index, distance) in told.distances.iter().enumerate() {
        let range = match *distance {
            u16::MAX => continue,
            far if far > told.max_distance => AIR,
            near => 0.01 * f64::from(near.max(1)),
        };
        for part in 0..=parts as u32 {
            let share = f64::from(part) / parts - 0.5;
            let angle = first + width * (index as f64 + share);
            let (right, ahead) = libm::sincos(angle.to_radians());
            give([range * ahead, range * right, 0.0]);
        }
    }
    Ok(())
}
