use super::points::distance;
use super::*;
use mpp_core::config::KNOTS;
use mpp_core::vehicle::Airframe;

const WAY: f64 = 54.0;
const LIMITS: ConfigureSpace = ConfigureSpace {
    bank: [1.0, 1.5],
    margin: 0.3,
    half_span: 0.6,
    heights: [0.6, 15.0],
    half_width: 30.0,
    programs: true,
    open: false,
};

fn model() -> SpaceModel {
    SpaceModel::new(&Airframe::REFERENCE, 12.0, 0.3, 20.0, LIMITS.bank).unwrap()
}

fn level() -> SpacePath {
    let trim = model().trim.state;
    SpacePath {
        position: [0.0, 0.0, 7.5],
        airspeed: trim.airspeed,
        angle_of_attack: trim.angle_of_attack(),
        ..SpacePath::default()
    }
}

/// Distance from a trunk 25 m ahead, thick enough for rays 45 deg apart.
fn to_trunk([x, y, _]: &Vector) -> f64 {
    libm::hypot(x - 25.0, *y) - 1.0
}

fn planned(clearance: &dyn Fn(&Vector) -> f64, paths: usize, seed: u64) -> Option<SpacePlan> {
    PaperMethod::new(paths, 7.5, &LIMITS, seed).plan_among(clearance, &model(), &level())
}

#[test]
fn an_empty_room_is_crossed_straight_and_level() {
    let plan = planned(&|_| 9.0, 1, 1).unwrap();
    for (stage, knot) in plan.knots.iter().enumerate() {
        let [x, y, z] = knot.position;
        assert!((x - 3.0 * stage as f64).abs() < 0.01, "{x}");
        assert!(y.abs() < 1e-6 && (z - 7.5).abs() < 0.01, "{y} {z}");
    }
    assert_eq!(planned(&|_| 9.0, 1, 1), Some(plan));
}

#[test]
fn a_trunk_is_passed_with_its_margin_and_within_the_limits() {
    let model = model();
    for seed in 1..6 {
        let plan = planned(&to_trunk, 5, seed).unwrap();
        for tenth in 0..45 {
            let (state, _) = plan.at(&model, 0.1 * f64::from(tenth));
            let left = to_trunk(&state.position);
            assert!(left > LIMITS.half_span, "{seed}: {left} {state:?}");
            assert!(state.bank.abs() < LIMITS.bank[0], "{seed}: {state:?}");
        }
    }
}

#[test]
fn nothing_is_planned_into_a_wall() {
    assert_eq!(planned(&|[x, ..]| 25.0 - x, 5, 1), None);
}

#[test]
fn alternatives_are_distinct_free_and_pass_on_both_sides() {
    let start = level().position;
    let room = Room::new(&to_trunk, &LIMITS, start, WAY);
    let goals = goals(&room, &start, WAY);
    assert_eq!(goals.len(), 9);
    let mut draws = generator(3, Stream::Trees);
    let trees = (0..40).map(|_| Tree::grow(&room, &start, &goals, &mut draws));
    let paths: Vec<_> = trees
        .flat_map(|tree| tree.paths().collect::<Vec<_>>())
        .collect();
    assert!(paths.len() > 25, "{}", paths.len());
    let mut sides = [false; 2];
    for (number, path) in paths.iter().enumerate() {
        assert!(!paths[..number].contains(path));
        assert!(distance(&path[0], &start) < 1e-9 && goals.contains(&path[path.len() - 1]));
        for leg in path.windows(2) {
            assert!(room.is_free(&leg[0], &leg[1], distance(&leg[0], &leg[1])));
        }
        let beside = collocation_points(path).map(|it| (it[0] - 25.0).abs());
        let nearest = (0..KNOTS).min_by(|a, b| beside[*a].total_cmp(&beside[*b]));
        let [_, y, _] = collocation_points(path)[nearest.unwrap()];
        sides[usize::from(y > 0.0)] = true;
    }
    assert_eq!(sides, [true; 2]);
}

#[test]
fn points_are_equally_spaced_along_a_path() {
    let path = [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [9.0, 9.0, 0.0]];
    for (stage, [x, y, _]) in collocation_points(&path).into_iter().enumerate() {
        assert!((x + y - stage as f64).abs() < 1e-9 && (x > 8.999 || y == 0.0));
    }
}

/// Rays that are not too far apart to find a trunk leave its axis outside, with the padding.
#[test]
fn rooms_hold_no_trunk() {
    let directions = room::directions();
    assert_eq!(directions.len(), 26);
    let room = Room::new(&to_trunk, &LIMITS, [0.0, 0.0, 7.5], WAY);
    let mut near = 0;
    for side in -8_i32..=8 {
        let y = 1.2 * f64::from(side.signum()) + 0.25 * f64::from(side);
        let points = core::array::from_fn(|stage| [15.0 + stage as f64, y, 7.5]);
        let corridor = room.corridor(&points);
        for boundary in 1..KNOTS {
            let holds = |[x, y, z]: Vector| {
                let mut faces = corridor.at(boundary);
                faces.all(|(normal, bound)| normal[0] * x + normal[1] * y + normal[2] * z <= bound)
            };
            let left = to_trunk(&points[boundary]);
            if left < 2.5 {
                near += 1;
                assert!(!holds([25.0, 0.0, 7.5]), "{boundary} {y}");
            }
            assert!(left < 3.0 || holds(points[boundary]), "{boundary} {y}");
        }
    }
    assert!(near > 20, "{near}");
}
