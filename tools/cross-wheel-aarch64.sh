#!/bin/bash
# cross-wheel-aarch64.sh FOLDER JOBS: builds the Python distribution for 64-bit ARM on another machine
# with Debian, FOLDER/xvrml-*_aarch64.whl, for the Python of Debian 12. FOLDER/root becomes a Debian for
# arm64 (make-aarch64-root.sh); its path has no blanks, which CMAKE_ARGS cannot hold. Needs what
# cross-aarch64.sh needs; pip downloads the backend.
set -euo pipefail
folder=$(realpath -m "$1")
cd "$(dirname "$0")/.."
jobs=${2:-2}
root=$folder/root
tools/make-aarch64-root.sh "$root"

# The backend is not isolated, so that CMake can be told where this pybind11 lies: it looks for packages
# in the root alone.
[ -x "$folder/venv/bin/pip" ] || /usr/bin/python3 -m venv "$folder/venv"
mapfile -t backend < <(sed -n '/^requires = \[/,/^\]/s/^ *"\([^;"]*\).*/\1/p' pyproject.toml)
"$folder/venv/bin/pip" install -q "${backend[@]}"
python=$folder/venv/bin/python
rm -f "$folder"/xvrml-*_aarch64.whl
# The folders of libraries are those where auditwheel looks; the programs of this machine skip
# libraries for another one.
LD_LIBRARY_PATH=$root/usr/lib/aarch64-linux-gnu:$root/lib/aarch64-linux-gnu _PYTHON_HOST_PLATFORM=linux-aarch64 CMAKE_BUILD_PARALLEL_LEVEL=$jobs \
  CMAKE_ARGS="-DCMAKE_TOOLCHAIN_FILE=$PWD/cmake/toolchains/aarch64-linux-gnu.cmake -DOPENRT_SYSROOT=$root \
  -DPython_INCLUDE_DIR=$(echo "$root"/usr/include/python3.*) -Dpybind11_DIR=$("$python" -m pybind11 --cmakedir)" \
  PATH="$folder/venv/bin:$PATH" "$python" -m pip wheel . --no-deps --no-build-isolation --config-settings=build-dir="$folder/wheel" -w "$folder"
"${PYTHON:-python3}" tests/checks/hardening.py "$folder"/xvrml-*_aarch64.whl
