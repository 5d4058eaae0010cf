#!/bin/bash
# test-embree4.sh FOLDER JOBS: builds the project and runs all its tests in a Debian 13 (trixie),
# which has Embree 4. FOLDER becomes its root. Nothing of this system is mounted there; the sources,
# and the corpus (OPENRT_CORPUS) if there is one, are copied. A later run reuses packages, ccache
# and the build. Needs root, debootstrap, unshare and Debian's mirror.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$(realpath -m "$1") jobs=${2:-2} corpus=${OPENRT_CORPUS:-../shared/corpus}
for tool in debootstrap unshare; do
  command -v $tool >/dev/null || { echo "test-embree4: $tool is not installed" >&2; exit 1; }
done
[ "$(id -u)" = 0 ] || { echo "test-embree4: needs root" >&2; exit 1; }

# Runs a command with its own root and its own processes; /proc and /dev/shm end with the command.
inside() {
  unshare --mount --pid --fork --kill-child --mount-proc="$root/proc" bash -c \
    'mkdir -p "$0/dev/shm" && mount -t tmpfs none "$0/dev/shm" && exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 bash -euc "$1"' \
    "$root" "$1" </dev/null
}

# The stamp is written last, so that an interrupted root is created again.
if [ ! -e "$root/debootstrap-done" ]; then
  mkdir -p "$root"
  debootstrap --variant=minbase --include=ca-certificates trixie "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
  touch "$root/debootstrap-done"
fi
cp -L /etc/resolv.conf "$root/etc/"
# Copies the sources again, so that deleted files disappear. Unchanged files keep their time, and
# changed ones get a new one.
mkdir -p "$root/src" && rm -rf "$root/src.new" && mkdir "$root/src.new"
git ls-files -z | tar --null -T - -c | tar -xm -C "$root/src.new"
(cd "$root/src.new" && find . -type f -print0 | while IFS= read -r -d '' file; do
  if cmp -s "$file" "../src/$file"; then touch -r "../src/$file" "$file"; fi
done)
if [ -d "$root/src/build" ]; then mv "$root/src/build" "$root/src.new/"; fi
rm -rf "$root/src" && mv "$root/src.new" "$root/src"
if [ -d "$corpus" ] && [ ! -d "$root/shared/corpus" ]; then
  mkdir -p "$root/shared" && cp -rL "$corpus" "$root/shared/corpus"
fi
inside "cd /src && tools/install-packages.sh && dpkg-query -W libembree-dev g++ && make test JOBS=$jobs"
