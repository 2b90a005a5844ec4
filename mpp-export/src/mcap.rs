//! MCAP with JSON messages, through the crate of the same name. `docs/logs.md` lists the topics.

use crate::error::ExportError;
use mpp_sim::log::FlightLog;

/// The bytes of the file.
///
/// # Errors
/// [`ExportError::NotBuilt`] without the cargo feature `formats`; [`ExportError::NoColumn`] when the log has a value
/// that the schema does not know; [`ExportError::Write`] if the library refuses.
pub fn mcap(log: &FlightLog) -> Result<Vec<u8>, ExportError> {
    #[cfg(feature = "formats")]
    return write::mcap(log);
    #[cfg(not(feature = "formats"))]
    {
        let _ = log;
        Err(ExportError::NotBuilt("MCAP"))
    }
}

#[cfg(feature = "formats")]
mod write {
    use crate::error::ExportError;
    use crate::flight::{TABLES, table};
    use crate::messages::{
        Stance, frame_transform, frame_transform_schema, laser_scan, laser_scan_schema,
        pose_in_frame, pose_in_frame_schema, scene_update_schema, table_schema,
    };
    use crate::scene::{cycle, moves, obstacles, scans};
    use crate::schema::{LATERAL, VERSION};
    use crate::space::{bodies, cycles, points_schema};
    use mcap::records::{MessageHeader, Metadata};
    use mcap::{WriteOptions, Writer};
    use mpp_analysis::picture::replay::details;
    use mpp_sim::log::FlightLog;
    use mpp_sim::space::Look;
    use serde_json::{Map, Value};
    use std::collections::BTreeMap;
    use std::io::Cursor;

    /// Nanoseconds of a tick.
    const TICK: u64 = 10_000_000;
    /// Ticks from one picture of moving obstacles to the next.
    const SCENE_TICKS: usize = 10;

    /// A message: its time \[ns\], and its JSON.
    type Timed = (u64, Value);

    /// Messages of one topic.
    struct Topic {
        name: String,
        /// Name and text of the schema.
        schema: Value,
        messages: Vec<Timed>,
    }

    pub(super) fn mcap(log: &FlightLog) -> Result<Vec<u8>, ExportError> {
        let topics = topics(log)?;
        write(log, &topics).map_err(|why| ExportError::Write("MCAP", why.to_string()))
    }

    fn topics(log: &FlightLog) -> Result<Vec<Topic>, ExportError> {
        let mut topics = TABLES
            .map(|schema| {
                Ok(Topic {
                    name: format!("/{}", schema.name),
                    schema: table_schema(schema),
                    messages: of_table(log, schema)?,
                })
            })
            .into_iter()
            .collect::<Result<Vec<Topic>, ExportError>>()?;
        let mut add = |name: &str, schema, messages| {
            let name = name.to_owned();
            topics.push(Topic {
                name,
                schema,
                messages,
            });
        };
        add(
            "/tf",
            frame_transform_schema(),
            of_ticks(log, |time, tick| frame_transform(time, &flown(log, tick))),
        );
        add(
            "/pose",
            pose_in_frame_schema(),
            of_ticks(log, |time, tick| pose_in_frame(time, &flown(log, tick))),
        );
        add(
            "/estimate",
            pose_in_frame_schema(),
            of_ticks(log, |time, tick| pose_in_frame(time, &estimated(log, tick))),
        );
        if log.header.space.is_some() {
            add("/lateral", table_schema(&LATERAL), of_table(log, &LATERAL)?);
            if let Some(look) = Look::again(log) {
                let [points, paths] = cycles(&look);
                add("/points", points_schema(), points);
                add("/field", scene_update_schema(), bodies(log, &look));
                add("/plan", scene_update_schema(), paths);
            }
            return Ok(topics);
        }
        let scans = scans(log).into_iter().map(|scan| {
            let time = u64::from(scan.tick) * TICK;
            (time, laser_scan(time, &scan))
        });
        add("/scan", laser_scan_schema(), scans.collect());
        add("/field", scene_update_schema(), of_field(log));
        let cycles = details(log).unwrap_or_default().into_iter().map(|detail| {
            let time = u64::from(detail.tick) * TICK;
            (time, cycle(time, &detail))
        });
        add("/plan", scene_update_schema(), cycles.collect());
        Ok(topics)
    }

    fn flown(log: &FlightLog, tick: usize) -> Stance {
        let (ticks, side) = (&log.ticks, &log.lateral);
        let (x, z, pitch) = (ticks.x[tick], ticks.z[tick], ticks.pitch[tick]);
        if side.is_empty() {
            return Stance::plane((x, z), pitch);
        }
        Stance::space(
            [x, side.y[tick], z],
            [side.bank[tick], pitch, side.course[tick]],
        )
    }

    fn estimated(log: &FlightLog, tick: usize) -> Stance {
        let (ticks, side) = (&log.ticks, &log.lateral);
        let (x, z, pitch) = (ticks.est_x[tick], ticks.est_z[tick], ticks.est_pitch[tick]);
        if side.is_empty() {
            return Stance::plane((x, z), pitch);
        }
        Stance::space(
            [x, side.est_y[tick], z],
            [side.est_bank[tick], pitch, side.est_course[tick]],
        )
    }

    /// The rows of a table as objects, each at its tick.
    fn of_table(
        log: &FlightLog,
        schema: &'static crate::schema::Schema,
    ) -> Result<Vec<Timed>, ExportError> {
        let table = table(log, schema)?;
        let names: Vec<&str> = schema.columns.iter().map(|column| column.name).collect();
        let message = |(number, row): (usize, Vec<Value>)| {
            let tick = match (names.first(), row.first().and_then(Value::as_u64)) {
                (Some(&"tick"), Some(tick)) => tick,
                _ => number as u64,
            };
            let names = names.iter().map(|name| (*name).to_owned());
            let object: Map<String, Value> = names.zip(row).collect();
            (tick * TICK, Value::from(object))
        };
        Ok(table.rows.into_iter().enumerate().map(message).collect())
    }

    fn of_ticks(log: &FlightLog, message: impl Fn(u64, usize) -> Value) -> Vec<Timed> {
        let timed = |tick| {
            let time = tick as u64 * TICK;
            (time, message(time, tick))
        };
        (0..log.ticks.t.len()).map(timed).collect()
    }

    fn of_field(log: &FlightLog) -> Vec<Timed> {
        let field = &log.header.field;
        let until = if moves(field) {
            log.ticks.t.len().max(1)
        } else {
            1
        };
        let times = (0..until)
            .step_by(SCENE_TICKS)
            .map(|tick| tick as u64 * TICK);
        times.map(|time| (time, obstacles(time, field))).collect()
    }

    fn write(log: &FlightLog, topics: &[Topic]) -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let options = WriteOptions::new().compression(None).library("mpp-export");
        let mut writer: Writer<Cursor<Vec<u8>>> = options.create(Cursor::new(Vec::new()))?;
        writer.write_metadata(&Metadata {
            name: "mpp".to_owned(),
            metadata: BTreeMap::from([
                ("schema_version".to_owned(), VERSION.to_string()),
                ("log_schema".to_owned(), log.schema.to_string()),
                ("log_hash".to_owned(), log.hash()?),
                ("summary".to_owned(), serde_json::to_string(&log.summary)?),
            ]),
        })?;
        let mut messages = Vec::new();
        for topic in topics {
            let name = topic.schema["title"].as_str().unwrap_or_default();
            let schema =
                writer.add_schema(name, "jsonschema", topic.schema.to_string().as_bytes())?;
            let channel = writer.add_channel(schema, &topic.name, "json", &BTreeMap::new())?;
            let numbered = topic.messages.iter().zip(0_u32..);
            messages.extend(
                numbered.map(|((time, message), sequence)| (*time, channel, sequence, message)),
            );
        }
        // In the order of time, as if it was recorded in flight.
        messages.sort_by_key(|(time, channel, sequence, _)| (*time, *channel, *sequence));
        for (time, channel_id, sequence, message) in messages {
            let header = MessageHeader {
                channel_id,
                sequence,
                log_time: time,
                publish_time: time,
            };
            writer.write_to_known_channel(&header, message.to_string().as_bytes())?;
        }
        writer.finish()?;
        Ok(writer.into_inner().into_inner())
    }
}
