#!/bin/bash
# test-wheel.sh WHEEL FOLDER: installs a wheel into a Debian 12 that contains only Python, created
# in FOLDER, and uses it there: pictures with text by the command vv and by Python, Scripts of all
# engines, two workers. No warning may occur. The pictures stay in FOLDER/pictures. Nothing of this
# system is mounted there. NUMPY: the version of numpy ("numpy<2"). Needs root, debootstrap, pip
# (which downloads numpy) and Debian's mirror. A wheel for another processor (_aarch64.whl) needs
# qemu-user-static, whose programs the kernel must start (binfmt_misc); all of it is then slow.
set -euo pipefail
wheel=$(realpath "$1") folder=$(realpath -m "$2") here=$(realpath "$(dirname "$0")/..")
case $wheel in *_x86_64.whl) machine=x86_64 debian=amd64 ;; *_aarch64.whl) machine=aarch64 debian=arm64 ;;
  *) echo "test-wheel: $wheel: a wheel for x86_64 or aarch64 was expected" >&2; exit 1 ;; esac
root=$folder/root picture="--size 640x480 --spp 16" small="--size 320x240 --spp 16" emulated=
[ "$machine" = "$(uname -m)" ] || picture="--size 120x90 --spp 4" small=$picture emulated=--emulated
if [ "$machine" != "$(uname -m)" ] && ! grep -qs enabled /proc/sys/fs/binfmt_misc/qemu-$machine; then
  echo "test-wheel: the kernel does not start programs for $machine: install qemu-user-static and binfmt-support" >&2; exit 1
fi
if [ -e "$root" ] && [ "$(cat "$root/debootstrap-done" 2>/dev/null)" != "$machine" ]; then
  echo "test-wheel: $root is no finished Debian for $machine: remove it, or name another folder" >&2; exit 1
fi
if [ ! -e "$root/debootstrap-done" ]; then
  mkdir -p "$root"
  debootstrap --arch=$debian --variant=minbase --include=python3,python3-venv,python3-pip bookworm "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
  echo "$machine" >"$root/debootstrap-done"
fi
rm -rf "$root/try" "$folder/wheels" && mkdir -p "$root/try" "$folder/pictures" "$folder/wheels"
"${PYTHON:-python3}" -m pip download -q --only-binary=:all: --python-version "$(chroot "$root" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')" \
  --platform manylinux2014_$machine --platform manylinux_2_28_$machine --platform manylinux_2_27_$machine -d "$folder/wheels" "${NUMPY:-numpy}"
cp "$wheel" "$folder"/wheels/numpy*.whl "$here"/examples/scenes/still_life.wrl "$here"/tools/wheel/try_wheel.py "$root/try/"
cp -r "$here/examples/scenes" "$root/try/scenes"
cat >"$root/try/text.wrl" <<'W'
#VRML V2.0 utf8
Viewpoint { position 0 0 9 }
Shape { appearance Appearance { material Material { } } geometry Text {
  string [ "SERIF" "bold" ] fontStyle FontStyle { justify [ "MIDDLE" "MIDDLE" ] style "BOLD" } } }
W
inside() {
  unshare --mount --pid --fork --kill-child --mount-proc="$root/proc" bash -c 'mkdir -p "$0/dev/shm" && mount -t tmpfs none "$0/dev/shm" &&
    exec chroot "$0" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/root bash -euc "cd /try; $1"' "$root" "$1" </dev/null
}
# The root must contain no library of this project, no font and no display.
inside 'if ls /usr/lib/*-linux-gnu | grep -E "embree|tbb|OpenEXR|libX11|libglib|libtcl"; then echo "the root is not bare"; exit 1; fi
        if [ -e /usr/share/fonts ] || [ -e /etc/fonts ]; then echo "the root has fonts"; exit 1; fi'
inside 'python3 -m venv v && v/bin/pip install -q --no-index --find-links=. xvrml-*.whl && v/bin/pip list'
inside '{ v/bin/vv still_life.wrl -o vv.png '"$picture"' --strict
          v/bin/vv text.wrl -o text.png '"$small"' --strict
          v/bin/vv scenes/glass_ball.wrl -o glass.png --size 160x120 --spp 4 --strict
          v/bin/python try_wheel.py tried '$emulated'; v/bin/vv --list-engines; v/bin/vv --version; v/bin/openrt-replay --help >/dev/null; } 2>errors
        v/bin/openrt-worker --connect 127.0.0.1:7447 2>/dev/null & v/bin/openrt-worker --connect 127.0.0.1:7447 2>/dev/null &
        v/bin/vv still_life.wrl -o cluster.png '"$picture"' --local-threads 0 --listen-workers 127.0.0.1:7447 --require-workers 2 2>errors.cluster
        kill %1 %2; cmp vv.png cluster.png; echo "two workers: the same picture"' || { cat "$root"/try/errors* >&2; exit 1; }
if grep -v '^vv: *[0-9]* %' "$root/try/errors" | grep -q .; then echo "test-wheel: warnings:" >&2; cat "$root/try/errors" >&2; exit 1; fi
cp "$root"/try/*.png "$folder/pictures/" && cp "$root/try/tried/python.png" "$folder/pictures/"
echo "the wheel works; pictures in $folder/pictures"
