#!/usr/bin/env bash
# The figures of docs/validation/beyond.md: success, the oracle's beside it, causes of failure.
# A killed run goes on where it was: rows are kept in OUT (default out/beyond). TRIALS scales the flights
# of every table for a quick look (percent, default 100); THREADS is that of `campaign` (0: every core).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${OUT:-out/beyond}
percent=${TRIALS:-100}
seed=${SEED:-10000}
mkdir -p "$out"
cargo build --release --locked -p sil-harness
harness=${CARGO_TARGET_DIR:-target}/release/sil-harness

# Name, flights, then flags of `campaign`.
fly() {
  local name=$1 flights=$2
  shift 2
  printf '\n== %s: campaign --navigation ideal %s --trials %s --seed %s\n' "$name" "$*" "$((flights * percent / 100))" "$seed"
  "$harness" campaign --preset flight --navigation ideal --threads "${THREADS:-0}" --seed "$seed" --oracle --taxonomy \
    --trials "$((flights * percent / 100))" --out "$out/$name.jsonl" "$@" | tee "$out/$name.txt"
}

fly sparse 1000 --obstacles 20,40 --replan-hz 1
fly dense 500 --obstacles 80,120,160 --replan-hz 4
for condition in actuators-thrust actuators-elevator gusts model-error lidar-faults all-together; do
  fly "$condition" 1000 --scenario "docs/scenarios/$condition.toml" --obstacles 40 --replan-hz 4
done
for scene in flytrap dynamics long-way; do
  fly "$scene" 100 --scene "$scene" --obstacles 0 --replan-hz 1,4
done
"$harness" figures --out "$out/figures" --rows "$out/dense.jsonl"
