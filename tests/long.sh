#!/bin/bash
# The long versions: every fuzz target for SECONDS (an hour unless given) with AddressSanitizer, the soak for as long, 200
# kills, and all ignored tests. Needs cargo-fuzz. Usage: tests/long.sh [SECONDS]
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-3600}
cargo build --release
tests/faults/kills.sh 200
for target in yaml obj mtl film geometry; do
    mkdir -p fuzz/corpus/$target
    tests/seeds.sh $target fuzz/corpus/$target
    # The sanitizer is switched on by a flag that stable compilers refuse without this.
    RUSTC_BOOTSTRAP=1 cargo fuzz run $target --sanitizer address -- -max_total_time="$seconds" -max_len=16384 -rss_limit_mb=4096
done
PATHTRACER_SOAK_SECONDS=$seconds cargo test --release --test tests soak -- --ignored --nocapture
cargo test --release --test tests -- --ignored
