//! Tests whether the core says that something is wrong before two faults at once cost the flight.

use mpp_analysis::campaign::{FaultPairs, Lists, NamedFault, PairReport};
use mpp_sim::scenario::ScenarioFile;
use sil_harness::campaign::run_pairs;

/// A sample of `campaign --faults all --pairs`. Decision 44 has the figures of 2,000 flights.
#[test]
fn pairs_of_faults_that_cost_the_flight_are_told_before() {
    let all = NamedFault::of(&["all".to_owned()]).unwrap();
    let (scenario, lists) = (ScenarioFile::default(), Lists::default());
    let campaign = FaultPairs::new(&scenario, &lists, 80, Some(64_000_000), &all).unwrap();
    let report = PairReport::new(run_pairs(&campaign, 0, || Ok(())).unwrap());
    assert_eq!(report.flights, 80);
    assert!(report.lost > 0, "pairs that cost nothing test nothing");
    assert!(report.lost_untold <= 3, "{report}");
}
