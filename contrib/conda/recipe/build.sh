#!/bin/bash
# Builds and installs the package of recipe.yaml. CMAKE_ARGS, PREFIX and SP_DIR come from conda.
set -euo pipefail
cmake -S . -B build/conda -G Ninja ${CMAKE_ARGS:-} -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PREFIX" \
  -DOPENRT_PYTHON_DIR="${SP_DIR#"$PREFIX"/}" -DPython_EXECUTABLE="$PYTHON" -DPython3_EXECUTABLE="$PYTHON"
cmake --build build/conda -j "${CPU_COUNT:-2}"
for part in libopenrt libxvrml dev vv python; do cmake --install build/conda --component $part; done
