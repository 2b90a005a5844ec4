//! Times 20,000 rays of 40 m and 20,000 wings among 2,000 trunks, and over hills: `cargo run --release -p mpp-sim --example rays`.
#![expect(clippy::disallowed_types, reason = "it measures time")]

use mpp_sim::random::{Stream, generator, uniform};
use mpp_sim::space::world::{Vector, World, WorldConfig, WorldError, WorldName};
use std::time::{Duration, Instant};

fn main() -> Result<(), WorldError> {
    let config = WorldConfig {
        density: 0.0825,
        ..WorldConfig::usual(WorldName::Forest, 1)
    };
    time(&config.build()?);
    time(&WorldConfig::usual(WorldName::Hills, 1).build()?);
    Ok(())
}

fn time(world: &World) {
    let mut draws = generator(9, Stream::Bodies);
    let rays: Vec<(Vector, Vector)> = (0..20_000)
        .map(|_| {
            let from = [200.0 * uniform(&mut draws), 0.0, 7.5];
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * uniform(&mut draws));
            (from, [cos, sin, 0.0])
        })
        .collect();
    let sight = least(|| {
        let ranges = rays
            .iter()
            .filter_map(|(from, along)| world.ray(*from, *along, 40.0));
        ranges.sum()
    });
    let wings = least(|| {
        let wing = |(at, along): &(Vector, Vector)| {
            let end = core::array::from_fn(|axis| at[axis] + 1.5 * along[axis]);
            world.clearance_of_segment(*at, end, 6.0)
        };
        rays.iter().map(wing).sum()
    });
    let trunks = world.bodies().len();
    println!("{trunks} trunks: 20,000 rays {sight:?}, 20,000 wings {wings:?}");
}

/// Shortest of 50 runs.
fn least(work: impl Fn() -> f64) -> Duration {
    let timed = (0..50).map(|_| {
        let start = Instant::now();
        std::hint::black_box(work());
        start.elapsed()
    });
    timed.min().unwrap_or_default()
}
