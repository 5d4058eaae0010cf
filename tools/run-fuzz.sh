#!/bin/bash
# run-fuzz.sh FOLDER SECONDS [CORPUS]: runs every fuzz target of FOLDER for SECONDS, with limited
# memory. It starts from the seeds in tests/ and the corpus of earlier runs (CORPUS, default
# build/fuzz-corpus). Afterwards it minimizes the corpus and adds the executions and the commit to
# CORPUS/executions.tsv, so that campaigns on several days count together. A finding ends the run
# with exit code 1; its file is in build/fuzz-findings. TARGETS="fuzz_a fuzz_b" runs these only;
# RUNS=N ends each target after N executions.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$1 seconds=$2 corpora=${3:-build/fuzz-corpus}
mkdir -p build/fuzz-findings "$corpora"
touch "$corpora/executions.tsv"
found=0
commit=$(git rev-parse --short=10 HEAD 2>/dev/null || true)
for target in "$folder"/fuzz_*; do
  [ -x "$target" ] || continue
  name=$(basename "$target")
  case " ${TARGETS:-$name} " in *" $name "*) ;; *) continue ;; esac
  corpus=$corpora/$name
  mkdir -p "$corpus"
  seeds=()
  if [ -d "tests/fuzz/seeds/$name" ]; then seeds+=("tests/fuzz/seeds/$name"); fi
  case $name in
    fuzz_xvrml_vrml | fuzz_xvrml_geometry | fuzz_xvrml_x3d_xml | fuzz_xvrml_x3d_json) seeds+=(tests/conformance/good tests/conformance/bad) ;;
  esac
  dictionary=()
  if [ -f "tests/fuzz/$name.dict" ]; then dictionary=("-dict=tests/fuzz/$name.dict"); fi
  memory=(-rss_limit_mb=2048 -malloc_limit_mb=512)
  # Readers of pictures: a small file must take little memory, whatever size it claims.
  if [ "$name" = fuzz_xvrml_image ]; then memory=(-rss_limit_mb=1024 -malloc_limit_mb=256); fi
  log=build/fuzz-findings/$name.log
  if ! "$target" -max_total_time="$seconds" -runs="${RUNS:--1}" -timeout=10 "${memory[@]}" -print_final_stats=1 \
    "${dictionary[@]}" -artifact_prefix="build/fuzz-findings/$name-" "$corpus" "${seeds[@]}" >"$log" 2>&1; then
    found=1
    tail -n 60 "$log"
  else
    smaller=$corpus.minimised
    rm -rf "$smaller" && mkdir "$smaller"
    if "$target" -merge=1 -rss_limit_mb=2048 "$smaller" "$corpus" "${seeds[@]}" >>"$log" 2>&1; then
      rm -rf "$corpus" && mv "$smaller" "$corpus"
    else
      rm -rf "$smaller" # keep the whole corpus
    fi
  fi
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | head -n 1)
  printf '%s\t%s\t%s\n' "$name" "${executions:-0}" "$commit" >>"$corpora/executions.tsv"
  total=$(awk -F'\t' -v n="$name" '$1 == n { sum += $2 } END { print sum }' "$corpora/executions.tsv")
  echo "$name: ${executions:-0} executions in $seconds s, $total in all runs, $(find "$corpus" -type f | wc -l) files kept"
done
awk -F'\t' '{ sum += $2 } END { printf "%d executions in all runs of all targets\n", sum }' "$corpora/executions.tsv"
exit $found
