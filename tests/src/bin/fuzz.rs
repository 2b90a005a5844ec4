//! Sends hostile frames to the flight core and to the MAVLink parts: `fuzz COUNT SEED`.

use mpp_tests::fuzz::{ROUND, Report, run};
use mpp_tests::golden::Failure;

/// Frames between two lines of progress.
const STEP: u64 = 1000 * ROUND;

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>());
    let (Some(Ok(count)), Some(Ok(seed)), None) =
        (arguments.next(), arguments.next(), arguments.next())
    else {
        return Err("give the number of frames and a seed, two whole numbers".into());
    };
    let mut report = Report::default();
    // Each part has a seed of its own, which a failure names.
    for part in 0..count.div_ceil(STEP) {
        let frames = STEP.min(count - part * STEP);
        report = report.and(run(frames, seed.wrapping_add(part))?);
        println!("{report:?}");
    }
    Ok(())
}
