#!/usr/bin/env bash
# packaging/deb.sh: builds the program and a Debian package of it for the release of Debian that this runs on, and prints the
# package's path. Needs cargo-deb (`cargo install cargo-deb`) and what the build needs.
set -euo pipefail
cd "$(dirname "$0")/.."

target=${CARGO_TARGET_DIR:-target}
folder=$target/release/package
version=$(sed -n '/^\[workspace.package\]/,/^version/s/^version = "\(.*\)"/\1/p' Cargo.toml)
# shellcheck disable=SC1091
. /etc/os-release
revision="1~deb${VERSION_ID:?not a release of Debian}"

cargo build --release --locked
mkdir -p "$folder"
program=$target/release/pathtracer
"$program" man | gzip -9n > "$folder/pathtracer.1.gz"
for shell in bash zsh fish; do "$program" completions "$shell" > "$folder/pathtracer.$shell"; done
gzip -9nc CHANGELOG.md > "$folder/changelog.gz"
gzip -9n > "$folder/changelog.Debian.gz" <<END
pathtracer ($version-$revision) $VERSION_CODENAME; urgency=medium

  * Built for Debian $VERSION_ID. What is new: changelog.gz beside this file.

 -- $(sed -n 's/^maintainer = "\(.*\)"/\1/p' Cargo.toml)  $(date -R -r CHANGELOG.md)
END
cargo deb --no-build --deb-revision "$revision"
