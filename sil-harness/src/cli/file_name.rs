//! What the files of a flight are called: two flights that differ in their scenario or in their orders never share one.

use mpp_sim::field::FieldFile;
use mpp_sim::generator::Generator;
use mpp_sim::orders::OrderEntry;
use mpp_sim::scenario::{Scenario, TICK_MS, TICKS_PER_SECOND};

/// Preset and seed, then whatever differs from that preset's flight: oracle, known map, scene, generator, `o` obstacles, `p` paths,
/// replanning rate, latency, slices per tick, duration, aircraft; what has no short name (lidar,
/// sensors, faults, fields, parameters of generators, numbers of another aircraft) as a number that stands for it,
/// and so the orders that took effect, parameters among them.
pub(super) fn file_name(scenario: &Scenario, orders: &[OrderEntry]) -> String {
    let mut usual = Scenario::new(scenario.preset, scenario.seed);
    let mut name = format!("{}-seed{}", scenario.preset, scenario.seed);
    if scenario.oracle {
        usual = usual.informed();
        name += "-oracle";
    }
    if scenario.known_map {
        usual.known_map = true;
        name += "-known-map";
    }
    if !scenario.generator.name.is_papers() {
        name += &format!("-{}", scenario.generator.name);
        usual.generator = Generator::named(scenario.generator.name);
    }
    if let Some(scene) = scenario.scene {
        name += &format!("-{scene}");
    }
    if scenario.scene.is_some() || !scenario.placed.is_empty() {
        usual.obstacles = 0;
    }
    let seconds = f64::from(scenario.ticks) / f64::from(TICKS_PER_SECOND);
    let latency = scenario.latency_ticks * TICK_MS;
    let mut part = |differs: bool, text: String| {
        if differs {
            name += &format!("-{text}");
        }
    };
    let Scenario {
        obstacles,
        paths,
        slices_per_tick: slices,
        ..
    } = scenario;
    part(*obstacles != usual.obstacles, format!("o{obstacles}"));
    part(*paths != usual.paths, format!("p{paths}"));
    let other_rate = scenario.replan_ticks != usual.replan_ticks;
    part(other_rate, format!("{}hz", scenario.replan_hz()));
    let late = scenario.latency_ticks != usual.latency_ticks;
    part(late, format!("{latency}ms"));
    part(*slices != usual.slices_per_tick, format!("{slices}slices"));
    part(scenario.ticks != usual.ticks, format!("{seconds}s"));
    let other_aircraft = scenario.aircraft != usual.aircraft;
    part(other_aircraft, scenario.aircraft.file.name.clone());
    let (mut rest, usual) = (rest(scenario), rest(&usual));
    if !orders.is_empty() {
        rest.extend(serde_json::to_vec(orders).unwrap_or_default());
    }
    if rest != usual {
        name += &format!("-{:08x}", fnv(&rest));
    }
    name
}

/// What has no short name.
fn rest(scenario: &Scenario) -> Vec<u8> {
    let Scenario {
        lidar,
        air_data,
        navigation,
        faults,
        placed,
        generator,
        body_radius,
        aircraft,
        world_scale,
        ..
    } = scenario;
    let field = (FieldFile::of(placed), generator, body_radius);
    let aircraft = (&aircraft.file, world_scale);
    serde_json::to_vec(&(lidar, air_data, navigation, faults, field, aircraft)).unwrap_or_default()
}

/// FNV-1a, 32 bits: the same on every machine.
fn fnv(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash, byte| {
        (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use mpp_sim::orders::Order;
    use mpp_sim::scenario::ScenarioFile;

    fn scenario(text: &str) -> Scenario {
        ScenarioFile::parse("", text).unwrap().build().unwrap()
    }

    fn name(text: &str) -> String {
        file_name(&scenario(text), &[])
    }

    #[test]
    fn what_differs_stands_in_the_name() {
        let rest = "obstacles = 40\npaths = 5\nreplan_hz = 2\nlatency_ms = 200\nslices_per_tick = 37\nduration = 9\naircraft = \"paper\"";
        for (text, expected) in [
            ("", "flight-seed1"),
            ("preset = \"paper\"\nseed = 7", "paper-seed7"),
            (
                "obstacles = 20\npaths = 25\nduration = 20\nlatency_ms = 10",
                "flight-seed1",
            ),
            ("scene = \"long-way\"", "flight-seed1-long-way"),
            (
                "scene = \"flytrap\"\nobstacles = 20",
                "flight-seed1-flytrap-o20",
            ),
            ("oracle = true", "flight-seed1-oracle"),
            ("known_map = true", "flight-seed1-known-map"),
            ("[generator]\nname = \"walls\"", "flight-seed1-walls"),
            ("replan_hz = 0.5", "flight-seed1-0.5hz"),
            (
                rest,
                "flight-seed1-o40-p5-2hz-200ms-37slices-9s-paper-da22ad41",
            ),
        ] {
            assert_eq!(name(text), expected, "{text}");
        }
    }

    #[test]
    fn a_flight_with_orders_does_not_take_the_place_of_one_without() {
        let paths = |value, tick| {
            let name = "MPP_PATHS".to_owned();
            let order = Order::Parameter { name, value };
            vec![OrderEntry { tick, order }]
        };
        let orders = [vec![], paths(5.0, 0), paths(9.0, 0), paths(5.0, 1)];
        let named = |orders: &Vec<OrderEntry>| file_name(&scenario(""), orders);
        let names: std::collections::BTreeSet<String> = orders.iter().map(named).collect();
        assert_eq!(names.len(), orders.len(), "{names:?}");
        assert!(
            names
                .iter()
                .all(|name| name == "flight-seed1" || name.len() == "flight-seed1-01234567".len()),
            "{names:?}"
        );
    }

    #[test]
    fn what_has_no_short_name_is_told_apart_too() {
        let gusts = |intensity| format!("[faults.gusts]\nintensity = {intensity}\n");
        let texts = [
            gusts("1.0"),
            gusts("2.0"),
            "[lidar]\nbeams = 31\n".to_owned(),
            "[air_data]\nairspeed_sigma = 0.1\n".to_owned(),
            "[navigation]\nsource = \"ideal\"\n".to_owned(),
            "[generator]\nradius = 0.5\n".to_owned(),
            "body_radius = 0.5\n".to_owned(),
            "[[field.circle]]\nx = 60.0\nz = 50.0\nradius = 2.0\n".to_owned(),
            "[[field.circle]]\nx = 61.0\nz = 50.0\nradius = 2.0\n".to_owned(),
        ];
        let names: std::collections::BTreeSet<String> = texts.iter().map(|t| name(t)).collect();
        assert_eq!(names.len(), texts.len(), "{names:?}");
        assert!(
            names
                .iter()
                .all(|name| name.len() == "flight-seed1-01234567".len()),
            "{names:?}"
        );
    }
}
