//! Tests the gate before adoption, and the ladder beneath it.

use crate::common::planning::{level, plan, planner};
use crate::common::world::{Disc, scan};
use mpp_core::gate::{Cause, Gate, GateVerdict, Space};
use mpp_core::map::RollingGrid;
use mpp_core::planner::{Planner, Verdict};
use mpp_core::settings::Settings;
use mpp_core::trajectory::Trajectory;
use mpp_core::tuning::gate::{REACTION, REST};
use mpp_core::tuning::grid::OCCUPIED;
use mpp_core::vehicle::{AirState, Conditions, VehicleState};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

const AHEAD: [Disc; 2] = [(118.0, 50.0, 2.0), (135.0, 46.0, 2.0)];

/// A planner that has planned past two discs, its state, and a gate for its plan.
fn planned() -> (Box<Planner>, VehicleState, Gate) {
    let settings = Settings::flight();
    let mut planner = planner(&settings);
    let state = level(&planner);
    assert_eq!(plan(&mut planner, &state, &AHEAD), Verdict::Feasible);
    let own = settings.planner.plane().unwrap();
    let mut gate = Gate::new();
    gate.set_up(&settings, own, state.air.angle_of_attack(), 12.0);
    gate.begin(3.0, 0.0, &state, &Conditions::STILL, 50.0);
    (planner, state, gate)
}

fn map(planner: &Planner) -> &RollingGrid {
    planner.plane().unwrap().map()
}

/// When a trajectory first lies in an occupied cell, looked up every 2 ms, after the reaction time \[s\].
fn strikes(map: &RollingGrid, plan: &Trajectory) -> Option<f64> {
    (0..2250)
        .map(|step| 0.002 * f64::from(step))
        .filter(|after| *after > REACTION + 0.125)
        .find(|after| {
            let reference = plan.sample(plan.start + after).unwrap();
            map.log_odds((reference.state.x, reference.state.z)) >= OCCUPIED
        })
}

#[test]
fn a_plan_passes_until_an_obstacle_stands_on_its_way() {
    let (planner, _, gate) = planned();
    let best = planner.best();
    let clear = map(&planner).clone();
    assert_eq!(
        gate.check(&clear, best, Space::NotOccupied),
        GateVerdict::Passes
    );
    for after in [1.0, 2.2, 3.9] {
        let at = best.sample(3.0 + after).unwrap().state;
        let mut blocked = clear.clone();
        let beside = |x: f64, z: f64| libm::hypot(x - at.x, z - at.z) < 0.5;
        blocked.know(|x, z| clear.log_odds((x, z)) >= OCCUPIED || beside(x, z));
        let GateVerdict::Refused(Cause::Obstacle, when) =
            gate.check(&blocked, best, Space::NotOccupied)
        else {
            panic!("an obstacle after {after} s was not seen");
        };
        assert!((when - after).abs() < 0.2, "{when} s for {after} s");
    }
}

#[test]
fn what_is_no_motion_of_this_aircraft_is_refused() {
    let (planner, _, gate) = planned();
    let map = map(&planner);
    let check = |change: &dyn Fn(&mut Trajectory)| {
        let mut plan = planner.best().clone();
        change(&mut plan);
        match gate.check(map, &plan, Space::NotOccupied) {
            GateVerdict::Passes => None,
            GateVerdict::Refused(cause, _) => Some(cause),
        }
    };
    assert_eq!(check(&|_| {}), None);
    assert_eq!(check(&|plan| plan.shift((4.0, 0.0))), Some(Cause::Start));
    assert_eq!(check(&|plan| plan.start += 1.0), Some(Cause::Incomplete));
    assert_eq!(
        check(&|plan| plan.stage_period *= 1.01),
        Some(Cause::Incomplete)
    );
    assert_eq!(
        check(&|plan| plan.knots[9].state.x += 0.5),
        Some(Cause::Motion)
    );
    let fast = |plan: &mut Trajectory| plan.knots[9].state.air.airspeed *= 1.5;
    assert_eq!(check(&fast), Some(Cause::Motion));
    let push = |plan: &mut Trajectory| plan.knots[9].feedforward.thrust = 30.0;
    assert_eq!(check(&push), Some(Cause::Limits));
    let none = |plan: &mut Trajectory| plan.knots[9].state.z = f64::NAN;
    assert_eq!(check(&none), Some(Cause::Incomplete));
}

/// A plan of which a bit flipped is refused, or it still strikes nothing that the map knows.
#[test]
fn no_flipped_bit_of_a_plan_leads_into_a_known_cell() {
    let (planner, _, gate) = planned();
    let map = map(&planner);
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let mut refused = 0;
    for _ in 0..3000 {
        let mut plan = planner.best().clone();
        let drawn = random.next_u64();
        let knot = &mut plan.knots[(drawn >> 8) as usize % 19];
        let AirState {
            airspeed,
            pitch,
            flight_path,
            ..
        } = &mut knot.state.air;
        let numbers = [
            &mut knot.state.x,
            &mut knot.state.z,
            airspeed,
            pitch,
            flight_path,
            &mut knot.feedforward.thrust,
        ];
        let number = numbers.into_iter().nth((drawn >> 16) as usize % 6).unwrap();
        *number = f64::from_bits(number.to_bits() ^ 1 << (drawn % 64));
        assert_ne!(plan.seal(), planner.best().seal());
        match gate.check(map, &plan, Space::NotOccupied) {
            GateVerdict::Passes => assert_eq!(strikes(map, &plan), None, "{drawn}"),
            GateVerdict::Refused(..) => refused += 1,
        }
    }
    assert!((300..2700).contains(&refused), "{refused} of 3000 refused");
}

#[test]
fn a_reserve_stays_where_beams_have_looked_and_a_climb_may_leave_the_band() {
    let (mut planner, state, mut gate) = planned();
    planner.forget();
    assert_eq!(plan(&mut planner, &state, &[]), Verdict::Feasible);
    let best = planner.best();
    let unseen = RollingGrid::new();
    assert_eq!(
        gate.check(&unseen, best, Space::NotOccupied),
        GateVerdict::Passes
    );
    let refused = gate.check(&unseen, best, Space::KnownFree);
    assert!(
        matches!(refused, GateVerdict::Refused(Cause::Obstacle, _)),
        "{refused:?}"
    );
    let mut climb = best.clone();
    climb.shift((0.0, 2.5));
    // The aircraft is 14 m above the middle of the band, out of it already: it may stay there, and not go farther.
    gate.begin(3.0, 0.0, &state, &Conditions::STILL, 36.0);
    assert_eq!(
        gate.check(&unseen, best, Space::NotOccupied),
        GateVerdict::Passes
    );
    let held = gate.check(&unseen, &climb, Space::NotOccupied);
    assert!(
        matches!(held, GateVerdict::Refused(Cause::Altitude, _)),
        "{held:?}"
    );
    assert_eq!(
        gate.check(&unseen, &climb, Space::Above),
        GateVerdict::Passes
    );
}

/// Programs that are all cut short leave paths of the lattice, and these are flown out.
#[test]
fn a_cycle_without_a_solved_program_flies_a_path_by_pursuit() {
    let mut planner = planner(&Settings::flight());
    let state = level(&planner);
    let scan = scan(&AHEAD, &state);
    planner.begin(3.0, &state, &Conditions::STILL, &scan);
    while planner.candidate().is_none() {
        assert!(planner.advance());
    }
    assert_eq!(planner.finish(), Verdict::Pursuit);
    let best = planner.best();
    assert_eq!(strikes(map(&planner), best), None);
    let way = |plan: &Trajectory| {
        let off = (0..450).map(|tick| {
            let at = plan.sample(3.0 + 0.01 * f64::from(tick)).unwrap().state;
            AHEAD.map(|(x, z, radius)| libm::hypot(at.x - x, at.z - z) - radius)
        });
        off.flatten().fold(f64::INFINITY, f64::min)
    };
    assert!(way(best) > 0.3, "{} m", way(best));
}

/// The aircraft flies on by the plan that it has, while the last programs are cut short and the plan is still clear.
#[test]
fn a_cycle_without_a_plan_keeps_a_previous_one_that_still_passes() {
    let (mut planner, _, _) = planned();
    let flown = planner.best().clone();
    for (later, kept) in [(0.25, true), (4.5 - 0.5 * REST, false)] {
        let mut planner = planner.clone();
        let time = 3.0 + later;
        let at = flown.sample(time).unwrap().state;
        planner.begin(time, &at, &Conditions::STILL, &scan(&AHEAD, &at));
        let verdict = planner.finish();
        assert_eq!(
            verdict == Verdict::Kept,
            kept,
            "{verdict:?} after {later} s"
        );
        if kept {
            assert_eq!(planner.best(), &flown);
        }
    }
    // A wall that the plan does not know.
    let at = flown.sample(3.25).unwrap().state;
    let wall: Vec<Disc> = (0..16)
        .map(|i| (112.0, 40.0 + 2.0 * f64::from(i), 1.0))
        .collect();
    planner.begin(3.25, &at, &Conditions::STILL, &scan(&wall, &at));
    for _ in 0..8 {
        planner.advance();
    }
    assert_ne!(planner.finish(), Verdict::Kept);
}

/// Nothing that the aircraft can fly misses a disc that is 4 m ahead.
#[test]
fn where_nothing_passes_what_strikes_latest_is_flown() {
    let mut planner = planner(&Settings::flight());
    let state = level(&planner);
    assert_eq!(
        plan(&mut planner, &state, &[(106.0, 50.0, 2.0)]),
        Verdict::Latest
    );
    assert_eq!(planner.summary().refused, Some(Cause::Obstacle));
    let (_, state, gate) = planned();
    let struck = gate.check(map(&planner), planner.best(), Space::NotOccupied);
    assert!(
        matches!(struck, GateVerdict::Refused(Cause::Obstacle, when) if when < 0.75),
        "{struck:?} from {state:?}"
    );
}
