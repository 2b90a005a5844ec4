//! Whether exports hold what the log holds, under the names that the page gives.

#![expect(clippy::unwrap_used, reason = "the helpers of tests fail as tests do")]

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use mpp_analysis::campaign::{Campaign, Lists, Row};
use mpp_export::schema::{ALL, Kind, SENSORS, TICKS};
use mpp_export::table::Table;
use mpp_export::{ExportError, csv::csv, flight, mcap::mcap, parquet::parquet, rows};
use mpp_sim::flight::fly;
use mpp_sim::flight_observer::FlightObserver;
use mpp_sim::log::FlightLog;
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Scenario, ScenarioFile};
use mpp_sim::space::{SpaceFile, fly_space};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;

fn scenario(text: &str) -> Scenario {
    ScenarioFile::parse("", text).unwrap().build().unwrap()
}

fn flown(text: &str) -> FlightLog {
    fly(&scenario(text), &mut PipeLink::new(), |_| {}).unwrap()
}

#[test]
fn the_page_has_every_column_with_kind_unit_frame_and_meaning() {
    let page = include_str!("../../docs/logs.md");
    for schema in ALL {
        let part = page
            .split(&format!("### Table `{}`", schema.name))
            .nth(1)
            .unwrap();
        let part = part.split("\n#").next().unwrap();
        let listed: Vec<&str> = part.lines().filter(|line| line.starts_with("|`")).collect();
        let row = |column: &mpp_export::schema::Column| {
            let kind = format!("{:?}", column.kind).to_lowercase();
            let (name, unit, frame, about) = (column.name, column.unit, column.frame, column.about);
            format!("|`{name}`|{kind}|{unit}|{frame}|{about}|")
        };
        let expected: Vec<String> = schema.columns.iter().map(row).collect();
        assert_eq!(listed, expected);
    }
}

#[test]
fn csv_reads_back_to_the_same_numbers() {
    let log = flown("seed = 3\nduration = 1.5");
    let table = flight::table(&log, &TICKS).unwrap();
    let text = String::from_utf8(csv(&table)).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = |name: &str| names.iter().position(|found| *found == name).unwrap();
    let cells: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let column = |name: &str| -> Vec<Option<f64>> {
        cells
            .iter()
            .map(|row| row[place(name)].parse().ok())
            .collect()
    };
    let whole = |column: &[f64]| column.iter().copied().map(Some).collect::<Vec<_>>();
    assert_eq!(column("z"), whole(&log.ticks.z));
    assert_eq!(
        column("applied_elevator"),
        whole(&log.ticks.applied_elevator)
    );
    assert_eq!(column("ref_x"), log.ticks.ref_x);
    assert!(log.ticks.ref_x.contains(&None) && cells.len() == 150);
}

#[test]
fn parquet_reads_back_to_the_same_numbers() {
    let log = flown("seed = 3\nduration = 1.5");
    let bytes = parquet(&flight::table(&log, &TICKS).unwrap()).unwrap();
    let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
    let metadata = reader
        .metadata()
        .file_metadata()
        .key_value_metadata()
        .unwrap();
    assert!(metadata.iter().any(|pair| pair.key == "mpp.schema_version"));
    let mut rows = 0;
    for (row, tick) in reader.get_row_iter(None).unwrap().zip(0..) {
        let row: BTreeMap<String, Field> = row.unwrap().into_columns().into_iter().collect();
        assert_eq!(row["z"], Field::Double(log.ticks.z[tick]));
        assert_eq!(
            row["ref_z"],
            log.ticks.ref_z[tick].map_or(Field::Null, Field::Double)
        );
        rows += 1;
    }
    assert_eq!(rows, 150);
}

#[test]
fn mcap_has_every_topic_in_the_order_of_time_and_the_logs_hash() {
    let log = flown(
        "seed = 3\nduration = 2.5\n[[field.circle]]\nx = 90.0\nz = 50.0\nradius = 1.0\nvelocity = [1.0, 0.0]",
    );
    let bytes = mcap(&log).unwrap();
    let mut counts = BTreeMap::new();
    let mut last = 0;
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        assert!(message.log_time >= last);
        last = message.log_time;
        let schema = message.channel.schema.clone().unwrap();
        let value: serde_json::Value = serde_json::from_slice(&message.data).unwrap();
        let schema: serde_json::Value = serde_json::from_slice(&schema.data).unwrap();
        let properties = schema["properties"].as_object().unwrap();
        assert!(
            value
                .as_object()
                .unwrap()
                .keys()
                .all(|key| properties.contains_key(key))
        );
        *counts.entry(message.channel.topic.clone()).or_insert(0) += 1;
    }
    let expected = [
        ("/estimate", 250),
        ("/field", 25),
        ("/plan", 3),
        ("/plans", 3),
        ("/pose", 250),
        ("/scan", 3),
        ("/tf", 250),
        ("/ticks", 250),
    ];
    assert_eq!(
        counts,
        expected
            .map(|(topic, count)| (topic.to_owned(), count))
            .into()
    );
    let hash = log.hash().unwrap();
    assert!(
        bytes
            .windows(hash.len())
            .any(|part| part == hash.as_bytes())
    );
    // Another flight than its seed gives has no scans and no cycles.
    let mut other = log;
    other.ticks.x[10] += 1.0;
    let fewer = mcap(&other).unwrap();
    let topics = mcap::MessageStream::new(&fewer).unwrap();
    assert!(
        topics
            .map(|message| message.unwrap().channel.topic.clone())
            .all(|topic| topic != "/scan")
    );
}

#[test]
fn mcap_of_a_flight_in_space_has_clouds_bodies_and_paths_where_they_were() {
    let file = SpaceFile {
        density: Some(0.005),
        seed: Some(5),
        ..SpaceFile::default()
    };
    let log = std::thread::Builder::new().stack_size(mpp_sim::space::STACK);
    let log = log.spawn(move || fly_space(&file.build(None).unwrap()).unwrap());
    let log = log.unwrap().join().unwrap();
    let bytes = mcap(&log).unwrap();
    let mut found: BTreeMap<String, Vec<serde_json::Value>> = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        let value = serde_json::from_slice(&message.data).unwrap();
        (found.entry(message.channel.topic.clone()).or_default()).push(value);
    }
    let trunks = found["/field"][0]["entities"][0]["cylinders"]
        .as_array()
        .unwrap();
    assert_eq!(trunks.len(), log.header.obstacles);
    // The plan of the last cycle may come too late.
    assert!((0..2).contains(&(found["/points"].len() - log.plans.len())));
    assert_eq!(found["/plan"].len(), found["/points"].len());
    // A point of the last cloud that has one lies at the bark of a trunk, or on the ground.
    let places = |cloud: &serde_json::Value| -> Vec<[f64; 3]> {
        let bytes = BASE64_STANDARD
            .decode(cloud["data"].as_str().unwrap())
            .unwrap();
        let part = |at: &[u8]| f64::from(f32::from_le_bytes(at.try_into().unwrap()));
        let point = |it: &[u8]| [0, 4, 8].map(|at| part(&it[at..at + 4]));
        bytes.chunks_exact(12).map(point).collect()
    };
    let cloud = found["/points"]
        .iter()
        .map(places)
        .rfind(|it| !it.is_empty());
    let off = |[x, y, z]: [f64; 3]| {
        let number = |value: &serde_json::Value| value.as_f64().unwrap();
        let to_bark = |trunk: &serde_json::Value| {
            let (at, wide) = (&trunk["pose"]["position"], number(&trunk["size"]["x"]));
            (libm::hypot(number(&at["x"]) - x, number(&at["y"]) - y) - 0.5 * wide).abs()
        };
        trunks.iter().map(to_bark).fold(z.abs(), f64::min)
    };
    let cloud = cloud.unwrap();
    let near = cloud.iter().filter(|place| off(**place) < 0.3).count();
    assert!(near * 10 > cloud.len() * 9, "{near} of {}", cloud.len());
    // What does not come out the same has its poses alone.
    let mut other = log;
    other.ticks.x[10] += 1.0;
    let fewer = mcap(&other).unwrap();
    let topics = mcap::MessageStream::new(&fewer).unwrap();
    let mut topics = topics.map(|message| message.unwrap().channel.topic.clone());
    assert!(topics.all(|topic| topic != "/points"));
}

#[test]
fn every_value_of_a_row_has_a_column() {
    let file = ScenarioFile::parse("", "preset = \"reference\"\nduration = 4").unwrap();
    let lists = Lists {
        obstacles: vec![60],
        ..Lists::default()
    };
    let campaign = Campaign::new(file, lists, 1, Some(1)).unwrap();
    let cell = campaign.cells().remove(0);
    // This flight fails: a failure has values of its own.
    let log = flown("preset = \"reference\"\nduration = 8\nobstacles = 60\nseed = 2");
    assert!(log.summary.failure.is_some());
    let row = Row {
        log_hash: log.hash().unwrap(),
        core_ms: Some(1.25),
        ..Row::new(cell, &log, &FlightObserver::default())
    };
    let table = rows::table(std::slice::from_ref(&row)).unwrap();
    let value = |name: &str| {
        table
            .columns()
            .find(|(column, _)| column.name == name)
            .unwrap()
            .1[0]
            .clone()
    };
    assert_eq!(value("seed"), 2);
    assert_eq!(value("generator"), "paper");
    assert_eq!(value("core_ms"), 1.25);
    assert!(value("failure_cause").is_string() && value("t_end").is_f64());
    for (column, values) in table.columns() {
        let fits = |value: &&serde_json::Value| match column.kind {
            Kind::Real => value.is_number(),
            Kind::Whole => value.is_u64(),
            Kind::Truth => value.is_boolean(),
            Kind::Text => value.is_string(),
        };
        assert!(
            values.iter().filter(|value| !value.is_null()).all(fits),
            "{}",
            column.name
        );
    }
}

#[test]
fn a_key_without_a_column_is_refused() {
    let object = serde_json::json!({ "tick": 1, "colour": "red" });
    let objects = [object.as_object().unwrap().clone()];
    let refused = Table::of_objects(&SENSORS, objects).unwrap_err();
    assert!(
        matches!(&refused, ExportError::NoColumn(key, _) if key == "colour"),
        "{refused}"
    );
}
