//! Generated programs. They have random obstacle fields, the tree's paths through them, the
//! corridors around these paths, and random motions at the start.

use chacha20::ChaCha8Rng;
use mpp_core::corridor::Corridor;
use mpp_core::paper::config::{GRID_ROWS, TREE_SAMPLES};
use mpp_core::paper::{
    Extension, GridPoint, OccupancyGrid, PaperSettings, Path, Search, StageModel, resample,
};
use mpp_core::qp::{Bounds, Condensed, Penalty, Problem, StageState, Weights};
use mpp_core::settings::{AttitudeLimits, Settings};
use mpp_core::vehicle::{AirState, Trim};
use rand_core::{Rng, SeedableRng};

/// Number of paths that are taken from one tree.
const PATHS_OF_A_TREE: usize = 3;

/// A model, and the data for programs about it.
pub(crate) struct Preset {
    pub(crate) own: PaperSettings,
    pub(crate) weights: Weights,
    /// Limits that attitude rows keep, if there are any.
    pub(crate) attitude: Option<AttitudeLimits>,
    pub(crate) trim: Trim,
    pub(crate) model: StageModel,
    pub(crate) shared: Box<Condensed>,
}

/// One program in the paper's notation, from which both solvers' inputs are made.
#[derive(Clone)]
pub(crate) struct Instance {
    pub(crate) initial: StageState,
    pub(crate) target: StageState,
    pub(crate) corridor: Corridor,
    /// Upper limits, then lower limits, of `(angle of attack, flight path)` as deviations from trim.
    pub(crate) attitude: Option<([f64; 2], [f64; 2])>,
    pub(crate) thrust_rise: f64,
    pub(crate) thrust_reserve: f64,
    pub(crate) hard_angle_of_attack: [bool; 2],
}

impl Preset {
    fn new(settings: &Settings, weights: Weights, attitude: Option<AttitudeLimits>) -> Self {
        let own = *settings.planner.paper().unwrap();
        let trim = settings.cruise.trim(&settings.airframe).unwrap();
        let model = StageModel::new(&settings.airframe, &trim, own.jacobian, own.initial).unwrap();
        let mut shared = Box::new(Condensed::new());
        shared.condense(&model.dynamics(), &weights).unwrap();
        Self {
            own,
            weights,
            attitude,
            trim,
            model,
            shared,
        }
    }

    /// The presets of the paper's method, and the corrected preset with the weights and the
    /// attitude rows of the flight planner.
    pub(crate) fn all() -> [Self; 3] {
        let (reference, paper) = (Settings::reference(), Settings::paper());
        let flight = Settings::flight().planner;
        let attitude = flight.plane().map(|own| own.attitude);
        [
            Self::new(&reference, reference.planner.weights, None),
            Self::new(&paper, paper.planner.weights, None),
            Self::new(&paper, flight.weights, attitude),
        ]
    }
}

impl Instance {
    /// The same program with every row moved outwards [m, rad, N].
    pub(crate) fn relaxed(&self, by: f64) -> Self {
        let mut relaxed = self.clone();
        relaxed
            .corridor
            .bounds
            .iter_mut()
            .flatten()
            .for_each(|bound| *bound += by);
        relaxed.thrust_rise += by;
        relaxed.thrust_reserve += by;
        if let Some((upper, lower)) = &mut relaxed.attitude {
            upper.iter_mut().for_each(|limit| *limit += by);
            lower.iter_mut().for_each(|limit| *limit -= by);
        }
        relaxed
    }

    /// The program in the form that the crate takes.
    pub(crate) fn problem(&self, penalty: Option<Penalty>) -> Problem {
        let mut bounds = Bounds::none();
        bounds.set_corridor(&self.corridor);
        bounds.set_thrust([self.thrust_rise, self.thrust_reserve]);
        if let Some((upper, lower)) = self.attitude {
            bounds.set_attitude(upper, lower);
        }
        Problem {
            initial: self.initial,
            target: self.target,
            bounds,
            penalty,
            hard_angle_of_attack: self.hard_angle_of_attack,
            ..Problem::EMPTY
        }
    }
}

/// Seeded random numbers.
pub(crate) struct Draw(ChaCha8Rng);

impl Draw {
    pub(crate) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// A uniform random number in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        f64::from(self.0.next_u32()) / (f64::from(u32::MAX) + 1.0)
    }

    /// A uniform random number between two numbers.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// A padded grid with discs as the lidar might see them, the nearest 3 m ahead.
fn field(draw: &mut Draw) -> OccupancyGrid {
    let mut grid = OccupancyGrid::new();
    let discs = draw.between(3.0, 40.0) as usize;
    for _ in 0..discs {
        let radius = draw.between(0.3, 1.5);
        let centre = GridPoint {
            row: draw.between(22.0, 52.0),
            col: draw.between(28.0 + radius, 85.0),
        };
        mark_disc(&mut grid, centre, radius);
    }
    grid.pad();
    grid
}

fn mark_disc(grid: &mut OccupancyGrid, centre: GridPoint, radius: f64) {
    for row in 0..GRID_ROWS as i32 {
        for col in 25..90 {
            let cell = GridPoint {
                row: f64::from(row) + 0.5,
                col: f64::from(col) + 0.5,
            };
            if centre.distance(&cell) <= radius.max(0.71) {
                grid.mark(row, col);
            }
        }
    }
}

/// A random motion about trim, as it occurs in flight.
fn motion(draw: &mut Draw, trim: &Trim) -> AirState {
    AirState {
        airspeed: trim.state.airspeed + draw.between(-1.5, 1.5),
        pitch: trim.state.pitch + draw.between(-0.25, 0.25),
        pitch_rate: draw.between(-0.5, 0.5),
        flight_path: trim.state.flight_path + draw.between(-0.25, 0.25),
    }
}

/// The next few programs. They come from one random field and one tree.
pub(crate) fn next_instances(draw: &mut Draw, preset: &Preset) -> Vec<Instance> {
    let own = &preset.own;
    let grid = field(draw);
    let estimate = motion(draw, &preset.trim);
    let height_missing = draw.between(-8.0, 8.0);
    // The limits go down to 40 % of the preset's limits, so that many programs meet them.
    let strictness = draw.between(0.4, 1.0);
    let mut search = Search::new();
    search.restart(own.rules);
    for _ in 0..=TREE_SAMPLES {
        if search.extend(&grid, || draw.unit()) == Extension::Complete {
            break;
        }
    }
    let mut instances = Vec::new();
    let mut path = Path::new();
    let mut next = 0;
    while let Some(after) = search.next_path(next, &mut path)
        && instances.len() < PATHS_OF_A_TREE
    {
        next = after;
        let points = resample(&path, own.rules);
        let mut corridor = Corridor::new();
        let cruise = preset.trim.state.airspeed;
        corridor.trace(&grid, &points, cruise, &own.padding, own.rules);
        instances.push(Instance {
            initial: preset.model.initial_state(&preset.trim, &estimate),
            target: [0.0, height_missing, 0.0, 0.0, 0.0, 0.0],
            corridor,
            attitude: preset.attitude.map(|limits| {
                let level = preset.trim.state.flight_path;
                let angle_of_attack = strictness * limits.angle_of_attack;
                let flight_path = strictness * limits.flight_path;
                (
                    [angle_of_attack, flight_path - level],
                    [-angle_of_attack, -flight_path - level],
                )
            }),
            thrust_rise: preset.attitude.map_or(f64::INFINITY, |_| {
                2.0 * strictness * preset.trim.control.thrust
            }),
            thrust_reserve: preset.trim.control.thrust,
            // The share of these programs is chosen so that rows of both kinds bind.
            hard_angle_of_attack: [strictness < 0.8, strictness < 0.6],
        });
    }
    instances
}
