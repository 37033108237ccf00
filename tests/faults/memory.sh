#!/bin/sh
# Renders in a control group of 400 MB, as root: a film that is larger is refused before it is allocated, a small one rendered.
# Usage: tests/faults/memory.sh [PROGRAM]
set -eu
program=$(realpath "${1:-target/release/pathtracer}")
scene=$(realpath scenes/bigBalls.yaml)
root=/sys/fs/cgroup
if [ -d "$root/memory" ]; then root=$root/memory; limit=memory.limit_in_bytes; else limit=memory.max; fi
group=$root/pathtracer-test
folder=$(mktemp -d)
trap 'rmdir "$group" 2>/dev/null || true; rm -rf "$folder"' EXIT
mkdir "$group"
[ -e "$group/$limit" ] || { echo "needs a control group that limits memory" >&2; exit 2; }
echo 400000000 > "$group/$limit"
cd "$folder"
render() { sh -c 'echo $$ > "$0/cgroup.procs"; exec "$@"' "$group" "$program" "$scene" "$@" --quiet; }
code=0
render 3000 2000 16 3 a.exr 2> message || code=$?
cat message
[ $code -eq 2 ] && [ ! -e a.exr ] && grep -q "the film of a picture of 3000 x 2000 pixels" message
render 300 200 16 3 a.exr
[ -s a.exr ]
echo "a film over the limit of the group is refused, a small one is rendered"
