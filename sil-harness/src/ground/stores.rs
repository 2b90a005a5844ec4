//! Answers about files and logs. There are no logs. A station that gets no answer waits for seconds.

use super::demands::Address;
use super::files::{DATA, FileReply, HEAD, Request};
use super::vehicle::Vehicle;
use hil_protocol::mavlink::messages::{
    FILE_TRANSFER_PROTOCOL_DATA, LOG_ENTRY_DATA, LOG_REQUEST_LIST_DATA,
};

/// Opcodes of answers.
const ACK: u8 = 128;
const NAK: u8 = 129;

impl Vehicle {
    /// Tells that there are no logs.
    pub(super) fn list_logs(&mut self, request: &LOG_REQUEST_LIST_DATA) {
        if self.is_target(request.target_system, request.target_component) {
            self.send(&LOG_ENTRY_DATA::DEFAULT);
        }
    }

    /// Answers a request for files.
    pub(super) fn answer_file_request(
        &mut self,
        request: &FILE_TRANSFER_PROTOCOL_DATA,
        to: Address,
    ) {
        let is_ours = self.is_target(request.target_system, request.target_component);
        let request = Request::of(&request.payload);
        if !is_ours || request.opcode >= ACK {
            return;
        }
        match self.files.answer(&request, to) {
            Ok(replies) => {
                for reply in &replies {
                    self.send_file_reply(&request, ACK, reply, to);
                }
            }
            Err(refusal) => {
                let reply = FileReply::of(vec![refusal as u8]);
                self.send_file_reply(&request, NAK, &reply, to);
            }
        }
    }

    fn send_file_reply(&mut self, request: &Request, opcode: u8, reply: &FileReply, to: Address) {
        let after = reply.number.wrapping_add(1);
        let sequence = request.sequence.wrapping_add(after).to_le_bytes();
        let offset = reply.offset.to_le_bytes();
        let size = reply.data.len() as u8;
        let last = u8::from(reply.is_last);
        let head = [opcode, size, request.opcode, last, 0];
        let mut payload = [0; HEAD + DATA];
        let bytes = sequence
            .iter()
            .chain([&request.session])
            .chain(&head)
            .chain(&offset)
            .chain(&reply.data);
        for (place, byte) in payload.iter_mut().zip(bytes) {
            *place = *byte;
        }
        self.send_to_station(
            &FILE_TRANSFER_PROTOCOL_DATA {
                target_network: 0,
                target_system: to.system,
                target_component: to.component,
                payload,
            },
            to,
        );
    }
}
