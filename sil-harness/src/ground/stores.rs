//! Answers of a vehicle that stores nothing: no files, no logs. A station that gets no answer waits for seconds.

use super::demands::Address;
use super::vehicle::Vehicle;
use hil_protocol::mavlink::messages::{
    FILE_TRANSFER_PROTOCOL_DATA, LOG_ENTRY_DATA, LOG_REQUEST_LIST_DATA,
};

/// Places in the payload of the file transfer protocol.
const SEQUENCE: usize = 0;
const SESSION: usize = 2;
const OPCODE: usize = 3;
const SIZE: usize = 4;
const REQUESTED: usize = 5;
const DATA: usize = 12;
/// Opcodes of requests, and of answers.
const TERMINATE_SESSION: u8 = 1;
const RESET_SESSIONS: u8 = 2;
const OPEN_FILE: u8 = 4;
const ACK: u8 = 128;
const NAK: u8 = 129;
/// Errors of answers.
const UNKNOWN_COMMAND: u8 = 7;
const FILE_NOT_FOUND: u8 = 10;

impl Vehicle {
    /// Tells that there are no logs.
    pub(super) fn list_logs(&mut self, request: &LOG_REQUEST_LIST_DATA) {
        if self.is_target(request.target_system, request.target_component) {
            self.send(&LOG_ENTRY_DATA::DEFAULT);
        }
    }

    /// Refuses a request for files. The end of sessions, of which there are none, is acknowledged.
    pub(super) fn answer_file_request(
        &mut self,
        request: &FILE_TRANSFER_PROTOCOL_DATA,
        to: Address,
    ) {
        let asked = request.payload[OPCODE];
        if !self.is_target(request.target_system, request.target_component) || asked >= ACK {
            return;
        }
        let sequence =
            u16::from_le_bytes([request.payload[SEQUENCE], request.payload[SEQUENCE + 1]]);
        let mut payload = [0; 251];
        payload[SEQUENCE..SESSION].copy_from_slice(&sequence.wrapping_add(1).to_le_bytes());
        payload[SESSION] = request.payload[SESSION];
        payload[REQUESTED] = asked;
        if asked == TERMINATE_SESSION || asked == RESET_SESSIONS {
            payload[OPCODE] = ACK;
        } else {
            payload[OPCODE] = NAK;
            payload[SIZE] = 1;
            payload[DATA] = if asked == OPEN_FILE {
                FILE_NOT_FOUND
            } else {
                UNKNOWN_COMMAND
            };
        }
        self.send(&FILE_TRANSFER_PROTOCOL_DATA {
            target_network: 0,
            target_system: to.system,
            target_component: to.component,
            payload,
        });
    }
}
