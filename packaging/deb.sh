#!/usr/bin/env bash
# packaging/deb.sh [OPTION...]: builds the program and a Debian package of it for the release of Debian that this runs on, and
# prints the package's path. Options go to cargo-deb. Needs cargo-deb (`cargo install cargo-deb`) and what the build needs.
# Who hands the package on names himself by DEBFULLNAME and DEBEMAIL, as with Debian's own tools. With PROGRAM the package
# is made of a program that is built already.
set -euo pipefail
cd "$(dirname "$0")/.."

target=${CARGO_TARGET_DIR:-target}
folder=$target/release/package
version=$(sed -n '/^\[workspace.package\]/,/^version/s/^version = "\(.*\)"/\1/p' Cargo.toml)
maintainer=$(sed -n 's/^maintainer = "\(.*\)"/\1/p' Cargo.toml)
if [ -n "${DEBFULLNAME:-}" ] && [ -n "${DEBEMAIL:-}" ]; then maintainer="$DEBFULLNAME <$DEBEMAIL>"; fi
# shellcheck disable=SC1091
. /etc/os-release
revision="1~deb${VERSION_ID:?not a release of Debian}"

program=$target/release/pathtracer
if [ -z "${PROGRAM:-}" ]; then
    cargo build --release --locked
elif [ "$PROGRAM" != "$program" ]; then
    mkdir -p "$target/release"
    # Not through the hard link that cargo has made.
    cp --remove-destination "$PROGRAM" "$program"
fi
mkdir -p "$folder/docs"
"$program" man | gzip -9n > "$folder/pathtracer.1.gz"
for shell in bash zsh fish; do "$program" completions "$shell" > "$folder/pathtracer.$shell"; done
packaging/documents.pl "$folder"
gzip -9nc CHANGELOG.md > "$folder/changelog.gz"
gzip -9n > "$folder/changelog.Debian.gz" <<END
pathtracer ($version-$revision) $VERSION_CODENAME; urgency=medium

  * Built for Debian $VERSION_ID. What is new: changelog.gz beside this file.

 -- $maintainer  $(date -R -r CHANGELOG.md)
END
cargo deb --no-build --deb-revision "$revision" --maintainer "$maintainer" "$@"
