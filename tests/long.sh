#!/bin/bash
# The long versions: every fuzz target for SECONDS (an hour unless given) with AddressSanitizer, the soak for as long, 200
# kills, full disks, damaged pictures, farms, all ignored tests, and the property tests with a seed of their own. Needs
# cargo-fuzz; what else is not there is skipped, and said at the end. Usage: tests/long.sh [SECONDS]
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-3600}
cargo build --release
program=${CARGO_TARGET_DIR:-target}/release/pathtracer
tests/faults/kills.sh 200 "$program"

skipped=()
# Runs a script if what it needs is there. Usage: try NEEDS COMMAND SCRIPT [ARGUMENT...]
try() {
    if eval "$2" > /dev/null 2>&1; then "${@:3}"; else skipped+=("$3 (needs $1)"); fi
}
# A container's root may not mount.
mounts() { folder=$(mktemp -d) && mount -t tmpfs tmpfs "$folder" && umount "$folder" && rmdir "$folder"; }
try 'root, who may mount' mounts tests/faults/disk_full.sh "$program"
group=/sys/fs/cgroup/memory
[ -d $group ] || group=/sys/fs/cgroup
try 'root, and control groups that limit memory' "mkdir $group/pathtracer-test && rmdir $group/pathtracer-test" \
    tests/faults/memory.sh "$program"
try 'a C++ compiler and libopenimageio-dev' 'c++ --version && pkg-config OpenImageIO' tests/faults/shim.sh "$program" 2000
try 'root, slurm-wlm and munge' '[ "$(id -u)" -eq 0 ] && command -v slurmctld && command -v slurmd && command -v munged' tests/farm/slurm.sh "$program"
try 'openjd-cli' 'command -v openjd' tests/farm/openjd.sh "$program"

for target in yaml obj mtl film geometry; do
    # What is new goes to the first folder; the kept inputs stay as they are.
    new=fuzz/target/corpus/$target
    mkdir -p "$new" fuzz/artifacts/$target
    words=()
    if [ -f fuzz/dict/$target.dict ]; then words=(-dict=fuzz/dict/$target.dict); fi
    tests/seeds.sh $target "$new" "$program"
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
printf 'skipped: %s\n' "${skipped[@]:-nothing}"
