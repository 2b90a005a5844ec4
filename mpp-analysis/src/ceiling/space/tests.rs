use super::*;
use mpp_core::config::TICK_PERIOD;
use mpp_core::vehicle::Control;
use mpp_sim::aircraft_file::AircraftFile;
use mpp_sim::space::SpaceFile;
use mpp_sim::space::world::{Extent, WorldConfig, WorldName};
use proptest::prelude::*;
use trunks::forest;

fn scenario(aircraft: &str, sphere: Option<f64>, world: &str, seed: u64) -> SpaceScenario {
    let file = SpaceFile {
        aircraft: AircraftFile::known(aircraft),
        airspeed: Some(if aircraft == "x8" { 16.0 } else { 12.0 }),
        sphere,
        world: Some(world.to_owned()),
        density: Some(0.04),
        seed: Some(seed),
        ..SpaceFile::default()
    };
    file.build(None).unwrap()
}

fn among(from: &SpaceScenario, trunks: &[Trunk], extent: Extent) -> SpaceScenario {
    let mut scenario = from.clone();
    scenario.world = forest(trunks, extent).unwrap();
    scenario
}

/// A row of trunks across the world with one gap of a clear width about a side \[m\].
fn row(x: f64, side: f64, gap: f64) -> Vec<Trunk> {
    let radius = 0.3;
    let places = (0..80).flat_map(|number| {
        let off = 0.5 * gap + radius + 0.5 * f64::from(number);
        [side - off, side + off]
    });
    let trunk = |y| Trunk { at: [x, y], radius };
    places.map(trunk).collect()
}

const EXTENT: Extent = Extent {
    length: 50.0,
    ..Extent::USUAL
};

fn verdict(aircraft: &str, sphere: Option<f64>, trunks: &[Trunk]) -> Feasibility {
    let scenario = among(&scenario(aircraft, sphere, "forest", 1), trunks, EXTENT);
    decide_in_space(&scenario).unwrap()
}

#[test]
fn a_gap_is_blocked_below_the_body_and_passable_above() {
    let ball = Some(0.4);
    for (aircraft, sphere, narrow, wide) in [
        ("ultrastick", ball, 0.78, 1.0),
        // A proof counts the fuselage alone, 0.16 m.
        ("ultrastick", None, 0.1, 1.8),
        ("x8", None, 0.1, 2.8),
    ] {
        let Feasibility::Blocked(place) = verdict(aircraft, sphere, &row(30.0, 0.0, narrow)) else {
            panic!("{aircraft} in a gap of {narrow} m");
        };
        assert!((29.4..31.1).contains(&place), "{aircraft} {place}");
        let passes = verdict(aircraft, sphere, &row(30.0, 0.0, wide));
        assert_eq!(passes, Feasibility::Passable, "{aircraft}");
    }
}

/// The tightest turn of the envelope up to its greatest course, and a straight line from there, reach less far to the side.
#[test]
fn a_gap_is_blocked_where_the_tightest_turn_does_not_reach_it() {
    let envelope = SpaceEnvelope::of(12.0);
    let turn = (GRAVITY * libm::tan(envelope.bank) + envelope.uneven) / envelope.speed[0].powi(2);
    let sine = libm::sin(envelope.course);
    let arc = (1.0 - libm::cos(envelope.course)) / turn;
    let reached = arc + (8.0 - sine / turn) * libm::tan(envelope.course);
    assert!((10.0..20.0).contains(&reached), "{reached}");
    let ball = Some(0.4);
    let far = verdict("ultrastick", ball, &row(8.0, reached + 3.0, 4.0));
    assert!(matches!(far, Feasibility::Blocked(_)), "{far:?}");
    let near = verdict("ultrastick", ball, &row(25.0, 4.0, 4.0));
    assert_eq!(near, Feasibility::Passable);
}

#[test]
fn forests_have_witnesses_and_no_proof_against_them() {
    for (aircraft, world, seed) in [
        ("ultrastick", "forest", 3),
        ("ultrastick", "grid", 3),
        ("x8", "forest", 4),
    ] {
        let question = Question::new(&scenario(aircraft, None, world, seed)).unwrap();
        assert!(question.witness().is_ok(), "{aircraft} {world}");
        assert_eq!(question.blocked_at(30.0), None, "{aircraft} {world}");
    }
}

/// A gap aside can be reached from as far as the oracle sees it, and from no nearer place. With a long sight it flies as a witness.
#[test]
fn an_oracle_passes_what_it_sees_in_time() {
    let gap = among(
        &scenario("ultrastick", None, "forest", 1),
        &row(30.0, 6.0, 4.0),
        EXTENT,
    );
    let wood = scenario("ultrastick", None, "forest", 3);
    for (scenario, sight, verdict) in [
        (&gap, 29.0, Feasibility::Passable),
        (&gap, 9.0, Feasibility::Undecided),
        (&wood, 60.0, Feasibility::Passable),
        (&wood, 5.0, Feasibility::Undecided),
    ] {
        assert_eq!(fly_with_sight(scenario, sight), Ok(verdict), "{sight}");
    }
}

#[test]
fn what_cannot_be_judged_is_refused() {
    let spheres = SpaceFile {
        world: Some("spheres".to_owned()),
        ..SpaceFile::default()
    };
    let refused = decide_in_space(&spheres.build(None).unwrap());
    assert_eq!(refused, Err(CeilingError::NoTrunk));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, failure_persistence: None, ..ProptestConfig::default() })]

    /// A thicket from which everything is taken that a random flight of the envelope hits is not blocked as far as it goes.
    #[test]
    fn no_flight_passes_a_blocked_thicket(
        seed in 0_u64..1000,
        name in prop_oneof![Just(("ultrastick", None)), Just(("x8", None)), Just(("ultrastick", Some(0.4)))],
        banks in proptest::collection::vec(-1.0_f64..1.0, 5),
    ) {
        let (aircraft, sphere) = name;
        let mut scenario = scenario(aircraft, sphere, "forest", seed);
        let mut question = Question::new(&scenario).unwrap();
        let mut lateral = regulator(&scenario.plane).unwrap();
        let (hull, trim) = (scenario.hull(), question.model.trim.control);
        let mut states = vec![*question.start.aircraft.state()];
        let plane = &mut question.start.aircraft;
        'flight: for bank in banks {
            for _ in 0..(0.4 / TICK_PERIOD) as u32 {
                let before = *plane.state();
                let surfaces = lateral.step(&before.lateral_motion(), bank);
                let control = Control { thrust: 1.2 * trim.thrust, ..trim };
                plane.step(control, surfaces).unwrap();
                if !question.envelope.holds(&before, plane.state()) {
                    break 'flight;
                }
                states.push(*plane.state());
            }
        }
        let random = WorldConfig {
            density: 0.5,
            extent: EXTENT,
            ..WorldConfig::usual(WorldName::Forest, seed)
        };
        let all = trunks(&random.build().unwrap()).unwrap();
        let near = all.into_iter().filter(|trunk| trunk.at[0] < 45.0);
        let untouched: Vec<_> = near.filter(|trunk| {
            let alone = among(&scenario, &[*trunk], Extent::USUAL);
            states.windows(2).all(|pair| hull.first_contact(&alone.world, &pair[0], &pair[1]).is_none())
        }).collect();
        let end = states.last().map_or(0.0, |state| state.plane.x) - LAST;
        scenario = among(&scenario, &untouched, Extent::USUAL);
        let question = Question::new(&scenario).unwrap();
        prop_assert_eq!(question.blocked_at(end), None);
    }
}
