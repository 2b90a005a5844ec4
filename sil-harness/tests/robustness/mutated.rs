//! Files that hold nothing of the kind, files without an end, and files that were damaged.

use crate::common::{run_in, scratch, talk};
use mpp_sim::scenario::ScenarioFile;
use sil_harness::ground::param_file;
use std::path::Path;

/// The commands that read a file, each with the file's name at its end.
const READERS: [&str; 7] = [
    "fly --out out --scenario",
    "fly --out out --params",
    "fly --out out --orders",
    "fly --out out --mavlink udp:127.0.0.1:9 --speed max --mavlink-key",
    "campaign --trials 1 --scenario",
    "campaign --report",
    "replay",
];

fn run(directory: &Path, command: &str, file: &str) -> (Option<i32>, String) {
    let arguments: Vec<&str> = command.split(' ').chain([file]).collect();
    let output = run_in(directory, &arguments);
    (output.status.code(), talk(&output))
}

/// Random numbers that depend on the seed alone (splitmix64).
struct Draw(u64);

impl Draw {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ (bits >> 31)) % bound.max(1) as u64) as usize
    }

    /// A text with some pieces cut out, doubled or replaced.
    fn damaged(&mut self, text: &str, pieces: &[&str]) -> String {
        let mut letters: Vec<char> = text.chars().collect();
        for _ in 0..=self.below(4) {
            let start = self.below(letters.len());
            let end = (start + self.below(12)).min(letters.len());
            let put: Vec<char> = match self.below(3) {
                0 => vec![],
                1 => letters[start..end].repeat(2),
                _ => pieces[self.below(pieces.len())].chars().collect(),
            };
            letters.splice(start..end, put);
        }
        letters.into_iter().collect()
    }
}

#[test]
fn what_is_no_such_file_is_refused_by_every_reader() {
    let directory = scratch("strangers");
    let deep = "[".repeat(200_000);
    let strangers: [(&str, &[u8]); 4] = [
        ("poem", b"roses are red = [violets\n"),
        ("binary", &[0xff, 0xfe, 0x00, 0x9f, 0x92, 0x96]),
        ("deep.toml", deep.as_bytes()),
        (
            "objects.json",
            b"{\"schema\":{\"schema\":{\"schema\":[[[[{}",
        ),
    ];
    for (name, bytes) in strangers {
        std::fs::write(directory.join(name), bytes).unwrap();
    }
    std::fs::create_dir(directory.join("folder")).unwrap();
    for command in READERS {
        let names = [
            "poem",
            "binary",
            "deep.toml",
            "objects.json",
            "folder",
            "nothing",
        ];
        for name in names {
            // A first line is a passphrase, whatever it says.
            if command.ends_with("key") && !["binary", "folder", "nothing"].contains(&name) {
                continue;
            }
            let (code, told) = run(&directory, command, name);
            assert_eq!(code, Some(2), "{command} {name}: {told}");
            assert!(
                told.contains(name) && told.len() < 4000,
                "{command} {name}: {told}"
            );
        }
    }
    std::fs::remove_dir_all(directory).unwrap();
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_without_an_end_is_refused_by_every_reader() {
    let directory = scratch("endless");
    for command in READERS {
        let (code, told) = run(&directory, command, "/dev/zero");
        assert_eq!(code, Some(2), "{command}: {told}");
        assert!(
            told.contains("bytes: give another file"),
            "{command}: {told}"
        );
    }
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn a_damaged_scenario_is_refused_or_bounded() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/scenarios");
    let pieces = [
        "=",
        "[",
        "]",
        "[[",
        "\"",
        "nan",
        "inf",
        "-1",
        "1e308",
        "-0.0",
        "18446744073709551615",
        "1979-05-27",
        "true",
        "\n",
        "seed = 1\n",
        "\u{0}",
        "#",
    ];
    let mut draw = Draw(1);
    let (mut built, mut refused) = (0, 0);
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            continue;
        }
        let text = std::fs::read_to_string(path).unwrap();
        for _ in 0..500 {
            let text = draw.damaged(&text, &pieces);
            match ScenarioFile::parse("it", &text).and_then(|file| file.build()) {
                Ok(scenario) => {
                    built += 1;
                    // An hour at most, and a field that fits into memory.
                    assert!(scenario.ticks <= 360_000, "{text}");
                    assert!(scenario.field().obstacles.len() <= 100_000, "{text}");
                }
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().contains(": "), "{error}");
                }
            }
        }
    }
    assert!(built > 100 && refused > 100, "{built} {refused}");
}

#[test]
fn damaged_parameters_are_refused_by_their_line() {
    let text = "# a comment\nMPP_ALT_M,52\nLQR_Q_PATH,900\n\nEKF_GATE,6\n";
    let mut draw = Draw(2);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..2000 {
        match param_file::parse(&draw.damaged(text, &[",", "nan", "1e999", "\n", "\t", "é"])) {
            Ok(_) => read += 1,
            Err(error) => {
                refused += 1;
                assert!(error.to_string().contains("line"), "{error}");
            }
        }
    }
    assert!(read > 100 && refused > 100, "{read} {refused}");
}

/// Rows and logs go through the whole program here; `hostile_logs.rs` has more of them.
#[test]
fn damaged_rows_and_orders_are_read_or_refused() {
    let directory = scratch("damaged");
    let flags = "campaign --trials 3 --duration 1 --out rows.jsonl";
    let output = run_in(&directory, &flags.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", talk(&output));
    let flags = "fly --duration 1 --seed 5 --out .";
    let output = run_in(&directory, &flags.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", talk(&output));
    let mut draw = Draw(3);
    // No digits, so that no flight becomes longer.
    let pieces = [
        "{", "}", "[", "]", "\"", ",", "null", "-", "e", "true", "\\u", "\n",
    ];
    for (name, command) in [
        ("rows.jsonl", "campaign --report"),
        ("flight-seed5-1s.json", "replay"),
        ("flight-seed5-1s.json", "fly --out again --orders"),
    ] {
        let text = std::fs::read_to_string(directory.join(name)).unwrap();
        let mut refused = 0;
        for _ in 0..30 {
            std::fs::write(directory.join("it.json"), draw.damaged(&text, &pieces)).unwrap();
            let (code, told) = run(&directory, command, "it.json");
            match code {
                Some(0) => {}
                Some(2) => refused += 1,
                _ => panic!("{command}: {code:?} {told}"),
            }
        }
        assert!(refused > 10, "{command}: {refused}");
    }
    std::fs::remove_dir_all(directory).unwrap();
}
