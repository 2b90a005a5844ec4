//! The planner in space: plans keep clear of what the map knows, keep the limits, and cost a bounded amount of work.

use mpp_core::config::STAGES;
use mpp_core::map::{SpaceBeam, VoxelGrid};
use mpp_core::planner::space::{Keep, MOST_SPACE_SLICES, SpacePlan, SpacePlanner};
use mpp_core::qp::space::{INPUTS, MAX_ITERATIONS};
use mpp_core::tuning::space_refinement::MOST_WORK;
use mpp_core::vehicle::{
    Airframe, GRAVITY, PathControl, PathState, SpaceControl, SpaceModel, SpacePath,
};
use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Radius of the body and distance that plans keep \[m\].
const BODY: f64 = 0.4;
const MARGIN: f64 = 0.75;

pub(crate) fn model() -> SpaceModel {
    SpaceModel::new(&Airframe::PAPER, 12.0, 0.45, 20.0, [0.96, 1.57]).unwrap()
}

pub(crate) const KEEP: Keep = Keep {
    margin: MARGIN,
    half_span: 0.0,
    heights: [0.9, 14.7],
    half_width: 29.5,
    altitude: 7.5,
};

pub(crate) fn level(model: &SpaceModel) -> SpacePath {
    SpacePath {
        position: [0.0, 0.0, 7.5],
        airspeed: 12.0,
        angle_of_attack: model.trim.state.angle_of_attack(),
        ..SpacePath::default()
    }
}

pub(crate) struct Draw(pub(crate) Pcg64Mcg);

impl Draw {
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The workspaces are larger than the stack of a test's thread.
pub(crate) fn with_planner(
    keep: Keep,
    run: impl FnOnce(&mut VoxelGrid, &mut SpacePlanner) + Send + 'static,
) {
    let body = move || {
        let mut map = Box::new(VoxelGrid::new());
        map.clear(0.0);
        let mut planner = Box::new(SpacePlanner::new());
        planner.set_up(model(), keep);
        run(&mut map, &mut planner);
    };
    let thread = std::thread::Builder::new().stack_size(16 << 20);
    thread.spawn(body).unwrap().join().unwrap();
}

/// Beams over 90 x 30 deg against a range for each direction.
pub(crate) fn sweep(range: impl Fn(&[f64; 3]) -> f64) -> Vec<SpaceBeam> {
    let mut beams = Vec::new();
    for ring in 0..32 {
        for column in 0..180 {
            let up = (f64::from(ring) / 31.0 - 0.5) * 0.52;
            let side = (f64::from(column) / 179.0 - 0.5) * 1.57;
            let (sin_up, cos_up) = libm::sincos(up);
            let (sin_side, cos_side) = libm::sincos(side);
            let direction = [cos_up * cos_side, cos_up * sin_side, sin_up];
            let range = Some(range(&direction)).filter(|range| *range < 45.0);
            beams.push(SpaceBeam { direction, range });
        }
    }
    beams
}

/// Range of a beam from the start to the nearest trunk `(x, y, radius)`.
pub(crate) fn to_trunks(trunks: &[[f64; 3]], direction: &[f64; 3]) -> f64 {
    let flat = libm::hypot(direction[0], direction[1]);
    let ranges = trunks.iter().map(|[x, y, radius]| {
        let along = (x * direction[0] + y * direction[1]) / flat;
        let off = (x * direction[1] - y * direction[0]) / flat;
        if along < 0.0 || off.abs() > *radius {
            return f64::INFINITY;
        }
        (along - libm::sqrt(radius * radius - off * off)) / flat
    });
    ranges.fold(f64::INFINITY, f64::min)
}

pub(crate) fn plan(
    planner: &mut SpacePlanner,
    map: &VoxelGrid,
    start: &SpacePath,
    shift: f64,
) -> (SpacePlan, usize) {
    planner.begin(start, shift);
    let slices = finish(planner, map);
    let (plan, _) = planner.best().unwrap();
    (*plan, slices)
}

/// Ends a cycle. Returns the number of its slices, which is bounded as that of the parts of each is: a step of the solver takes
/// up rows, settles them, and drops some.
pub(crate) fn finish(planner: &mut SpacePlanner, map: &VoxelGrid) -> usize {
    let (mut slices, mut parts) = (1, 1);
    while !planner.advance(map) {
        parts += 1;
        if planner.is_between_slices() {
            (slices, parts) = (slices + 1, 1);
        }
        assert!(slices <= MOST_SPACE_SLICES, "{slices}");
        assert!(parts <= MAX_ITERATIONS + 3 * INPUTS * STAGES, "{parts}");
    }
    slices
}

/// A map of 40 trunks ahead, seen from its start: their x, y and radius \[m\].
pub(crate) fn see_forest(map: &mut VoxelGrid, draw: &mut Draw) -> Vec<[f64; 3]> {
    map.clear(0.0);
    let trunks: Vec<[f64; 3]> = (0..40)
        .map(|_| {
            let radius = draw.between(0.15, 0.4);
            [draw.between(9.0, 45.0), draw.between(-20.0, 20.0), radius]
        })
        .collect();
    let beams = sweep(|direction| to_trunks(&trunks, direction));
    map.insert(&[0.0, 0.0, 7.5], beams.iter().copied(), 45.0);
    trunks
}

fn in_bounds(plan: &SpacePlan, model: &SpaceModel) {
    for knot in &plan.knots {
        let [low, high] = model.angle_of_attack;
        assert!(knot.bank.abs() <= model.bank + 1e-9, "{knot:?}");
        assert!(knot.angle_of_attack >= low - 0.03 - 1e-9);
        assert!(knot.angle_of_attack <= high + 0.03 + 1e-9);
    }
    for control in &plan.controls {
        assert!(control.bank_rate.abs() <= model.bank_rate + 1e-9);
        assert!((0.0..=model.thrust_max).contains(&control.thrust));
    }
}

#[test]
fn plans_in_forests_keep_clear_of_the_trunks_and_within_the_limits() {
    with_planner(KEEP, |map, planner| {
        let (mut draw, model) = (Draw(Pcg64Mcg::seed_from_u64(3)), model());
        let mut clear = 0;
        for _ in 0..12 {
            let trunks = see_forest(map, &mut draw);
            let (plan, _) = plan(planner, map, &level(&model), 0.0);
            in_bounds(&plan, &model);
            let mut least = f64::INFINITY;
            for step in 0..150 {
                let [x, y, _] = plan.at(&model, f64::from(step) * 0.02).0.position;
                for [tx, ty, radius] in &trunks {
                    least = least.min(libm::hypot(tx - x, ty - y) - radius);
                }
            }
            clear += usize::from(least > BODY);
        }
        // The first three seconds of at least ten of twelve plans are flown without a touch.
        assert!(clear >= 10, "{clear}");
    });
}

#[test]
fn a_plan_goes_through_the_only_window_of_a_wall() {
    with_planner(KEEP, |map, planner| {
        let model = model();
        // A wall at 25 m with a window of 6 x 5 m, 7 m to the right and 2 m above the aircraft.
        let beams = sweep(|direction| {
            let range = 25.0 / direction[0];
            let [y, z] = [range * direction[1] - 7.0, range * direction[2] - 2.0];
            if y.abs() < 3.0 && z.abs() < 2.5 {
                100.0
            } else {
                range
            }
        });
        map.insert(&[0.0, 0.0, 7.5], beams.iter().copied(), 45.0);
        let (plan, _) = plan(planner, map, &level(&model), 0.0);
        in_bounds(&plan, &model);
        let through = (0..225)
            .map(|step| plan.at(&model, f64::from(step) * 0.02).0.position)
            .find(|at| at[0] >= 25.0)
            .unwrap();
        assert!((through[1] - 7.0).abs() < 3.0 - BODY, "{through:?}");
        assert!((through[2] - 9.5).abs() < 2.5 - BODY, "{through:?}");
    });
}

#[test]
fn a_wing_banks_or_goes_around_where_a_sphere_passes() {
    // Two trunks leave a gap of 2.4 m: enough for a sphere of 0.4 m, not for a level wing of 2 m.
    let trunks = [[20.0, -1.5, 0.3], [20.0, 1.5, 0.3]];
    let beams = sweep(move |direction| to_trunks(&trunks, direction));
    for half_span in [0.0, 1.0] {
        let beams = beams.clone();
        let keep = Keep {
            half_span,
            margin: if half_span > 0.0 { 0.35 } else { MARGIN },
            ..KEEP
        };
        with_planner(keep, move |map, planner| {
            let model = model();
            map.insert(&[0.0, 0.0, 7.5], beams.iter().copied(), 45.0);
            let (plan, _) = plan(planner, map, &level(&model), 0.0);
            let mut least = f64::INFINITY;
            for step in 0..150 {
                let at = plan.at(&model, f64::from(step) * 0.02).0;
                let wing = at.wing();
                for share in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                    let [x, y, _]: [f64; 3] = core::array::from_fn(|axis| {
                        at.position[axis] + share * half_span * wing[axis]
                    });
                    for [tx, ty, radius] in &trunks {
                        least = least.min(libm::hypot(tx - x, ty - y) - radius);
                    }
                }
            }
            assert!(
                least > if half_span > 0.0 { 0.0 } else { BODY },
                "{half_span}: {least}"
            );
        });
    }
}

/// The slices after the programs never make the plan dearer, and where it lacks room they make it cheaper by a fifth.
#[test]
fn the_refinement_makes_plans_cheaper_within_the_limits() {
    with_planner(KEEP, |map, planner| {
        let (mut draw, model) = (Draw(Pcg64Mcg::seed_from_u64(4)), model());
        let mut cheaper = 0;
        for _ in 0..10 {
            map.clear(0.0);
            let trunks: Vec<[f64; 3]> = (0..50)
                .map(|_| [draw.between(9.0, 45.0), draw.between(-20.0, 20.0), 0.3])
                .collect();
            let beams = sweep(|direction| to_trunks(&trunks, direction));
            map.insert(&[0.0, 0.0, 7.5], beams.iter().copied(), 45.0);
            planner.choose(1, false);
            planner.begin(&level(&model), 0.0);
            let mut prices = Vec::new();
            while !planner.advance(map) {
                prices.extend(planner.best().map(|(_, judgement)| judgement.price));
            }
            let (plan, judgement) = planner.best().unwrap();
            in_bounds(plan, &model);
            assert!(prices.iter().all(|price| *price >= judgement.price));
            // A plan with room has nothing to gain.
            if prices[0] > 5.0 {
                assert!(judgement.price < 0.8 * prices[0], "{}", prices[0]);
                cheaper += 1;
            }
        }
        assert!(cheaper >= 3, "{cheaper}");
    });
}

/// A plan that begins by leading back is moved for long before a move is found dear; the bound ends that.
#[test]
fn moves_of_plans_that_lead_back_end_at_the_bound() {
    with_planner(KEEP, |map, planner| {
        let (mut draw, model) = (Draw(Pcg64Mcg::seed_from_u64(6)), model());
        let mut ended = 0;
        for round in 0..12 {
            let _ = see_forest(map, &mut draw);
            let start = SpacePath {
                course: 1.5 + 0.14 * f64::from(round),
                ..level(&model)
            };
            let _ = plan(planner, map, &start, 0.0);
            // The last move, judged twice.
            let work = planner.work();
            assert!(work < MOST_WORK + 6 * STAGES, "{work}");
            ended += usize::from(work >= MOST_WORK);
        }
        assert!(ended > 0);
    });
}

/// Scans and starts that make no sense cost no more slices, and nothing panics.
#[test]
fn hostile_scans_and_starts_end_within_the_bound() {
    with_planner(KEEP, |map, planner| {
        let mut draw = Draw(Pcg64Mcg::seed_from_u64(9));
        for round in 0..25 {
            let beams: Vec<SpaceBeam> = (0..400)
                .map(|_| SpaceBeam {
                    direction: [(); 3].map(|()| draw.between(-1.0, 1.0)),
                    range: Some(draw.between(0.0, 60.0)).filter(|range| *range < 50.0),
                })
                .collect();
            let odd = match round % 5 {
                0 => f64::NAN,
                1 => f64::INFINITY,
                2 => 1e300,
                _ => draw.between(-60.0, 60.0),
            };
            let mut numbers = level(planner.model()).numbers();
            numbers[round % 8] = odd;
            let start = SpacePath::of(numbers);
            map.insert(&start.position, beams.iter().copied(), 45.0);
            planner.begin(&start, odd);
            finish(planner, map);
        }
    });
}

#[test]
fn the_same_scan_gives_the_same_bits() {
    with_planner(KEEP, |map, planner| {
        let trunks = [[18.0, 1.0, 0.3], [25.0, -4.0, 0.2], [24.0, 5.0, 0.4]];
        let beams = sweep(|direction| to_trunks(&trunks, direction));
        let start = level(planner.model());
        map.insert(&start.position, beams.iter().copied(), 45.0);
        let (first, slices) = plan(planner, map, &start, 0.0);
        planner.set_up(model(), KEEP);
        assert_eq!(plan(planner, map, &start, 0.0), (first, slices));
    });
}

#[test]
fn without_bank_the_point_mass_is_that_of_the_plane() {
    let (model, mut draw) = (model(), Draw(Pcg64Mcg::seed_from_u64(1)));
    for _ in 0..1000 {
        let [v, path, alpha] = [
            draw.between(8.0, 20.0),
            draw.between(-0.5, 0.5),
            draw.between(-0.1, 0.3),
        ];
        let (rate, thrust) = (draw.between(-1.0, 1.0), draw.between(0.0, 20.0));
        let plane = PathState {
            x: 1.0,
            z: 2.0,
            airspeed: v,
            flight_path: path,
            angle_of_attack: alpha,
        };
        let control = PathControl {
            angle_of_attack_rate: rate,
            thrust,
        };
        let wanted = plane.after(&model.airframe, &control, 0.25, 1);
        let space = SpacePath {
            position: [1.0, 0.0, 2.0],
            airspeed: v,
            angle_of_attack: alpha,
            flight_path: path,
            ..SpacePath::default()
        };
        let control = SpaceControl {
            angle_of_attack_rate: rate,
            thrust,
            bank_rate: 0.0,
        };
        let found = space.after(&model, &control, 0.25);
        assert_eq!(found.position[1].to_bits(), 0.0_f64.to_bits());
        for (a, b) in [
            (found.position[0], wanted.x),
            (found.position[2], wanted.z),
            (found.airspeed, wanted.airspeed),
            (found.flight_path, wanted.flight_path),
        ] {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }
}

#[test]
fn a_level_turn_has_the_radius_of_the_formula() {
    let model = model();
    for bank in [0.4, 0.6, -0.8] {
        let mut state = level(&model);
        state.bank = bank;
        let mut course = 0.0;
        for _ in 0..400 {
            let pull = GRAVITY / libm::cos(bank);
            state.angle_of_attack = model.angle_for(state.airspeed, pull);
            let thrust = model.thrust_for(state.airspeed, state.angle_of_attack, 0.0);
            let control = SpaceControl {
                thrust,
                ..SpaceControl::default()
            };
            // The angle of attack is that of the thrust of level flight: the path is held by hand.
            state.flight_path = 0.0;
            course = state.course;
            state = state.after(&model, &control, 0.01);
        }
        let rate = (state.course - course) / 0.01;
        let wanted = GRAVITY * libm::tan(bank) / state.airspeed;
        assert!((rate / wanted - 1.0).abs() < 0.02, "{rate} {wanted}");
    }
}
