//! Campaigns that end when their intervals are narrow enough.

use crate::common::{harness, place};
use std::process::Output;

/// A campaign past so many obstacles that short flights succeed or fail.
fn campaign(flags: &[&str]) -> Output {
    let fixed = [
        "campaign",
        "--obstacles",
        "0,300",
        "--duration",
        "2",
        "--trials",
        "60",
    ];
    harness().args(fixed).args(flags).output().unwrap()
}

/// The cell without an obstacle stops long before the other, for every number of threads, and when the row file holds
/// more flights than count.
#[test]
fn a_campaign_ends_by_the_width_of_its_intervals() {
    let width = ["--until-width", "17"];
    let alone = campaign(&[&width[..], &["--threads", "1"]].concat());
    let text = String::from_utf8(alone.stdout.clone()).unwrap();
    assert!(alone.status.success(), "{text}");
    assert!(text.contains("cells stopped by width"), "{text}");
    let last = text.lines().last().unwrap();
    assert!(last.contains("those of a sequential stop"), "{text}");
    let flown = |row: usize| {
        text.lines()
            .nth(row)
            .unwrap()
            .split_whitespace()
            .nth(5)
            .map(str::to_owned)
    };
    assert_eq!(flown(1).as_deref(), Some("20"), "{text}");
    assert_eq!(
        campaign(&[&width[..], &["--threads", "2"]].concat()).stdout,
        alone.stdout
    );

    let rows = place("until-width.jsonl");
    let out = ["--out", rows.to_str().unwrap()];
    assert!(campaign(&out).status.success());
    let before = std::fs::read(&rows).unwrap();
    let resumed = campaign(&[&width[..], &out].concat());
    assert_eq!(resumed.stdout, alone.stdout);
    assert_eq!(std::fs::read(&rows).unwrap(), before);
    std::fs::remove_file(rows).unwrap();
}

#[test]
fn a_width_that_cannot_be_is_refused() {
    for (flags, hint) in [
        (&["--until-width", "0"][..], "give a width of more than 0"),
        (&["--until-width", "nan"], "give a width of more than 0"),
        (
            &["--until-width", "5", "--shard", "1/2"],
            "cannot be used with",
        ),
        (&["--until-width", "5", "--oracle"], "cannot be used with"),
    ] {
        let output = campaign(flags);
        let talk = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{talk}");
        assert!(talk.contains(hint), "{talk}");
    }
}
