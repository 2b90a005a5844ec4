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

fn random_surfaces(draws: &mut Draws, most: f64) -> LateralControl {
    LateralControl {
        aileron: within(draws, most),
        rudder: within(draws, most),
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

fn lateral_bits(state: &LateralState) -> [u64; 8] {
    let [w, x, y, z] = state.attitude.0;
    let rates = [state.roll_rate, state.yaw_rate];
    [state.y, w, x, y, z, state.sideslip, rates[0], rates[1]].map(f64::to_bits)
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
        let mut space = SpaceDynamics::level(&model).unwrap();
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
            // Zeros may have either sign: a product of 0 and a negative number is -0, and no later sum tells them apart.
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
        let mut right = SpaceDynamics::level(&model).unwrap();
        let mut left = right;
        for tick in 0..2000 {
            if tick % 50 == 0 {
                right.state.plane = random_plane(&mut draws, model.known.cruise);
                right.state.lateral = random_lateral(&mut draws);
                left.state = mirrored(&right.state);
            }
            let control = random_control(&mut draws, &model);
            let surfaces = random_surfaces(&mut draws, 0.4);
            let opposite = LateralControl {
                aileron: -surfaces.aileron,
                rudder: -surfaces.rudder,
            };
            let flown = right.step(control, surfaces, 0.01);
            assert_eq!(left.step(control, opposite, 0.01), flown);
            let (seen, name) = (mirrored(&left.state), &model.file.name);
            assert_eq!(
                bits(&seen.plane),
                bits(&right.state.plane),
                "{name}, tick {tick}"
            );
            let (seen, lateral) = (
                lateral_bits(&seen.lateral),
                lateral_bits(&right.state.lateral),
            );
            assert_eq!(seen, lateral, "{name}, tick {tick}");
        }
    }
}

/// Energy of motion and height [J/kg].
fn energy(state: &SpaceState) -> f64 {
    GRAVITY * state.plane.z + 0.5 * state.plane.air.airspeed.powi(2)
}

/// Without air a body keeps its spin energy, its angular momentum and its energy in fall.
#[test]
fn without_air_energy_and_momentum_stay() {
    let mut draws = generator(3, Stream::Field);
    for model in models() {
        let mut body = SpaceDynamics::level(&model).unwrap();
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
            [
                p * spin[0] + q * spin[1] + r * spin[2],
                x,
                y,
                z,
                velocity[0],
                velocity[1],
                energy(state),
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
        let mut body = SpaceDynamics::level(&model).unwrap();
        let glide = Control {
            thrust: 0.0,
            ..model.trim.control
        };
        let mut most_bank: f64 = 0.0;
        for tick in 0..200 {
            let aileron = if tick < 40 { 0.1 } else { -0.03 };
            let before = energy(&body.state);
            let surfaces = LateralControl {
                aileron,
                rudder: 0.0,
            };
            body.step(glide, surfaces, 0.01).unwrap();
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

/// A flight of 30 s whose commands change every half second, up to these surfaces \[rad\]; returns whether it was flown whole.
/// Nothing else may end it than a departure.
fn random_flight(
    draws: &mut Draws,
    model: &AircraftModel,
    mut body: SpaceDynamics,
    most: f64,
) -> bool {
    let (mut control, mut surfaces) = (model.trim.control, LateralControl::default());
    for tick in 0..3000 {
        if tick % 50 == 0 {
            control = random_control(draws, model);
            surfaces = random_surfaces(draws, most);
        }
        match body.step(control, surfaces, 0.01) {
            Err(PlantError::Departed) => return false,
            other => assert_eq!(other, Ok(()), "{}, tick {tick}", model.file.name),
        }
        assert!(body.state.is_finite());
        assert!(
            body.state.lateral.sideslip.abs() < MOST_SIDESLIP
                && body.state.plane.air.airspeed > 0.0
        );
        let length = body.state.lateral.attitude.length();
        assert!((length - 1.0).abs() < 1e-14, "{length}");
    }
    true
}

#[test]
fn random_flights_stay_finite_or_depart() {
    let mut draws = generator(4, Stream::Field);
    for model in models() {
        let name = &model.file.name;
        let level = SpaceDynamics::level(&model).unwrap();
        let mut whole = [0; 2];
        for _ in 0..20 {
            whole[0] += u32::from(random_flight(&mut draws, &model, level, 0.3));
            let mut tumbling = level;
            tumbling.state.plane = random_plane(&mut draws, model.known.cruise);
            tumbling.state.lateral = random_lateral(&mut draws);
            whole[1] += u32::from(random_flight(&mut draws, &model, tumbling, 0.4));
        }
        match name.as_str() {
            "zagi" => assert!(whole[0] <= 3, "{whole:?}"),
            "ultrastick" => assert!(whole[0] >= 12, "{whole:?}"),
            _ => assert!(whole.iter().all(|it| *it >= 18), "{name}: {whole:?}"),
        }
        let mut body = level;
        let nonsense = random_surfaces(&mut draws, f64::NAN);
        let refused = body.step(model.trim.control, nonsense, 0.01);
        assert_eq!(refused, Err(PlantError::NonFiniteControl));
        assert_eq!(body.state, level.state);
    }
}

#[test]
fn sideways_and_without_airspeed_no_step_is_flown() {
    for model in models() {
        let level = SpaceDynamics::level(&model).unwrap();
        for (sideslip, airspeed) in [(1.4, 12.0), (-3.0, 12.0), (0.0, -1.0)] {
            let mut body = level;
            body.state.lateral.sideslip = sideslip;
            body.state.plane.air.airspeed = airspeed;
            let before = body.state;
            let refused = body.step(model.trim.control, LateralControl::default(), 0.01);
            assert_eq!(refused, Err(PlantError::Departed), "{}", model.file.name);
            assert_eq!(body.state, before);
        }
    }
}

/// Air that rolls to the right takes the wing along, and without it that roll rate would damp itself.
#[test]
fn a_rolling_gust_rolls_the_aircraft_with_it() {
    for model in models() {
        let rolled = |gust_roll: f64, roll_rate: f64| {
            let mut body = SpaceDynamics::level(&model).unwrap();
            body.gust_roll = gust_roll;
            body.state.lateral.roll_rate = roll_rate;
            let surfaces = LateralControl::default();
            body.rate(&body.state, model.trim.control, surfaces)
                .lateral
                .roll_rate
        };
        let name = &model.file.name;
        assert!(rolled(0.2, 0.0) > 0.0 && rolled(0.0, 0.2) < 0.0, "{name}");
        let with_the_air = rolled(0.2, 0.2);
        assert!(with_the_air.abs() < 1e-12, "{name}: {with_the_air}");
    }
}

/// The core's lateral matrices are the slopes of this motion about level flight.
#[test]
fn the_cores_linear_model_is_that_of_the_plant() {
    const H: f64 = 1e-6;
    for model in models() {
        let body = SpaceDynamics::level(&model).unwrap();
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
