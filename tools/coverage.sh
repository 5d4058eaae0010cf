#!/bin/bash
# coverage.sh BUILD: sums gcov's line counts per source file of the libraries, after the tests have
# run in a coverage build.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
root=$(pwd)
find "$build" -name '*.gcda' -print0 | xargs -0 -r gcov --json-format --stdout 2>/dev/null |
  "${PYTHON:-python3}" -c '
import collections, json, sys
root, hits = sys.argv[1] + "/", collections.defaultdict(dict)
for text in sys.stdin:
    for f in json.loads(text)["files"]:
        name = f["file"].removeprefix(root)
        if name.startswith(("libopenrt/", "libxvrml/", "plugins/", "apps/")):
            for line in f["lines"]:
                n = line["line_number"]
                hits[name][n] = hits[name].get(n, 0) + line["count"]
total = covered = 0
for name in sorted(hits):
    lines = hits[name].values()
    c = sum(1 for x in lines if x)
    total, covered = total + len(lines), covered + c
    print(f"{100 * c / len(lines):6.1f} %  {c:5} of {len(lines):5}  {name}")
print(f"{100 * covered / max(total, 1):6.1f} %  {covered} of {total} lines")
' "$root" | tee "$build/coverage.txt" | tail -1
