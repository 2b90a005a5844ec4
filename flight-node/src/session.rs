//! A session: hello, configuration, ticks.

use crate::convert;
use hil_protocol::{
    ActuatorCommand, Configure, ConfigureReply, ConfigureVerdict, Decoder, Hello,
    LidarScan as WireScan, MAX_FRAME, Message, PlanReport, Rejection, RejectionCause, Role,
    SensorFrame as WireFrame, encode,
};
use mpp_core::config::{MAX_BEAMS, STAGES, TICK_PERIOD};
use mpp_core::estimate::{Innovation, Verdict};
use mpp_core::flight::FlightLoop;
use mpp_core::health::Health;
use mpp_core::planner::{PlanSummary, Planner};
use mpp_core::sense::LidarScan;

/// A flight under way.
struct Flight {
    configure: Configure,
    control: FlightLoop,
    last_tick: Option<u32>,
    /// The tick of the scan that the planner works on.
    cycle: Option<u32>,
    /// The tick of the last scan that started a cycle.
    last_cycle: Option<u32>,
    /// The tick of the trajectory being flown.
    plan_tick: Option<u32>,
    /// A checked scan that waits for its sensor frame.
    scan_tick: Option<u32>,
}

/// The core and its side of the link. Large: place it in a `static` or a box.
pub struct FlightNode {
    decoder: Decoder,
    buffer: [u8; MAX_FRAME],
    planner: Planner,
    scan: LidarScan,
    flight: Option<Flight>,
}

impl FlightNode {
    /// A node that waits for a hello.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            decoder: Decoder::new(),
            buffer: [0; MAX_FRAME],
            planner: Planner::new(),
            scan: LidarScan::new(),
            flight: None,
        }
    }

    /// Takes bytes from the link; `send` gets every frame of the answer, whole.
    pub fn receive(&mut self, bytes: &[u8], mut send: impl FnMut(&[u8])) {
        for byte in bytes {
            match self.decoder.push(*byte) {
                None => {}
                Some(Ok(message)) => self.handle(&message, &mut send),
                Some(Err(fault)) => self.reject(RejectionCause::Frame(fault), &mut send),
            }
        }
    }

    /// What went wrong so far in this flight; none before it is configured.
    #[must_use]
    pub fn health(&self) -> Option<&Health> {
        self.flight.as_ref().map(|flight| flight.control.health())
    }

    /// The planner, to look at between ticks.
    #[must_use]
    pub fn planner(&self) -> &Planner {
        &self.planner
    }

    fn handle(&mut self, message: &Message, send: &mut impl FnMut(&[u8])) {
        match message {
            Message::Hello(_) => self.greet(send),
            Message::Configure(configure) => self.configure(configure, send),
            Message::LidarScan(scan) => self.take_scan(scan, send),
            Message::SensorFrame(frame) => self.tick(frame, send),
            other => self.reject(RejectionCause::UnexpectedMessage { id: other.id() }, send),
        }
    }

    fn emit(&mut self, message: &Message, send: &mut impl FnMut(&[u8])) {
        // The buffer holds the longest message, so this cannot fail.
        if let Ok(frame) = encode(message, &mut self.buffer) {
            send(frame);
        }
    }

    fn reject(&mut self, cause: RejectionCause, send: &mut impl FnMut(&[u8])) {
        let tick = self
            .flight
            .as_ref()
            .and_then(|flight| flight.last_tick)
            .unwrap_or(0);
        self.emit(&Message::Rejection(Rejection { tick, cause }), send);
    }

    /// A hello starts a session anew, wherever the last one was.
    fn greet(&mut self, send: &mut impl FnMut(&[u8])) {
        self.flight = None;
        let hello = Hello {
            role: Role::Core,
            software: software(),
            tick_period_us: (TICK_PERIOD * 1e6) as u32,
            beams_max: MAX_BEAMS as u16,
            stages: STAGES as u16,
        };
        self.emit(&Message::Hello(hello), send);
    }

    fn configure(&mut self, configure: &Configure, send: &mut impl FnMut(&[u8])) {
        let verdict = match self.set_up(configure) {
            Ok(flight) => {
                self.flight = Some(flight);
                ConfigureVerdict::Accepted
            }
            Err(verdict) => verdict,
        };
        self.emit(&Message::ConfigureReply(ConfigureReply { verdict }), send);
    }

    fn set_up(&mut self, configure: &Configure) -> Result<Flight, ConfigureVerdict> {
        if self.flight.is_some() {
            return Err(ConfigureVerdict::AlreadyConfigured);
        }
        let settings = convert::settings(configure)?;
        let control = FlightLoop::new(&settings).map_err(convert::setup_verdict)?;
        self.planner
            .set_up(&settings)
            .map_err(convert::setup_verdict)?;
        Ok(Flight {
            configure: *configure,
            control,
            last_tick: None,
            cycle: None,
            last_cycle: None,
            plan_tick: None,
            scan_tick: None,
        })
    }

    fn take_scan(&mut self, wire: &WireScan, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return self.reject(RejectionCause::NotConfigured, send);
        };
        let (beams, range_max) = (flight.configure.beams, flight.configure.range_max);
        convert::scan(wire, &mut self.scan);
        match self.scan.check(usize::from(beams), f64::from(range_max)) {
            Ok(()) => flight.scan_tick = Some(wire.tick),
            Err(error) => {
                flight.scan_tick = None;
                self.reject(convert::scan_rejection(error), send);
            }
        }
    }

    /// One tick, as the crate's documentation describes it.
    fn tick(&mut self, frame: &WireFrame, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return self.reject(RejectionCause::NotConfigured, send);
        };
        let expected = flight
            .last_tick
            .map_or(frame.tick, |last| last.saturating_add(1));
        if frame.tick != expected {
            let found = frame.tick;
            self.reject(RejectionCause::TickOrder { expected, found }, send);
            if found < expected {
                // An old frame: the step for it has been made.
                return;
            }
        }
        self.take_over(frame.tick, send);
        self.step(frame, send);
        self.start_cycle(frame.tick, send);
        self.run_planner();
    }

    /// Finishes the cycle whose latency has passed and takes over its trajectory.
    fn take_over(&mut self, tick: u32, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return;
        };
        let Some(scan_tick) = flight.cycle else {
            return;
        };
        if tick < scan_tick.saturating_add(flight.configure.latency_ticks) {
            return;
        }
        flight.cycle = None;
        let verdict = self.planner.finish();
        let adoption = flight
            .control
            .adopt(time(tick), verdict, self.planner.best());
        let outcome = convert::outcome(adoption);
        if flight.control.trajectory().is_none() {
            flight.plan_tick = None;
        } else if outcome != hil_protocol::PlanOutcome::KeptPrevious {
            flight.plan_tick = Some(scan_tick);
        }
        let PlanSummary {
            candidates,
            feasible,
            tree_runs,
            slices,
            complete,
            cost,
            violation,
            ..
        } = *self.planner.summary();
        let report = PlanReport {
            scan_tick,
            used_from_tick: tick,
            outcome,
            candidates: candidates as u16,
            feasible: feasible as u16,
            tree_runs: tree_runs as u16,
            slices: slices as u32,
            cost,
            violation,
            complete,
        };
        self.emit(&Message::PlanReport(report), send);
    }

    fn step(&mut self, frame: &WireFrame, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return;
        };
        flight.last_tick = Some(frame.tick);
        let output = flight
            .control
            .step(time(frame.tick), &convert::sensor_frame(frame));
        let age = flight
            .plan_tick
            .map_or(0, |plan| frame.tick.saturating_sub(plan));
        let report = convert::step_report(frame.tick, age, flight.control.estimate(), &output);
        let command = ActuatorCommand {
            tick: frame.tick,
            thrust: output.control.thrust,
            elevator: output.control.elevator,
            mode: convert::mode(output.mode),
        };
        if let Some(cause) = measurement_rejection(output.innovation, output.position_used) {
            self.reject(cause, send);
        }
        self.emit(&Message::StepReport(report), send);
        self.emit(&Message::ActuatorCommand(command), send);
    }

    /// Starts a cycle from the scan of this tick, if one is due.
    fn start_cycle(&mut self, tick: u32, send: &mut impl FnMut(&[u8])) {
        let Some(flight) = &mut self.flight else {
            return;
        };
        let Some(scan_tick) = flight.scan_tick.take() else {
            return;
        };
        if scan_tick != tick {
            let cause = RejectionCause::TickOrder {
                expected: tick,
                found: scan_tick,
            };
            return self.reject(cause, send);
        }
        let period = flight.configure.replan_period_ticks;
        if flight
            .last_cycle
            .is_some_and(|last| tick < last.saturating_add(period))
        {
            return;
        }
        flight.cycle = Some(tick);
        flight.last_cycle = Some(tick);
        self.planner
            .begin(time(tick), &flight.control.state(), &self.scan);
    }

    fn run_planner(&mut self) {
        let slices = self
            .flight
            .as_ref()
            .map_or(0, |flight| flight.configure.slices_per_tick);
        for _ in 0..slices {
            if !self.planner.advance() {
                break;
            }
        }
    }
}

impl Default for FlightNode {
    fn default() -> Self {
        Self::new()
    }
}

/// Time of a tick [s].
fn time(tick: u32) -> f64 {
    f64::from(tick) * TICK_PERIOD
}

/// This crate's version.
fn software() -> [u8; 3] {
    let part = |text: &str| text.parse().unwrap_or(0);
    [
        part(env!("CARGO_PKG_VERSION_MAJOR")),
        part(env!("CARGO_PKG_VERSION_MINOR")),
        part(env!("CARGO_PKG_VERSION_PATCH")),
    ]
}

fn measurement_rejection(innovation: Innovation, position_used: bool) -> Option<RejectionCause> {
    let Innovation { airspeed, pitch } = innovation;
    if !position_used || airspeed == Verdict::NotFinite || pitch == Verdict::NotFinite {
        Some(RejectionCause::NonFiniteSensor)
    } else if airspeed == Verdict::Gated || pitch == Verdict::Gated {
        Some(RejectionCause::InnovationGate {
            airspeed: airspeed == Verdict::Gated,
            pitch: pitch == Verdict::Gated,
        })
    } else {
        None
    }
}
