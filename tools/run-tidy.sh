#!/bin/bash
# run-tidy.sh BUILD JOBS: runs clang-tidy (.clang-tidy) on every source of the repository that BUILD
# compiles. Fails on any warning.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 jobs=$2
sources=$(git ls-files 'libopenrt/*.cpp' 'libxvrml/*.cpp' 'plugins/*.cpp' 'apps/*.cpp' 'bindings/*.cpp')
# shellcheck disable=SC2086
printf '%s\n' $sources | xargs -P "$jobs" -n 4 clang-tidy-14 -p "$build" --quiet --warnings-as-errors='*' 2> >(grep -v 'warnings generated' >&2 || true)
