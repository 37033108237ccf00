#!/bin/bash
# Fills a folder with what a fuzz target begins with: the project's own scenes, meshes and materials, good and bad.
# Usage: tests/seeds.sh TARGET FOLDER [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/.."
target=$1 folder=$2
program=${3:-target/release/pathtracer}
small() { find "$@" -type f -size -16k; }
case $target in
yaml) small scenes tests/data/bad_scenes tests/golden -name '*.yaml' ;;
obj) small tests/data objects scenes -name '*.obj' ;;
mtl) small tests/data objects scenes -name '*.mtl' ;;
*) ;;
esac | while read -r file; do cp "$file" "$folder/$(basename "$(dirname "$file")")-$(basename "$file")"; done
if [ "$target" = film ]; then
    work=$(mktemp -d)
    scene=scenes/bigBalls.yaml
    $program $scene 18 2 40 2 "$work/a.film" --part 0/2 --quiet
    $program $scene 5 3 40 2 "$work/b.film" --chunks 1..2 --aov depth --quiet
    $program $scene 18 3 20 2 "$work/c.png" --checkpoint "$work/c.film" --noise 0.1 --quiet
    $program $scene 5 3 20 2 "$work/d.png" --checkpoint "$work/d.film" --scramble-length 2 --quiet
    $program $scene 18 2 100 2 "$work/e.film" --part 1/2 --noise 0.5 --quiet
    $program $scene 3 2 1 1 "$work/f.film" --part 0/1 --error-estimate off --quiet
    for file in "$work"/*.film; do
        # The target puts magic, length and checksum there itself: one byte, the header, a line end, the sums.
        python3 - "$file" "$folder/$(basename "$file")" <<'EOF'
import struct, sys
data = open(sys.argv[1], "rb").read()
length = struct.unpack_from("<I", data, 12)[0]
header, sums = data[16:16 + length], data[16 + length:-16]
open(sys.argv[2], "wb").write(b"\1" + header + b"\n" + sums)
open(sys.argv[2] + "-raw", "wb").write(b"\0" + data)
EOF
    done
    rm -r "$work"
fi
if [ "$target" = geometry ]; then
    for seed in 1 2 3 4 5 6 7 8; do
        python3 -c "import random, sys; random.seed($seed); sys.stdout.buffer.write(random.randbytes(4000))" > "$folder/random-$seed"
    done
fi
