//! The collision check: the wing is a segment, the fuselage a capsule.

use super::motion::SpaceState;
use super::pose::Pose;
use super::world::{Vector, World, WorldError};

/// Distance at which something counts as touched \[m\]. Between two checked attitudes no point of the hull moves by more than
/// twice this, so that it passes through no wire, however thin.
const TOUCH: f64 = 0.005;
/// Pieces of half a wing that are looked at, and how far around them \[m\].
const PIECES: i32 = 32;
const FAR: f64 = 5.0;

/// What an aircraft can hit something with, about its centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hull {
    /// Half of the span of the wing \[m\].
    pub half_span: f64,
    /// Half of the length of the fuselage \[m\].
    pub half_length: f64,
    /// Radius of the fuselage \[m\].
    pub radius: f64,
}

impl Hull {
    /// A wing of this span \[m\] without a fuselage.
    #[must_use]
    pub fn wing(span: f64) -> Self {
        Self {
            half_span: 0.5 * span,
            half_length: 0.0,
            radius: 0.0,
        }
    }

    /// Distance from the nearest body or the ground \[m\], at most `most`; 0 or less where the hull touches.
    #[must_use]
    pub fn clearance(&self, world: &World, state: &SpaceState, most: f64) -> f64 {
        self.clear(world, &Pose::of(state), most)
    }

    fn clear(&self, world: &World, pose: &Pose, most: f64) -> f64 {
        let ends = |[x, y, z]: [f64; 3]| (pose.place([-x, -y, -z]), pose.place([x, y, z]));
        let (left, right) = ends([0.0, self.half_span, 0.0]);
        let (tail, nose) = ends([self.half_length, 0.0, 0.0]);
        let wing = world.clearance_of_segment(left, right, most);
        let fuselage = world.clearance_of_segment(tail, nose, most + self.radius) - self.radius;
        wing.min(fuselage)
    }

    /// The share of the way between two states of one tick at which the hull first touches something.
    #[must_use]
    pub fn first_contact(&self, world: &World, from: &SpaceState, to: &SpaceState) -> Option<f64> {
        let (from, to) = (Pose::of(from), Pose::of(to));
        let (moved, turned) = from.change(&to);
        let most = moved + turned * self.half_span.max(self.half_length + self.radius);
        let far = most + TOUCH;
        if self.clear(world, &from, far) >= far {
            return None;
        }
        let count = (most / (2.0 * TOUCH)).ceil().max(1.0);
        let mut shares = (0..=count as u32).map(|piece| f64::from(piece) / count);
        shares.find(|share| self.clear(world, &from.towards(&to, *share), 1.0) <= TOUCH)
    }

    /// The place on wing or fuselage that is nearest to a body or the ground, within a few centimetres.
    #[must_use]
    pub fn nearest(&self, world: &World, state: &SpaceState) -> Vector {
        let pose = Pose::of(state);
        let shares = (-PIECES..=PIECES).map(|at| f64::from(at) / f64::from(PIECES));
        let places = shares.flat_map(|share| {
            let wing = pose.place([0.0, share * self.half_span, 0.0]);
            let fuselage = pose.place([share * self.half_length, 0.0, 0.0]);
            let gap = |place: Vector, radius: f64| (world.clearance(place, FAR) - radius, place);
            [gap(wing, 0.0), gap(fuselage, self.radius)]
        });
        let least = places.min_by(|(a, _), (b, _)| a.total_cmp(b));
        least.map_or([0.0; 3], |(_, place)| place)
    }

    /// Refuses a start at which the hull touches something.
    ///
    /// # Errors
    /// [`WorldError::Start`].
    pub fn check_start(&self, world: &World, state: &SpaceState) -> Result<(), WorldError> {
        if self.clearance(world, state, 1.0) > TOUCH {
            Ok(())
        } else {
            Err(WorldError::Start)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::world::{Body, Extent};
    use crate::space::{LateralState, Quaternion};
    use mpp_core::vehicle::{AirState, VehicleState};

    const SPAN: f64 = 2.0;

    fn state([x, y, z]: Vector, attitude: Quaternion) -> SpaceState {
        let air = AirState {
            airspeed: 12.0,
            pitch: 0.0,
            pitch_rate: 0.0,
            flight_path: 0.0,
        };
        SpaceState {
            plane: VehicleState { x, z, air },
            lateral: LateralState {
                y,
                attitude,
                ..LateralState::NONE
            },
        }
    }

    fn world(bodies: &[Body]) -> World {
        World::new(bodies.to_vec(), Extent::USUAL).unwrap()
    }

    fn trunk(y: f64) -> Body {
        Body::Cylinder {
            x: 10.0,
            y,
            radius: 0.2,
            height: f64::INFINITY,
        }
    }

    /// The gap is 0.8 spans wide, and the cosine of 45 deg is less.
    #[test]
    fn a_banked_wing_fits_where_a_level_one_does_not() {
        let gap = world(&[trunk(1.0), trunk(-1.0)]);
        let hull = Hull::wing(SPAN);
        for (bank, clear) in [(0.0, 0.0), (45.0, 0.8 - 0.5_f64.sqrt())] {
            for sign in [1.0, -1.0] {
                let banked = state(
                    [10.0, 0.0, 7.5],
                    Quaternion::roll(sign * f64::to_radians(bank)),
                );
                assert!((hull.clearance(&gap, &banked, 5.0) - clear).abs() < 1e-9);
            }
        }
    }

    /// Beside the right wing tip, before the nose of a fuselage.
    #[test]
    fn the_nearest_place_is_on_the_part_that_is_nearest() {
        let hull = Hull {
            half_span: 1.0,
            half_length: 0.5,
            radius: 0.1,
        };
        let at = |x: f64, y: f64| {
            let state = state([x, y, 8.0], Quaternion::ONE);
            hull.nearest(&world(&[trunk(0.0)]), &state)
        };
        let off = |[x, y, z]: Vector, place: Vector| {
            libm::hypot(libm::hypot(x - place[0], y - place[1]), z - place[2])
        };
        assert!(off(at(10.0, -1.5), [10.0, -0.5, 8.0]) < 1e-9);
        assert!(off(at(9.0, 0.0), [9.5, 0.0, 8.0]) < 1e-9);
    }

    /// Of a wing that is banked to the right the right end is low.
    #[test]
    fn the_low_end_of_the_wing_is_that_of_the_bank() {
        let ball = |y, z| Body::Sphere {
            centre: [0.0, y, z],
            radius: 0.1,
        };
        let right = state([0.0, 0.0, 7.5], Quaternion::roll(0.5));
        let hull = Hull::wing(SPAN);
        let (sin, cos) = libm::sincos(0.5);
        assert!(hull.clearance(&world(&[ball(cos, 7.5 - sin)]), &right, 5.0) < 1e-9);
        assert!(hull.clearance(&world(&[ball(cos, 7.5 + sin)]), &right, 5.0) > 0.5);
    }

    #[test]
    fn the_fuselage_is_a_capsule_along_the_nose() {
        let hull = Hull {
            half_span: 0.5,
            half_length: 1.0,
            radius: 0.1,
        };
        let up = state([7.0, 0.0, 7.5], Quaternion::ONE);
        let clearance = hull.clearance(&world(&[trunk(0.0)]), &up, 5.0);
        assert!((clearance - (3.0 - 0.2 - 1.0 - 0.1)).abs() < 1e-9);
        let low = state(
            [0.0, 0.0, 1.5],
            Quaternion::pitch(core::f64::consts::FRAC_PI_2),
        );
        assert!((hull.clearance(&world(&[]), &low, 5.0) - 0.4).abs() < 1e-9);
    }

    /// A wire of 1 mm across a tick of 0.12 m.
    #[test]
    fn no_wire_slips_through_between_two_ticks() {
        let hull = Hull::wing(SPAN);
        for number in 0..100 {
            let x = 5.0 + 0.12 * f64::from(number) / 100.0;
            let wire = Body::Capsule {
                from: [x, 0.7, 0.0],
                to: [x, 0.7, 15.0],
                radius: 0.0005,
            };
            let tick = |x, turn| state([x, 0.0, 7.5], Quaternion::roll(turn));
            let share = hull.first_contact(&world(&[wire]), &tick(5.0, 0.3), &tick(5.12, 0.34));
            let expected = (f64::from(number) / 100.0 - 0.0055 / 0.12).max(0.0);
            assert!(
                (share.unwrap() - expected).abs() < 0.09,
                "{share:?} {expected}"
            );
            let aside = hull.first_contact(&world(&[wire]), &tick(5.0, 1.2), &tick(5.12, 1.2));
            assert_eq!(aside, None);
        }
    }

    #[test]
    fn a_start_in_a_tree_is_refused() {
        let at = |y| state([10.0, y, 7.5], Quaternion::ONE);
        let tree = world(&[trunk(0.0)]);
        let hull = Hull::wing(SPAN);
        assert!(hull.check_start(&tree, &at(1.3)).is_ok());
        assert_eq!(hull.check_start(&tree, &at(1.1)), Err(WorldError::Start));
    }
}
