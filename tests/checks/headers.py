#!/usr/bin/env python3
"""Compiles every public header alone, with only the include folders that a user has, and warnings
as errors.

headers.py ROOT GENERATED CC CXX   GENERATED: folder that holds xvrml/nodes.h

C headers: C99 -pedantic and C++17. openrts.hpp: C++17. xvrml: C++20. Each is also included twice in
one file."""
import pathlib
import subprocess
import sys
import tempfile

root, generated, cc, cxx = pathlib.Path(sys.argv[1]), *sys.argv[2:5]
STRICT = ["-Wall", "-Wextra", "-pedantic", "-Werror", "-fsyntax-only"]
includes = [f"-I{root}/libopenrt/include", f"-I{root}/libxvrml/include", f"-I{generated}"]

jobs = []
for header in sorted((root / "libopenrt/include/openrt").iterdir()):
    if header.suffix == ".h":
        jobs.append((f"openrt/{header.name}", [cc, "-x", "c", "-std=c99", "-Wstrict-prototypes"]))
    jobs.append((f"openrt/{header.name}", [cxx, "-x", "c++", "-std=c++17"]))
xvrml = sorted(p.name for p in (root / "libxvrml/include/xvrml").glob("*.h")) + ["nodes.h"]
for header in ("xvrml/xscript.h", "xvrml/xscript_types.h"):
    jobs.append((header, [cc, "-x", "c", "-std=c99", "-Wstrict-prototypes"]))
jobs += [(f"xvrml/{name}", [cxx, "-x", "c++", "-std=c++20"]) for name in xvrml]
if len(jobs) < 6:
    sys.exit("headers.py: the public headers are not where they should be")

failed = 0
for name, command in jobs:
    with tempfile.NamedTemporaryFile("w", suffix=".c") as source:
        source.write(f"#include <{name}>\n#include <{name}>\n")
        source.flush()
        run = subprocess.run([*command, *STRICT, *includes, source.name],
                             capture_output=True,
                             text=True)
    if run.returncode:
        failed += 1
        print(f"{name} ({command[3]}):\n{run.stderr}")
print(f"{len(jobs) - failed} of {len(jobs)} compile alone")
sys.exit(1 if failed else 0)
