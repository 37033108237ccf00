#!/usr/bin/env bash
# tests/fresh/run.sh SUITE [FOLDER]: the README's two commands on a Debian SUITE (bookworm or trixie) that has nothing but
# Rust, in a root made by debootstrap under FOLDER, each with its seconds. Needs root, debootstrap and a Rust toolchain of
# rustup here, which the new root borrows. A root that is there already is used again: then the first command is not timed
# from nothing. Certificates and cargo's settings of this machine are passed on, so that mirrors work there too.
set -euo pipefail
cd "$(dirname "$0")/../.."

suite=${1:?usage: tests/fresh/run.sh SUITE [FOLDER]}
folder=${2:-$(mktemp -d)}
root=$folder/$suite
rustup=${RUSTUP_HOME:-$HOME/.rustup}
cargo=${CARGO_HOME:-$HOME/.cargo}

if [ ! -e "$root/etc/debian_version" ]; then
    debootstrap --variant=minbase --include=ca-certificates "$suite" "$root" >/dev/null
fi
mounted=()
unmount() { for place in "${mounted[@]}"; do umount "$place"; done; }
trap unmount EXIT
borrow() {
    mkdir -p "$2"
    mount "${@:3}" "$1" "$2"
    mounted=("$2" "${mounted[@]}")
}
borrow proc "$root/proc" -t proc
borrow /dev "$root/dev" --bind
borrow "$rustup" "$root/root/.rustup" -o bind,ro
mkdir -p "$root/root/.cargo/bin"
cp -a "$cargo/bin/." "$root/root/.cargo/bin/"
if [ -e "$cargo/config.toml" ]; then cp "$cargo/config.toml" "$root/root/.cargo/"; fi
for file in /etc/resolv.conf /etc/hosts /etc/ssl/certs/ca-certificates.crt; do
    if [ -e "$file" ]; then cp -L "$file" "$root$file"; fi
done

rm -rf "$root/root/pathtracer"
git clone --quiet . "$root/root/pathtracer"
# The code block after a line of the README, without the sudo that root does not need.
command_after() {
    awk -v line="$1" '$0 == line { found = 1 } found && /^```$/ { exit } found && inside { print } found && /^```sh$/ { inside = 1 }' \
        README.md | sed 's/sudo //g'
}
timed() {
    local start=$SECONDS
    env -i HOME=/root TERM=dumb DEBIAN_FRONTEND=noninteractive CARGO_TARGET_DIR=/root/target \
        PATH=/root/.cargo/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        "$(command -v chroot)" "$root" bash -euo pipefail -c "cd /root/pathtracer && $2"
    printf '%s on %s: %d s\n' "$1" "$suite" "$((SECONDS - start))"
}
timed 'set up and render' "$(command_after 'Set up and render:')"
test -s "$root/root/pathtracer/bigBalls.png"
timed 'set up and pass the tests' "$(command_after 'Set up and pass the tests:')"
