//! The core's estimator in space behind sensors with errors, on the plant in six degrees of freedom that flies turns.

use mpp_core::config::TICK_PERIOD;
use mpp_core::control::SpaceRegulator;
use mpp_core::estimate::SpaceEstimator;
use mpp_core::vehicle::{GRAVITY, LateralControl, SpaceControl, SpaceModel, SpacePath};
use mpp_sim::aircraft_file::{AircraftFile, AircraftModel};
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::{SensorErrors, SpaceAircraft, SpaceSensors, WindConfig, regulator, true_path};

/// Time by which bank and angle of attack follow, as flights of the planner use it \[s\].
const AHEAD: f64 = 0.12;
/// Time before the first turn, and rate of the bank there [s, rad/s].
const SETTLED: f64 = 3.0;
const BANK_RATE: f64 = 1.0;

/// Level flight with a bank by time: what a plan would be.
struct Turns {
    model: SpaceModel,
    bank: fn(f64) -> f64,
    now: SpacePath,
}

impl Turns {
    fn state(&self, time: f64, position: [f64; 3], course: f64) -> (SpacePath, SpaceControl) {
        let (model, bank) = (&self.model, (self.bank)(time));
        let airspeed = model.trim.state.airspeed;
        let angle_of_attack = model.angle_for(airspeed, GRAVITY / bank.cos());
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
        for (position, velocity) in self.now.position.iter_mut().zip(velocity) {
            *position += TICK_PERIOD * velocity;
        }
        self.now.course += TICK_PERIOD * GRAVITY * (self.bank)(time).tan() / airspeed;
    }
}

/// The estimate of a tick beside the truth.
struct Tick {
    time: f64,
    estimator: SpaceEstimator,
    truth: SpacePath,
    sideslip: f64,
    ground: [f64; 3],
    wind: [f64; 3],
    wanted: SpacePath,
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
    bank: fn(f64) -> f64,
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
            turns.now.course + AHEAD * GRAVITY * bank(time).tan() / known.cruise,
        );
        let (command, lateral) = follower.step(&turns.model, &motion, &now, (&ahead.0, &ahead.1));
        each(&Tick {
            time,
            estimator: estimator.clone(),
            truth,
            sideslip: state.lateral.sideslip,
            ground: truth.ground_velocity(&air),
            wind: air,
            wanted: now,
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
    0.8 * ((time - SETTLED).max(0.0) * 1.5).sin()
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

#[test]
fn show() {
    for (name, air) in [
        ("calm", ([0.0; 3], 0.0)),
        ("5", ([0.0, 5.0, 0.0], 0.0)),
        ("5+gusts .63", ([0.0, 5.0, 0.0], 0.63)),
    ] {
        let mut s: [Spread; 12] = Default::default();
        for seed in 0..20 {
            fly(seed, air, slalom, 20.0, |t| {
                if t.time < 3.0 {
                    return;
                }
                let e = &t.estimator;
                let m = e.motion().unwrap();
                let g = e.ground_velocity().unwrap();
                let v = e.variances().unwrap();
                for a in 0..3 {
                    s[0].take(m.path.position[a] - t.truth.position[a]);
                    s[1].take(g[a] - t.ground[a]);
                    s[2].take((m.path.position[a] - t.truth.position[a]) / v[0].sqrt());
                    s[3].take((g[a] - t.ground[a]) / v[1].sqrt());
                    s[4].take(e.wind()[a] - air.0[a]);
                    s[5].take(e.gusty_wind()[a] - t.wind[a]);
                }
                let [al, be] = e.flow_angles().unwrap();
                s[6].take((al - t.truth.angle_of_attack).to_degrees());
                s[7].take((be - t.sideslip).to_degrees());
                s[8].take((m.path.bank - t.truth.bank).to_degrees());
                s[9].take(e.bank_bias().to_degrees());
                s[10].take(t.sideslip.to_degrees());
                s[11].take(t.wanted.position[2] - t.truth.position[2]);
            });
        }
        let n = [
            "pos",
            "vel",
            "nees p",
            "nees v",
            "wind",
            "gusty",
            "alpha",
            "beta",
            "bank",
            "bias",
            "true beta",
            "height",
        ];
        println!("{name}");
        for (n, s) in n.iter().zip(&s) {
            println!("  {n:10} rms {:.4} most {:.3}", s.rms(), s.most);
        }
    }
}

#[test]
fn debug() {
    for seed in 0..20 {
        let mut worst = 0.0_f64;
        fly(seed, ([0.0, 5.0, 0.0], 0.0), slalom, 20.0, |t| {
            let h = t.wanted.position[2] - t.truth.position[2];
            worst = worst.max(h.abs());
            if seed == 1 && ((t.time * 100.0).round() as i64) % 20 == 0 {
                let m = t.estimator.motion().unwrap();
                println!(
                    "{:.2} w {:.2?} g {:.2?} bank {:.2} {:.2} al {:.3} {:.3} h {:.2} off {:.2?} c {:.2} {:.2} v {:.1}",
                    t.time,
                    t.estimator.wind(),
                    t.estimator.gusty_wind(),
                    m.path.bank,
                    t.truth.bank,
                    m.path.angle_of_attack,
                    t.truth.angle_of_attack,
                    h,
                    [0, 1].map(|a| t.wanted.position[a] - t.truth.position[a]),
                    t.wanted.course,
                    t.truth.course,
                    t.truth.airspeed
                );
            }
        });
        println!("{seed} {worst:.2}");
    }
}
