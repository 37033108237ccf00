#!/usr/bin/env bash
# tests/fresh/run.sh SUITE [FOLDER [WHAT [DEB]]]: what the README promises on a Debian SUITE (bookworm or trixie) that has
# nothing but Rust, in a root made by debootstrap under FOLDER, each with its seconds. WHAT:
#   render    the README's first command
#   tests     the README's second command
#   both      these two (the default)
#   package   packaging/deb.sh in that root (with PROGRAM in the environment: of a program that is built there already, such
#             as the one that the tests leave, /root/target/debug/pathtracer); or nothing there, but the package DEB: then it is installed in a clean root
#             without Rust, and renders an example as a user would
# Needs root, debootstrap and a Rust toolchain of rustup here, which the new root borrows. A root that is there already is
# used again: then the first command is not timed from nothing. Certificates and cargo's settings of this machine are
# passed on, so that mirrors work there too.
set -euo pipefail
cd "$(dirname "$0")/../.."

suite=${1:?usage: tests/fresh/run.sh SUITE [FOLDER [render|tests|both|package [DEB]]]}
folder=${2:-$(mktemp -d)}
what=${3:-both}
package=${4:-}
rustup=${RUSTUP_HOME:-$HOME/.rustup}
cargo=${CARGO_HOME:-$HOME/.cargo}

mounted=()
unmount() { for place in "${mounted[@]}"; do umount "$place"; done; }
trap unmount EXIT
borrow() {
    mkdir -p "$2"
    mount "${@:3}" "$1" "$2"
    mounted=("$2" "${mounted[@]}")
}
# A root with the network of this machine, and nothing else.
make_root() {
    if [ ! -e "$1/etc/debian_version" ]; then
        debootstrap --variant=minbase --include=ca-certificates "$suite" "$1" >/dev/null
    fi
    borrow proc "$1/proc" -t proc
    borrow /dev "$1/dev" --bind
    for file in /etc/resolv.conf /etc/hosts /etc/ssl/certs/ca-certificates.crt; do
        if [ -e "$file" ]; then cp -L "$file" "$1$file"; fi
    done
}
# The toolchain and the project.
add_rust() {
    borrow "$rustup" "$1/root/.rustup" -o bind,ro
    mkdir -p "$1/root/.cargo/bin"
    cp -a "$cargo/bin/." "$1/root/.cargo/bin/"
    if [ -e "$cargo/config.toml" ]; then cp "$cargo/config.toml" "$1/root/.cargo/"; fi
    rm -rf "$1/root/pathtracer"
    git clone --quiet . "$1/root/pathtracer"
}
# The code block after a line of the README, without the sudo that root does not need.
command_after() {
    awk -v line="$1" '$0 == line { found = 1 } found && /^```$/ { exit } found && inside { print } found && /^```sh$/ { inside = 1 }' \
        README.md | sed 's/sudo //g'
}
# timed NAME ROOT COMMANDS: runs them there with an empty environment, and says how long it took.
timed() {
    local TIMEFORMAT="$1 on $suite: %0R s, %0U s of CPU"
    time env -i HOME=/root TERM=dumb DEBIAN_FRONTEND=noninteractive CARGO_TARGET_DIR=/root/target \
        PATH=/root/.cargo/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        "$(command -v chroot)" "$2" bash -euo pipefail -c "$3"
}
# Pictures at exact are the same file on every release, whatever its Embree.
say_hash() {
    test -s "$1"
    printf 'SHA-256 of %s on %s: %s\n' "$(basename "$1")" "$suite" "$(sha256sum < "$1" | cut -d ' ' -f 1)"
}
build_package() {
    timed 'install what the build needs' "$1" '
        apt-get -qq update
        apt-get -qq install -y build-essential libclang-dev libembree-dev libopenimageio-dev pkg-config'
    timed 'build cargo-deb' "$1" 'cargo install --quiet --debug cargo-deb --locked'
    # From nothing, whatever has been built before.
    timed 'build everything and the package' "$1" '
        export CARGO_TARGET_DIR=/root/pathtracer/target PROGRAM='"${PROGRAM:-}"'
        cd /root/pathtracer && packaging/deb.sh && packaging/check.sh target/debian/pathtracer_*.deb'
    package=$(echo "$1"/root/pathtracer/target/debian/pathtracer_*.deb)
}
# Installs the package where there is no compiler, and uses it as somebody who is not root.
try_package() {
    cp "$package" "$1/tmp/pathtracer.deb"
    timed 'install the package' "$1" 'apt-get -qq update && apt-get -qq install -y /tmp/pathtracer.deb'
    # shellcheck disable=SC2016
    timed 'render an example' "$1" '
        id user >/dev/null 2>&1 || useradd --create-home user
        su user -c "
            set -eu
            cd
            examples=/usr/share/doc/pathtracer/examples/scenes
            pathtracer --version
            pathtracer check \$examples/*.yaml
            pathtracer \$examples/objectScene.yaml 320 320 8 10 objectScene.png
            pathtracer \$examples/gallery.yaml 320 240 8 10 gallery.exr
            pathtracer \$examples/gallery.yaml 320 240 8 10 gallery.jpg
            pathtracer info gallery.jpg >/dev/null
            test -s objectScene.png -a -s gallery.jpg"
        apt-cache policy $(dpkg-query --show --showformat "\${Recommends}" pathtracer | tr -d "|,") | grep -B 1 Installed'
    # Meshes by Embree, and pictures as colours.
    say_hash "$1/home/user/objectScene.png"
    say_hash "$1/home/user/gallery.exr"
}

case $what in
render | tests | both)
    make_root "$folder/$suite"
    add_rust "$folder/$suite"
    ;;
package)
    if [ -z "$package" ]; then
        make_root "$folder/$suite"
        add_rust "$folder/$suite"
        build_package "$folder/$suite"
    fi
    make_root "$folder/$suite-package"
    try_package "$folder/$suite-package"
    ;;
*)
    echo "unknown: $what" >&2
    exit 2
    ;;
esac
if [ "$what" = render ] || [ "$what" = both ]; then
    timed 'set up and render' "$folder/$suite" "cd /root/pathtracer && $(command_after 'Set up and render:')"
    say_hash "$folder/$suite/root/pathtracer/bigBalls.png"
fi
if [ "$what" = tests ] || [ "$what" = both ]; then
    timed 'set up and pass the tests' "$folder/$suite" "cd /root/pathtracer && $(command_after 'Set up and pass the tests:')"
fi
