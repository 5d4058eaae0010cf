#!/bin/bash
# cross-aarch64.sh FOLDER JOBS [TARGET...]: builds the project for 64-bit ARM on another machine with
# Debian, into FOLDER/release, and draws a picture there. FOLDER/root becomes a Debian 12 for arm64,
# unpacked and never run; this system's package manager learns nothing of the other architecture.
# OPTIONS: further options of cmake. Needs root, Debian's mirror, and the packages
# g++-aarch64-linux-gnu and mmdebstrap; the picture needs qemu-user-static, too.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(realpath -m "$1") jobs=${2:-2}
shift $(($# < 2 ? $# : 2))
targets=("$@")
[ $# -gt 0 ] || targets=(vv openrt-worker openrt-replay shaders scripts xvrml_python)
for tool in aarch64-linux-gnu-g++ mmdebstrap flatc; do
  command -v $tool >/dev/null || { echo "cross-aarch64: $tool is not installed" >&2; exit 1; }
done

# The packages that are linked. Tools of the build are this machine's. A stamp is written last, so
# that an interrupted root is made again.
root=$folder/root
tools='g\+\+|make|cmake|ninja-build|ccache|pkg-config|git|ca-certificates|flatbuffers-compiler'
packages=$(tools/install-packages.sh --list | grep -vxE "$tools" | paste -sd,)
if [ "$(cat "$root/packages" 2>/dev/null)" != "$packages" ]; then
  rm -rf "$root" && mkdir -p "$root"
  mmdebstrap --variant=extract --architectures=arm64 --include="$packages,libc6-dev,libstdc++-12-dev,libgtest-dev,librapidcheck-dev" \
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
fi

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
