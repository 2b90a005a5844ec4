//! Tests the estimate of position and wind against motions that are known.

use crate::common::draw::gaussian;
use crate::common::sensors::frame;
use mpp_core::config::TICK_PERIOD;
use mpp_core::estimate::{Navigation, Observation, PositionVerdict, WindFilter};
use mpp_core::flight::FlightLoop;
use mpp_core::sense::{GroundVelocity, Position};
use mpp_core::settings::Settings;
use mpp_core::vehicle::{AirState, VehicleState, Wind};
use proptest::prelude::*;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

const CHANGE: f64 = 1.0;

fn fix(x: f64, z: f64, age: u32, sigma: f64) -> Position {
    Position {
        age,
        x,
        z,
        sigma,
        velocity: None,
    }
}

/// Square of an innovation over its variance, mean of both axes [-], from a filter before and after a correction by
/// `h0 p + h1 w` with an error of the variance `error`. A correction leaves the share `error / variance` of the
/// innovation, so the product of what was off before and after, over `error`, is this square.
fn normalised(
    [before, after]: [&WindFilter; 2],
    [h0, h1]: [f64; 2],
    value: (f64, f64),
    error: f64,
) -> f64 {
    let [before, after] = [before, after].map(|filter| {
        let (position, wind) = (filter.position(), filter.wind());
        (
            value.0 - h0 * position.0 - h1 * wind.x,
            value.1 - h0 * position.1 - h1 * wind.z,
        )
    });
    0.5 * (before.0 * after.0 + before.1 * after.1) / error
}

fn air(airspeed: f64, flight_path: f64) -> AirState {
    AirState {
        airspeed,
        flight_path,
        ..AirState::default()
    }
}

proptest! {
    /// The wind is what carries the aircraft beside its motion through the air, at any delay.
    #[test]
    fn a_steady_wind_is_found(
        x in -3.0..3.0, z in -3.0..3.0, path in -0.5..0.5, airspeed in 8.0..16.0, delay in 0_u32..30,
    ) {
        let (wind, air) = (Wind { x, z }, air(airspeed, path));
        let (ahead, up) = wind.ground_velocity(&air);
        let mut navigation = Navigation::new(Some(CHANGE), 50.0);
        let at = |tick: u32| {
            let time = f64::from(tick) * TICK_PERIOD;
            (ahead * time, 50.0 + up * time)
        };
        for tick in 0_u32..400 {
            navigation.predict(&air, if tick == 0 { 0.0 } else { TICK_PERIOD });
            navigation.correct_motion(&air);
            if let Some(then) = tick.checked_sub(delay) {
                let (x, z) = at(then);
                let verdict = navigation.take(&fix(x, z, delay, 0.0));
                prop_assert_eq!(verdict, PositionVerdict::Accepted);
            }
        }
        let truth = at(399);
        for filter in [navigation.quick(), navigation.smooth()] {
            let (found, position) = (filter.wind(), filter.position());
            prop_assert!((found.x - x).abs() < 1e-3 && (found.z - z).abs() < 1e-3, "{found:?}");
            prop_assert!((position.0 - truth.0).abs() < 0.01 && (position.1 - truth.1).abs() < 0.01);
        }
        // The pose of an earlier tick lies on the way.
        let ((x, z), _) = navigation.pose_at(30).unwrap();
        let truth = at(369);
        prop_assert!((x - truth.0).abs() < 0.01 && (z - truth.1).abs() < 0.01);
    }

    /// Errors that are as declared give innovations as the covariance says: their mean square over their
    /// variance is 1. Rate, delay and the velocity do not matter.
    #[test]
    fn innovations_are_consistent(
        seed in any::<u64>(), sigma in 0.005..0.5, period in 1_u32..20, delay in 0_u32..20,
        with_velocity in any::<bool>(),
    ) {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let air = air(12.0, 0.1);
        let mut navigation = Navigation::new(Some(CHANGE), 50.0);
        let mut wind = Wind { x: 1.0, z: -0.5 };
        let mut truth = vec![((0.0, 50.0), wind)];
        let (mut sum, mut count) = (0.0, 0.0);
        for tick in 0_u32..8000 {
            if tick > 0 {
                let step = CHANGE * TICK_PERIOD.sqrt();
                let before = wind;
                wind.x += step * gaussian(&mut random);
                wind.z += step * gaussian(&mut random);
                // A random walk has no greater value than what the filter believes in this test.
                wind.x = wind.x.clamp(-8.0, 8.0);
                wind.z = wind.z.clamp(-8.0, 8.0);
                let (x, z) = truth[tick as usize - 1].0;
                let mean = Wind { x: 0.5 * (before.x + wind.x), z: 0.5 * (before.z + wind.z) };
                let (ahead, up) = mean.ground_velocity(&air);
                truth.push(((x + ahead * TICK_PERIOD, z + up * TICK_PERIOD), wind));
            }
            navigation.predict(&air, if tick == 0 { 0.0 } else { TICK_PERIOD });
            let due = (tick % period == 0).then(|| tick.checked_sub(delay)).flatten();
            if let Some(then) = due {
                let ((x, z), wind) = truth[then as usize];
                let (ahead, up) = wind.ground_velocity(&air);
                let velocity = with_velocity.then(|| GroundVelocity {
                    x: ahead + 0.1 * gaussian(&mut random),
                    z: up + 0.1 * gaussian(&mut random),
                    sigma: 0.1,
                });
                let position = fix(x + sigma * gaussian(&mut random), z + sigma * gaussian(&mut random), delay, sigma);
                let mut without_velocity = navigation.clone();
                let before = *navigation.quick();
                without_velocity.take(&position);
                let verdict = navigation.take(&Position { velocity, ..position });
                prop_assert_eq!(verdict, PositionVerdict::Accepted);
                if tick > 500 {
                    let (still, late) = (Wind::STILL.ground_velocity(&air), f64::from(delay) * TICK_PERIOD);
                    let between = without_velocity.quick();
                    sum += match velocity {
                        Some(velocity) => {
                            let wind = (velocity.x - still.0, velocity.z - still.1);
                            let error = 0.1 * 0.1 + CHANGE * CHANGE * late;
                            normalised([between, navigation.quick()], [0.0, 1.0], wind, error)
                        }
                        None => {
                            let now = (position.x + still.0 * late, position.z + still.1 * late);
                            let error = sigma * sigma + CHANGE * CHANGE * late * late * late / 3.0;
                            normalised([&before, between], [1.0, -late], now, error)
                        }
                    };
                    count += 1.0;
                }
            }
        }
        let mean = sum / count;
        // Four standard errors of the mean of chi-square values with two degrees of freedom.
        let doubt = 4.0 / f64::sqrt(count);
        // Late measurements share the noise of the wind with the estimate, which the filter does not know: it
        // is then careful, and most so where the white error is a small part of the error that it assumes.
        let late = f64::from(delay) * TICK_PERIOD;
        let shared = CHANGE * CHANGE * late * late * late / 3.0;
        let careful = match (delay, with_velocity) {
            (0, _) => 0.95,
            (_, true) => 0.1,
            (_, false) => (sigma * sigma / (sigma * sigma + shared)).min(0.1),
        };
        prop_assert!(mean < 1.05 + doubt && mean > careful - doubt, "{mean} of {count}");
    }
}

/// Without an estimate of the wind each position is taken as it is, as the paper does.
#[test]
fn without_wind_a_position_is_taken_as_it_is() {
    let mut navigation = Navigation::new(None, 50.0);
    for (tick, x) in (0..5).zip([0.0, 3.0, 77.0, 78.0, -4.0]) {
        navigation.predict(&air(12.0, 0.0), if tick == 0 { 0.0 } else { TICK_PERIOD });
        assert_eq!(
            navigation.take(&fix(x, 50.0, 0, 0.1)),
            PositionVerdict::Accepted
        );
        for filter in [navigation.quick(), navigation.smooth()] {
            assert_eq!(filter.position(), (x, 50.0));
            assert_eq!(filter.wind(), Wind::STILL);
        }
    }
}

/// Level flight at 12 m/s in a wind across, with positions at 10 Hz as good as those of `rtk`. Gives the winds across of the
/// quick and of the smooth filter at each tick.
fn winds_across(random: &mut Pcg64Mcg, wind: impl Fn(u32) -> f64) -> Vec<[f64; 2]> {
    let air = air(12.0, 0.0);
    let mut navigation = Navigation::new(Some(CHANGE), 50.0);
    let (mut x, mut z) = (0.0, 50.0);
    (0..3000)
        .map(|tick| {
            let period = if tick == 0 { 0.0 } else { TICK_PERIOD };
            x += 12.0 * period;
            z += wind(tick) * period;
            navigation.predict(&air, period);
            navigation.correct_motion(&air);
            if tick % 10 == 0 {
                let mut noisy = |value| value + 0.02 * gaussian(random);
                let fix = fix(noisy(x), noisy(z), 0, 0.02);
                assert_eq!(navigation.take(&fix), PositionVerdict::Accepted);
            }
            [navigation.quick(), navigation.smooth()].map(|filter| filter.wind().z)
        })
        .collect()
}

/// In still air the smooth filter takes less of the positions' noise for wind. By the model, the noise in the wind grows with
/// the power 3/4 of the change that a filter assumes: half of it gives 0.59 of the noise.
#[test]
fn the_smooth_filter_takes_less_noise_for_wind() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let winds = winds_across(&mut random, |_| 0.0);
    let noise = |which: usize| -> f64 {
        let settled = &winds[1000..];
        let squares: f64 = settled.iter().map(|wind| wind[which] * wind[which]).sum();
        (squares / settled.len() as f64).sqrt()
    };
    let share = noise(1) / noise(0);
    assert!((0.5..0.7).contains(&share), "{share}");
}

/// A fix that repeats the one that started the filter has twice its variance: that of the source, and that of a wind which
/// changed since, `noise * delay^3 / 3`.
#[test]
fn a_late_fix_allows_for_a_wind_that_has_changed() {
    for (delay, sigma, noise) in [(0.0, 0.02, 1.0), (0.3, 0.1, 1.0), (0.3, 0.02, 4.0)] {
        let mut filter = WindFilter::new(50.0);
        filter.start(&Observation::position((0.0, 50.0), delay, sigma), noise);
        let off = 3.0 * sigma;
        let observed = Observation::position((0.0, 50.0 + off), delay, sigma);
        let variance = 2.0 * (sigma * sigma + noise * delay * delay * delay / 3.0);
        let error = sigma * sigma + noise * delay * delay * delay / 3.0;
        let before = filter;
        assert!(filter.correct(&observed, noise));
        let found = normalised([&before, &filter], [1.0, -delay], (0.0, 50.0 + off), error);
        assert!((found - 0.5 * off * off / variance).abs() < 1e-9, "{found}");
    }
}

/// A gust that leaps is in the smooth filter's wind after 1 s, whether it fits the filter's assumption or not.
#[test]
fn the_smooth_filter_finds_a_gust() {
    for gust in [-2.0, -1.0, 0.5, 1.5, 2.0] {
        let mut random = Pcg64Mcg::seed_from_u64(2);
        let winds = winds_across(&mut random, |tick| f64::from(u8::from(tick >= 1500)) * gust);
        for found in winds.get(1600..).unwrap() {
            assert!((found[1] - gust).abs() < 0.3, "{found:?} of {gust}");
        }
    }
}

/// A position that stands still, leaps or is wild gives no wind, and does not reach the elevator.
#[test]
fn a_wrong_position_is_refused_and_counted() {
    let faults: [fn(u32, f64) -> f64; 4] = [
        |_, _| 120.0,
        |tick, x| x - 4.5 * f64::from(u32::from(tick >= 100)),
        |tick, x| if tick == 100 { 1e160 } else { x },
        |tick, x| {
            if (100..150).contains(&tick) {
                x + 0.3 * f64::from(tick % 7)
            } else {
                x
            }
        },
    ];
    for (number, fault) in faults.into_iter().enumerate() {
        let mut flight = FlightLoop::new(&Settings::flight()).unwrap();
        let level = flight.state().air;
        let trim = Settings::flight()
            .cruise
            .trim(&Settings::flight().airframe)
            .unwrap();
        for tick in 0..400 {
            let time = f64::from(tick) * TICK_PERIOD;
            let air = AirState {
                airspeed: level.airspeed + 1e-9 * f64::from(tick % 2),
                pitch: level.pitch + 1e-9 * f64::from(tick % 2),
                ..level
            };
            let out = flight.step(
                time,
                &frame(&VehicleState {
                    x: fault(tick, level.airspeed * time),
                    z: 50.0,
                    air,
                }),
            );
            assert!((out.control.elevator - trim.control.elevator).abs() < 0.1);
            let wind = flight.conditions().wind;
            assert!(
                wind.x.abs() < 0.5 && wind.z.abs() < 0.5,
                "{number} at {tick}: {wind:?}"
            );
        }
        let health = flight.health();
        assert!(
            health.positions_gated > 0 || health.positions_held > 0,
            "{number}"
        );
        assert_eq!(health.commands_not_finite, 0);
        // The leap stays, so the filter restarts from it.
        assert_eq!(
            health.positions_restarted,
            u32::from(number == 1),
            "{number}"
        );
        if number == 1 {
            assert!((flight.state().x - (level.airspeed * 3.99 - 4.5)).abs() < 0.05);
        }
    }
}

/// A clock that jumps leaves the position in doubt; the next position is taken at once, and no wind comes
/// of it.
#[test]
fn a_clock_that_jumps_gives_no_wind() {
    for jump in [0.6, 10.0, 1e4, -3.0] {
        let mut flight = FlightLoop::new(&Settings::flight()).unwrap();
        let level = flight.state().air;
        let mut time = 0.0;
        for tick in 0..200 {
            time += TICK_PERIOD;
            if tick == 100 {
                time += jump;
            }
            let last_digits = 1e-9 * f64::from(tick % 2);
            let air = AirState {
                airspeed: level.airspeed + last_digits,
                pitch: level.pitch + last_digits,
                ..level
            };
            let x = level.airspeed * TICK_PERIOD * f64::from(tick);
            let out = flight.step(time, &frame(&VehicleState { x, z: 50.0, air }));
            assert_eq!(
                out.position,
                Some(PositionVerdict::Accepted),
                "{jump} at {tick}"
            );
            assert!((flight.state().x - x).abs() < 0.05, "{jump} at {tick}");
            let wind = flight.conditions().wind;
            assert!(
                wind.x.abs() < 0.5 && wind.z.abs() < 0.5,
                "{jump} at {tick}: {wind:?}"
            );
        }
    }
}

/// A measurement older than 0.3 s, from the future, or not newer than the last one is not used.
#[test]
fn late_positions_are_refused() {
    let mut navigation = Navigation::new(Some(CHANGE), 50.0);
    for tick in 0..100 {
        navigation.predict(&air(12.0, 0.0), if tick == 0 { 0.0 } else { TICK_PERIOD });
    }
    for age in [51, 1000, u32::MAX] {
        assert_eq!(
            navigation.take(&fix(1.0, 50.0, age, 0.1)),
            PositionVerdict::Late
        );
    }
    assert_eq!(
        navigation.take(&fix(11.0, 50.0, 3, 0.1)),
        PositionVerdict::Accepted
    );
    assert_eq!(
        navigation.take(&fix(10.9, 50.0, 4, 0.1)),
        PositionVerdict::Late
    );
    assert_eq!(
        navigation.take(&fix(11.3, 50.0, 0, 0.1)),
        PositionVerdict::Accepted
    );
    let unsound = [
        fix(f64::NAN, 50.0, 0, 0.1),
        fix(1.0, f64::INFINITY, 0, 0.1),
        fix(1.0, 50.0, 0, -0.1),
        fix(1.0, 50.0, 0, f64::NAN),
    ];
    for bad in unsound {
        assert_eq!(navigation.take(&bad), PositionVerdict::NotFinite);
    }
}
