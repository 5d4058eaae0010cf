#!/bin/bash
# make-aarch64-root.sh FOLDER: unpacks a Debian 12 for 64-bit ARM into FOLDER, with the packages that
# the project links. It is never run, and this system's package manager learns nothing of the other
# architecture. Needs root, Debian's mirror and mmdebstrap.
set -euo pipefail
root=$(realpath -m "$1")
cd "$(dirname "$0")/.."
command -v mmdebstrap >/dev/null || { echo "make-aarch64-root: mmdebstrap is not installed" >&2; exit 1; }

# The packages that are linked. Tools of the build are this machine's. A stamp is written last, so
# that an interrupted root is made again.
tools='g\+\+|make|cmake|ninja-build|ccache|pkg-config|git|ca-certificates|flatbuffers-compiler'
packages=$(tools/install-packages.sh --list | grep -vxE "$tools" | paste -sd,),libc6-dev,libstdc++-12-dev,libgtest-dev,librapidcheck-dev
[ "$(cat "$root/packages" 2>/dev/null)" != "$packages" ] || exit 0
# Only what this script has begun is deleted.
if [ -e "$root" ] && [ ! -e "$root.begun" ] && [ -n "$(ls -A "$root")" ]; then
  echo "make-aarch64-root: $root: a new or an empty folder was expected" >&2
  exit 1
fi
rm -rf "$root" && mkdir -p "$root" && touch "$root.begun"
mmdebstrap --variant=extract --architectures=arm64 --include="$packages" \
  bookworm "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
rm -f "$root"/var/cache/apt/archives/*.deb
# Links are made relative, as those that begin at the root would lead into this system.
find "$root" -xdev -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
  to=$root$(readlink "$link")
  if [ -e "$to" ]; then ln -sfnr "$to" "$link"; fi
done
# numpy's libraries have places that Debian's alternatives choose at installation.
for library in blas/libblas.so.3 lapack/liblapack.so.3; do
  if [ -e "$root/usr/lib/aarch64-linux-gnu/$library" ]; then ln -sfn "$library" "$root/usr/lib/aarch64-linux-gnu/"; fi
done
echo "$packages" >"$root/packages"
