#!/usr/bin/env python3
"""Checks that a build without tests, as packages have it, links: whatever the project's other parts
use of libxvrml's internals is among the private symbols that the library then exports. A build with
tests exports all of them, and would not notice.

private_symbols.py MAKER SCRIPT_OPTION... -- FILE...
MAKER          cmake/tools/make_version_script.py
SCRIPT_OPTION  --of FOLDER --siblings=FOLDER... HEADER..., as CMake gives them to MAKER
FILE           libraries and programs that link libxvrml"""
import pathlib
import re
import subprocess
import sys
import tempfile


def version_script(maker, options):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "script.map"
        subprocess.run([
            sys.executable, maker, "--output", out, "--version", "PUBLIC", "--private", "PRIVATE",
            *options
        ],
                       check=True)
        return out.read_text()


def matcher(script):
    """Returns one regular expression for the patterns of a version script, which are the shell's."""
    parts = []
    for line in script.splitlines():
        if not line.startswith("      "):
            continue
        part = re.escape(line.strip().removesuffix(";"))
        part = part.replace(r"\[!a\-zA\-Z0\-9_\]", "[^a-zA-Z0-9_]")
        parts.append(part.replace(r"\*", ".*").replace(r"\?", "."))
    return re.compile("|".join(parts))


def used(file):
    """Returns the internals of libxvrml that a file takes from it."""
    text = subprocess.run(["nm", "-D", "-C", "--undefined-only", "--with-symbol-versions", file],
                          capture_output=True,
                          text=True,
                          check=True).stdout
    return {
        line.split(None, 1)[1].split("@")[0]
        for line in text.splitlines() if "@XVRML_PRIVATE" in line
    }


def main():
    maker, *options = sys.argv[1:sys.argv.index("--")]
    files = sys.argv[sys.argv.index("--") + 1:]
    exported = matcher(version_script(maker, options))
    found, complaints = 0, []
    for file in files:
        for symbol in sorted(used(file)):
            found += 1
            if not exported.fullmatch(symbol):
                complaints.append(f"{pathlib.Path(file).name}: {symbol} is not exported in a build "
                                  "without tests")
    print(*complaints,
          f"{len(files)} files, {found} internals of libxvrml, {len(complaints)} complaints",
          sep="\n")
    if not found:
        print("no file uses any: this checks nothing")
    return 1 if complaints or not found else 0


if __name__ == "__main__":
    sys.exit(main())
