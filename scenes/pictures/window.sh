#!/usr/bin/env bash
# scenes/pictures/window.sh [PROGRAM [SAMPLES]]: the README's pictures of the window, dark and light, on a virtual display:
# a scene whose preview, with so many samples (48), has ended, and an object that was clicked.
# Needs Xvfb, xdotool, Mesa's software GL and ImageMagick (Debian: xvfb xdotool libgl1-mesa-dri imagemagick).
set -euo pipefail
cd "$(dirname "$0")"
root=$(cd ../.. && pwd)
program=$(realpath "${1:-$root/target/release/pathtracer}")
samples=${2:-48}
work=$(mktemp -d)
children=()
trap 'kill "${children[@]}" 2>/dev/null || true; rm -r "$work"' EXIT

# settled: waits until the window has looked the same for ten seconds, and stores it as shot.png.
settled() {
    local before='' now=''
    for _ in $(seq 180); do
        sleep 10
        import -window root "$work/shot.png"
        now=$(convert "$work/shot.png" rgb:- | sha256sum)
        [ "$now" = "$before" ] && return
        before=$now
    done
    echo 'the window never came to rest' >&2
    return 1
}

# shot THEME OUT
shot() {
    mkdir -p "$work/$1/pathtracer"
    # As high as wide, which fills the place between the panels.
    cat > "$work/$1/pathtracer/window.json" <<JSON
{"theme": "$1", "window": [1280, 800], "width": 1420, "height": 1440, "samples": $samples, "bounces": 20}
JSON
    mkfifo "$work/$1/number"
    Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp -noreset 3> "$work/$1/number" 2> /dev/null &
    children=($!)
    read -r number < "$work/$1/number"
    export DISPLAY=:$number XDG_CONFIG_HOME=$work/$1 LIBGL_ALWAYS_SOFTWARE=1
    unset WAYLAND_DISPLAY
    (cd "$root" && exec "$program" scenes/glassBalls.yaml) &
    children+=($!)
    local window=''
    until window=$(xdotool search --onlyvisible --name glassBalls | head -n 1) && [ -n "$window" ]; do sleep 0.2; done
    xdotool windowfocus --sync "$window"
    settled
    xdotool mousemove 610 430 click 1
    settled
    convert "$work/shot.png" -strip -define png:compression-level=9 "PNG24:$2"
    xdotool key ctrl+q
    wait "${children[1]}"
    kill "${children[0]}"
    children=()
}

shot Dark window.png
shot Light window_light.png
