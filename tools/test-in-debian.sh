#!/bin/bash
# test-in-debian.sh RELEASE FOLDER JOBS: builds the project and runs `make test` in a Debian of its
# own, as on a machine that has nothing of ours. FOLDER becomes its root. The sources are those that
# git tracks here; nothing of this system is mounted there. Needs root, debootstrap, unshare and
# Debian's mirror ($DEBIAN_MIRROR, if it is not debootstrap's).
#
# trixie (Debian 13) has Embree 4. A later run reuses packages, compiler cache and the build, and the
# corpus is copied there, if there is one (OPENRT_CORPUS).
# bookworm (Debian 12) is the machine that the README speaks of: the build begins anew at each run,
# without a compiler cache, and there is no corpus.
set -euo pipefail
cd "$(dirname "$0")/.."
release=$1 root=$(realpath -m "$2") jobs=${3:-2} corpus=${OPENRT_CORPUS:-../shared/corpus}
for tool in debootstrap unshare; do
  command -v $tool >/dev/null || { echo "test-in-debian: $tool is not installed" >&2; exit 1; }
done
[ "$(id -u)" = 0 ] || { echo "test-in-debian: needs root" >&2; exit 1; }

# Runs a command with its own root and its own processes; /proc and /dev/shm end with the command.
inside() {
  unshare --mount --pid --fork --kill-child --mount-proc="$root/proc" bash -c \
    'mkdir -p "$0/dev/shm" && mount -t tmpfs none "$0/dev/shm" && exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 bash -euc "$1"' \
    "$root" "$1" </dev/null
}

# The stamp is written last, so that an interrupted root is created again.
if [ ! -e "$root/debootstrap-done" ]; then
  mkdir -p "$root"
  debootstrap --variant=minbase --include=ca-certificates,make "$release" "$root" ${DEBIAN_MIRROR:+"$DEBIAN_MIRROR"}
  touch "$root/debootstrap-done"
fi
cp -L /etc/resolv.conf "$root/etc/"
# Copies the sources again, so that deleted files disappear. Unchanged files keep their time, and
# changed ones get a new one.
mkdir -p "$root/src" && rm -rf "$root/src.new" && mkdir "$root/src.new"
git ls-files -z | tar --null -T - -c | tar -xm -C "$root/src.new"
if [ "$release" = bookworm ]; then
  rm -rf "$root/src" && mv "$root/src.new" "$root/src"
  inside "cd /src && CCACHE_DISABLE=1 make test JOBS=$jobs"
  exit
fi
(cd "$root/src.new" && find . -type f -print0 | while IFS= read -r -d '' file; do
  if cmp -s "$file" "../src/$file"; then touch -r "../src/$file" "$file"; fi
done)
if [ -d "$root/src/build" ]; then mv "$root/src/build" "$root/src.new/"; fi
rm -rf "$root/src" && mv "$root/src.new" "$root/src"
if [ -d "$corpus" ] && [ ! -d "$root/shared/corpus" ]; then
  mkdir -p "$root/shared" && cp -rL "$corpus" "$root/shared/corpus"
fi
inside "cd /src && tools/install-packages.sh && dpkg-query -W libembree-dev g++ && make test JOBS=$jobs"
