//! The core's estimator in space behind sensors with errors, on the plant in six degrees of freedom that flies turns.

use mpp_core::config::TICK_PERIOD;
use mpp_core::control::{SpaceMotion, SpaceRegulator};
use mpp_core::estimate::SpaceEstimator;
use mpp_core::vehicle::{GRAVITY, LateralControl, Quaternion, SpaceControl, SpaceModel, SpacePath};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::{SensorErrors, SpaceAircraft, SpaceSensors, WindConfig, regulator, true_path};
use std::collections::VecDeque;

/// Time by which bank and angle of attack follow, as flights of the planner use it \[s\].
const AHEAD: f64 = 0.12;
/// Time before the first turn, and rate of the bank there [s, rad/s].
const SETTLED: f64 = 3.0;
const BANK_RATE: f64 = 1.0;

/// A bank by time \[rad\].
type Bank = fn(f64) -> f64;

/// Level flight with a bank by time: what a plan would be.
struct Turns {
    model: SpaceModel,
    bank: Bank,
    now: SpacePath,
}

impl Turns {
    fn state(&self, time: f64, position: [f64; 3], course: f64) -> (SpacePath, SpaceControl) {
        let (model, bank) = (&self.model, (self.bank)(time));
        let airspeed = model.trim.state.airspeed;
        let angle_of_attack = model.angle_for(airspeed, GRAVITY / libm::cos(bank));
        let path = SpacePath {
            position,
            airspeed,
            angle_of_attack,
            bank,
            flight_path: 0.0,
            course,
        };
        let control = SpaceControl {
            bank_rate: ((self.bank)(time + 0.01) - bank) / 0.01,
            angle_of_attack_rate: 0.0,
            thrust: model.thrust_for(airspeed, angle_of_attack, 0.0),
        };
        (path, control)
    }

    fn advance(&mut self, time: f64) {
        let airspeed = self.model.trim.state.airspeed;
        let velocity = self.now.ground_velocity(&self.model.wind);
        // The wanted height stays.
        for (position, velocity) in self.now.position.iter_mut().zip(velocity).take(2) {
            *position += TICK_PERIOD * velocity;
        }
        self.now.course += TICK_PERIOD * GRAVITY * libm::tan((self.bank)(time)) / airspeed;
    }
}

/// The estimate of a tick beside the truth.
struct Tick {
    time: f64,
    estimator: SpaceEstimator,
    truth: SpacePath,
    attitude: Quaternion,
    sideslip: f64,
    ground: [f64; 3],
}

fn scenario(seed: u64) -> Scenario {
    let mut file = AircraftFile::known("ultrastick").unwrap();
    file.cruise = 13.0;
    Scenario {
        aircraft: AircraftModel::new(file).unwrap(),
        ..Scenario::new(Preset::Flight, seed)
    }
}

fn fly(
    seed: u64,
    (steady, gusts): ([f64; 3], f64),
    bank: Bank,
    seconds: f64,
    mut each: impl FnMut(&Tick),
) {
    let mut scenario = scenario(seed);
    scenario.faults.gusts.intensity = gusts;
    let wind = WindConfig {
        steady,
        lateral_gusts: gusts,
        ..WindConfig::default()
    };
    let mut plant = SpaceAircraft::new(&scenario, wind).unwrap();
    let known = &scenario.aircraft.known;
    let model = SpaceModel::new(&known.airframe, known.cruise, 0.28, 20.0, [1.05, 1.57]).unwrap();
    let lateral = scenario.aircraft.file.lateral.as_ref().unwrap().airframe();
    let follower = SpaceRegulator::new(&known.airframe, regulator(&scenario).unwrap(), &model);
    let mut sensors = SpaceSensors::new(seed, SensorErrors::RTK);
    let mut estimator = SpaceEstimator::new(&model, &lateral);
    let mut turns = Turns {
        model,
        bank,
        now: true_path(plant.state()),
    };
    let mut surfaces = LateralControl::default();
    let mut started = false;
    for tick in 0..(seconds / TICK_PERIOD) as u32 {
        let time = f64::from(tick) * TICK_PERIOD;
        let told = sensors.step(&plant);
        estimator.predict(told.inertial.as_ref());
        estimator.observe_airspeed(Some(told.airspeed), &surfaces);
        estimator.observe_fix(told.fix.as_ref());
        let (state, air) = (plant.state(), plant.wind());
        let truth = true_path(state);
        turns.model.wind = estimator.wind();
        let Some(motion) = estimator.motion() else {
            plant.step(model.trim.control, surfaces).unwrap();
            continue;
        };
        if !started || time < 0.5 * SETTLED {
            turns.now = motion.path;
            turns.now.position[2] = 50.0;
            started = true;
        }
        let (now, _) = turns.state(time, turns.now.position, turns.now.course);
        let ahead = turns.state(
            time + AHEAD,
            turns.now.position,
            turns.now.course + AHEAD * GRAVITY * libm::tan(bank(time)) / known.cruise,
        );
        let (command, lateral) = follower.step(&turns.model, &motion, &now, (&ahead.0, &ahead.1));
        each(&Tick {
            time,
            estimator: estimator.clone(),
            truth,
            attitude: state.attitude(),
            sideslip: state.lateral.sideslip,
            ground: truth.ground_velocity(&air),
        });
        plant.step(command, lateral).unwrap();
        surfaces = lateral;
        turns.advance(time);
    }
}

/// A bank that is reached by a ramp.
fn ramp(time: f64, bank: f64) -> f64 {
    ((time - SETTLED).max(0.0) * BANK_RATE).min(bank)
}

fn slalom(time: f64) -> f64 {
    0.8 * libm::sin((time - SETTLED).max(0.0) * 1.5)
}

/// Sums of squares, and what they mean.
#[derive(Default)]
struct Spread {
    sum: f64,
    most: f64,
    count: f64,
}

impl Spread {
    fn take(&mut self, value: f64) {
        self.sum += value * value;
        self.most = self.most.max(value.abs());
        self.count += 1.0;
    }

    fn rms(&self) -> f64 {
        (self.sum / self.count).sqrt()
    }
}

/// Seeds of each case.
const SEEDS: core::ops::Range<u64> = 0..12;

/// Errors of position and velocity have the size that the filter tells (NEES), in slaloms with a side wind as without wind.
#[test]
fn errors_are_as_the_covariance_says_and_the_wind_does_not_matter() {
    let spread = |steady: [f64; 3]| {
        let mut all: [Spread; 7] = Default::default();
        for seed in SEEDS {
            let mut errors = VecDeque::new();
            fly(seed, (steady, 0.0), slalom, 20.0, |tick| {
                // The first two seconds find the wind.
                if tick.time < 2.0 {
                    return;
                }
                let (estimator, truth) = (&tick.estimator, &tick.truth);
                let motion = estimator.motion().unwrap();
                let ground = estimator.ground_velocity().unwrap();
                let [position, velocity, _] = estimator.variances().unwrap().map(f64::sqrt);
                for axis in 0..3 {
                    let place = motion.path.position[axis] - truth.position[axis];
                    all[0].take(place / position);
                    all[1].take((ground[axis] - tick.ground[axis]) / velocity);
                    all[2].take(estimator.wind()[axis] - steady[axis]);
                }
                let [attack, sideslip] = estimator.flow_angles().unwrap();
                all[3].take((attack - truth.angle_of_attack).to_degrees());
                all[4].take((sideslip - tick.sideslip).to_degrees());
                all[5].take((motion.path.bank - truth.bank).to_degrees());
                let attitude = estimator.pose(0.0).unwrap().attitude;
                let error = tick.attitude.in_world(attitude.turn_to(tick.attitude));
                errors.push_back(error);
                if errors.len() > 100 {
                    let before = errors.pop_front().unwrap();
                    let moved = [0, 1, 2].map(|axis| error[axis] - before[axis]);
                    moved.iter().for_each(|it| all[6].take(it.to_degrees()));
                }
            });
        }
        all.map(|it| (it.rms(), it.most))
    };
    let calm = spread([0.0; 3]);
    let windy = spread([0.0, 5.0, 0.0]);
    for all in [&calm, &windy] {
        let [position, velocity, wind, attack, sideslip, bank, attitude] = *all;
        assert!((0.8..1.2).contains(&position.0), "{all:?}");
        assert!((0.7..1.2).contains(&velocity.0), "{all:?}");
        assert!(position.1 < 6.0 && velocity.1 < 6.0, "{all:?}");
        assert!(wind.0 < 0.25 && wind.1 < 1.2, "{all:?}");
        assert!(
            attack.0 < 0.6 && sideslip.0 < 0.6 && bank.0 < 0.8,
            "{all:?}"
        );
        // What is told moves by 0.44 deg within a second.
        assert!(attitude.0 < 0.3, "{all:?}");
    }
    for (calm, windy) in calm.iter().zip(&windy) {
        assert!(
            (calm.0 - windy.0).abs() < 0.02 * calm.0,
            "{calm:?} {windy:?}"
        );
    }
}

/// Nothing is refused in light turbulence, and the angles to the flow follow its gusts.
#[test]
fn gusts_are_followed_and_not_refused() {
    let (mut attack, mut sideslip, mut refused) = (Spread::default(), Spread::default(), 0);
    for seed in SEEDS {
        let mut last = 0;
        fly(seed, ([0.0, 5.0, 0.0], 0.77), slalom, 20.0, |tick| {
            let [told, slip] = tick.estimator.flow_angles().unwrap();
            attack.take((told - tick.truth.angle_of_attack).to_degrees());
            sideslip.take((slip - tick.sideslip).to_degrees());
            let counts = tick.estimator.refused();
            last = counts.inertial + counts.airspeed + counts.position + counts.velocity;
        });
        refused += last;
    }
    assert!(
        attack.rms() < 1.3 && sideslip.rms() < 1.3,
        "{} {}",
        attack.rms(),
        sideslip.rms()
    );
    // Of 24,000 airspeeds.
    assert!(refused < 24, "{refused}");
}

/// A turn neither climbs nor sinks, by sensors with errors and an estimated wind.
#[test]
fn altitude_is_held_with_bank() {
    let banks: [(Bank, f64); 2] = [
        (|time| ramp(time, 30_f64.to_radians()), 1.0),
        (|time| ramp(time, 45_f64.to_radians()), 1.2),
    ];
    for (bank, most) in banks {
        let mut worst = 0.0_f64;
        for seed in SEEDS {
            fly(seed, ([0.0, 5.0, 0.0], 0.0), bank, 20.0, |tick| {
                if tick.time > SETTLED {
                    worst = worst.max((tick.truth.position[2] - 50.0).abs());
                }
            });
        }
        println!("worst {worst:.2} m");
        assert!(worst < most, "{worst}");
    }
}

/// In a stall the lift line tells a small angle of attack, and the wanted lift asks for more of it.
#[test]
fn the_elevator_balances_no_angle_beyond_the_greatest() {
    let scenario = scenario(1);
    let known = &scenario.aircraft.known;
    let model = SpaceModel::new(&known.airframe, known.cruise, 0.28, 20.0, [1.05, 1.57]).unwrap();
    let follower = SpaceRegulator::new(&known.airframe, regulator(&scenario).unwrap(), &model);
    let plan = SpacePath {
        position: [0.0, 0.0, 50.0],
        airspeed: known.cruise,
        angle_of_attack: 0.15,
        ..SpacePath::default()
    };
    let path = SpacePath {
        position: [0.0, 0.0, 40.0],
        airspeed: 10.0,
        angle_of_attack: 0.05,
        ..plan
    };
    let rates = [0.0; 3];
    let motion = SpaceMotion {
        path,
        rates,
        sideslip: 0.0,
    };
    let control = SpaceControl {
        thrust: model.trim.control.thrust,
        ..SpaceControl::default()
    };
    let (command, _) = follower.step(&model, &motion, &plan, (&plan, &control));
    let a = known.airframe.balanced();
    let balanced = -(a.moment_zero + a.moment_elevator * command.elevator) / a.moment_alpha;
    let [_, greatest] = model.angle_of_attack;
    assert!((balanced - greatest - 0.03).abs() < 1e-9, "{balanced}");
}
