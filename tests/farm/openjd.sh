#!/bin/sh
# A render in 4 parts by Open Job Description's own runner (pip install openjd-cli): the template is checked, a task is killed
# and the job run again, and the picture is that of one render.
# Usage: tests/farm/openjd.sh [PROGRAM] [OPENJD]
set -eu
program=$(realpath "${1:-target/release/pathtracer}")
openjd=${2:-openjd}
scene=$(realpath scenes/bigBalls.yaml)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp "$scene" "$folder/scene.yaml"
cd "$folder"
render="scene.yaml 400 240 200 6"
"$program" $render whole.exr --quiet
"$program" farm export --parts 4 $render out.exr > job.yaml
"$openjd" check job.yaml
"$openjd" summary job.yaml
run() { "$openjd" run job.yaml --step Merge --run-dependencies -p "Program=$program" > log 2>&1; }
run &
job=$!
killed=
for _ in $(seq 2000); do
    for pid in $(pgrep -x pathtracer); do
        if { tr '\0' ' ' < "/proc/$pid/cmdline"; } 2>/dev/null | grep -q "part-2.film --part 2/4"; then
            kill -9 "$pid" && killed=yes
        fi
    done
    [ -n "$killed" ] && break
    sleep 0.02
done
if wait $job; then echo "a killed task did not stop the run" >&2; exit 1; fi
grep -q openjd_progress log
[ ! -e out.exr ]
echo "a task was killed: the run ended without a picture"
run
cmp out.exr whole.exr
echo "run again, it made what was missing; the picture is that of one render"
grep -c "is there already" log
