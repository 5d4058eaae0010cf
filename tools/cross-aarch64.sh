#!/bin/bash
# cross-aarch64.sh FOLDER JOBS [TARGET...]: builds the project for 64-bit ARM on another machine with
# Debian, into FOLDER/release, and draws a picture there. FOLDER/root becomes a Debian for arm64
# (make-aarch64-root.sh). OPTIONS: further options of cmake. Needs root, Debian's mirror, and the
# packages g++-aarch64-linux-gnu and mmdebstrap; the picture needs qemu-user-static, too.
set -euo pipefail
folder=$(realpath -m "$1")
cd "$(dirname "$0")/.."
jobs=${2:-2}
shift $(($# < 2 ? $# : 2))
targets=("$@")
[ $# -gt 0 ] || targets=(vv openrt-worker openrt-replay shaders scripts xvrml_python)
for tool in aarch64-linux-gnu-g++ flatc; do
  command -v $tool >/dev/null || { echo "cross-aarch64: $tool is not installed" >&2; exit 1; }
done
root=$folder/root
tools/make-aarch64-root.sh "$root"

python=${PYTHON:-/usr/bin/python3}
read -ra options <<<"${OPTIONS:-}"
cmake --log-level=NOTICE -S . -B "$folder/release" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/toolchains/aarch64-linux-gnu.cmake" -DOPENRT_SYSROOT="$root" \
  -DPython_EXECUTABLE="$python" -DPython3_EXECUTABLE="$python" \
  -DOPENRT_WINDOW=OFF -DOPENRT_SERVER=OFF -DOPENRT_FILMS=OFF "${options[@]}"
cmake --build "$folder/release" -j "$jobs" --target "${targets[@]}"

qemu=$(command -v qemu-aarch64-static || command -v qemu-aarch64 || true)
if [ -n "$qemu" ] && [ -x "$folder/release/bin/vv" ]; then
  "$qemu" -L "$root" "$folder/release/bin/vv" examples/scenes/still_life.wrl -o "$folder/still_life.png" --size 160x120 --spp 4
  echo "$folder/still_life.png: drawn by the program for 64-bit ARM"
elif [ -z "$qemu" ]; then
  echo "cross-aarch64: built; without qemu-user-static it is not tried"
fi
