#!/bin/bash
# make-wheel.sh FOLDER JOBS: builds the Python distribution with everything it needs,
# FOLDER/xvrml-*.whl. This is the wheel that `pip install .` builds, in the isolated environment
# that pip makes from pyproject.toml's build-system.requires. PYTHON: the Python to build for.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1 jobs=${2:-2}
[ -x build/venv/bin/pip ] || "${PYTHON:-python3}" -m venv build/venv
rm -f "$folder"/xvrml-*.whl
CMAKE_BUILD_PARALLEL_LEVEL=$jobs build/venv/bin/pip wheel . --no-deps -w "$folder"
# checks for paths of this machine and for memory that is both writable and executable
"${PYTHON:-python3}" tests/checks/hardening.py "$folder"/xvrml-*.whl
