#!/bin/bash
# test-wheel.sh WHEEL FOLDER: installs a wheel into a Debian 12 that has Python and nothing else, made in FOLDER, and uses it there:
# a picture by the command vv, one by Python, an untrusted Script, a shader plug-in. Pictures are left in FOLDER/pictures. Nothing of
# this system is mounted there. Needs root, debootstrap, pip (which fetches numpy) and Debian's mirror.
set -euo pipefail
wheel=$(realpath "$1") folder=$(realpath -m "$2") here=$(realpath "$(dirname "$0")/..")
root=$folder/root
if [ ! -e "$root/etc/debian_version" ]; then
  mkdir -p "$root"
  debootstrap --variant=minbase --include=python3,python3-venv,python3-pip bookworm "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}"
fi
rm -rf "$root/try" && mkdir -p "$root/try" "$folder/pictures" "$folder/wheels"
"${PYTHON:-python3}" -m pip download -q --only-binary=:all: --python-version "$(chroot "$root" python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')" \
  --platform manylinux2014_x86_64 --platform manylinux_2_28_x86_64 --platform manylinux_2_27_x86_64 -d "$folder/wheels" "${NUMPY:-numpy}"
cp "$wheel" "$folder"/wheels/numpy*.whl "$here"/examples/scenes/still_life.wrl "$root/try/"
cp -r "$here/examples/scenes" "$root/try/scenes"
cat >"$root/try/try.py" <<'P'
import pathlib
import numpy
import xvrml
print("package:", pathlib.Path(xvrml.__file__).parent)
world = xvrml.load("still_life.wrl")
picture = world.render(size=(320, 240), spp=8)
pixels = numpy.asarray(picture)
assert pixels.shape == (240, 320, 4) and pixels[..., :3].std() > 0.05, pixels.shape
picture.save("python.png")
pathlib.Path("js.wrl").write_text('#VRML V2.0 utf8\nDEF S Script { eventOut SFFloat x url "javascript:function initialize() { x = 42; }" }\n')
browser = xvrml.Browser("js.wrl")
browser.tick(0.1)
print("Script: x =", browser["S"].x)
assert browser["S"].x == 42
P
inside() {
  unshare --mount --pid --fork --mount-proc="$root/proc" chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/root bash -euc "cd /try; $1"
}
# No library of ours and no display may be there.
inside 'if ls /usr/lib/x86_64-linux-gnu | grep -E "embree|tbb|OpenEXR|libX11|libglib"; then echo "the root is not bare"; exit 1; fi'
inside 'rm -rf v && python3 -m venv v && v/bin/pip install -q --no-index --find-links=. xvrml-*.whl && v/bin/pip list'
inside 'v/bin/vv still_life.wrl -o vv.png --size 640x480 --spp 16 && v/bin/python try.py && v/bin/vv --list-engines && v/bin/vv --version &&
        v/bin/openrt-replay --help >/dev/null && v/bin/vv scenes/glass_ball.wrl -o glass.png --size 160x120 --spp 4'
cp "$root"/try/*.png "$folder/pictures/"
echo "the wheel works; pictures in $folder/pictures"
