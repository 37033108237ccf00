#!/bin/bash
# Kills renders of the sample scenes at random moments (kill -9) until each ends, and compares the pictures with those of
# renders that nobody disturbed. Usage: tests/faults/kills.sh [KILLS] [PROGRAM]; ends with 1 if a picture differs.
set -u
kills=${1:-200}
program=$(realpath "${2:-target/release/pathtracer}")
scenes=$(realpath scenes)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
RANDOM=1
done=0 renders=0 differ=0
options=("" "--noise 0.2" "--sampler independent" "--error-bars bars.exr" "--aov albedo,normal" "--clamp 2 --accel native")
while [ $done -lt "$kills" ]; do
    for scene in bigBalls glassBalls legacyBalls mirrorRoom cornellBox objectScene gallery; do
        [ $done -lt "$kills" ] || break
        option=${options[$((renders % ${#options[@]}))]}
        render="$scenes/$scene.yaml 96 72 70 6"
        rm -f -- *
        "$program" $render whole.exr $option --quiet || exit 1
        [ -e bars.exr ] && mv bars.exr whole-bars.exr
        longest=1000
        while :; do
            # Longer and longer, so that the render does end.
            limit=$((RANDOM % longest + 20))
            seconds=$(printf '%d.%03d' $((limit / 1000)) $((limit % 1000)))
            ( timeout -s KILL "$seconds" "$program" $render a.exr $option --quiet --checkpoint a.film --resume a.film \
                --every 100ms; exit $? ) 2>/dev/null
            code=$?
            [ $code -eq 137 ] || break
            done=$((done + 1))
            longest=$((longest + longest / 8))
        done
        renders=$((renders + 1))
        if [ $code -ne 0 ] || ! cmp -s a.exr whole.exr || { [ -e whole-bars.exr ] && ! cmp -s bars.exr whole-bars.exr; }; then
            echo "differs: $render $option (exit code $code)"
            differ=$((differ + 1))
        fi
    done
done
echo "$done kills in $renders renders, $differ pictures differ"
[ $differ -eq 0 ]
