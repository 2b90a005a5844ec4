//! What comes before a sensor frame: attitude, position and points.

use super::SpaceTask;
use hil_protocol::{DecodeError, InertialFrame, PointPacket, RejectionCause, SpacePosition};

impl SpaceTask {
    pub(super) fn take_inertial(&mut self, told: &InertialFrame, send: &mut impl FnMut(&[u8])) {
        match &mut self.session {
            Some(session) => session.inertial = Some(*told),
            None => self.reject(RejectionCause::NotConfigured, send),
        }
    }

    pub(super) fn take_position(&mut self, told: &SpacePosition, send: &mut impl FnMut(&[u8])) {
        match &mut self.session {
            Some(session) => session.position = Some(*told),
            None => self.reject(RejectionCause::NotConfigured, send),
        }
    }

    // Not inlined, so that the packet lies on no other stack.
    #[inline(never)]
    pub(super) fn take_points(&mut self, send: &mut impl FnMut(&[u8])) -> Result<(), DecodeError> {
        let packet: PointPacket = self.decoder.body()?;
        let taken = match self.session {
            Some(_) => self.sweep.take(&packet),
            None => Err(RejectionCause::NotConfigured),
        };
        if let Err(cause) = taken {
            self.reject(cause, send);
        }
        Ok(())
    }
}
