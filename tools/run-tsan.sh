#!/bin/bash
# run-tsan.sh FOLDER JOBS: runs the tests of a build with ThreadSanitizer (preset tsan): first those
# in C++, with ctest, then those in Python whose programs share a world among threads: the page, the
# control channel, the window, their editor, and clusters. TESTS="test_control ..." names other ones.
#
# Anything that the sanitizer reports about programs that the Python tests start goes to
# FOLDER/races, because a test need not notice how its program ends. One report ends the run with
# exit code 1. Programs are about ten times slower than usual here, so a Python test may fail by a
# limit of time that it sets itself: such tests are named, and do not decide.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$(realpath "$1") jobs=$2
tests=${TESTS:-test_vv_serve test_vv_serve_access test_vv_serve_files test_control
  test_control_clients test_vv_window test_vv_window_input test_vv_window_previews
  test_vv_window_cluster test_vv_cluster
  test_control_edit test_vv_edit test_vv_edit_hostile test_vv_edit_compare test_vv_serve_edit
  test_vv_edit_keys test_vv_serve_edit_tools
  test_cluster_faults test_vv_time}
races=$folder/races
rm -rf "$races"
mkdir -p "$races"

found=0
ctest --preset tsan -j "$jobs" || found=1

# A program that is busy half a second after it was told to end leaves its threads to the system.
export TSAN_OPTIONS="suppressions=$PWD/tests/checks/tsan.supp:history_size=4:report_thread_leaks=0:log_path=$races/race"
export OPENRT_VV=$folder/bin/vv OPENRT_WORKER=$folder/bin/openrt-worker PYTHONDONTWRITEBYTECODE=1
# SDL draws windows itself, because the sanitizer ends a program that unloads a library of its list, as
# SDL does with Mesa's.
export SDL_RENDER_DRIVER=software SDL_FRAMEBUFFER_ACCELERATION=0
export OPENRT_TEST_PATIENCE=10 # tests wait that many times longer for what their programs do
for test in $tests; do
  if ! "${PYTHON:-python3}" -m pytest -q -p no:cacheprovider "tests/python/$test.py" >"$races/$test.log" 2>&1; then
    echo "$test: $(tail -n 1 "$races/$test.log") (all of it: $races/$test.log)"
  fi
done

for report in "$races"/race.*; do
  [ -e "$report" ] || continue
  found=1
  cat "$report"
done
exit $found
