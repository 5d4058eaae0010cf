#!/bin/bash
# make-deb.sh FOLDER JOBS: builds Debian packages for this system's release, FOLDER/*.deb, with
# CPack (cmake/Packages.cmake).
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1 jobs=${2:-2} python=${PYTHON:-/usr/bin/python3}
cmake --log-level=NOTICE -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_INSTALL_RPATH=ON \
  -DOPENRT_PYTHON_DIR=lib/python3/dist-packages -DPython_EXECUTABLE="$python" -DPython3_EXECUTABLE="$python"
# The packaged programs have no run path. Those that run during the build (for manual pages) find
# the libraries here.
LD_LIBRARY_PATH="$(realpath "$folder")/lib" cmake --build "$folder" -j "$jobs"
cd "$folder" && cpack
python3 "$OLDPWD/tests/checks/hardening.py" ./*.deb
