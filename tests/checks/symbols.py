#!/usr/bin/env python3
"""Checks the binary interface of the libraries. Every symbol of a stored list is still exported,
with the same version. Every exported symbol has a version. No C++ internals of other libraries
(std, fmt, ...) are exported.

symbols.py LIST_FOLDER LIBRARY...            LIST_FOLDER/<name>.symbols, e.g. libopenrt.symbols
symbols.py --update LIST_FOLDER LIBRARY...   writes the lists again: after a symbol was added,
                                             or removed together with SOVERSION

Exported symbols that are missing from a list are named, but are no error. Symbols of a private
version, which the project's libraries of one release use among themselves, are in no list."""
import pathlib
import re
import subprocess
import sys


def exported(library):
    """Returns {symbol@@VERSION} of the public versions, and the violations."""
    text = subprocess.run(["nm", "-D", "--defined-only", "--with-symbol-versions", library],
                          capture_output=True,
                          text=True,
                          check=True).stdout
    found, complaints = set(), []
    for line in text.splitlines():
        *_, kind, name = line.split()
        if kind == "A":  # the versions themselves
            continue
        symbol, _, version = name.partition("@@")
        if not version:
            complaints.append(f"{symbol} is exported without a version")
        elif "PRIVATE" not in version:
            if re.match(r"_ZN?K?(St|9__gnu_cxx|3fmt|3tbb)", symbol):
                complaints.append(f"{symbol} is another library's")
            if kind in "TDBR":  # weak symbols come and go with the compiler
                found.add(f"{symbol}@@{version}")
    return found, complaints


def main():
    arguments = sys.argv[1:]
    update = arguments[0] == "--update" and bool(arguments.pop(0))
    folder, bad = pathlib.Path(arguments[0]), 0
    for library in map(pathlib.Path, arguments[1:]):
        name = library.name.split(".so")[0]
        there, complaints = exported(library)
        stored = folder / f"{name}.symbols"
        if update:
            stored.write_text("".join(f"{s}\n" for s in sorted(there)))
        wanted = set(stored.read_text().split())
        complaints += [f"{s} is no longer exported" for s in sorted(wanted - there)]
        soname = re.search(
            r"SONAME.*\[(.*)\]",
            subprocess.run(["readelf", "-d", library], capture_output=True, text=True).stdout)
        if not soname or not re.fullmatch(rf"{name}\.so\.\d+", soname[1]):
            complaints.append(f"{name} has no SONAME with its version")
        for symbol in sorted(there - wanted):
            print(f"{name}: new: {symbol}")
        print(*[f"{name}: {c}" for c in complaints],
              f"{name}: {len(there)} public symbols, {len(complaints)} complaints",
              sep="\n")
        bad += len(complaints)
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main())
