//! The lateral regulator of the core on the plant in six degrees of freedom.

use crate::common::models;
use mpp_core::control::{LateralMotion, LateralRegulator};
use mpp_core::vehicle::{LateralControl, Nose, linearize_lateral};
use mpp_sim::plant::Plant;
use mpp_sim::scenario::{Preset, Scenario};
use mpp_sim::space::{CourseHold, SpaceAircraft, SpaceState, WindConfig, regulator};

fn scenarios(seed: u64) -> impl Iterator<Item = Scenario> {
    models().map(move |aircraft| Scenario {
        aircraft,
        ..Scenario::new(Preset::Flight, seed)
    })
}

/// The nose of zagi runs away unless banks bring it back.
fn departs(name: &str) -> bool {
    name == "zagi"
}

/// The states of a flight with the controls of level flight and a wanted bank.
fn flown(scenario: &Scenario, wind: WindConfig, ticks: u32, bank: f64) -> Vec<SpaceState> {
    let mut aircraft = SpaceAircraft::new(scenario, wind).unwrap();
    let mut regulator = regulator(scenario).unwrap();
    let trim = scenario.trim().unwrap().control;
    let step = |_| {
        let command: LateralControl = regulator.step(&aircraft.state().lateral_motion(), bank);
        aircraft.step(trim, command).unwrap();
        *aircraft.state()
    };
    (0..ticks).map(step).collect()
}

/// Light turbulence of MIL-F-8785C, section 3.7.3.4: a tenth of a wind of 15 knots.
const LIGHT: f64 = 0.77;

#[test]
fn bank_stays_level_in_light_turbulence() {
    for seed in 1..=3 {
        for mut scenario in scenarios(seed) {
            scenario.faults.gusts.intensity = LIGHT;
            let wind = WindConfig {
                lateral_gusts: LIGHT,
                ..WindConfig::default()
            };
            let states = flown(&scenario, wind, 3000, 0.0);
            let squares: f64 = states.iter().map(|state| state.bank().powi(2)).sum();
            let rms = (squares / states.len() as f64).sqrt().to_degrees();
            let name = &scenario.aircraft.file.name;
            assert!(rms < if departs(name) { 6.0 } else { 3.0 }, "{name}: {rms}");
        }
    }
}

#[test]
fn a_turn_is_reached_and_coordinated() {
    for scenario in scenarios(1).filter(|it| !departs(&it.aircraft.file.name)) {
        for bank in [30_f64, -30.0] {
            let unit = scenario.aircraft.units().time;
            let ticks = (400.0 * unit) as u32;
            let states = flown(&scenario, WindConfig::default(), ticks, bank.to_radians());
            let name = &scenario.aircraft.file.name;
            let share = |state: &SpaceState| state.bank().to_degrees() / bank;
            let most = states.iter().map(share).fold(0.0, f64::max);
            let early = &states[..ticks as usize / 4];
            let end = states.last().unwrap();
            assert!(early.iter().any(|state| share(state) > 0.9), "{name}");
            let held = (share(end) - 1.0).abs();
            assert!(most < 1.25 && held < 0.05, "{name}: {most}, {held}");
            let slip = end.lateral.sideslip.to_degrees();
            assert!(slip.abs() < 3.0, "{name}: {slip}");
        }
    }
}

/// Held by the ailerons alone, such a nose runs away. So the bank goes to the other side first, the nose then comes along, and
/// the turn is a coordinated one.
#[test]
fn a_nose_that_runs_away_is_brought_into_the_turn() {
    for scenario in scenarios(1).filter(|it| departs(&it.aircraft.file.name)) {
        let bank = 30_f64.to_radians();
        let states = flown(&scenario, WindConfig::default(), 2500, bank);
        let least = states.iter().map(SpaceState::bank).fold(0.0, f64::min);
        let end = states.last().unwrap();
        let (off, slip) = (end.bank() - bank, end.lateral.sideslip);
        assert!(
            least < -0.2 && off.abs() < 0.06 && slip.abs() < 0.052,
            "{off} {slip}"
        );
    }
}

/// The runaway grows on the plant as plans count on it, with a bank and without.
#[test]
fn the_runaway_of_a_nose_is_as_told() {
    for scenario in scenarios(1) {
        let model = &scenario.aircraft;
        let table = model.file.lateral.as_ref().unwrap();
        let linear = linearize_lateral(&model.known.airframe, &table.airframe(), &model.trim);
        let nose = Nose::of(&linear).filter(|_| table.rudder.is_none());
        assert_eq!(nose.is_some(), departs(&model.file.name));
        let Some(nose) = nose else { continue };
        let mut aircraft = SpaceAircraft::new(&scenario, WindConfig::default()).unwrap();
        let regulator = regulator(&scenario).unwrap();
        let (mut told, mut off) = (0.0_f64, 0.0_f64);
        for stage in 0..12 {
            let wanted = if stage < 4 { 0.3 } else { 0.0 };
            let before = aircraft.state().bank();
            for _ in 0..25 {
                let command = regulator.follow(&aircraft.state().lateral_motion(), wanted, 0.0);
                aircraft.step(model.trim.control, command).unwrap();
            }
            let now = aircraft.state().lateral_motion();
            told = nose.after_stage(told, 0.5 * (before + now.bank));
            let is = nose.runaway(now.sideslip, [now.roll_rate, now.yaw_rate], now.bank);
            off = off.max((is - told).abs() / told.abs().max(0.1));
        }
        println!("runaway {told}, off by a share of {off}");
        assert!(told > 0.6 && off < 0.1, "{told} {off}");
    }
}

#[test]
fn a_motion_that_is_no_number_gives_neutral_surfaces() {
    let scenario = scenarios(1).next().unwrap();
    let mut regulator = regulator(&scenario).unwrap();
    let aircraft = SpaceAircraft::new(&scenario, WindConfig::default()).unwrap();
    let level = aircraft.state().lateral_motion();
    let bad = LateralMotion {
        roll_rate: f64::NAN,
        ..level
    };
    let before = regulator;
    for (motion, bank) in [(bad, 0.1), (level, f64::INFINITY)] {
        assert_eq!(regulator.step(&motion, bank), LateralControl::default());
    }
    assert_eq!(regulator, before);
    assert!(regulator.step(&level, 0.1).aileron > 0.0);
}

#[test]
fn an_aileron_that_turns_nothing_has_no_regulator() {
    let scenario = scenarios(1).next().unwrap();
    let model = &scenario.aircraft;
    let mut lateral = model.file.lateral.as_ref().unwrap().airframe();
    lateral.roll.aileron = 0.0;
    lateral.yaw.aileron = 0.0;
    let airframe = &model.known.airframe;
    let refused = LateralRegulator::design(airframe, &lateral, &model.trim, [0.4; 2]);
    assert!(refused.unwrap_err().to_string().contains("lateral table"));
}

/// Without anything from the side the planner's plane is flown bit for bit, and in gusts the track is held.
#[test]
fn the_course_is_held() {
    for mut scenario in scenarios(4) {
        let trim = scenario.trim().unwrap().control;
        let name = scenario.aircraft.file.name.clone();
        let mut plane = mpp_sim::aircraft::Aircraft::new(&scenario).unwrap();
        let mut calm = CourseHold::new(&scenario).unwrap();
        for _ in 0..500 {
            plane.step(trim).unwrap();
            calm.step(trim).unwrap();
            assert_eq!(plane.state(), calm.state(), "{name}");
        }
        scenario.faults.gusts.intensity = 0.77;
        let mut gusty = CourseHold::new(&scenario).unwrap();
        let mut off = 0.0_f64;
        for _ in 0..2000 {
            gusty.step(trim).unwrap();
            off = off.max(gusty.space().lateral.y.abs());
        }
        println!("{name}: {off:.2} m off the track");
        let unit = scenario.aircraft.units().length;
        assert!(departs(&name) || off < unit.max(1.0), "{name}: {off} m");
        assert!(off > 0.0, "{name} flies in gusts from the side");
    }
}
