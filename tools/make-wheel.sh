#!/bin/bash
# make-wheel.sh FOLDER JOBS: the Python distribution with all that it needs, FOLDER/xvrml-*.whl: what `pip install .` builds, in the
# isolated environment that pip makes of pyproject.toml's build-system.requires. PYTHON: the Python that it is for.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1 jobs=${2:-2}
[ -x build/venv/bin/pip ] || "${PYTHON:-python3}" -m venv build/venv
rm -f "$folder"/xvrml-*.whl
CMAKE_BUILD_PARALLEL_LEVEL=$jobs build/venv/bin/pip wheel . --no-deps -w "$folder"
"${PYTHON:-python3}" tests/checks/hardening.py "$folder"/xvrml-*.whl # no path of this machine, nothing executable that is writable
