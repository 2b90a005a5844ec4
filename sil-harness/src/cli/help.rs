//! Texts of `--help`: headings of groups of flags, examples, and the words that results use.

/// Flags that say what is flown through what.
pub(super) const WORLD: &str = "World";
/// Flags of the planner.
pub(super) const PLANNER: &str = "Planner";
/// Flags that say where the core runs.
pub(super) const CORE: &str = "Core";
/// Flags for people who follow or steer a flight.
pub(super) const GROUND: &str = "Ground stations and pages";
/// Flags of a run of many flights.
pub(super) const RUN: &str = "Run";
/// Flags of what is printed and written.
pub(super) const OUTPUT: &str = "Output";

pub(super) const FLY: &str = "\
Examples:
  sil-harness fly --seed 7 --obstacles 40 --replan-hz 4
  sil-harness fly --preset reference --json
  sil-harness fly --scenario docs/scenarios/all-together.toml --strict
  sil-harness fly --live                       # watch at http://127.0.0.1:8088/
  sil-harness fly --mavlink --duration 600     # for ground stations

Words of the result:
  strict       the flight survived and never left the altitude band of +-11 m
  clearance    least distance to the edge of an obstacle
  replans      planning cycles whose plan was delivered
  candidates   refined trajectories, over all replans. A cycle refines its best paths again: so 7 paths may give
               11 candidates a replan
  feasible     candidates that meet every limit
  rejections   inputs that the core refused, such as a damaged frame or an old scan; the log has the causes
  log          hash of the log: the same scenario gives the same hash on every machine

Exit codes: 0 reached the end, 2 usage, 3 collision, 4 extreme state, 5 left the altitude band (with --strict),
6 link, 8 terminated from the ground, 130 and 143 interrupted, 1 anything else";

pub(super) const CAMPAIGN: &str = "\
Examples:
  sil-harness campaign --obstacles 20,40 --paths 5,25 --trials 300 --seed 0 --out rows.jsonl
  sil-harness campaign --shard 2/8 --out part2.jsonl --trials 300
  sil-harness campaign --report part1.jsonl part2.jsonl --json
  sil-harness campaign --trials 3000 --until-width 1.0
  sil-harness campaign --faults all --trials 60
  sil-harness campaign --faults all --pairs --trials 2000

A success neither collides nor reaches an extreme state; a strict one also stays in the altitude band of +-11 m.
Intervals are Wilson's, 95 %.";

pub(super) const CEILING: &str = "\
Examples:
  sil-harness ceiling --generator paper,sealed --obstacles 160,320 --margin 0,0.3
  sil-harness campaign --obstacles 160 --replan-hz 4 --oracle --ceiling

blocked     no flight of the envelope passes: an outer approximation of all of them ends before the field does
passable    a flight of the simulated aircraft, found by search, passes
undecided   neither was found
docs/validation/ceiling.md defines the envelope.";

pub(super) const AIRCRAFT: &str = "\
Examples:
  sil-harness aircraft zagi
  sil-harness aircraft my.toml --flights 100";

pub(super) const SPACE: &str = "\
Examples:
  sil-harness space --aircraft ultrastick
  sil-harness space --aircraft x8 --bank -20 --wind 0,4,0 --gusts light --out turn.csv
  sil-harness space --aircraft ultrastick --world forest --density 0.02 --seed 7
  sil-harness space --aircraft rascal --flights 100 --gusts light

Elevator and thrust stay those of level flight, so a turn loses height. With --flights the planner commands them, and the
course is held.
Exit codes: 0 flown, 2 usage, 4 extreme state: the aircraft departed, 1 anything else";

pub(super) const FLY_IN_SPACE: &str = "\
Examples:
  sil-harness fly --preset space --density 0.02
  sil-harness fly --preset space --aircraft delta --airspeed 12 --world walls --json

Exit codes: 0 reached the end, 2 usage, 3 collision, 4 extreme state, 5 left the band or ran out of time, 130 and 143
interrupted, 1 anything else";

pub(super) const CAMPAIGN_IN_SPACE: &str = "\
Examples:
  sil-harness campaign --preset space --density 0.01,0.02,0.04 --trials 100 --seed 900000
  sil-harness campaign --preset space --density 0.04 --sphere 0.4 --out rows.jsonl
  sil-harness campaign --preset space --density 0.02 --baseline library-7

A flight arrives if neither wing nor fuselage touches anything on its way and it stays in the band.
Exit codes: 0 flown, 2 usage, 130 and 143 interrupted, 1 anything else";

pub(super) const CEILING_IN_SPACE: &str = "\
Examples:
  sil-harness ceiling --preset space --aircraft x8 --airspeed 16 --density 0.04,0.1 --seed 900000
  sil-harness ceiling --preset space --density 0.0625 --sight 12,20,30
  sil-harness ceiling --preset space --density 0.1 --sphere 0.4 --trials 500 --json";

pub(super) const FIGURES: &str = "\
Examples:
  sil-harness figures --out out/figures --rows rows.jsonl";

pub(super) const CORE_EXAMPLES: &str = "\
Examples:
  sil-harness core --listen 127.0.0.1:5790 &
  sil-harness fly --link tcp:127.0.0.1:5790";

pub(super) const REPLAY: &str = "\
Examples:
  sil-harness replay out/flight-seed1.json --out flight.html
  sil-harness replay out/flight-seed1.json --against out/flight-seed2.json";

pub(super) const PARAMS: &str = "\
Examples:
  sil-harness params --long > my.params
  sil-harness fly --params my.params";

pub(super) const BENCH: &str = "\
Examples:
  sil-harness bench qp --generate 1000     # in a build with --features clarabel
  sil-harness bench cycle --json";

pub(super) const EXPORT: &str = "\
Examples:
  sil-harness export out/flight-seed1.json > ticks.csv
  sil-harness export out/flight-seed1.json --out flight.mcap     # for Foxglove
  sil-harness export rows.jsonl --out rows.parquet

docs/logs.md has every table and column with unit and frame.";

pub(super) const COMPLETIONS: &str = "\
Examples:
  sil-harness completions bash > ~/.local/share/bash-completion/completions/sil-harness
  sil-harness completions zsh > _sil-harness      # in a folder of $fpath";

pub(super) const MAN: &str = "\
Examples:
  sil-harness man | man -l -
  sil-harness man --out ~/.local/share/man/man1";
