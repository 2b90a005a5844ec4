//! Key files, and the times of signatures beside them.

use crate::common::{run_in, scratch, talk};
use hil_protocol::mavlink::messages::COMMAND_LONG_DATA;
use hil_protocol::mavlink::{Key, Sender, Signer};
use mpp_sim::navigation::NavigationConfig;
use sil_harness::ground::home::Home;
use sil_harness::ground::transport::{Transport, signing_time};
use sil_harness::ground::vehicle::{Vehicle, VehicleConfig};
use std::net::UdpSocket;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

#[test]
fn a_key_that_others_can_read_is_warned_of_and_a_foreign_state_refused() {
    let directory = scratch("keys");
    let (key, state) = (directory.join("key"), directory.join("key.state"));
    std::fs::write(&key, "secret\n").unwrap();
    let flags = "fly --duration 1 --speed max --mavlink udp:127.0.0.1:9 --mavlink-key key --out .";
    let flags: Vec<&str> = flags.split(' ').collect();
    for (mode, warned) in [(0o644, true), (0o640, true), (0o600, false)] {
        std::fs::set_permissions(&key, std::fs::Permissions::from_mode(mode)).unwrap();
        let output = run_in(&directory, &flags);
        assert!(output.status.success(), "{}", talk(&output));
        assert_eq!(talk(&output).contains("chmod 600 key"), warned, "{mode:o}");
        assert!(state.exists());
    }
    std::fs::write(&state, "a poem").unwrap();
    let output = run_in(&directory, &flags);
    assert_eq!(output.status.code(), Some(2), "{}", talk(&output));
    assert!(
        talk(&output).contains("key.state: line 1"),
        "{}",
        talk(&output)
    );
    assert_eq!(std::fs::read_to_string(&state).unwrap(), "a poem");
    std::fs::remove_dir_all(directory).unwrap();
}

/// A vehicle that waits to be armed by whoever holds the key, and the station's socket.
fn vehicle(state: &Path) -> (Transport, UdpSocket) {
    let vehicle = Vehicle::new(&VehicleConfig {
        instance: 0,
        patience: None,
        hold: true,
        key: Some((Key::of_passphrase("secret"), signing_time())),
        home: Home::ZURICH,
        navigation: NavigationConfig::RTK,
    });
    let mut transport = Transport::new(vehicle, |_| {});
    let station = UdpSocket::bind("127.0.0.1:0").unwrap();
    transport
        .connect(vec![station.local_addr().unwrap()])
        .unwrap();
    transport.remember(state).unwrap();
    (transport, station)
}

/// Whether the vehicle is armed after it got this datagram. It then ends its flight.
fn obeys(state: &Path, datagram: &[u8]) -> bool {
    let (transport, armed) = hears(state, datagram);
    transport.end("here").unwrap();
    armed
}

/// A vehicle that got this datagram, and whether it is armed.
fn hears(state: &Path, datagram: &[u8]) -> (Transport, bool) {
    use mpp_sim::orders::Ground;
    let (mut transport, station) = vehicle(state);
    // It speaks first, so that the station knows where it is.
    (0..100).for_each(|_| transport.hold());
    let (_, vehicle) = station.recv_from(&mut [0; 300]).unwrap();
    station.send_to(datagram, vehicle).unwrap();
    transport.orders(0);
    let armed = transport.ready();
    (transport, armed)
}

#[test]
fn what_was_recorded_in_one_flight_is_not_obeyed_in_the_next() {
    let directory = scratch("repeated");
    let state = directory.join("key.state");
    let mut signer = Signer::new(Key::of_passphrase("secret"), 1, signing_time());
    let arm = COMMAND_LONG_DATA {
        command: 400,
        param1: 1.0,
        ..COMMAND_LONG_DATA::DEFAULT
    };
    let mut arm = || Sender::new(255, 190).signed_frame(&arm, &mut signer);
    let recorded = arm();
    assert!(obeys(&state, recorded.as_bytes()));
    assert!(!obeys(&state, recorded.as_bytes()));
    assert!(obeys(&state, arm().as_bytes()));
    // A vehicle that crashed has not ended its flight.
    let recorded = arm();
    let (crashed, armed) = hears(&state, recorded.as_bytes());
    drop(crashed);
    assert!(armed && !obeys(&state, recorded.as_bytes()));
    std::fs::remove_dir_all(directory).unwrap();
}

/// One socket serves one kind of addresses. The other station would never hear a word.
#[test]
fn addresses_of_two_kinds_are_refused() {
    let output = run_in(
        &scratch("kinds"),
        &[
            "fly",
            "--duration",
            "1",
            "--mavlink",
            "udp:127.0.0.1:9,udp:[::1]:9",
        ],
    );
    assert!(!output.status.success());
    assert!(
        talk(&output).contains("give addresses of one kind"),
        "{}",
        talk(&output)
    );
}
