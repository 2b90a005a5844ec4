//! Questions about one flight in space, and their answers.

use crate::desk::{Logged, MOST_TICKS, json, told};
use mpp_sim::log::Header;
use mpp_sim::orders::{Order, OrderEntry};
use mpp_sim::space::world::Body;
use mpp_sim::space::{
    Moment, SpaceCycle, SpaceFile, SpaceFlight, SpacePipe, SpaceScenario, moment,
};
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// A question, as JSON with the key `ask`. They are those of [`desk::Question`](crate::desk::Question) in space.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Question {
    /// Begins a flight. The answer is a [`Begun`].
    Begin {
        /// The flight, with the keys of a scenario file in space.
        #[serde(default)]
        scenario: Box<SpaceFile>,
        /// Orders that are given at their ticks.
        #[serde(default)]
        orders: VecDeque<OrderEntry>,
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
pub struct Begun {
    /// The flight's parameters.
    header: Header,
    /// Trunks: place ahead and to the right, and radius \[m\].
    trunks: Vec<[f64; 3]>,
    /// Span of the wing \[m\].
    span: f64,
    /// State at the start, as in [`Flown`].
    state: Moment,
}

/// The answer to [`Question::Fly`].
#[derive(Debug, Default, Serialize)]
pub struct Flown {
    /// The state after each tick.
    states: Vec<Moment>,
    /// Planning cycles that began.
    cycles: Vec<SpaceCycle>,
    /// Orders that took effect.
    orders: Vec<OrderEntry>,
    /// Orders that were refused, and why.
    refused: Vec<String>,
    /// Durations of the ticks that planned \[ms\].
    planning: Vec<f64>,
    /// Whether the flight has ended.
    ended: bool,
}

/// One flight in space at a time.
pub struct Desk {
    clock: fn() -> f64,
    flight: Option<Flying>,
}

struct Flying {
    scenario: SpaceScenario,
    link: SpacePipe,
    flight: SpaceFlight,
    orders: VecDeque<OrderEntry>,
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
        if let Question::Begin { scenario, orders } = question {
            let flying = Flying::begin(&scenario, orders)?;
            let answer = json(&flying.begun());
            self.flight = Some(flying);
            return answer;
        }
        let flying = self.flight.as_mut().ok_or("no flight has begun")?;
        match question {
            Question::Fly { ticks, orders } => json(&flying.fly(ticks, &orders, self.clock)?),
            Question::Log => json(&Logged::of(&flying.flight.log())?),
            _ => (flying.flight.log().to_json()).map_err(|error| error.to_string()),
        }
    }
}

impl Flying {
    fn begin(file: &SpaceFile, orders: VecDeque<OrderEntry>) -> Result<Self, String> {
        let scenario = file.build(None).map_err(|error| error.to_string())?;
        let mut link = SpacePipe::of(&scenario);
        let flight = SpaceFlight::begin(&scenario, &mut link).map_err(|error| error.to_string())?;
        Ok(Self {
            scenario,
            link,
            flight,
            orders,
        })
    }

    fn begun(&self) -> Begun {
        let trunk = |body: &Body| match *body {
            Body::Cylinder { x, y, radius, .. } => Some([x, y, radius]),
            _ => None,
        };
        Begun {
            header: self.scenario.header(),
            trunks: self
                .scenario
                .world
                .bodies()
                .iter()
                .filter_map(trunk)
                .collect(),
            span: 2.0 * self.scenario.hull().half_span,
            state: moment(&self.flight),
        }
    }

    fn fly(&mut self, ticks: u32, orders: &[Order], clock: fn() -> f64) -> Result<Flown, String> {
        let mut news = Flown::default();
        for order in orders {
            self.obey(order.clone(), &mut news);
        }
        for _ in 0..ticks.min(MOST_TICKS) {
            if self.flight.has_ended() {
                break;
            }
            let tick = u64::from(self.flight.flown());
            while let Some(entry) = self.orders.pop_front_if(|entry| entry.tick <= tick) {
                self.obey(entry.order, &mut news);
            }
            let began = clock();
            (self.flight.tick(&self.scenario, &mut self.link))
                .map_err(|error| error.to_string())?;
            news.states.push(moment(&self.flight));
            let took = clock() - began;
            if let Some(cycle) = SpaceCycle::of(&self.scenario, &self.flight, &self.link) {
                news.planning.push(took);
                news.cycles.push(cycle);
            }
        }
        news.ended = self.flight.has_ended();
        Ok(news)
    }

    fn obey(&mut self, order: Order, news: &mut Flown) {
        let tick = u64::from(self.flight.flown());
        match self.flight.obey(&self.scenario, &order) {
            Ok(()) => news.orders.push(OrderEntry { tick, order }),
            Err(refused) => news.refused.push(refused.to_string()),
        }
    }
}
