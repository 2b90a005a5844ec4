//! Tests scenario files: their keys and the errors.

use super::*;

fn parse(text: &str) -> Result<Scenario, ScenarioError> {
    ScenarioFile::parse("test.toml", text)?.build()
}

fn refused(text: &str) -> String {
    parse(text).unwrap_err().to_string()
}

#[test]
fn an_empty_file_is_the_default_flight() {
    assert_eq!(parse("").unwrap(), Scenario::new(Preset::Flight, 1));
    let reference = parse("preset = \"reference\"\nseed = 7").unwrap();
    assert_eq!(reference, Scenario::new(Preset::Reference, 7));
}

#[test]
fn the_documented_example_holds_every_key() {
    let text = include_str!("../../../../docs/scenarios/example.toml");
    let file = ScenarioFile::parse("example.toml", text).unwrap();
    let scenario = file.build().unwrap();
    assert_eq!(scenario.obstacles, 40);
    assert_eq!(scenario.replan_ticks, 25);
    assert_eq!(scenario.placed.len(), 1);
    assert!((scenario.lidar.field_of_view - 100_f64.to_radians()).abs() < 1e-15);
    // The example leaves no key to its default, so a key that is added later must be documented
    // too.
    let json = serde_json::to_value(&file).unwrap();
    let keys = |value: &serde_json::Value| value.as_object().unwrap().len();
    assert_eq!(keys(&json), 20);
    assert_eq!((keys(&json["generator"]), keys(&json["field"])), (5, 1));
    assert_eq!((keys(&json["lidar"]), keys(&json["air_data"])), (5, 2));
    assert_eq!(keys(&json["navigation"]), 8);
    assert_eq!(keys(&json["faults"]["actuators"]), 7);
    let faults = &json["faults"];
    assert_eq!(keys(faults), 15);
    // A flag that is false is not written.
    assert_eq!((keys(&faults["airspeed"]), keys(&faults["air"])), (8, 4));
    assert_eq!((keys(&faults["scan"]), keys(&faults["link"])), (7, 4));
    assert_eq!(keys(&faults["clock"]), 4);
}

#[test]
fn the_papers_planner_has_no_map_to_be_known() {
    assert!(parse("known_map = true").unwrap().known_map);
    for preset in ["paper", "reference"] {
        let error = parse(&format!("preset = \"{preset}\"\nknown_map = true")).unwrap_err();
        assert!(error.to_string().contains("known_map"), "{error}");
    }
}

#[test]
fn unknown_keys_are_refused_by_name() {
    for (text, key) in [
        ("obstcles = 20", "obstcles"),
        ("[lidar]\nbeam = 3", "beam"),
        ("[air_data]\npitch_sigma = 1.0", "pitch_sigma"),
        ("[navigation]\nspeed = 1.0", "speed"),
        ("[faults]\nwind = 1.0", "wind"),
        ("[faults.gusts]\nstrength = 1.0", "strength"),
        ("[faults.actuators]\nthrust = 1.0", "thrust"),
        ("[faults.model_error]\nweight = 0.1", "weight"),
        ("[faults.lidar]\nghosts = 0.1", "ghosts"),
        ("[faults.airspeed]\nstuck = true", "stuck"),
        ("[faults.position]\ndelay = 0.2", "delay"),
        ("[faults.scan]\nrate_hz = 2.0", "rate_hz"),
        ("[faults.link]\nlost = 0.2", "lost"),
        ("[faults.clock]\nback = 1.0", "back"),
        (
            "[[field.circle]]\nx = 1.0\nz = 1.0\nradius = 1.0\ncolour = 2",
            "colour",
        ),
    ] {
        let error = refused(text);
        assert!(error.contains(&format!("unknown field `{key}`")), "{error}");
        assert!(error.contains("test.toml"), "{error}");
    }
}

/// A rate that was printed, and more paths than a cycle of preset `flight` finds.
#[test]
fn numbers_are_taken_for_what_is_flown() {
    let built = |text: &str| ScenarioFile::parse("", text).unwrap().build().unwrap();
    assert_eq!(built("replan_hz = 0.75188").replan_ticks, 133);
    for (paths, flown, most) in [(3, 3, 3), (7, 7, 7), (8, 25, 7), (25, 25, 7), (50, 25, 7)] {
        let flight = built(&format!("paths = {paths}"));
        assert_eq!((flight.paths, flight.most_candidates()), (flown, most));
    }
    assert_eq!(built("preset = \"paper\"\npaths = 50").paths, 50);
}

#[test]
fn nonsense_is_refused_by_key() {
    for (text, key) in [
        ("replan_hz = 3.0", "replan_hz"),
        ("replan_hz = 0.0", "replan_hz"),
        ("latency_ms = 15", "latency_ms"),
        ("replan_hz = 10.0\nlatency_ms = 110", "latency_ms"),
        ("duration = 0", "duration"),
        ("duration = -1.5", "duration"),
        ("duration = 2.005", "duration"),
        ("duration = 3600.01", "duration"),
        ("duration = nan", "duration"),
        ("world_scale = 0.0", "world_scale"),
        ("world_scale = nan", "world_scale"),
        ("world_scale = 1e10", "world_scale"),
        ("obstacles = 1001", "obstacles"),
        ("paths = 51", "paths"),
        ("preset = \"paper\"\npaths = 51", "paths"),
        ("slices_per_tick = 0", "slices_per_tick"),
        ("[lidar]\nbeams = 0", "lidar.beams"),
        ("[lidar]\nbeams = 129", "lidar.beams"),
        (
            "[lidar]\nfield_of_view_deg = nan",
            "lidar.field_of_view_deg",
        ),
        ("[lidar]\nrange_max = -1.0", "lidar.range_max"),
        ("[lidar]\nrange_max = 0.9", "lidar.range_max"),
        ("[lidar]\nrange_max = 100000.1", "lidar.range_max"),
        ("[lidar]\nrange_max = nan", "lidar.range_max"),
        ("[lidar]\nrange_error = -0.1", "lidar.range_error"),
        (
            "[air_data]\nairspeed_sigma = inf",
            "air_data.airspeed_sigma",
        ),
        ("[navigation]\nrate_hz = 33.0", "navigation.rate_hz"),
        ("[navigation]\nrate_hz = 0.5", "navigation.rate_hz"),
        ("[navigation]\ndelay_ms = 15", "navigation.delay_ms"),
        ("[navigation]\ndelay_ms = 510", "navigation.delay_ms"),
        ("[navigation]\nsigma = -0.1", "navigation.sigma"),
        ("[navigation]\nwander = nan", "navigation.wander"),
        ("[navigation]\nwander_time = 0.0", "navigation.wander_time"),
        (
            "[navigation]\nvelocity_sigma = inf",
            "navigation.velocity_sigma",
        ),
        ("[faults.gusts]\nintensity = -1.0", "faults.gusts.intensity"),
        ("[faults.lidar]\ndropouts = 1.5", "faults.lidar.dropouts"),
        ("body_radius = -1.0", "body_radius"),
        (
            "duration = 3600\nobstacles = 900\n[generator]\nname = \"endless\"",
            "obstacles",
        ),
        ("[faults.x]\nnoise = 1e308", "faults.x"),
        ("[faults.z]\nbias = -1e10", "faults.z"),
        ("[generator]\nradius = 0.0", "generator.radius"),
        ("[generator]\nvelocity = [nan, 0.0]", "generator.velocity"),
        (
            "[generator]\nname = \"forest\"\ncluster = 0",
            "generator.cluster",
        ),
        (
            "body_radius = 3.0\n[generator]\nname = \"walls\"",
            "generator.gap",
        ),
    ] {
        let error = refused(text);
        assert!(error.starts_with(&format!("{key}: give ")), "{error}");
    }
    let error = refused("[generator]\nname = \"walls\"\nspread = 1.0");
    let expected = "generator.spread: leave it out: walls takes radius, gap";
    assert_eq!(error, expected);
    let error = refused("preset = \"reference\"\n[generator]\nname = \"walls\"");
    assert!(
        error.starts_with("lidar.rule: the authors' lidar knows circles only"),
        "{error}"
    );
    let error = refused("[[field.circle]]\nx = 1.0\nz = 50.0\nradius = 2.0");
    assert!(
        error.starts_with("field, circle 1, place: it covers the start"),
        "{error}"
    );
    assert!(refused("preset = \"best\"").contains("unknown variant `best`"));
}

#[test]
fn a_scene_stands_alone_unless_obstacles_are_asked_for() {
    let scene = parse("scene = \"flytrap\"").unwrap();
    assert_eq!(scene.obstacles, 0);
    assert!(scene.field().obstacles.len() > 10);
    let both = parse("scene = \"flytrap\"\nobstacles = 20").unwrap();
    assert_eq!(
        both.field().obstacles.len(),
        scene.field().obstacles.len() + 20
    );
    let placed = parse("[[field.circle]]\nx = 30.0\nz = 50.0\nradius = 2.0").unwrap();
    assert_eq!(placed.field().obstacles.len(), 1);
}

#[test]
fn a_bad_table_of_a_fault_is_refused_by_table_and_key() {
    for (text, table, key) in [
        ("airspeed]\nfrom = -1.0", "airspeed", "from"),
        ("airspeed]\nfrom = 2.0\nuntil = 2.0", "airspeed", "until"),
        ("pitch]\nbias = nan", "pitch", "bias"),
        ("x]\nquantum = 0.0", "x", "quantum"),
        ("z]\nnoise = -1.0", "z", "noise"),
        ("elevator]\nscale = inf", "elevator", "scale"),
        ("thrust]\nramp = nan", "thrust", "ramp"),
        ("air]\ndelay_ms = 15", "air", "delay_ms"),
        ("air]\ndelay_ms = 20000", "air", "delay_ms"),
        ("position]\nrate_hz = 3.0", "position", "rate_hz"),
        ("scan]\nrotation_deg = 200.0", "scan", "rotation_deg"),
        ("link]\nloss = 1.5", "link", "loss"),
        ("clock]\njump = 1e9", "clock", "jump"),
    ] {
        let error = refused(&format!("[faults.{text}"));
        let begin = format!("faults.{table}: give a");
        assert!(error.starts_with(&begin), "{error}");
        assert!(error.contains(&format!("`{key}`")), "{error}");
    }
}

#[test]
fn a_fault_that_the_flight_does_not_reach_is_refused() {
    let late = "[faults.scan]\nfrom = 30.0\nuntil = 50.0\nmissing = true";
    let error = refused(late);
    assert!(
        error.starts_with("faults.scan: it begins after the flight"),
        "{error}"
    );
    assert!(parse(&format!("duration = 40\n{late}")).is_ok());
    let error = refused("[faults.scan]\nfrom = 5.0");
    assert!(error.starts_with("faults.scan: nothing fails"), "{error}");
}

#[test]
fn a_lidars_file_with_a_range_that_the_core_refuses_is_named() {
    assert!(LidarTable::parse("my.toml", "range_max = 100000.0").is_ok());
    let error = LidarTable::parse("my.toml", "range_max = 0.5").unwrap_err();
    let expected = "my.toml: lidar.range_max: give 1 to 100000 m, the core's bounds";
    assert_eq!(error.to_string(), expected);
}

/// A second file changes what it names and keeps the rest, also within a table.
#[test]
fn a_file_over_a_file_keeps_what_it_does_not_name() {
    let text = "seed = 7\nobstacles = 40\n[faults.gusts]\nintensity = 1.0\n\
                [faults.link]\nfrom = 2.0\nloss = 0.1";
    let base = ScenarioFile::parse("base.toml", text).unwrap();
    let over = "latency_ms = 20\n[faults.link]\nloss = 0.2\n[navigation]\nsource = \"rtk\"";
    let both = base.under("over.toml", over).unwrap();
    assert_eq!(
        (both.seed, both.obstacles, both.latency_ms),
        (Some(7), Some(40), Some(20))
    );
    assert!((both.faults.gusts.intensity - 1.0).abs() < 1e-15);
    assert_eq!(
        (both.faults.link.from, both.faults.link.loss),
        (Some(2.0), Some(0.2))
    );
    assert_eq!(both.navigation.source, Some(NavigationSource::Rtk));
    assert_eq!(base.under("over.toml", "").unwrap(), base);
    let error = base
        .under("over.toml", "latency = 20")
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("over.toml") && error.contains("`latency`"),
        "{error}"
    );
}
