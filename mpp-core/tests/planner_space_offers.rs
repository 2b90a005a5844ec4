//! Plans of others in a cycle of the planner in space.

use crate::planner_space::{KEEP, level, model, plan, sweep, to_trunks, with_planner};
use mpp_core::planner::space::{SpacePlan, towards};
use mpp_core::vehicle::GRAVITY;

/// Of two plans of others the cheaper one counts, and the planner can go on by itself afterwards.
#[test]
fn a_cycle_waits_for_plans_of_others_and_judges_them() {
    with_planner(KEEP, |map, planner| {
        let (model, start) = (model(), level(&model()));
        map.insert(
            &start.position,
            sweep(|to| to_trunks(&[[15.0, 0.5, 0.4]], to)).into_iter(),
            45.0,
        );
        let turned = |right: f64| {
            let mut plan = SpacePlan::new();
            plan.fly(&model, &start, |stage, state| {
                let right = if stage < 4 { right } else { -right };
                towards(&model, state, [GRAVITY, right], 0.25)
            });
            plan
        };
        planner.wait_for_offers();
        planner.begin(&start, 0.0);
        assert_eq!(planner.awaited(), None);
        while !planner.advance(map) {}
        assert_eq!((planner.awaited(), planner.proposed()), (Some(&start), 0));
        assert!(planner.advance(map) && planner.best().is_none());
        planner.offer(&[turned(0.0), turned(-6.0)]);
        let (best, _) = planner.best().unwrap();
        assert_eq!((*best, planner.awaited()), (turned(-6.0), None));
        planner.choose(3, true);
        plan(planner, map, &start, 0.25);
        assert!(planner.proposed() > 0);
    });
}
