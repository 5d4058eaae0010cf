#!/bin/bash
# Installs the Debian packages that the project needs. `tools/install-packages.sh` installs those
# for building, testing and the demo; `dev` adds the ones for `make fuzz`, `make tidy` and `make
# format`, `docs` those for `make docs`. If all are installed, it returns at once and needs no
# network. Runs as root or through sudo.
set -euo pipefail

build=(
  g++ make cmake ninja-build ccache pkg-config git ca-certificates
  libembree-dev libtbb-dev libhwy-dev                           # ray kernels, threads, vectors
  libimath-dev libopenexr-dev libpng-dev libjpeg-dev libgif-dev # small maths, pictures
  libwebp-dev libstb-dev libsndfile1-dev                        # more pictures, sounds
  zlib1g-dev libzstd-dev libxxhash-dev                          # compression, hashes
  libexpat1-dev                                                 # X3D in XML
  libflatbuffers-dev flatbuffers-compiler # scene edits
  libzmq3-dev cppzmq-dev liblz4-dev       # the cluster
  libfast-float-dev libfmt-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev
  libavcodec-dev libavformat-dev libswscale-dev # films; optional
  libfreetype-dev libharfbuzz-dev libfontconfig-dev fonts-dejavu-core libglu1-mesa-dev # text, polygons
  python3 python3-dev python3-numpy python3-venv pybind11-dev
  # script engines, each built if its library is installed; their sandbox
  duktape-dev tcl-dev tk-dev libffi-dev libseccomp-dev
  libsdl2-dev libimgui-dev                             # the window and its editor
  libwebsockets-dev                                    # the page of vv serve
)
tests=(libglut-dev libglu1-mesa-dev libgtest-dev librapidcheck-dev libbenchmark-dev python3-pytest python3-hypothesis python3-pil python3-zmq xvfb xdotool python3-yaml python3-distributed mypy chromium chromium-driver)
dev=(clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev llvm-14)
docs=(python3-sphinx python3-myst-parser furo python3-sphinx-copybutton doxygen)

# Debian 12 has none of these; a build without them does less (docs/scripts.md).
newer=(libquickjs)

# `--list` only prints the packages for building (tools/cross-aarch64.sh).
if [ "${1:-}" = --list ]; then
  printf '%s\n' "${build[@]}"
  exit 0
fi

wanted=("${build[@]}" "${tests[@]}")
[ "${1:-}" = dev ] && wanted+=("${dev[@]}")
[ "${1:-}" = docs ] && wanted+=("${docs[@]}")

if ! command -v apt-get >/dev/null; then
  echo "install-packages: no apt-get here; install the counterparts of these packages yourself:" "${wanted[@]}" >&2
  exit 0
fi

for package in "${newer[@]}"; do
  apt-cache show "$package" >/dev/null 2>&1 && wanted+=("$package")
done

installed=$(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^ii  *//p' || true)
missing=()
for package in "${wanted[@]}"; do
  grep -qx -- "$package" <<<"$installed" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "install-packages: needs root or sudo to install:" "${missing[@]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} system packages: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
install() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300 \
    install --no-install-recommends "${missing[@]}" </dev/null >"$log" 2>&1
}
# The package lists may be old or missing: fetch them first. If that fails, try with the existing
# ones.
"${as_root[@]}" apt-get -qq -o DPkg::Lock::Timeout=300 update </dev/null >"$log" 2>&1 || cat "$log" >&2
if ! install; then
  cat "$log" >&2
  echo "install-packages: apt-get could not install the packages above" >&2
  exit 1
fi
