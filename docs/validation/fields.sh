#!/usr/bin/env bash
# Every figure of docs/validation/fields.md: each generator at two densities beside the oracle, bars, bodies,
# obstacles that move, and the same with ideal navigation. A killed run goes on where it was: rows are kept in
# OUT (default out/fields). TRIALS is the number of flights in a cell; SHARD such as 2/5 flies a part of them;
# THREADS is that of `campaign` (0: every core); HARNESS is a program that is built already. At the end it prints
# the report of all shards in OUT.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${OUT:-out/fields}
trials=${TRIALS:-100}
seed=${SEED:-50000}
shard=${SHARD:-1/1}
part=${shard/\//of}
mkdir -p "$out"
if [ -z "${HARNESS:-}" ]; then
  cargo build --release --locked -p sil-harness
  HARNESS=${CARGO_TARGET_DIR:-target}/release/sil-harness
fi

# Name, then flags of `campaign`.
names=()
fly() {
  local name=$1
  shift
  names+=("$name")
  printf '\n== %s: campaign %s --trials %s --seed %s --shard %s\n' "$name" "$*" "$trials" "$seed" "$shard"
  "$HARNESS" campaign --preset flight --replan-hz 4 --threads "${THREADS:-0}" --seed "$seed" \
    --trials "$trials" --shard "$shard" --out "$out/$name-$part.jsonl" "$@" > /dev/null
}

# Name, the text of a scenario file, then flags of `campaign`.
fly_scenario() {
  local name=$1 text=$2
  shift 2
  printf '%b\n' "$text" > "$out/$name.toml"
  fly "$name" --scenario "$out/$name.toml" "$@"
}

declare -A densities=([paper]=40,120 [sealed]=40,120 [endless]=40,120 [forest]=40,120 [wires]=40,120
  [canyon]=8,16 [slalom]=8,12 [walls]=4,8)
generators=(slalom walls forest sealed wires canyon endless paper)

for generator in "${generators[@]}"; do
  fly "$generator" --oracle --generator "$generator" --obstacles "${densities[$generator]}"
done

# How fast an obstacle may move [m/s].
for speed in 0.5 1 2 4; do
  fly_scenario "vertical-$speed" "[generator]\nvelocity = [0.0, $speed]" --obstacles 20
done
for speed in 1 2 5 10; do
  fly_scenario "head-on-$speed" "[generator]\nvelocity = [-$speed, 0.0]" --obstacles 20
done

# A body [m].
for radius in 0.1 0.25 0.5; do
  fly_scenario "body-$radius" "body_radius = $radius" --obstacles 40,120
done

# Bars of 4 m, 0.1 m thick.
fly_scenario bars '[generator]\nname = "wires"\nlength = 4.0' --obstacles 20,40

for generator in "${generators[@]}"; do
  fly "$generator-ideal" --navigation ideal --generator "$generator" --obstacles "${densities[$generator]}"
done

for name in "${names[@]}"; do
  printf '\n== %s\n' "$name"
  "$HARNESS" campaign --taxonomy --report "$out/$name"-[0-9]*of*.jsonl | tee "$out/$name.txt"
done
