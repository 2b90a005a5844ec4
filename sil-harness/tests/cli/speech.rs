//! What the command line says: how much, for whom, and with which exit code.

use crate::common::{harness, run};

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_quiet_flight_prints_its_result_only_and_a_verbose_one_more() {
    let flight = |flag: &str| {
        let (output, out) = run(&format!("loud{flag}"), &["fly", "--duration", "1.5", flag]);
        std::fs::remove_dir_all(out).unwrap();
        assert!(output.status.success());
        (text(&output.stdout), text(&output.stderr))
    };
    let (result, quiet) = flight("-q");
    assert_eq!(quiet, "");
    assert!(result.contains("after 1.50 s"), "{result}");
    let (same, verbose) = flight("-v");
    assert_eq!(same, result);
    for part in [
        "aircraft reference",
        "lidar: 100 beams",
        "plans by verdict: Adopted 2",
    ] {
        assert!(verbose.contains(part), "{part}: {verbose}");
    }
    // Errors are never silent.
    let (output, _) = run("loud", &["fly", "-q", "--duration", "0"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("duration: give 0.01 to"));
}

#[test]
fn who_asks_for_a_strict_flight_gets_an_exit_code_for_leaving_the_band() {
    // This flight survives and leaves the band.
    let flags = [
        "--preset",
        "reference",
        "--seed",
        "19",
        "--obstacles",
        "40",
        "--duration",
        "10.5",
    ];
    for (more, code) in [
        (&[][..], 0),
        (&["--strict"], 5),
        (&["--strict", "--json"], 5),
    ] {
        let (output, out) = run("band", &[&flags, more].concat());
        assert_eq!(output.status.code(), Some(code), "{}", text(&output.stdout));
        std::fs::remove_dir_all(out).unwrap();
    }
}

#[test]
fn numbers_that_are_no_seed_and_no_time_are_refused_with_a_sentence() {
    for (flags, hint) in [
        (
            ["fly", "--seed", "-1"],
            "a seed is a whole number from 0 to 18446744073709551615",
        ),
        (["campaign", "--seed", "1.5"], "a seed is a whole number"),
        (["fly", "--duration", "2.005"], "a multiple of 0.01 s"),
        (["fly", "--patience", "0"], "give 0.001 to 1000000 seconds"),
    ] {
        let output = harness().args(flags).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{flags:?}");
        assert!(
            text(&output.stderr).contains(hint),
            "{}",
            text(&output.stderr)
        );
    }
}

#[test]
fn completions_and_manual_know_every_command() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let output = harness().args(["completions", shell]).output().unwrap();
        let script = text(&output.stdout);
        assert!(
            output.status.success() && script.contains("check-reference"),
            "{shell}"
        );
    }
    let (output, out) = run("man", &["man"]);
    assert!(output.status.success());
    let page = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    assert!(page("sil-harness.1").contains(r"sil\-harness\-campaign(1)"));
    assert!(page("sil-harness-fly.1").contains("Words of the result"));
    assert!(page("sil-harness-bench-qp.1").contains("Clarabel"));
    std::fs::remove_dir_all(&out).unwrap();
    let main = harness().arg("man").output().unwrap();
    assert!(text(&main.stdout).contains(".TH sil-harness 1"));
    assert!(!out.exists());
}

/// Clarabel takes long to build and no flight needs it, so a build may be without it, and says so.
#[cfg(not(feature = "clarabel"))]
#[test]
fn a_benchmark_beside_clarabel_names_the_feature_that_it_needs() {
    let arguments = ["bench", "qp", "--generate", "1"];
    let output = harness().args(arguments).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    assert!(said.contains("with `--features clarabel`"), "{said}");
}
