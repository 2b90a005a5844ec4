//! Trunks in plan view, and what an aircraft covers there.

use crate::ceiling::CeilingError;
use mpp_core::vehicle::GRAVITY;
use mpp_sim::space::Hull;
use mpp_sim::space::world::{Body, Extent, World, WorldError};

/// Side of a cell of the lists of near trunks \[m\].
const CELL: f64 = 1.0;
/// Greatest distance from trunks that anything asks for \[m\].
const ROOM: f64 = 1.0;
/// Room behind the start and beyond the extent that the cells cover \[m\].
const BESIDE: f64 = 10.0;

/// An endless trunk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Trunk {
    /// Axis: ahead, to the right \[m\].
    pub(super) at: [f64; 2],
    /// \[m\]
    pub(super) radius: f64,
}

/// Place and attitude in plan view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Place {
    /// Ahead, to the right \[m\].
    pub(super) at: [f64; 2],
    /// \[rad\]
    pub(super) course: f64,
    /// \[rad\]
    pub(super) bank: f64,
}

impl Place {
    /// The place after `dt` \[s\] of a level turn whose bank changes at a rate [rad/s], at an airspeed [m/s].
    pub(super) fn after(&self, rate: f64, airspeed: f64, dt: f64) -> Self {
        let turn = GRAVITY * libm::tan(self.bank + 0.5 * rate * dt) / airspeed * dt;
        let (sin, cos) = libm::sincos(self.course + 0.5 * turn);
        let way = airspeed * dt;
        Self {
            at: [self.at[0] + way * cos, self.at[1] + way * sin],
            course: self.course + turn,
            bank: self.bank + rate * dt,
        }
    }
}

/// The trunks of a world, which nothing flies over.
///
/// # Errors
/// [`CeilingError::NoTrunk`] for another body or a trunk with a top.
pub(super) fn trunks(world: &World) -> Result<Vec<Trunk>, CeilingError> {
    let trunk = |body: &Body| match *body {
        Body::Cylinder {
            x,
            y,
            radius,
            height,
        } if height.is_infinite() => Ok(Trunk { at: [x, y], radius }),
        _ => Err(CeilingError::NoTrunk),
    };
    world.bodies().iter().map(trunk).collect()
}

/// The world of these trunks.
pub(super) fn forest(trunks: &[Trunk], extent: Extent) -> Result<World, WorldError> {
    let body = |trunk: &Trunk| Body::Cylinder {
        x: trunk.at[0],
        y: trunk.at[1],
        radius: trunk.radius,
        height: f64::INFINITY,
    };
    World::new(trunks.iter().map(body).collect(), extent)
}

/// Trunks by the cells that they are near to.
pub(super) struct Woods {
    cells: Vec<Vec<Trunk>>,
    first: [f64; 2],
    count: [usize; 2],
    hull: Hull,
}

impl Woods {
    /// For a hull, so that each cell has the trunks that it may come near to from there.
    pub(super) fn new(trunks: &[Trunk], extent: &Extent, hull: &Hull) -> Self {
        let reach = hull.half_span.max(hull.half_length + hull.radius) + ROOM;
        let first = [-BESIDE, -extent.half_width - BESIDE];
        let size = [extent.length + 2.0 * BESIDE, -2.0 * first[1]];
        let count = size.map(|size| (size / CELL) as usize + 1);
        let mut cells = vec![Vec::new(); count[0] * count[1]];
        for trunk in trunks {
            let far = reach + trunk.radius;
            let range = |axis: usize| {
                let edge = |by: f64| (trunk.at[axis] + by - first[axis]) / CELL;
                let end = (edge(far) + 1.0).max(0.0) as usize;
                edge(-far).max(0.0) as usize..end.min(count[axis])
            };
            for column in range(0) {
                for row in range(1) {
                    cells[column * count[1] + row].push(*trunk);
                }
            }
        }
        Self {
            cells,
            first,
            count,
            hull: *hull,
        }
    }

    fn near(&self, at: [f64; 2]) -> &[Trunk] {
        let cell = [0, 1].map(|axis| (at[axis] - self.first[axis]) / CELL);
        let inside = [0, 1].map(|axis| cell[axis] >= 0.0 && cell[axis] < self.count[axis] as f64);
        if inside != [true; 2] {
            return &[];
        }
        &self.cells[cell[0] as usize * self.count[1] + cell[1] as usize]
    }

    /// Distance of the hull from the nearest trunk \[m\], at most `most`, while it flies `half` \[m\] from before a place until
    /// behind it; less than it is, and negative inside.
    pub(super) fn gap(&self, place: &Place, half: f64, most: f64) -> f64 {
        let (sin, cos) = libm::sincos(place.course);
        let hull = &self.hull;
        let span = hull.half_span * libm::cos(place.bank);
        let length = hull.half_length + half;
        self.near(place.at).iter().fold(most, |least, trunk| {
            let [x, y] = [0, 1].map(|axis| trunk.at[axis] - place.at[axis]);
            let (ahead, aside) = ((cos * x + sin * y).abs(), (cos * y - sin * x).abs());
            let from = |length: f64, width: f64| {
                libm::hypot((ahead - length).max(0.0), (aside - width).max(0.0))
            };
            let wing = from(half, span);
            let body = from(length, 0.0) - hull.radius;
            least.min(wing.min(body) - trunk.radius)
        })
    }
}
