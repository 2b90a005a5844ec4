//! Tests the core with hostile frames. `cargo xtask fuzz` sends as many as one likes.

use mpp_tests::fuzz::run;

#[test]
fn a_million_hostile_frames_do_no_harm() {
    let report = run(1_000_000, 1).expect("hostile frames do no harm");
    assert_eq!(report.frames, 1_000_000);
    // The frames must get far enough to matter.
    assert!(
        report.messages > 100_000 && report.commands > 50_000,
        "{report:?}"
    );
    assert!(report.accepted > 1000 && report.plans > 100, "{report:?}");
    assert!(report.found > 100_000, "{report:?}");
}

#[test]
fn the_same_seed_sends_the_same_frames() {
    let run = |seed| run(4000, seed).expect("hostile frames do no harm");
    assert_eq!(run(7), run(7));
    assert_ne!(run(7), run(8));
}
