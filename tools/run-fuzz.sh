#!/bin/bash
# run-fuzz.sh FOLDER SECONDS: runs every fuzz target of FOLDER for SECONDS, from the seeds in tests/ and the corpus of earlier
# runs (build/fuzz-corpus). A finding ends the run with its file in build/fuzz-findings.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1 seconds=$2
mkdir -p build/fuzz-findings
found=0
for target in "$folder"/fuzz_*; do
  [ -x "$target" ] || continue
  name=$(basename "$target")
  corpus=build/fuzz-corpus/$name
  mkdir -p "$corpus"
  seeds=()
  for dir in "tests/fuzz/seeds/$name" tests/conformance/good tests/conformance/bad; do
    if [ -d "$dir" ]; then seeds+=("$dir"); fi
  done
  dictionary=()
  if [ -f "tests/fuzz/$name.dict" ]; then dictionary=("-dict=tests/fuzz/$name.dict"); fi
  echo "$name: $seconds s"
  log=build/fuzz-findings/$name.log
  if ! "$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 "${dictionary[@]}" \
    -artifact_prefix="build/fuzz-findings/$name-" "$corpus" "${seeds[@]}" >"$log" 2>&1; then
    found=1
    tail -n 60 "$log"
  fi
  grep -E '^stat::(number_of_executed_units|average_exec_per_sec|peak_rss_mb)' "$log" || true
done
exit $found
