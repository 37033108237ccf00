#!/usr/bin/env bash
# docs/pictures/make.sh [gallery|keys|all [PROGRAM [PERCENT [FOLDER]]]]: renders the pictures of the README's gallery, and those
# of docs/scenes.md, whose scenes are below, with PERCENT (100) of their samples, but at least one, into FOLDER (this one).
# Needs a build with OpenImageIO, as the pictures are JPEG.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
what=${1:-all}
program=$(realpath "${2:-$root/target/release/pathtracer}")
percent=${3:-100}
cd "${4:-$root/docs/pictures}"
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

# share SAMPLES: as many as are wanted of them.
share() { echo $((percent * $1 > 100 ? percent * $1 / 100 : 1)); }

# sample NAME WIDTH HEIGHT SAMPLES: a picture of a sample scene.
sample() {
    "$program" "$root/scenes/$1.yaml" "$2" "$3" "$(share "$4")" 20 "gallery_$1.jpg" --quiet
}

# key NAME [SAMPLES]: a picture of the scene on standard input; those with mirrors and glass need more samples.
key() {
    cat > "$work/$1.yaml"
    "$program" "$work/$1.yaml" 240 150 "$(share "${2:-20}")" 12 "key_$1.jpg" --quiet --error-estimate off
}

# camera [KEY: VALUE]...: looks along +x at the origin's surroundings; later keys replace earlier ones.
camera() {
    local keys='FocusDistance: 7'
    case "$*" in *FocusDistance*) keys='' ;; esac
    case "$*" in *Fov*) ;; *) keys="$keys
Fov: 0.2" ;; esac
    printf 'Camera:\n  Position: [-7, 0, 1.9]\n  LookingAt: [0, 0, 0.75]\n'
    printf '%s\n' "$keys" "$@" | sed '/^$/d; s/^/  /'
}
environment() { printf 'Environment:\n'; printf '  %s\n' "$@"; }
soft_sky() { environment 'SkyColor: [0.55, 0.65, 0.85]' 'HorizonColor: [0.8, 0.8, 0.8]' 'GroundColor: [0.2, 0.2, 0.2]' 'Strength: 0.35'; }
# object [KEY: VALUE]...
object() {
    printf '  - Object:\n'
    printf '      %s\n' "$@"
}
# Floor, and a lamp behind the camera on the left.
stage() {
    printf 'Objects:\n'
    object 'Type: Rectangle' 'Position: [0, 0, 0]' 'Width: 4000' 'Height: 4000' 'Rotation: [0, 90, 0]' \
        'Material: { Type: Diffuse, Color: [0.45, 0.45, 0.48] }'
    object 'Type: Ball' 'Position: [-6, 6, 8]' 'Radius: 1.2' 'Material: { Type: Diffuse, EmissionStrength: 50 }'
}
ball() { object 'Type: Ball' "Position: [$1, $2, $3]" "Radius: $3" "Material: { $4 }"; }
# Three balls from left to right, each with its material.
three() {
    soft_sky; stage
    ball 0 1.5 0.7 "$1"; ball 0 0 0.7 "$2"; ball 0 -1.5 0.7 "$3"
}
# Balls of three colours, near on the right and far on the left.
row() {
    ball -2 -0.9 0.55 'Type: Diffuse, Color: [0.75, 0.15, 0.1]'
    ball 0 0 0.55 'Type: Diffuse, Color: [0.85, 0.65, 0.15]'
    ball 3.2 1.3 0.55 'Type: Diffuse, Color: [0.1, 0.35, 0.65]'
}
# knight Y [KEY: VALUE]...
knight() {
    object 'Type: TriangleMesh' "Filepath: $root/objects/knight.obj" "Position: [0, $1, 0]" "${@:2}" \
        'Material: { Type: Diffuse, Color: [0.7, 0.55, 0.35] }'
}

gallery() {
    sample bigBalls 480 270 256
    sample glassBalls 480 270 256
    sample legacyBalls 400 320 256
    sample mirrorRoom 400 225 64
    sample objectScene 320 320 48
    sample cornellBox 240 240 64
    sample gallery 400 268 64
}

keys() {
    # Camera
    for fov in 0.12 0.2 0.35; do { camera "Fov: $fov"; soft_sky; stage; row; } | key "fov_$fov"; done
    for radius in 0 0.08 0.25; do { camera "ApertureRadius: $radius"; soft_sky; stage; row; } | key "aperture_$radius"; done
    for strength in 35 105; do { camera "DepthOfField: $strength"; soft_sky; stage; row; } | key "depth_of_field_$strength"; done
    for distance in 5 7 10.2; do
        { camera 'ApertureRadius: 0.2' "FocusDistance: $distance"; soft_sky; stage; row; } | key "focus_$distance"
    done
    for angle in -15 0 15; do { camera "Angle: $angle"; soft_sky; stage; row; } | key "angle_$angle"; done

    # Environment
    local mirror='Type: Reflective, Color: [0.9, 0.9, 0.9]'
    { camera; printf 'Objects:\n'; row; ball 0.8 1.35 0.75 "$mirror"; } | key sky_default
    { camera; environment 'SkyColor: [0.1, 0.15, 0.4]' 'HorizonColor: [1, 0.5, 0.25]' 'GroundColor: [0.1, 0.07, 0.06]'
        printf 'Objects:\n'; row; ball 0.8 1.35 0.75 "$mirror"; } | key sky_colors
    for rotation in 0 140; do
        { camera; environment "Image: $root/objects/sky.exr" "Rotation: $rotation"
            printf 'Objects:\n'; row; ball 0.8 1.35 0.75 "$mirror"; } | key "sky_image_$rotation"
    done
    for strength in 0.3 1 2; do
        { camera; environment 'SkyColor: [0.2, 0.5, 1]' 'HorizonColor: [0.7, 0.8, 0.8]' 'GroundColor: [0.1, 0.1, 0.1]' \
            "Strength: $strength"; printf 'Objects:\n'; row; ball 0.8 1.35 0.75 "$mirror"; } | key "strength_$strength"
    done

    # Shapes
    local clay='Material: { Type: Diffuse, Color: [0.75, 0.4, 0.25] }'
    { camera; soft_sky; stage
        object 'Type: Ball' 'Position: [0, 1.6, 0.55]' 'Radius: 0.55' "$clay"
        object 'Type: Box' 'Position: [0, 0.45, 0.5]' 'Width: 0.8' 'Height: 1' 'Depth: 0.8' 'Rotation: [0, 0, 30]' "$clay"
        object 'Type: Rectangle' 'Position: [0, -0.65, 0.5]' 'Width: 0.8' 'Height: 1' 'Rotation: [0, 0, -25]' "$clay"
        knight -1.75 'Scale: 0.6' 'Rotation: [0, 0, -120]'; } | key shapes
    { camera; soft_sky; stage
        for at in '1.5 0.3' '0.2 0.5' '-1.4 0.7'; do
            object 'Type: Ball' "Position: [0, ${at% *}, ${at#* }]" "Radius: ${at#* }" "$clay"
        done; } | key radius
    { camera; soft_sky; stage
        for at in '1.4 0,0,0' '0 0,0,35' '-1.45 30,0,35'; do
            object 'Type: Box' "Position: [0, ${at% *}, 0.7]" 'Width: 0.8' 'Height: 0.8' 'Depth: 0.8' "Rotation: [${at#* }]" "$clay"
        done; } | key rotation
    { camera; soft_sky; stage
        knight 1.5 'Scale: 0.45' 'Rotation: [0, 0, -120]'; knight 0.2 'Scale: 0.6' 'Rotation: [0, 0, -120]'
        knight -1.5 'Scale: 0.85' 'Rotation: [0, 0, -120]'; } | key scale
    { camera; soft_sky; stage
        knight 1.3 'Scale: 0.7' 'Axes: YUp' 'Rotation: [0, 0, -120]'
        # It lies, and would reach below the floor.
        knight 0 'Scale: 0.7' 'Axes: ZUp' 'Rotation: [0, 0, -120]' | sed '/Position/s/0\]/0.41]/'
        knight -1.5 'Scale: 0.7' 'Axes: SwapYZ' 'Rotation: [0, 0, -120]'; } | key axes
    { camera 'Fov: 0.12'; soft_sky; stage
        object 'Type: TriangleMesh' "Filepath: $work/globe.obj" 'Position: [0, 0.65, 0.75]' 'Smooth: true' "$clay"
        object 'Type: TriangleMesh' "Filepath: $work/globe.obj" 'Position: [0, -0.65, 0.75]' 'Smooth: false' "$clay"; } | key smooth

    # Materials
    camera > "$work/camera"
    materials() { local name=$1 samples=$2; shift 2; { cat "$work/camera"; three "$@"; } | key "$name" "$samples"; }
    materials color 20 'Type: Diffuse, Color: [0.75, 0.15, 0.1]' 'Type: Diffuse, Color: [0.8, 0.8, 0.8]' 'Type: Diffuse, Color: [0.1, 0.1, 0.1]'
    local glow='Type: Diffuse, Color: [0.3, 0.3, 0.3], EmissionColor: [1, 0.6, 0.25], EmissionStrength'
    materials emission 20 "$glow: 0" "$glow: 0.3" "$glow: 1"
    materials specularity 400 'Type: Reflective, Color: [0.9, 0.8, 0.6], Specularity: 1' 'Type: Reflective, Color: [0.9, 0.8, 0.6], Specularity: 0.85' \
        'Type: Reflective, Color: [0.9, 0.8, 0.6], Specularity: 0.5'
    materials coat 400 'Type: ClearCoat, Color: [0.6, 0.08, 0.06], ClearCoat: 0.05' 'Type: ClearCoat, Color: [0.6, 0.08, 0.06], ClearCoat: 0.2' \
        'Type: ClearCoat, Color: [0.6, 0.08, 0.06], ClearCoat: 0.6'
    materials coat_color 400 'Type: ClearCoat, Color: [0.1, 0.1, 0.1], ClearCoat: 0.5' 'Type: ClearCoat, Color: [0.1, 0.1, 0.1], ClearCoat: 0.5, ClearCoatColor: [1, 0.75, 0.3]' \
        'Type: ClearCoat, Color: [0.1, 0.1, 0.1], ClearCoat: 0.5, ClearCoatColor: [1, 0.75, 0.3], Specularity: 0.85'
    materials ratio 400 'Type: Refractive, RefractionRatio: 0.9' 'Type: Refractive, RefractionRatio: 0.67' 'Type: Refractive, RefractionRatio: 0.42'
    local wood="Color: { Image: $root/objects/wood.png }"
    { camera; soft_sky; stage
        ball 0 1.5 0.7 "Type: Diffuse, $wood"
        object 'Type: Box' 'Position: [0, 0, 0.55]' 'Width: 1.1' 'Height: 1.1' 'Depth: 1.1' 'Rotation: [0, 0, 30]' "Material: { Type: Diffuse, $wood }"
        object 'Type: Rectangle' 'Position: [0, -1.6, 0.6]' 'Width: 1.2' 'Height: 1.2' 'Rotation: [0, 0, -20]' "Material: { Type: ClearCoat, $wood, ClearCoat: 0.15 }"; } | key image 200
    { camera; soft_sky; stage
        for at in '0.75 sRGB' '-0.75 Linear'; do
            object 'Type: Rectangle' "Position: [0, ${at% *}, 0.7]" 'Width: 1.3' 'Height: 1.3' \
                "Material: { Type: Diffuse, Color: { Image: $root/objects/wood.png, ColorSpace: ${at#* } } }"
        done; } | key color_space
    { camera 'Fov: 0.17'; soft_sky; stage
        object 'Type: TriangleMesh' "Filepath: $root/objects/lantern.obj" 'Position: [0, 0.8, 0]' 'Rotation: [0, 0, 25]' 'Material: FromFile'
        object 'Type: TriangleMesh' "Filepath: $root/objects/lantern.obj" 'Position: [0, -0.8, 0]' 'Rotation: [0, 0, 25]' "$clay"; } | key from_file
}

# A coarse globe with the normals of a ball.
globe() {
    awk 'BEGIN {
        pi = atan2(0, -1); around = 10; rings = 7
        for (ring = 0; ring < rings; ring++) for (i = 0; i < around; i++) {
            polar = pi * (ring + 0.5) / rings; angle = 2 * pi * i / around
            x = sin(polar) * cos(angle); y = cos(polar); z = sin(polar) * sin(angle)
            printf "v %.5f %.5f %.5f\nvn %.5f %.5f %.5f\n", 0.5 * x, 0.5 * y, 0.5 * z, x, y, z
        }
        for (ring = 0; ring + 1 < rings; ring++) for (i = 0; i < around; i++) {
            a = ring * around + i + 1; b = ring * around + (i + 1) % around + 1
            printf "f %d//%d %d//%d %d//%d %d//%d\n", a, a, b, b, b + around, b + around, a + around, a + around
        }
        printf "f"; for (i = 1; i <= around; i++) printf " %d//%d", i, i
        printf "\nf"; for (i = around; i > 0; i--) printf " %d//%d", (rings - 1) * around + i, (rings - 1) * around + i
        print ""
    }'
}

globe > "$work/globe.obj"
case $what in
gallery | keys) "$what" ;;
all) gallery; keys ;;
*) echo "unknown: $what" >&2; exit 2 ;;
esac
