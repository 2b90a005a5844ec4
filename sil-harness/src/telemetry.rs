//! MAVLink 2 telemetry of a flight, over UDP to a ground station.

use crate::run::Moment;
use crate::scenario::TICKS_PER_SECOND;
use hil_protocol::telemetry::{Datagram, MavSeverity, Telemetry};
use std::io;
use std::net::UdpSocket;

/// Ticks from a position to the next: 10 Hz, a ground station's customary rate.
const POSITION_TICKS: u32 = TICKS_PER_SECOND / 10;

/// Largest thrust that the throttle display knows [N]: it only scales a percentage.
const FULL_THROTTLE: f64 = 15.0;

/// A one-way link to a ground station.
///
/// Nobody needs to listen: datagrams that cannot be delivered are lost, and the flight goes on.
pub struct TelemetryLink {
    socket: UdpSocket,
    telemetry: Telemetry,
}

impl TelemetryLink {
    /// Opens a socket towards `HOST:PORT`.
    ///
    /// # Errors
    /// When the address does not resolve or no socket is to be had.
    pub fn open(address: &str) -> io::Result<Self> {
        let socket = UdpSocket::bind("0.0.0.0:0")?;
        socket.connect(address)?;
        Ok(Self {
            socket,
            telemetry: Telemetry::new(),
        })
    }

    /// Sends what is due at a tick: heartbeat at 1 Hz, attitude and position at 10 Hz, and a text
    /// for each plan.
    pub fn send(&mut self, moment: &Moment<'_>) {
        let tick = moment.tick;
        let milliseconds = (tick.t * 1e3).round() as u32;
        let number = milliseconds / (1000 / TICKS_PER_SECOND);
        if number.is_multiple_of(TICKS_PER_SECOND) {
            let heartbeat = self.telemetry.heartbeat(true, true);
            self.deliver(&heartbeat);
        }
        if number.is_multiple_of(POSITION_TICKS) {
            let air = &tick.estimate;
            let (climb_share, forward_share) = libm::sincos(air.flight_path);
            let (climb, forward) = (air.airspeed * climb_share, air.airspeed * forward_share);
            let throttle = (tick.control.thrust / FULL_THROTTLE * 100.0).clamp(0.0, 100.0) as u16;
            let (x, z) = (tick.state.x, tick.state.z);
            let attitude = self
                .telemetry
                .attitude(milliseconds, air.pitch, air.pitch_rate);
            let position = self
                .telemetry
                .local_position_ned(milliseconds, x, z, forward, climb);
            let hud = self
                .telemetry
                .vfr_hud(air.airspeed, forward, z, climb, throttle);
            for datagram in [attitude, position, hud] {
                self.deliver(&datagram);
            }
        }
        if let Some(plan) = moment.plan {
            let severity = match plan.outcome.as_str() {
                "Adopted" => MavSeverity::MAV_SEVERITY_INFO,
                _ => MavSeverity::MAV_SEVERITY_WARNING,
            };
            let text = format!(
                "MPP {}: {}/{}",
                plan.outcome, plan.feasible, plan.candidates
            );
            let text = self.telemetry.status_text(severity, &text);
            self.deliver(&text);
        }
    }

    fn deliver(&self, datagram: &Datagram) {
        // A ground station that is not there yet answers "refused"; it may come later.
        let _ = self.socket.send(datagram.as_bytes());
    }
}
