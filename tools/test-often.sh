#!/bin/bash
# test-often.sh BUILD TIMES: runs TIMES times what may depend on time: the tests of ctest that have
# the label `timed`, and the files of tests/python that start threads, windows, servers or clusters.
# TESTS="test_control ..." names other files, and leaves ctest out. Every failure is printed, and one
# ends the run with exit code 1: a test that fails by chance shows a fault of the product, until it
# is shown that the test is wrong.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1 times=$2 failed=0 runs=0
starts='threading|Popen|asyncio|multiprocessing|(cluster_tools|control_server|page_client|webdriver|window_driver|xserver) import'
if [ -n "${TESTS:-}" ]; then
  read -ra files <<<"$TESTS"
  files=("${files[@]/#/tests/python/}") && files=("${files[@]/%/.py}")
else
  mapfile -t files < <(grep -lE "$starts" tests/python/test_*.py)
  ctest --test-dir "$build" --no-tests=error -L timed --repeat "until-fail:$times" --output-on-failure || failed=1
fi
for _ in $(seq "$times"); do
  for file in "${files[@]}"; do
    runs=$((runs + 1))
    PYTHONPATH=$build/python "${PYTHON:-python3}" -m pytest -q -p no:cacheprovider "$file" >"$build/often.log" 2>&1 && continue
    failed=$((failed + 1))
    grep -E '^(FAILED|ERROR)' "$build/often.log" || tail -n 20 "$build/often.log"
  done
done
echo "FIGURE: $times times ${#files[@]} files of tests/python ($runs runs), $failed failures"
[ "$failed" = 0 ]
