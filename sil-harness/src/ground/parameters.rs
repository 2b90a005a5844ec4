//! The parameter protocol: lists, reads and writes.
//!
//! A value is sent as a 32-bit float. A station that has asked for the vehicle's version knows from there that whole
//! numbers come as the bytes of an integer, and gets them so. A value that comes back unchanged changes nothing. Any
//! other float means the decimal number that a person would have typed.

use super::channels::Channel;
use super::metadata::is_whole;
use super::severity::Severity;
use super::vehicle::{Vehicle, Waiting};
use hil_protocol::ParameterVerdict;
use hil_protocol::mavlink::messages::*;
use hil_protocol::mavlink::{CharArray, text};
use mpp_node::parameters::{self, PARAMETERS, Tuning};
use mpp_sim::orders::{Order, Refused};

/// MAV_PARAM_TYPE: integers of 8, 16 and 32 bits without and with a sign, and the float of 32 bits.
const UINT8: u8 = 1;
const INT8: u8 = 2;
const UINT16: u8 = 3;
const INT16: u8 = 4;
const UINT32: u8 = 5;
const INT32: u8 = 6;
const REAL32: u8 = 9;
/// MAV_PARAM_ERROR_DOES_NOT_EXIST, _VALUE_OUT_OF_RANGE and _PERMISSION_DENIED.
const UNKNOWN: u8 = 1;
const OUT_OF_RANGE: u8 = 2;
const NOT_NOW: u8 = 3;

/// Why a write is refused, as MAVLink says it. `NOT_NOW` says that another value would be refused too.
fn code(refused: Refused) -> u8 {
    match refused {
        Refused::Parameter(
            ParameterVerdict::InFlight
            | ParameterVerdict::PathsInFlight
            | ParameterVerdict::CruiseFixed,
        ) => NOT_NOW,
        Refused::UnknownParameter | Refused::Parameter(ParameterVerdict::Unknown) => UNKNOWN,
        _ => OUT_OF_RANGE,
    }
}

impl Vehicle {
    /// Answers a request for the whole list.
    pub(super) fn list_parameters(&mut self) {
        self.parameters.begin(present(self.tuning.as_ref()));
    }

    pub(super) fn read_parameter(&mut self, request: &PARAM_REQUEST_READ_DATA) {
        let present = present(self.tuning.as_ref());
        let number = match usize::try_from(request.param_index) {
            Ok(index) => present.get(index).copied(),
            Err(_) => number(&request.param_id).filter(|number| present.contains(number)),
        };
        match number {
            Some(number) => self.send_parameter(number),
            None => self.refuse_parameter(request.param_id, request.param_index, UNKNOWN),
        }
    }

    pub(super) fn write_parameter(&mut self, write: &PARAM_SET_DATA) {
        let name = write.param_id.to_str().unwrap_or("?").to_owned();
        let number = number(&write.param_id);
        let current = number.and_then(|number| self.tuning.as_ref()?.value(number));
        let (Some(number), Some(current)) = (number, current) else {
            self.say(Severity::Warning, &format!("{name}: no such parameter"));
            self.refuse_parameter(write.param_id, -1, UNKNOWN);
            return;
        };
        let value = match integer(write.param_value, write.param_type) {
            Some(value) => value,
            None if (current as f32).to_bits() == write.param_value.to_bits() => current,
            None => decimal(write.param_value),
        };
        if value.to_bits() == current.to_bits() {
            self.send_parameter(number);
            return;
        }
        self.order(Order::Parameter { name, value }, Waiting::Parameter(number));
    }

    /// Answers a write with the value in force, whether or not the write took effect.
    pub(super) fn answer_write(&mut self, number: u8, result: Result<(), Refused>) {
        self.send_parameter(number);
        if let (Err(refused), Some(parameter)) = (result, PARAMETERS.get(usize::from(number))) {
            self.say(Severity::Warning, &format!("{}: {refused}", parameter.name));
            self.refuse_parameter(text(parameter.name), -1, code(refused));
        }
    }

    fn refuse_parameter(&mut self, param_id: CharArray<16>, param_index: i16, error: u8) {
        self.send(&PARAM_ERROR_DATA {
            param_id,
            param_index,
            error,
            ..PARAM_ERROR_DATA::DEFAULT
        });
    }

    pub(super) fn send_parameter(&mut self, number: u8) {
        let present = present(self.tuning.as_ref());
        let value = self.tuning.as_ref().and_then(|tuning| tuning.value(number));
        let index = present.iter().position(|other| *other == number);
        let parameter = PARAMETERS.get(usize::from(number));
        if let (Some(value), Some(index), Some(parameter)) = (value, index, parameter) {
            let as_float = PARAM_VALUE_DATA {
                param_id: text(parameter.name),
                param_value: value as f32,
                param_type: REAL32,
                param_count: present.len() as u16,
                param_index: index as u16,
            };
            let is_whole = is_whole(parameter);
            let as_bytes = PARAM_VALUE_DATA {
                param_value: f32::from_bits(value as i32 as u32),
                param_type: INT32,
                ..as_float.clone()
            };
            let wants_bytes = |channel: &Channel| is_whole && channel.typed;
            self.send_where(&as_float, true, |channel| !wants_bytes(channel));
            self.send_where(&as_bytes, false, wants_bytes);
        }
    }
}

/// The number in the bytes of a written value, if its type is that of an integer.
fn integer(value: f32, kind: u8) -> Option<f64> {
    let [a, b, c, d] = value.to_bits().to_le_bytes();
    match kind {
        UINT8 => Some(f64::from(a)),
        INT8 => Some(f64::from(i8::from_le_bytes([a]))),
        UINT16 => Some(f64::from(u16::from_le_bytes([a, b]))),
        INT16 => Some(f64::from(i16::from_le_bytes([a, b]))),
        UINT32 => Some(f64::from(u32::from_le_bytes([a, b, c, d]))),
        INT32 => Some(f64::from(i32::from_le_bytes([a, b, c, d]))),
        _ => None,
    }
}

/// Numbers of the parameters that this preset has. The place in this list is MAVLink's index.
fn present(tuning: Option<&Tuning>) -> Vec<u8> {
    let numbers = 0..PARAMETERS.len() as u8;
    numbers
        .filter(|number| tuning.is_some_and(|tuning| tuning.value(*number).is_some()))
        .collect()
}

/// The number of the parameter with this name.
fn number(name: &CharArray<16>) -> Option<u8> {
    parameters::number(name.to_str().ok()?)
}

/// The shortest decimal number that gives this float: 0.1, not 0.10000000149.
pub(super) fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_float_means_what_was_typed() {
        for (float, double) in [
            (0.1_f32, 0.1_f64),
            (1e-9, 1e-9),
            (12.0, 12.0),
            (-0.35, -0.35),
        ] {
            assert_eq!(decimal(float).to_bits(), double.to_bits());
        }
        assert!(decimal(f32::NAN).is_nan());
        assert!(decimal(f32::INFINITY).is_infinite());
    }

    #[test]
    fn names_fit_and_are_unique() {
        for (place, parameter) in PARAMETERS.iter().enumerate() {
            assert!(parameter.name.len() <= 16, "{}", parameter.name);
            assert_eq!(number(&text(parameter.name)), Some(place as u8));
        }
    }
}
