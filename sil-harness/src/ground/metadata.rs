//! What the vehicle says about its parameters, in the files that MAVLink's component metadata names.

use crc::{Algorithm, Crc};
use mpp_node::parameters::{PARAMETERS, Parameter};
use serde_json::{Value, json};

/// Where a station finds the first file.
pub(super) const GENERAL_URI: &str = "mftp:///general.json";
/// COMP_METADATA_TYPE_PARAMETER.
const ABOUT_PARAMETERS: u8 = 1;

/// The sum of MAVLink's file transfer: that of Ethernet, but from 0 on, and without the inversion at the end.
const FILE_SUM: Algorithm<u32> = Algorithm {
    init: 0,
    xorout: 0,
    ..crc::CRC_32_ISO_HDLC
};
static SUM: Crc<u32> = Crc::<u32>::new(&FILE_SUM);

/// A file that stations can read.
pub(super) struct File {
    /// Its name, without a folder.
    pub(super) name: &'static str,
    pub(super) bytes: Vec<u8>,
}

impl File {
    /// The checksum by which stations know a file again.
    pub(super) fn sum(&self) -> u32 {
        SUM.checksum(&self.bytes)
    }
}

/// All files: the one that names the others, and the one about the parameters.
pub(super) fn files() -> [File; 2] {
    let parameters = File {
        name: "parameter.json",
        bytes: parameters().to_string().into_bytes(),
    };
    let general = json!({
        "version": 1,
        "metadataTypes": [{
            "type": ABOUT_PARAMETERS,
            "uri": format!("mftp:///{}", parameters.name),
            "fileCrc": parameters.sum(),
        }],
    });
    let general = File {
        name: "general.json",
        bytes: general.to_string().into_bytes(),
    };
    [general, parameters]
}

fn parameters() -> Value {
    let all: Vec<Value> = PARAMETERS.iter().map(describe).collect();
    json!({ "version": 1, "parameters": all })
}

fn describe(parameter: &Parameter) -> Value {
    let [least, most] = parameter.range;
    let group = parameter.name.split('_').next().unwrap_or_default();
    let when = if parameter.in_flight {
        "Can change in flight."
    } else {
        "Can change before the flight only."
    };
    let mut entry = json!({
        "name": parameter.name,
        "type": if is_whole(parameter) { "Int32" } else { "Float" },
        "group": group,
        "units": parameter.unit,
        "longDesc": when,
        "min": least,
        "max": most,
    });
    if let (Some(step), Some(entry)) = (parameter.step, entry.as_object_mut()) {
        entry.insert("increment".to_owned(), json!(step));
    }
    entry
}

/// Whether a parameter counts something.
pub(super) fn is_whole(parameter: &Parameter) -> bool {
    let step = parameter.step;
    step.is_some_and(|step| (1.0..=1.0).contains(&step))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value of the other end's definition: from 0, `123456789` gives this sum.
    #[test]
    fn the_sum_is_that_of_the_file_transfer() {
        let file = File {
            name: "check",
            bytes: b"123456789".to_vec(),
        };
        assert_eq!(file.sum(), 0x2DFD_2D88);
    }
}
