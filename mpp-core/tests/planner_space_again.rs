//! The planner in space goes on from cycle to cycle.

use super::planner_space::{Draw, KEEP, finish, level, model, plan, see_forest, with_planner};
use mpp_core::planner::space::next_start;
use mpp_core::vehicle::SPACE_STATES;
use rand_core::SeedableRng;
use rand_pcg::Pcg64Mcg;

/// The next plan begins where this one will be, moved by a part of the deviation; along the track by all of it.
#[test]
fn the_next_plan_begins_between_the_last_plan_and_the_aircraft() {
    with_planner(KEEP, |map, planner| {
        let model = model();
        let (plan, _) = plan(planner, map, &level(&model), 0.0);
        let then = plan.at(&model, 0.4).0;
        assert_eq!(next_start(&then, &[0.0; SPACE_STATES]), then);
        let deviation = [-0.4, 0.2, 0.0, 1.0, 0.0, -0.1, 0.0, 0.0];
        let start = next_start(&then, &deviation);
        assert!((start.position[0] - then.position[0] + 0.4).abs() < 1e-9);
        assert!((start.airspeed - then.airspeed - 1.0).abs() < 1e-9);
        let share = (start.position[1] - then.position[1]) / 0.2;
        assert!(share > 0.0 && share < 1.0, "{share}");
        let bank = (start.bank - then.bank) / -0.1;
        assert!((bank - share).abs() < 1e-9, "{bank}");
    });
}

/// A plan past trunks that is continued without a deviation stays what it is, whenever the next cycle begins.
#[test]
fn the_previous_plan_goes_on_as_it_was() {
    with_planner(KEEP, |map, planner| {
        let (mut draw, model) = (Draw(Pcg64Mcg::seed_from_u64(8)), model());
        let mut kept = 0;
        for shift in [0.05, 0.1, 0.17, 0.24, 0.25, 0.26, 0.4, 0.5] {
            let _ = see_forest(map, &mut draw);
            let (before, _) = plan(planner, map, &level(&model), 0.0);
            planner.begin(&before.at(&model, shift).0, shift);
            finish(planner, map);
            let again = *planner.candidates().next().unwrap();
            let off = |time: f64| {
                let (was, is) = (before.at(&model, shift + time).0, again.at(&model, time).0);
                libm::hypot(
                    was.position[1] - is.position[1],
                    was.position[2] - is.position[2],
                )
            };
            // The same as a path may be cheaper.
            let most = (0..16)
                .map(|at| off(0.25 * f64::from(at)))
                .fold(0.0, f64::max);
            kept += usize::from(most < 0.01);
        }
        assert!(kept >= 6, "{kept}");
    });
}
