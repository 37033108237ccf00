#!/bin/bash
# Reads damaged pictures through the shim of OpenImageIO, built with AddressSanitizer and UndefinedBehaviorSanitizer.
# Usage: shim.sh PATHTRACER [ROUNDS]
set -euo pipefail
program=$(realpath "$1")
rounds=${2:-300}
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
c++ -std=c++17 -g -O1 -Wall -Wextra -fsanitize=address,undefined -fno-sanitize-recover=undefined \
    "$root/tests/faults/shim.cpp" "$root/src/picture/oiio_shim.cpp" $(pkg-config --cflags --libs OpenImageIO) -o shim
for extension in tif hdr jpg png exr; do
    "$program" "$root/scenes/bigBalls.yaml" 40 30 1 3 "whole.$extension" --quiet
done
"$program" "$root/scenes/bigBalls.yaml" 40 30 1 3 whole.tiff --depth float --quiet
# Libraries below print what they think of the files.
ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1 ./shim "$rounds" whole.* 2> messages ||
    { grep -v '^libpng' messages >&2; exit 1; }
