//! What the gate lets through when all goes wrong: `cargo run --release -p mpp-c --example gate -- flips 100000`, or
//! `-- scans 1500`.
//!
//! `flips` turns a random bit of a planner over in the middle of a cycle, and counts what is offered then and strikes a cell
//! that a planner without the flip knows as occupied. A flip may trap or hang, as on a flight computer; so each flip runs in a
//! process that may die. `scans` plans on adversarial scans from states beyond flight.
#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    unsafe_code,
    reason = "a command, which turns over bits of a value; its sines need not be those of another machine"
)]

use mpp_core::map::RollingGrid;
use mpp_core::planner::{Planner, Verdict};
use mpp_core::sense::LidarScan;
use mpp_core::settings::Settings;
use mpp_core::trajectory::Trajectory;
use mpp_core::tuning::gate::REACTION;
use mpp_core::tuning::grid::OCCUPIED;
use mpp_core::vehicle::{AirState, Conditions, VehicleState, Wind};
use std::process::{Command, Stdio};

/// Numbers from a seed (splitmix64).
struct Draw(u64);

impl Draw {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ mixed >> 31
    }

    fn between(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn main() {
    let mut words = std::env::args().skip(1);
    let what = words.next().unwrap_or_default();
    let mut number = || words.next().and_then(|word| word.parse().ok());
    match (what.as_str(), number(), number()) {
        ("flips", Some(count), None) => flips(count),
        ("one-by-one", Some(from), Some(to)) => (from..to).for_each(one_flip),
        ("scans", Some(count), None) => scans(count),
        _ => println!("usage: gate flips COUNT | gate scans COUNT"),
    }
}

/// A scan of 100 beams over 100 degrees past discs `(x, z, radius)` \[m\].
fn scan(discs: &[[f64; 3]], state: &VehicleState) -> LidarScan {
    let mut scan = LidarScan::new();
    (scan.angle_min, scan.angle_increment) = (-0.8727, 0.017_453);
    for beam in 0..100 {
        let (up, ahead) = (state.air.pitch + scan.beam_angle(beam)).sin_cos();
        let ranges = discs.iter().filter_map(|[x, z, radius]| {
            let (off_x, off_z) = (x - state.x, z - state.z);
            let (along, across) = (off_x * ahead + off_z * up, off_z * ahead - off_x * up);
            let left = radius * radius - across * across;
            (left > 0.0)
                .then(|| along - left.sqrt())
                .filter(|range| *range > 0.1)
        });
        let nearest = ranges.fold(f64::INFINITY, f64::min);
        let range = if nearest < 45.0 { nearest as f32 } else { 0.0 };
        scan.ranges.push(range).unwrap();
    }
    scan
}

/// Whether a trajectory lies in an occupied cell after the reaction time.
fn strikes(map: &RollingGrid, plan: &Trajectory) -> bool {
    let steps = (0..900).map(|step| 0.005 * f64::from(step));
    let avoidable = steps.filter(|after| *after > REACTION + 0.125);
    avoidable.into_iter().any(|after| {
        plan.sample(plan.start + after)
            .is_some_and(|at| map.log_odds((at.state.x, at.state.z)) >= OCCUPIED)
    })
}

fn planner() -> Box<Planner> {
    let mut planner = Box::new(Planner::new());
    planner.set_up(&Settings::flight()).unwrap();
    planner
}

/// A field and a planner that has planned a cycle in it. It stands at the beginning of the next one.
fn begun(draw: &mut Draw) -> Box<Planner> {
    let mut planner = planner();
    let discs: Vec<[f64; 3]> = (0..14)
        .map(|_| [draw.between(112.0, 150.0), draw.between(38.0, 62.0), 1.0])
        .collect();
    let state = VehicleState {
        x: 100.0,
        z: 50.0,
        air: planner.trim().state,
    };
    planner.begin(0.0, &state, &Conditions::STILL, &scan(&discs, &state));
    while planner.advance() {}
    planner.finish();
    let next = planner.best().sample(0.25).map_or(state, |at| at.state);
    planner.begin(0.25, &next, &Conditions::STILL, &scan(&discs, &next));
    planner
}

/// What a planner offers, and whether a bit of it is another one than the gate saw.
fn offered(mut planner: Box<Planner>) -> (Verdict, Box<Planner>) {
    for _ in 0..5000 {
        if !planner.advance() {
            break;
        }
    }
    let verdict = planner.finish();
    (verdict, planner)
}

fn is_checked(verdict: Verdict) -> bool {
    !matches!(verdict, Verdict::Latest | Verdict::Nothing)
}

/// Turns one bit over, and prints what came of it.
fn one_flip(number: u64) {
    let mut draw = Draw(number / 20);
    let clean = begun(&mut draw);
    let (_, whole) = offered(clean.clone());
    let slices = whole.summary().slices as u64;
    let mut draw = Draw(!number);
    let mut flipped = clean;
    for _ in 0..draw.bits() % slices.max(1) {
        flipped.advance();
    }
    let bytes = size_of::<Planner>() as u64;
    let (byte, bit) = (draw.bits() % bytes, draw.bits() % 8);
    let start = core::ptr::from_mut::<Planner>(&mut flipped).cast::<u8>();
    // SAFETY: the byte lies within the planner, which nothing else reads now. The value may be none of its type any
    // more: that is what is tried, in a process of its own.
    unsafe { *start.add(byte as usize) ^= 1 << bit };
    let (verdict, planner) = offered(flipped);
    let best = planner.best();
    let sealed = planner.seal() == best.seal();
    let map = whole.plane().unwrap().map();
    let came = match (sealed, is_checked(verdict)) {
        (false, _) => "altered",
        (_, false) => "refused",
        _ if best.sample(0.25).is_none() => "empty",
        // The flip has made the map forget the cell, or the gate is wrong.
        _ if strikes(map, best) && strikes(planner.plane().unwrap().map(), best) => "strikes",
        _ if strikes(map, best) => "forgotten",
        _ if best == whole.best() => "same",
        _ => "other",
    };
    println!("{number} {came}");
}

/// Runs flips in processes that may die, and adds up what came of them.
fn flips(count: u64) {
    let mut sums: Vec<(String, u64)> = Vec::new();
    let mut add = |came: &str| match sums.iter_mut().find(|(name, _)| name == came) {
        Some((_, sum)) => *sum += 1,
        None => sums.push((came.to_owned(), 1)),
    };
    let mut next = 0;
    while next < count {
        let to = count.min(next + 2000).to_string();
        let mut child = Command::new(std::env::current_exe().unwrap());
        let child = child.args(["one-by-one", &next.to_string(), &to]);
        let output = child.stderr(Stdio::null()).output().unwrap();
        for line in String::from_utf8_lossy(&output.stdout).lines() {
            let (number, came) = line.split_once(' ').unwrap();
            next = number.parse::<u64>().unwrap() + 1;
            if came == "strikes" || came == "forgotten" {
                println!("{line}");
            }
            add(came);
        }
        if !output.status.success() {
            add("trapped");
            next += 1;
        }
    }
    println!("{count} flips: {sums:?}");
}

/// Plans on scans that no field gives, from states beyond flight.
fn scans(count: u64) {
    let mut sums = [0_u32; 7];
    let mut failed = 0;
    for number in 0..count {
        let mut draw = Draw(number);
        let mut planner = planner();
        let (mut time, mut x) = (0.0, 100.0);
        for cycle in 0..6_u32 {
            let state = VehicleState {
                x,
                z: 50.0 + draw.between(-8.0, 8.0),
                air: AirState {
                    airspeed: draw.between(9.0, 16.0),
                    pitch: draw.between(-0.3, 0.6),
                    pitch_rate: draw.between(-0.5, 0.5),
                    flight_path: draw.between(-0.35, 0.35),
                },
            };
            let conditions = Conditions {
                wind: Wind {
                    x: draw.between(-4.0, 4.0),
                    z: draw.between(-2.0, 2.0),
                },
                lift: draw.between(-0.1, 0.1),
            };
            let mut scan = scan(&[], &state);
            let (kind, near) = (number % 6, draw.between(2.0, 20.0));
            for (beam, range) in scan.ranges.iter_mut().enumerate() {
                *range = match kind {
                    0 => near as f32,
                    1 => [near as f32, 0.0][beam / 4 % 2],
                    2 => [near as f32, 3.0 * near as f32][beam % 2],
                    3 => (4.0 / (f64::from(beam as u32) / 50.0 - 1.0).abs().max(0.1)) as f32,
                    4 => draw.between(1.0, 44.0) as f32,
                    _ => {
                        if (44..56).contains(&beam) {
                            0.0
                        } else {
                            near as f32
                        }
                    }
                };
            }
            planner.begin(time, &state, &conditions, &scan);
            while planner.advance() {}
            let verdict = planner.finish();
            let place = [
                Verdict::Feasible,
                Verdict::LeastViolating,
                Verdict::Kept,
                Verdict::Pursuit,
                Verdict::Reserve,
                Verdict::Latest,
                Verdict::Nothing,
            ];
            let place = place.iter().position(|it| *it == verdict).unwrap();
            sums[place] += 1;
            let map = planner.plane().unwrap().map();
            failed += u32::from(
                is_checked(verdict) && verdict != Verdict::Kept && strikes(map, planner.best()),
            );
            time += 0.25;
            x += 3.0 * f64::from(cycle % 2);
        }
    }
    let [feasible, least, kept, pursuit, reserve, latest, nothing] = sums;
    println!(
        "{} cycles: feasible {feasible}, least violating {least}, kept {kept}, pursuit {pursuit}, reserve {reserve}, \
         nothing passes {latest}, nothing {nothing}; let through and strikes: {failed}",
        6 * count
    );
}
