//! Whole flights in space: plant and sensors on one side of the link, the core on the other.

use hil_protocol::{Message, PointPacket, RejectionCause};
use mpp_sim::aircraft_file::AircraftFile;
use mpp_sim::link::{Link, LinkError};
use mpp_sim::log::FlightLog;
use mpp_sim::orders::{Mode, Order, Refused};
use mpp_sim::outcome::Outcome;
use mpp_sim::space::world::Body;
use mpp_sim::space::{
    Look, SpaceCycle, SpaceFile, SpaceFlight, SpacePipe, fly_space, fly_space_again, fly_space_with,
};

/// Does something on a stack on which the core in space can be built.
pub(crate) fn aside<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> T {
    let thread = std::thread::Builder::new().stack_size(mpp_sim::space::STACK);
    thread.spawn(work).unwrap().join().unwrap()
}

fn forest(density: f64, seed: u64) -> SpaceFile {
    SpaceFile {
        density: Some(density),
        sphere: Some(0.4),
        seed: Some(seed),
        ..SpaceFile::default()
    }
}

pub(crate) fn flown(file: SpaceFile, stems: Option<Vec<Body>>) -> Result<FlightLog, String> {
    aside(move || {
        let scenario = file
            .build(stems.as_deref())
            .map_err(|error| error.to_string())?;
        fly_space(&scenario).map_err(|error| error.to_string())
    })
}

pub(crate) fn trunk(x: f64, y: f64) -> Body {
    Body::Cylinder {
        x,
        y,
        radius: 0.4,
        height: f64::INFINITY,
    }
}

/// A trunk in the way, and one that gives the world its size.
fn way() -> Vec<Body> {
    vec![trunk(60.0, 0.1), trunk(120.0, 30.0)]
}

/// A wing without a rudder, whose nose runs away.
#[test]
fn zagi_crosses_a_light_forest() {
    let arrived = (964_000..964_004).filter(|seed| {
        let file = SpaceFile {
            aircraft: Some(AircraftFile::known("zagi").unwrap()),
            sphere: None,
            ..forest(0.01, *seed)
        };
        flown(file, None).unwrap().summary.outcome == Outcome::Survived
    });
    assert!(arrived.count() >= 3);
}

#[test]
fn light_forests_are_crossed_and_the_same_seed_flies_the_same() {
    let mut arrived = 0;
    for seed in 70..74 {
        let log = flown(forest(0.01, seed), None).unwrap();
        assert_eq!(log.rejections, [], "{seed}");
        let off = log.lateral.ref_y.iter().zip(&log.lateral.y);
        let off: Vec<f64> = off.filter_map(|(it, y)| Some((*it)? - y)).collect();
        let mean = off.iter().map(|it| it.abs()).sum::<f64>() / off.len() as f64;
        assert!(off.len() > 1000 && mean < 0.2, "{seed}: {mean}");
        arrived += usize::from(log.summary.outcome == Outcome::Survived);
    }
    assert!(arrived >= 3, "{arrived}");
    let again = || flown(forest(0.01, 70), None).unwrap().hash().unwrap();
    assert_eq!(again(), again());
}

#[test]
fn the_log_has_every_lateral_column_and_reads_back() {
    let log = flown(forest(0.005, 5), None).unwrap();
    let side = &log.lateral;
    assert_eq!(side.y.len(), log.ticks.t.len());
    let most = |column: &[f64]| column.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    // A flight straight ahead would show nothing.
    for column in [
        &side.y,
        &side.bank,
        &side.course,
        &side.sideslip,
        &side.roll_rate,
        &side.aileron,
    ] {
        assert!(most(column) > 1e-3);
    }
    let off: Vec<f64> = side
        .bank
        .iter()
        .zip(&side.est_bank)
        .skip(50)
        .map(|(a, b)| a - b)
        .collect();
    assert!(most(&off) < 0.06, "{}", most(&off));
    let bytes = log.to_json().unwrap();
    assert_eq!(FlightLog::from_json(&bytes).unwrap(), log);
    let error = log.header.scenario().unwrap_err().to_string();
    assert!(error.contains("in space"), "{error}");
}

/// A link that loses the points of the lidar.
struct Blind(SpacePipe);

impl Link for Blind {
    fn send(&mut self, message: &Message) -> Result<(), LinkError> {
        match message {
            Message::PointPacket(_) => Ok(()),
            other => self.0.send(other),
        }
    }

    fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
        self.0.receive(awaited)
    }
}

/// Who sees nothing hits what stands in the way.
#[test]
fn a_trunk_in_the_way_is_passed_with_the_lidar_and_hit_without_sight() {
    let file = || SpaceFile {
        sphere: Some(0.4),
        ..SpaceFile::default()
    };
    let seeing = flown(file(), Some(way())).unwrap();
    assert_eq!(seeing.summary.outcome, Outcome::Survived);
    let blind = aside(move || {
        let scenario = file().build(Some(&way())).unwrap();
        fly_space_with(&scenario, &mut Blind(SpacePipe::of(&scenario)), || false).unwrap()
    });
    assert_eq!(blind.summary.outcome, Outcome::Collision);
    assert_eq!(blind.summary.replans, 0);
}

/// It stands in the way from its tick on, the log holds it, and the log's orders give the same flight again.
#[test]
fn a_trunk_that_is_planted_in_flight_is_passed_and_planted_again() {
    let (log, again) = aside(|| {
        let file = SpaceFile {
            sphere: Some(0.4),
            ..SpaceFile::default()
        };
        let scenario = file.build(Some(&[trunk(120.0, 30.0)])).unwrap();
        let mut link = SpacePipe::of(&scenario);
        let mut flight = SpaceFlight::begin(&scenario, &mut link).unwrap();
        for _ in 0..300 {
            flight.tick(&scenario, &mut link).unwrap();
        }
        let [x, y] = [flight.state().plane.x, flight.state().lateral.y];
        let radius = 0.4;
        let planted = |x, y, radius| Order::Trunk { x, y, radius };
        for (order, why) in [
            (planted(x, y, radius), Refused::Range),
            (planted(x + 25.0, y, 0.0), Refused::Range),
            (Order::Mode { mode: Mode::Cruise }, Refused::World),
        ] {
            assert_eq!(flight.obey(&scenario, &order), Err(why));
        }
        let order = planted(x + 25.0, y, radius);
        flight.obey(&scenario, &order).unwrap();
        while !flight.has_ended() {
            flight.tick(&scenario, &mut link).unwrap();
            assert_eq!(flight.returns().is_some(), flight.flown() % 10 == 1);
        }
        let log = flight.log();
        let mut link = SpacePipe::of(&scenario);
        let again = fly_space_again(&scenario, &mut link, &log.orders, || false).unwrap();
        (log, again)
    });
    assert_eq!(log.summary.outcome, Outcome::Survived);
    assert_eq!(log.orders.len(), 1);
    assert_eq!(log.orders.first().unwrap().tick, 300);
    // It went around.
    let clearance = log.summary.min_clearance.unwrap();
    assert!(clearance > 0.1 && clearance < 3.0, "{clearance}");
    assert_eq!(log, again);
    // Who looks at the log sees the same flight, and nothing of one that it does not tell of.
    let look = Look::again(&log).unwrap();
    assert_eq!(look.moments.len(), log.ticks.t.len() + 1);
    // The plan of the last cycle may come too late.
    assert!((0..2).contains(&(look.cycles.len() - log.plans.len())));
    for (number, (at, ..)) in look.moments.iter().take(log.ticks.t.len()).enumerate() {
        assert_eq!(
            at.map(f64::to_bits),
            [
                log.ticks.x[number],
                log.lateral.y[number],
                log.ticks.z[number]
            ]
            .map(f64::to_bits)
        );
    }
    let planted =
        |cycle: &SpaceCycle| cycle.tick > 300 && !cycle.hits.is_empty() && cycle.paths.len() > 1;
    assert!(look.cycles.iter().any(planted));
    // Plans begin where the flight comes to.
    for cycle in &look.cycles {
        if let (Some([x, y, z, _]), Some((at, ..))) = (
            cycle.paths.last().and_then(|path| path.first()),
            look.moments.get(cycle.begins as usize),
        ) {
            let off = [x, y, z].map(|it| 0.01 * f64::from(*it));
            let off = off
                .iter()
                .zip(at)
                .map(|(a, b)| (a - b).powi(2))
                .sum::<f64>();
            assert!(off.sqrt() < 0.3, "{off} at {}", cycle.tick);
        }
    }
    let mut other = log;
    other.orders.clear();
    assert!(Look::again(&other).is_none());
}

/// A trunk behind another one is hit in the first sweep by beams that see through, as far as they see, and by no others. The log
/// tells of it.
#[test]
fn beams_that_see_through_hit_what_is_hidden() {
    let hits_behind = |see_through: bool, sight: Option<f64>| {
        let file = SpaceFile {
            see_through: Some(see_through),
            sight,
            ..forest(0.01, 1)
        };
        let bodies = vec![trunk(20.0, 0.0), trunk(28.0, 0.0), trunk(60.0, 30.0)];
        let log = flown(file, Some(bodies)).unwrap();
        assert_eq!(log.summary.outcome, Outcome::Survived);
        assert_eq!(log.header.space.as_ref().unwrap().see_through, see_through);
        let look = aside(move || Look::again(&log)).unwrap();
        // In centimetres.
        let points = look.cycles.first().unwrap().hits.chunks(3);
        points
            .filter(|point| point[0] > 2600 && point[1].abs() < 35)
            .count()
    };
    assert_eq!(hits_behind(false, None), 0);
    assert!(hits_behind(true, None) > 5);
    assert_eq!(hits_behind(true, Some(25.0)), 0);
}

/// A lidar that falls silent leaves the map, in which plans go on.
#[test]
fn plans_go_on_in_the_map_without_points() {
    struct Failing(SpacePipe, u32);
    impl Link for Failing {
        fn send(&mut self, message: &Message) -> Result<(), LinkError> {
            match message {
                Message::PointPacket(packet) if packet.tick > self.1 => Ok(()),
                other => self.0.send(other),
            }
        }
        fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
            self.0.receive(awaited)
        }
    }
    let log = aside(|| {
        let file = SpaceFile {
            sphere: Some(0.4),
            ..SpaceFile::default()
        };
        let scenario = file.build(Some(&way())).unwrap();
        fly_space_with(
            &scenario,
            &mut Failing(SpacePipe::of(&scenario), 300),
            || false,
        )
        .unwrap()
    });
    assert!(log.plans.iter().any(|plan| plan.tick > 500));
    assert_eq!(log.summary.outcome, Outcome::Survived);
}

#[test]
fn packets_that_show_nothing_are_refused_by_name() {
    let causes = aside(|| {
        let scenario = forest(0.005, 1).build(None).unwrap();
        let mut ticks = 0;
        struct Odd<'a>(SpacePipe, &'a mut u32);
        impl Link for Odd<'_> {
            fn send(&mut self, message: &Message) -> Result<(), LinkError> {
                if let Message::SensorFrame(frame) = message {
                    *self.1 += 1;
                    let packet = |points: &[[f32; 3]]| {
                        Message::PointPacket(PointPacket {
                            tick: frame.tick,
                            sensor_time: 0,
                            interval: 0,
                            points: points.iter().copied().collect(),
                        })
                    };
                    match frame.tick {
                        1 => self.0.send(&packet(&[]))?,
                        2 => self
                            .0
                            .send(&packet(&[[1.0, 0.0, 0.0], [f32::NAN, 0.0, 0.0]]))?,
                        3 => self.0.send(&packet(&[[0.0; 3]]))?,
                        _ => {}
                    }
                }
                self.0.send(message)
            }
            fn receive(&mut self, awaited: &str) -> Result<Message, LinkError> {
                self.0.receive(awaited)
            }
        }
        let log = fly_space_with(
            &scenario,
            &mut Odd(SpacePipe::of(&scenario), &mut ticks),
            || false,
        );
        log.unwrap().rejections
    });
    let expected = [
        RejectionCause::ScanLength {
            expected: 2048,
            found: 0,
        },
        RejectionCause::ScanNotFinite { beam: 1 },
        RejectionCause::ScanNotFinite { beam: 0 },
    ];
    let causes: Vec<String> = causes.into_iter().map(|it| it.cause).collect();
    assert_eq!(causes, expected.map(|cause| format!("{cause:?}")));
}

#[test]
fn what_makes_no_sense_is_one_sentence() {
    let named = |name: &str| AircraftFile::known(name);
    for (file, stems, hint) in [
        (forest(-1.0, 1), None, "density: give more than 0"),
        (forest(f64::NAN, 1), None, "density: give more than 0"),
        (
            SpaceFile {
                aircraft: named("cessna182"),
                ..SpaceFile::default()
            },
            None,
            "give this table",
        ),
        (
            SpaceFile::default(),
            Some(vec![trunk(0.0, 0.0), trunk(90.0, 30.0)]),
            "at its start",
        ),
        (
            SpaceFile::default(),
            Some(vec![trunk(90.0, 1.0)]),
            "leaves no room",
        ),
        (
            SpaceFile::default(),
            Some((-40..=40).map(|y| trunk(90.0, f64::from(y))).collect()),
            "wider than every gap at 90.0 m",
        ),
        (
            SpaceFile {
                candidates: Some(8),
                ..SpaceFile::default()
            },
            None,
            "give 1 to 7",
        ),
        (
            SpaceFile {
                replan_hz: Some(0.0),
                ..SpaceFile::default()
            },
            None,
            "give a rate",
        ),
        (
            SpaceFile {
                preset: Some("flight".to_owned()),
                ..SpaceFile::default()
            },
            None,
            "give space",
        ),
    ] {
        let error = flown(file, stems).unwrap_err();
        assert!(error.contains(hint), "{error}");
        assert!(!error.contains('\n'), "{error}");
    }
}
