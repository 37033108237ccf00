#!/bin/bash
# The long versions: every fuzz target for SECONDS (an hour unless given) with AddressSanitizer, the soak for as long, 200
# kills, all ignored tests, and the property tests with a seed of their own. Needs cargo-fuzz. Usage: tests/long.sh [SECONDS]
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-3600}
cargo build --release
tests/faults/kills.sh 200
for target in yaml obj mtl film geometry; do
    # What is new goes to the first folder; the kept inputs stay as they are.
    new=fuzz/target/corpus/$target
    mkdir -p "$new" fuzz/artifacts/$target
    words=()
    if [ -f fuzz/dict/$target.dict ]; then words=(-dict=fuzz/dict/$target.dict); fi
    tests/seeds.sh $target "$new"
    # The sanitizer is switched on by a flag that stable compilers refuse without this.
    RUSTC_BOOTSTRAP=1 cargo fuzz run $target --sanitizer address "$new" fuzz/corpus/$target -- \
        -max_total_time="$seconds" -max_len=16384 -rss_limit_mb=4096 "${words[@]}" -artifact_prefix=fuzz/artifacts/$target/
done
PATHTRACER_SOAK_SECONDS=$seconds cargo test --release --test tests soak -- --ignored --nocapture
cargo test --release --test tests -- --ignored
# Cases that no run has tried; the seed says how to try them again.
seed=$(date +%s)
echo "PATHTRACER_SEED=$seed"
PATHTRACER_SEED=$seed cargo test --release --test tests extremes::geometry
