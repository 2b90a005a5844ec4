//! Simple planners in the place of the planner in space, on the same sensors, map, regulator and plant.

use crate::forest::{aside, flown, trunk};
use mpp_sim::inquest::Cause;
use mpp_sim::orders::{Order, OrderEntry};
use mpp_sim::outcome::Outcome;
use mpp_sim::space::world::Body;
use mpp_sim::space::{BaselineName, SpaceFile, SpacePipe, fly_space_again};

fn outcome(name: BaselineName, bodies: &[Body]) -> Outcome {
    let file = SpaceFile {
        baseline: Some(name.name().to_owned()),
        ..SpaceFile::default()
    };
    let log = flown(file, Some(bodies.to_vec())).unwrap();
    let space = log.header.space.as_ref().unwrap();
    assert_eq!(space.baseline.as_deref(), Some(name.name()));
    assert!(log.plans.len() > 5, "{name}: {}", log.plans.len());
    log.summary.outcome
}

#[test]
fn every_baseline_crosses_an_empty_world() {
    for name in BaselineName::ALL {
        let flown = outcome(name, &[trunk(150.0, 30.0)]);
        assert_eq!(flown, Outcome::Survived, "{name}");
    }
}

/// A wall of trunks with a gap to either side of the way.
#[test]
fn gaps_beside_the_way_are_found_by_all_but_straight() {
    let places = (-37..=37).map(|place| 0.8 * f64::from(place));
    let closed = places.filter(|y| !(2.5..10.0).contains(&y.abs()));
    let mut bodies: Vec<Body> = closed.map(|y| trunk(60.0, y)).collect();
    bodies.push(trunk(120.0, 30.0));
    for (name, expected) in [
        (BaselineName::Straight, Outcome::Collision),
        (BaselineName::Library7, Outcome::Survived),
        (BaselineName::Library105, Outcome::Survived),
        (BaselineName::Paper, Outcome::Survived),
    ] {
        assert_eq!(outcome(name, &bodies), expected, "{name}");
    }
}

#[test]
fn a_baseline_has_no_settings_of_the_planner() {
    let named = |name: &str| SpaceFile {
        baseline: Some(name.to_owned()),
        ..SpaceFile::default()
    };
    for (file, hint) in [
        (
            named("library-8"),
            "there is no baseline `library-8`: give straight",
        ),
        (
            SpaceFile {
                candidates: Some(3),
                ..named("library-7")
            },
            "leave candidates, programs and mode out",
        ),
        (
            SpaceFile {
                programs: Some(true),
                ..named("paper")
            },
            "leave candidates, programs and mode out",
        ),
        (
            SpaceFile {
                programs: Some(false),
                ..named("straight")
            },
            "leave candidates, programs and mode out",
        ),
    ] {
        let error = flown(file, None).unwrap_err();
        assert!(
            error.contains(hint) && error.starts_with("baseline"),
            "{error}"
        );
    }
}

/// The paths are candidates, and the log flies again.
#[test]
fn the_method_of_the_paper_draws_as_many_paths_as_wanted() {
    let paper = |candidates| SpaceFile {
        baseline: Some("paper".to_owned()),
        candidates: Some(candidates),
        ..SpaceFile::default()
    };
    let bodies = vec![trunk(30.0, 0.2), trunk(60.0, 30.0)];
    let fly = |candidates| flown(paper(candidates), Some(bodies.clone())).unwrap();
    let (one, five) = (fly(1), fly(5));
    assert_eq!((one.header.paths, five.header.paths), (1, 5));
    assert_eq!(five.summary.outcome, Outcome::Survived);
    assert_eq!(five.hash().unwrap(), fly(5).hash().unwrap());
    assert_ne!(five.hash().unwrap(), one.hash().unwrap());
    let again = mpp_sim::space::scenario_of(&five.header).unwrap();
    assert_eq!(again.header(), five.header);
    let error = flown(paper(51), None).unwrap_err();
    assert!(error.contains("candidates: give 1 to 50"), "{error}");
}

/// Who flies straight on hits a trunk that stood there all the time, and one that grows half a second ahead: nobody knew that one.
#[test]
fn a_collision_tells_for_how_long_the_obstacle_was_known() {
    let failure = |stands: Vec<Body>, grows: Option<f64>| {
        aside(move || {
            let file = SpaceFile {
                baseline: Some("straight".to_owned()),
                ..SpaceFile::default()
            };
            let scenario = file.build(Some(&stands)).unwrap();
            let orders = grows.map(|x| OrderEntry {
                tick: 400,
                order: Order::Trunk {
                    x,
                    y: 0.0,
                    radius: 0.4,
                },
            });
            let orders = Vec::from_iter(orders);
            let mut link = SpacePipe::of(&scenario);
            let log = fly_space_again(&scenario, &mut link, &orders, || false).unwrap();
            assert_eq!(log.orders.len(), orders.len());
            (log.summary.failure.unwrap(), log)
        })
    };
    let (known, log) = failure(vec![trunk(60.0, 0.0), trunk(120.0, 30.0)], None);
    assert_eq!(known.cause, Cause::NoWay);
    assert!(known.off_plan.is_some_and(|off| off < 0.3), "{known:?}");
    // The lidar sees 45 m.
    let since = log.summary.t_end - known.seen_before.unwrap();
    assert!(since < 2.0, "{since}");
    let x = log.ticks.x[400] + 6.0;
    let (hidden, _) = failure(vec![trunk(120.0, 30.0)], Some(x));
    assert_eq!(hidden.cause, Cause::Hidden);
    assert!(hidden.seen_before.is_some_and(|time| time < 0.6));
}
