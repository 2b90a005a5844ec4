//! A core in another process, and a listener of the telemetry.

use crate::common::{harness, run, scratch};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpStream, UdpSocket};
use std::path::PathBuf;
use std::process::{Child, Output, Stdio};
use std::time::Duration;

#[test]
fn a_core_that_is_not_there_is_a_link_error() {
    // A port that was free a moment ago.
    let port = std::net::TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap()
        .port();
    let (output, _) = run("nobody", &["--link", &format!("tcp:127.0.0.1:{port}")]);
    let talk = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(6), "{talk}");
    assert!(
        talk.contains("connecting to the core at 127.0.0.1"),
        "{talk}"
    );
}

/// A core in another process that serves once, and its address for `--link`.
fn serving(flags: &[&str]) -> (Child, String) {
    let mut core = harness()
        .args([&["core", "--listen", "127.0.0.1:0", "--once"], flags].concat())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut greeting = String::new();
    BufReader::new(core.stderr.take().unwrap())
        .read_line(&mut greeting)
        .unwrap();
    let link = greeting.split_whitespace().last().unwrap().to_owned();
    assert!(link.starts_with("tcp:127.0.0.1:"), "{greeting}");
    (core, link)
}

#[test]
fn a_core_in_another_process_flies_the_same_log() {
    let (mut core, link) = serving(&[]);
    let link = link.as_str();
    // A stranger who configures nothing does not end the core that serves once.
    let mut stranger = TcpStream::connect(link.trim_start_matches("tcp:")).unwrap();
    stranger.write_all(b"GET / HTTP/1.1\r\n\r\n").unwrap();
    drop(stranger);
    let flags = ["--seed", "9", "--duration", "5", "--json"];
    let (apart, out) = run("apart", &[&flags[..], &["--link", link]].concat());
    assert!(core.wait().unwrap().success());
    let (together, other) = run("together", &flags);
    let hash = |output: &Output| {
        let result: Value = serde_json::from_slice(&output.stdout).unwrap();
        result["log_hash"].as_str().map(str::to_owned)
    };
    assert!(hash(&apart).is_some());
    assert_eq!(hash(&apart), hash(&together));
    let bytes = |out: &PathBuf| std::fs::read(out.join("flight-seed9-5s.json")).unwrap();
    assert_eq!(bytes(&out), bytes(&other));
    std::fs::remove_dir_all(out).unwrap();
    std::fs::remove_dir_all(other).unwrap();
}

#[test]
fn telemetry_goes_out_over_udp() {
    let ground = UdpSocket::bind("127.0.0.1:0").unwrap();
    ground
        .set_read_timeout(Some(Duration::from_secs(5)))
        .unwrap();
    let target = format!("udp:{}", ground.local_addr().unwrap());
    let flags = ["--duration", "2", "--speed", "max", "--mavlink", &target];
    let (output, out) = run("mavlink", &flags);
    assert!(output.status.success());
    std::fs::remove_dir_all(out).unwrap();
    // Two seconds of everything; one heartbeat and a text at the end.
    let mut ids = std::collections::BTreeMap::new();
    let mut datagram = [0; 300];
    for _ in 0..93 {
        let length = ground.recv(&mut datagram).unwrap();
        assert!(length > 9 && datagram[0] == 0xFD, "MAVLink 2 magic");
        let id = u32::from_le_bytes([datagram[7], datagram[8], datagram[9], 0]);
        *ids.entry(id).or_insert(0) += 1;
    }
    let expected = [
        (0, 3),
        (1, 2),
        (2, 2),
        (24, 2),
        (30, 20),
        (32, 20),
        (33, 10),
        (74, 20),
        (105, 2),
        (132, 2),
        (141, 2),
        (231, 2),
        (242, 1),
        (245, 2),
        (253, 1),
        (331, 2),
    ];
    assert_eq!(ids.into_iter().collect::<Vec<_>>(), expected);
}

/// The lidar sees two metres, so only the field file tells of the circle in the way.
#[test]
fn a_core_that_was_told_the_field_is_its_oracle() {
    let folder = scratch("told-field");
    let file = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let field = file(
        "field.toml",
        "[[circle]]\nx = 60.0\nz = 50.0\nradius = 2.0\n",
    );
    let scenario = file("dark.toml", "[lidar]\nrange_max = 2.0\n");
    let wrong = file(
        "wrong.toml",
        "[[circle]]\nx = 60.0\nz = 50.0\nradius = -2.0\n",
    );
    let refused = harness()
        .args(["core", "--oracle", &wrong])
        .output()
        .unwrap();
    let talk = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{talk}");
    assert!(
        talk.contains("wrong.toml") && talk.contains("radius"),
        "{talk}"
    );
    let outcome = |oracle: &[&str]| {
        let (mut core, link) = serving(oracle);
        let flags = [
            "--field",
            &field,
            "--scenario",
            &scenario,
            "--duration",
            "8",
            "--json",
        ];
        let (output, out) = run("told", &[&flags[..], &["--link", &link]].concat());
        assert!(core.wait().unwrap().success());
        std::fs::remove_dir_all(out).unwrap();
        let result: Value = serde_json::from_slice(&output.stdout).unwrap();
        result["outcome"].as_str().unwrap().to_owned()
    };
    assert_eq!(outcome(&[]), "collision");
    assert_eq!(outcome(&["--oracle", &field]), "survived");
    std::fs::remove_dir_all(folder).unwrap();
}
