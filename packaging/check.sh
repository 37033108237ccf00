#!/usr/bin/env bash
# packaging/check.sh DEB: whether a package holds what it should and can be installed here, without installing it.
set -euo pipefail
package=$(realpath "${1:?usage: packaging/check.sh DEB}")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
fail() { echo "$package: $*" >&2; exit 1; }

dpkg-deb --extract "$package" "$work"
cd "$work/usr/share"
for file in man/man1/pathtracer.1.gz bash-completion/completions/pathtracer zsh/vendor-completions/_pathtracer \
    fish/vendor_completions.d/pathtracer.fish applications/pathtracer.desktop doc/pathtracer/copyright doc/pathtracer/changelog.gz; do
    [ -s "$file" ] || fail "/usr/share/$file is missing"
done
dpkg-deb --field "$package" Depends | grep -q libembree || fail 'it does not depend on Embree'
dpkg-deb --field "$package" Conflicts | grep -qx embree-tools || fail 'it does not exclude embree-tools'

# What it depends on, and one of every choice that it recommends, are packages of this release.
{ dpkg-deb --field "$package" Depends; dpkg-deb --field "$package" Recommends; } | tr ',' '\n' | sed 's/([^)]*)//g' |
    while IFS='|' read -r -a choices; do
        for choice in "${choices[@]}"; do
            if apt-cache show "${choice// /}" >/dev/null 2>&1; then continue 2; fi
        done
        fail "no package of this release is ${choices[*]}"
    done

# Links of the documents lead to files of the package.
cd doc/pathtracer
for document in README.md docs/*.md; do
    grep -o '](\([^)#]*\)' "$document" | sed 's/^](//' | sort -u | while read -r link; do
        case $link in '' | http*) continue ;; esac
        [ -e "$(dirname "$document")/$link" ] || fail "$document links to $link"
    done
done
grep -oh '/usr/share/doc/pathtracer/[a-zA-Z/]*\.yaml' README.md docs/*.md | sort -u | while read -r scene; do
    case $scene in */NAME.yaml) continue ;; esac
    [ -e "$work$scene" ] || fail "the documents name $scene"
done

# The program works with the examples of the package.
cd examples/scenes
"$work/usr/bin/pathtracer" check ./*.yaml >/dev/null
"$work/usr/bin/pathtracer" objectScene.yaml 32 32 1 4 "$work/picture.png" --quiet
[ -s "$work/picture.png" ] || fail 'it renders no picture'
echo "$(basename "$package"): $(dpkg-deb --contents "$package" | grep -c '^-') files, $(stat -c %s "$package") bytes; the program in it $(stat -c %s "$work/usr/bin/pathtracer") bytes"
