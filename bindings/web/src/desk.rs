//! Questions about one flight, and their answers.

use mpp_core::vehicle::VehicleState;
use mpp_node::parameters::Tuning;
use mpp_sim::aircraft_file::AircraftFile;
use mpp_sim::entries::{Columns, PlanEntry};
use mpp_sim::flight::Flight;
use mpp_sim::inspector::{Inspector, PlanDetail};
use mpp_sim::log::{FlightLog, Header, Summary};
use mpp_sim::orders::{Ground, Order, OrderEntry, Refused};
use mpp_sim::pipe::PipeLink;
use mpp_sim::scenario::{Scenario, ScenarioFile};
use mpp_sim::tick_record::TickRecord;
use mpp_sim::world::World;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Greatest number of ticks that one question flies: a minute.
pub(crate) const MOST_TICKS: u32 = 6000;

/// A question, as JSON with the key `ask`.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Question {
    /// Begins a flight. The answer is a [`Begun`].
    Begin {
        /// The flight, with the keys of a scenario file.
        #[serde(default)]
        scenario: Box<ScenarioFile>,
        /// Orders that are given at their ticks.
        #[serde(default)]
        orders: VecDeque<OrderEntry>,
        /// Whether each planning cycle is shown; see [`PlanDetail`].
        #[serde(default)]
        details: bool,
    },
    /// Flies so many ticks, at most 6000. The answer is a [`Flown`].
    Fly {
        /// Number of ticks.
        ticks: u32,
        /// Orders that are given before the first of these ticks.
        #[serde(default)]
        orders: Vec<Order>,
    },
    /// Asks for hash and summary of the log so far. The answer is a [`Logged`].
    Log,
    /// Asks for the log so far. The answer is its bytes, as `sil-harness` writes them.
    Bytes,
}

/// The answer to [`Question::Begin`].
#[derive(Serialize)]
pub struct Begun<'a> {
    /// The flight's parameters and its field.
    header: &'a Header,
    /// Names of the aircraft that come with the project.
    aircraft: Vec<&'static str>,
}

/// The answer to [`Question::Fly`].
#[derive(Debug, Default, Serialize)]
pub struct Flown {
    /// The ticks that were flown.
    ticks: Columns,
    /// Plans that were taken over.
    plans: Vec<PlanEntry>,
    /// Planning cycles that began, if they are shown.
    details: Vec<PlanDetail>,
    /// Orders that took effect.
    orders: Vec<OrderEntry>,
    /// Orders that were refused, and why.
    refused: Vec<String>,
    /// Durations of the ticks that planned: sensors, planning cycle, step and plant \[ms\].
    planning: Vec<f64>,
    /// Whether the flight has ended.
    ended: bool,
}

/// The answer to [`Question::Log`].
#[derive(Debug, Serialize)]
pub struct Logged {
    /// The log's hash.
    hash: String,
    /// Ticks flown.
    ticks: u32,
    /// The flight's totals so far.
    summary: Summary,
}

/// One flight at a time.
pub struct Desk {
    clock: fn() -> f64,
    flight: Option<Flying>,
}

struct Flying {
    flight: Flight,
    world: World,
    link: PipeLink,
    tower: Tower,
}

/// What follows the flight and gives it orders.
struct Tower {
    clock: fn() -> f64,
    /// Time at which the tick began \[ms\].
    began: f64,
    orders: VecDeque<OrderEntry>,
    tick: u32,
    tuning: Option<Tuning>,
    details: bool,
    inspector: Option<Inspector>,
    news: Flown,
}

impl Ground for Tower {
    fn begin(&mut self, tuning: &Tuning, _: &VehicleState) {
        self.tuning = Some(*tuning);
    }

    fn orders(&mut self, tick: u32) -> Vec<Order> {
        self.tick = tick;
        let mut due = Vec::new();
        while let Some(entry) = self
            .orders
            .pop_front_if(|entry| entry.tick <= u64::from(tick))
        {
            due.push(entry.order);
        }
        due
    }

    fn settled(&mut self, order: &Order, result: Result<(), Refused>, tuning: &Tuning) {
        self.tuning = Some(*tuning);
        match result {
            Ok(()) => self.news.orders.push(OrderEntry {
                tick: u64::from(self.tick),
                order: order.clone(),
            }),
            Err(refused) => self.news.refused.push(refused.to_string()),
        }
    }

    fn watch(&mut self, record: &TickRecord<'_>) {
        if record.scan.is_some() {
            self.news.planning.push((self.clock)() - self.began);
        }
        self.news.ticks.push(record.tick);
        self.news.plans.extend(record.plan.cloned());
        let Some(tuning) = self.tuning.as_ref().filter(|_| self.details) else {
            return;
        };
        // The inspector does not exist before the first tick: until then any parameter may change.
        if self.inspector.is_none() {
            self.inspector = Inspector::new(tuning).ok();
        }
        let inspector = self.inspector.as_mut();
        let detail = inspector.and_then(|inspector| inspector.look(record, tuning));
        self.news.details.extend(detail);
    }
}

impl Flying {
    fn begin(scenario: &Scenario, mut tower: Tower) -> Result<Self, String> {
        let mut world = World::of(scenario).map_err(|error| error.to_string())?;
        let mut link = PipeLink::of(scenario);
        let flight = Flight::begin(&mut world, scenario, &mut link, &mut tower)
            .map_err(|error| error.to_string())?;
        Ok(Self {
            flight,
            world,
            link,
            tower,
        })
    }

    fn fly(&mut self, ticks: u32, orders: Vec<Order>) -> Result<Flown, String> {
        let tick = u64::from(self.flight.flown());
        for order in orders.into_iter().rev() {
            self.tower.orders.push_front(OrderEntry { tick, order });
        }
        for _ in 0..ticks.min(MOST_TICKS) {
            self.tower.began = (self.tower.clock)();
            let on = self
                .flight
                .tick(&mut self.world, &mut self.link, &mut self.tower);
            if !on.map_err(|error| error.to_string())? {
                break;
            }
        }
        self.tower.news.ended = self.flight.has_ended();
        Ok(std::mem::take(&mut self.tower.news))
    }

    fn logged(&self) -> Result<Logged, String> {
        Logged::of(&self.flight.log(&self.world))
    }
}

impl Logged {
    pub(crate) fn of(log: &FlightLog) -> Result<Self, String> {
        Ok(Self {
            hash: log.hash().map_err(|error| error.to_string())?,
            ticks: log.ticks.t.len() as u32,
            summary: log.summary,
        })
    }
}

impl Desk {
    /// A desk without a flight. The clock gives milliseconds.
    #[must_use]
    pub fn new(clock: fn() -> f64) -> Self {
        Self {
            clock,
            flight: None,
        }
    }

    /// Answers a question. Both are JSON. Instead of an answer that does not exist there is an object with
    /// the key `error`.
    pub fn answer(&mut self, question: &[u8]) -> Vec<u8> {
        told(self.try_to_answer(question))
    }

    fn try_to_answer(&mut self, question: &[u8]) -> Result<Vec<u8>, String> {
        let question = serde_json::from_slice(question).map_err(|error| error.to_string())?;
        if let Question::Begin {
            scenario,
            orders,
            details,
        } = question
        {
            return self.begin(&scenario, orders, details);
        }
        let flying = self.flight.as_mut().ok_or("no flight has begun")?;
        match question {
            Question::Fly { ticks, orders } => json(&flying.fly(ticks, orders)?),
            Question::Log => json(&flying.logged()?),
            Question::Bytes => {
                let log = flying.flight.log(&flying.world);
                log.to_json().map_err(|error| error.to_string())
            }
            _ => Err("a flight begins once".to_owned()),
        }
    }

    fn begin(
        &mut self,
        file: &ScenarioFile,
        orders: VecDeque<OrderEntry>,
        details: bool,
    ) -> Result<Vec<u8>, String> {
        let scenario = file.build().map_err(|error| error.to_string())?;
        let tower = Tower {
            clock: self.clock,
            began: 0.0,
            orders,
            tick: 0,
            tuning: None,
            details,
            inspector: None,
            news: Flown::default(),
        };
        let flying = Flying::begin(&scenario, tower)?;
        let answer = json(&Begun {
            header: flying.flight.header(),
            aircraft: AircraftFile::KNOWN.map(|(name, _)| name).to_vec(),
        });
        self.flight = Some(flying);
        answer
    }
}

/// The answer, or an object with the key `error`.
pub(crate) fn told(answer: Result<Vec<u8>, String>) -> Vec<u8> {
    answer.unwrap_or_else(|error| {
        let error = serde_json::json!({ "error": error });
        error.to_string().into_bytes()
    })
}

pub(crate) fn json(answer: &impl Serialize) -> Result<Vec<u8>, String> {
    serde_json::to_vec(answer).map_err(|error| error.to_string())
}
