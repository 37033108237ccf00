#!/bin/sh
# Renders into file systems that are full or read-only, as root. Usage: tests/faults/disk_full.sh [PROGRAM]
set -eu
program=$(realpath "${1:-target/release/pathtracer}")
scene=$(realpath scenes/bigBalls.yaml)
folder=$(mktemp -d)
small="$folder/small"
trap 'umount "$small" 2>/dev/null || true; rm -rf "$folder"' EXIT
mkdir "$small"
mount -t tmpfs -o size=64k tmpfs "$small"
cd "$folder"
render="$scene 200 120 40 6"
"$program" $render whole.exr --quiet
code=0
"$program" $render small/a.exr --quiet 2> message || code=$?
cat message
[ $code -eq 1 ] && [ ! -e small/a.exr ] && [ -z "$(ls -A small)" ]
"$program" merge a.exr.film a.exr --quiet
cmp a.exr whole.exr
echo "disk full: the film was kept, and its picture is that of one render"
"$program" $render b.exr --checkpoint small/b.film --every 100ms 2> message
grep -q "no checkpoint" message
cmp b.exr whole.exr
[ -z "$(ls -A small)" ]
echo "no room for a checkpoint: the render said so and went on"
mount -o remount,ro "$small"
code=0
"$program" $render small/c.exr --quiet 2> message || code=$?
cat message
[ $code -eq 1 ]
echo "read-only: found before the render"
