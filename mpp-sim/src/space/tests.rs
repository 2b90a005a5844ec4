use super::*;
use crate::aircraft_file::{AircraftFile, AircraftModel};
use crate::dynamics::Dynamics;
use crate::random::{Draws, Stream, generator, uniform};
use mpp_core::vehicle::{AirState, GRAVITY, LateralAirframe, VehicleState, linearize_lateral};

/// The aircraft with a lateral table.
fn models() -> impl Iterator<Item = AircraftModel> {
    let known = AircraftFile::KNOWN.into_iter();
    let files = known.map(|(name, _)| AircraftFile::known(name).unwrap());
    files
        .filter(|file| file.lateral.is_some())
        .map(|file| AircraftModel::new(file).unwrap())
}

/// The rigid aircraft in level flight.
fn body(model: &AircraftModel) -> SpaceDynamics {
    let plane = VehicleState {
        x: 0.0,
        z: 50.0,
        air: model.trim.state,
    };
    SpaceDynamics {
        airframe: model.known.airframe,
        lateral: model.file.lateral.as_ref().unwrap().airframe(),
        more: Aerodynamics::of(&model.file),
        gust_roll: 0.0,
        state: SpaceState {
            plane,
            lateral: LateralState::NONE,
        },
    }
}

fn within(draws: &mut Draws, most: f64) -> f64 {
    most * (2.0 * uniform(draws) - 1.0)
}

/// A random motion in the vertical plane, also far beyond the stall.
fn random_plane(draws: &mut Draws, cruise: f64) -> VehicleState {
    let flight_path = within(draws, 1.2);
    VehicleState {
        x: within(draws, 100.0),
        z: within(draws, 100.0),
        air: AirState {
            airspeed: cruise * (1.0 + within(draws, 0.6)),
            pitch: flight_path + within(draws, 0.8),
            pitch_rate: within(draws, 3.0),
            flight_path,
        },
    }
}

fn random_control(draws: &mut Draws, model: &AircraftModel) -> Control {
    let trim = model.trim.control;
    Control {
        thrust: trim.thrust * (1.0 + within(draws, 1.0)),
        elevator: trim.elevator * (1.0 + within(draws, 1.0)),
    }
}

fn random_surfaces(draws: &mut Draws) -> LateralControl {
    LateralControl {
        aileron: within(draws, 0.4),
        rudder: within(draws, 0.4),
    }
}

fn random_lateral(draws: &mut Draws) -> LateralState {
    let turn = [0, 1, 2, 3].map(|_| within(draws, 1.0));
    LateralState {
        y: within(draws, 100.0),
        attitude: Quaternion(turn).normalised(),
        sideslip: within(draws, 1.0),
        roll_rate: within(draws, 3.0),
        yaw_rate: within(draws, 2.0),
    }
}

fn bits(state: &VehicleState) -> [u64; 6] {
    let air = &state.air;
    [
        state.x,
        state.z,
        air.airspeed,
        air.pitch,
        air.pitch_rate,
        air.flight_path,
    ]
    .map(f64::to_bits)
}

#[test]
fn without_lateral_state_and_command_it_is_the_vertical_plane_to_the_last_bit() {
    let mut draws = generator(1, Stream::Field);
    for model in models() {
        let mut space = body(&model);
        for _ in 0..5000 {
            space.state.plane = random_plane(&mut draws, model.known.cruise);
            let control = random_control(&mut draws, &model);
            let mut plane = Dynamics {
                airframe: space.airframe,
                more: space.more,
                state: space.state.plane,
            };
            let expected = plane.step(control, 0.01);
            let flown = space.step(control, LateralControl::default(), 0.01);
            assert_eq!(flown, expected);
            assert_eq!(
                bits(&space.state.plane),
                bits(&plane.state),
                "{}",
                model.file.name
            );
            assert_eq!(space.state.lateral, LateralState::NONE);
        }
    }
}

/// The state that a mirror shows.
fn mirrored(state: &SpaceState) -> SpaceState {
    let from = &state.lateral;
    let [w, x, y, z] = from.attitude.0;
    let lateral = LateralState {
        y: -from.y,
        attitude: Quaternion([w, -x, y, -z]),
        sideslip: -from.sideslip,
        roll_rate: -from.roll_rate,
        yaw_rate: -from.yaw_rate,
    };
    SpaceState { lateral, ..*state }
}

#[test]
fn a_left_turn_is_the_mirror_of_a_right_turn_to_the_last_bit() {
    let mut draws = generator(2, Stream::Field);
    for model in models() {
        let mut right = body(&model);
        let mut left = right;
        for tick in 0..2000 {
            if tick % 50 == 0 {
                right.state.plane = random_plane(&mut draws, model.known.cruise);
                right.state.lateral = random_lateral(&mut draws);
                left.state = mirrored(&right.state);
            }
            let control = random_control(&mut draws, &model);
            let surfaces = random_surfaces(&mut draws);
            let opposite = LateralControl {
                aileron: -surfaces.aileron,
                rudder: -surfaces.rudder,
            };
            let flown = right.step(control, surfaces, 0.01);
            assert_eq!(left.step(control, opposite, 0.01), flown);
            assert_eq!(
                mirrored(&left.state),
                right.state,
                "{}, tick {tick}",
                model.file.name
            );
        }
    }
}

/// Without air a body keeps its spin energy, its angular momentum and its energy in fall.
#[test]
fn without_air_energy_and_momentum_stay() {
    let mut draws = generator(3, Stream::Field);
    for model in models() {
        let mut body = body(&model);
        body.airframe.air_density = 0.0;
        body.state.plane = random_plane(&mut draws, model.known.cruise);
        body.state.lateral = random_lateral(&mut draws);
        let kept = |body: &SpaceDynamics| {
            let state = &body.state;
            let l: LateralAirframe = body.lateral;
            let [p, q, r] = [
                state.lateral.roll_rate,
                state.plane.air.pitch_rate,
                state.lateral.yaw_rate,
            ];
            let spin = [
                l.roll_inertia * p - l.product_inertia * r,
                body.airframe.pitch_inertia * q,
                l.yaw_inertia * r - l.product_inertia * p,
            ];
            let [x, y, z] = state.attitude().in_world(spin);
            let velocity = state.lateral.attitude.in_world(state.air_velocity());
            let energy = GRAVITY * state.plane.z + 0.5 * state.plane.air.airspeed.powi(2);
            [
                p * spin[0] + q * spin[1] + r * spin[2],
                x,
                y,
                z,
                velocity[0],
                velocity[1],
                energy,
            ]
        };
        let before = kept(&body);
        let idle = Control {
            thrust: 0.0,
            elevator: 0.0,
        };
        for _ in 0..50 {
            body.step(idle, LateralControl::default(), 0.01).unwrap();
        }
        for (before, after) in before.into_iter().zip(kept(&body)) {
            let gap = (after - before).abs();
            assert!(
                gap < 1e-4 * before.abs().max(1.0),
                "{}: {before} {after}",
                model.file.name
            );
        }
    }
}

/// Drag and side force take what the glide loses, also while it rolls and slips.
#[test]
fn a_rolling_glide_pays_for_its_drag() {
    for model in models() {
        let mut body = body(&model);
        let glide = Control {
            thrust: 0.0,
            ..model.trim.control
        };
        let energy =
            |state: &SpaceState| GRAVITY * state.plane.z + 0.5 * state.plane.air.airspeed.powi(2);
        let mut most_bank: f64 = 0.0;
        for tick in 0..200 {
            let aileron = if tick < 40 { 0.1 } else { -0.03 };
            let before = energy(&body.state);
            body.step(
                glide,
                LateralControl {
                    aileron,
                    rudder: 0.0,
                },
                0.01,
            )
            .unwrap();
            most_bank = most_bank.max(body.state.bank());
            assert!(
                energy(&body.state) < before,
                "{}, tick {tick}",
                model.file.name
            );
        }
        assert!(most_bank > 0.05);
    }
}

#[test]
fn random_flights_stay_finite_and_turns_stay_turns() {
    let mut draws = generator(4, Stream::Field);
    for model in models() {
        let mut body = body(&model);
        for _ in 0..300 {
            body.state.plane = random_plane(&mut draws, model.known.cruise);
            body.state.lateral = random_lateral(&mut draws);
            for _ in 0..30 {
                let control = random_control(&mut draws, &model);
                let surfaces = random_surfaces(&mut draws);
                if body.step(control, surfaces, 0.01).is_err() {
                    break;
                }
                assert!(body.state.is_finite());
                let length = body.state.lateral.attitude.length();
                assert!((length - 1.0).abs() < 1e-14, "{length}");
            }
        }
        let nonsense = LateralControl {
            aileron: f64::NAN,
            rudder: 0.0,
        };
        let start = body.state;
        let refused = body.step(model.trim.control, nonsense, 0.01);
        assert_eq!(refused, Err(PlantError::NonFiniteControl));
        assert_eq!(body.state, start);
    }
}

/// The core's lateral matrices are the slopes of this motion about level flight.
#[test]
fn the_cores_linear_model_is_that_of_the_plant() {
    const H: f64 = 1e-6;
    for model in models() {
        let body = body(&model);
        let linear = linearize_lateral(&body.airframe, &body.lateral, &model.trim);
        let pitch = model.trim.state.pitch;
        let rate = |column: usize, h: f64| {
            let mut state = body.state;
            let mut surfaces = LateralControl::default();
            let lateral = &mut state.lateral;
            match column {
                0 => lateral.sideslip = h,
                1 => lateral.roll_rate = h,
                2 => lateral.yaw_rate = h,
                3 => {
                    let turned = Quaternion::pitch(pitch).times(Quaternion::roll(h));
                    lateral.attitude = turned.times(Quaternion::pitch(-pitch));
                }
                4 => surfaces.aileron = h,
                _ => surfaces.rudder = h,
            }
            let rate = body.rate(&state, model.trim.control, surfaces).lateral;
            [rate.sideslip, rate.roll_rate, rate.yaw_rate]
        };
        for column in 0..6 {
            let (more, less) = (rate(column, H), rate(column, -H));
            for row in 0..3 {
                let slope = (more[row] - less[row]) / (2.0 * H);
                let expected = if column < 4 {
                    linear.a[(row, column)]
                } else {
                    linear.b[(row, column - 4)]
                };
                let gap = (slope - expected).abs();
                assert!(
                    gap < 1e-4 * expected.abs().max(1.0),
                    "{}: {row} {column}: {slope} {expected}",
                    model.file.name
                );
            }
        }
    }
}
