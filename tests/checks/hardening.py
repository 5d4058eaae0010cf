#!/usr/bin/env python3
"""Checks with readelf how programs and libraries were compiled and what they ask of the loader.

hardening.py [--plain] [--partial] PLACE...
PLACE      a file, a folder (all programs and shared libraries below it), a wheel, a Debian package
--plain    does not require stack protector, _FORTIFY_SOURCE and endbr64: for debug builds and
           plug-ins of other projects
--partial  the places together need not hold all programs and libraries of the project: one package, a
           plug-in
hardening.py --self    tests this check with programs made for it

For every file:
* Each element of RUNPATH and RPATH begins with $ORIGIN, or is a folder that only root and the user
  can write to (libraries installed in /opt). In packages only $ORIGIN is allowed. An empty element
  means the current folder: starting a program in a folder of downloads would run code from there.
* Full RELRO (GNU_RELRO and BIND_NOW), stack and data not executable, no text relocations,
  position-independent programs (PIE).

For our own files, but not the third-party libraries in a wheel:
* The stack protector, in files with more than a little code, and checked string functions.
* endbr64 at every exported function on x86-64 (CET), and the CET note if the compiler's start files
  have it; otherwise the linker drops it."""
import functools
import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import zipfile

LARGE = 64 << 10  # bytes of code: large enough that some function has an array on its stack
WANTED = ("libopenrt.so", "libxvrml.so", "libxvrml_openrt.so", "vv", "openrt-replay",
          "xvrml-script-host", "xvrml-decoder", "vrml97.so")
OURS = re.compile(r"lib(openrt|xvrml)[\w]*\.so|_xvrml|vv$|openrt-|xvrml-|nodegen$")
PRINTERS = {"printf", "fprintf", "sprintf", "snprintf", "vsnprintf"}
ENDBR64 = b"\xf3\x0f\x1e\xfa"


def readelf(*arguments):
    return subprocess.run(["readelf", "-W", *map(str, arguments)],
                          capture_output=True,
                          text=True,
                          check=True).stdout


def is_loadable(path):
    """Returns whether the file is a program or a shared library, not an object file or archive."""
    if path.is_symlink() or not path.is_file():
        return False
    with path.open("rb") as file:
        head = file.read(18)
    return head[:4] == b"\x7fELF" and int.from_bytes(head[16:18],
                                                     "little" if head[5] == 1 else "big") in (2, 3)


def loadable_below(folder):
    """Returns programs and libraries below a folder, except those that CMake compiles to identify
    the compiler."""
    found = []
    for place, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if name not in ("CMakeFiles", "CMakeTmp")]
        found += [
            path for path in (pathlib.Path(place) / name for name in names) if is_loadable(path)
        ]
    return sorted(found)


@functools.cache
def start_files_have_cet():
    """Returns whether the C library's start files carry the CET note. If they do not, the linker
    adds it to no file."""
    compiler = os.environ.get("CC", "cc")
    for name in ("crti.o", "Scrt1.o"):
        done = subprocess.run([compiler, f"-print-file-name={name}"],
                              capture_output=True,
                              text=True)
        path = pathlib.Path(done.stdout.strip())
        if done.returncode or not path.is_file() or "IBT" not in readelf("-n", path):
            return False
    return True


@functools.cache
def guarded(folder):
    """Returns whether only root and the user can put files into an absolute folder or replace one
    of its parents."""
    path = pathlib.Path(folder)
    if not path.is_absolute() or not path.is_dir():
        return False
    for place in (path.resolve(), *path.resolve().parents):
        status = place.stat()
        if status.st_uid not in (0, os.getuid()):
            return False
        if status.st_mode & (stat.S_IWGRP | stat.S_IWOTH) and not status.st_mode & stat.S_ISVTX:
            return False
    return True


def path_complaints(dynamic, packed):
    for kind, text in re.findall(r"\((RUNPATH|RPATH)\).*\[(.*)\]", dynamic):
        for element in text.split(":"):
            if element == "":
                yield f"{kind} has an empty element, which is the current folder: {text}"
            elif re.match(r"\$(ORIGIN|\{ORIGIN\})(/|$)", element):
                continue
            elif packed or not guarded(element):
                yield f"{kind} names {element}, which is neither below $ORIGIN nor a folder that only root and the user can write to"


def functions_without_endbr(path, symbols):
    """Returns exported functions that do not begin with endbr64. Weak symbols are skipped: for
    inline functions and templates the linker may have used the copy of a third-party static library
    (GoogleTest)."""
    segments = [
        tuple(int(x, 16) for x in m) for m in re.findall(
            r"^\s+LOAD\s+(0x\w+) (0x\w+) 0x\w+ (0x\w+) 0x\w+ R E", readelf("-l", path), re.M)
    ]
    content = path.read_bytes()
    for address, kind, binding, section, name in symbols:
        if kind != "FUNC" or binding != "GLOBAL" or section == "UND" or name.startswith(
                "_init@") or name in ("_init", "_fini"):
            continue
        for offset, start, size in segments:
            if start <= address < start + size and content[offset + address -
                                                           start:][:4] != ENDBR64:
                yield name


def complaints(path, ours, plain=False, packed=False):
    headers, dynamic = readelf("-hl", path), readelf("-d", path)
    yield from path_complaints(dynamic, packed)
    stack = re.search(r"GNU_STACK\s+(?:0x\w+\s+){5}([RWE ]+?)\s+0x", headers)
    if not stack or "E" in stack[1]:
        yield "the stack is executable"
    if re.search(r"^\s+LOAD .* RWE ", headers, re.M):
        yield "a part of it is writable and executable"
    if not ours:
        return
    if "(TEXTREL)" in dynamic:
        yield "it has text relocations"
    if "GNU_RELRO" not in headers:
        yield "no GNU_RELRO: the loader's tables stay writable"
    if not re.search(r"BIND_NOW|FLAGS_1.*NOW", dynamic):
        yield "no BIND_NOW: the loader's tables stay writable"
    if "INTERP" in headers and not re.search(r"Type:\s+DYN", headers):
        yield "a program at a fixed address (no PIE)"
    if plain:
        return
    symbols = []
    for line in readelf("--dyn-syms", path).splitlines():
        field = line.split()
        if len(field) >= 8 and field[0].rstrip(":").isdigit():
            symbols.append((int(field[1], 16), field[3], field[4], field[6], field[7]))
    needed = {name.partition("@")[0] for _, _, _, section, name in symbols if section == "UND"}
    code = re.search(r"\] \.text\s+PROGBITS\s+\w+ \w+ (\w+)", readelf("-S", path))
    if code and int(code[1], 16) > LARGE and "__stack_chk_fail" not in needed:
        yield "compiled without -fstack-protector-strong"
    if needed & PRINTERS and not any(name.endswith("_chk") for name in needed):
        yield "compiled without _FORTIFY_SOURCE: it calls " + ", ".join(sorted(needed & PRINTERS))
    if "X86-64" in headers:
        if bare := list(functions_without_endbr(path, symbols)):
            yield f"compiled without -fcf-protection: {bare[0]} and {len(bare) - 1} more functions do not begin with endbr64"
        if start_files_have_cet() and not re.search(r"IBT.*SHSTK", readelf("-n", path)):
            yield "no CET note (IBT, SHSTK)"


def unpacked(place, scratch):
    """Returns the folder with the contents of a wheel or package."""
    folder = scratch / place.name
    if place.suffix == ".deb":
        subprocess.run(["dpkg-deb", "-x", place, folder], check=True)
    else:
        with zipfile.ZipFile(place) as wheel:
            wheel.extractall(folder)
    return folder


def check(places, plain, partial):
    bad = 0
    names = set()
    with tempfile.TemporaryDirectory() as scratch:
        for place in map(pathlib.Path, places):
            packed = place.suffix in (".deb", ".whl")
            folder = unpacked(place, pathlib.Path(scratch)) if packed else place
            files = [folder] if folder.is_file() else loadable_below(folder)
            for path in files:
                # Where a wheel keeps third-party libraries.
                foreign = any(part.endswith(".libs") for part in path.parts)
                ours = not foreign and (place.suffix != ".whl" or bool(OURS.match(path.name)) or
                                        path.parent.name in ("shaders", "scripts"))
                for complaint in complaints(path, ours, plain, packed):
                    print(
                        f"{place if packed else ''}{'/' if packed else ''}{path.relative_to(folder) if packed else path}: {complaint}"
                    )
                    bad += 1
            names |= {re.sub(r"(\.so)[.\d]*$", r"\1", p.name) for p in files}
            print(f"{place}: {len(files)} programs and libraries")
    for missing in (name for name in WANTED if name not in names and not partial):
        print(f"{missing} is not there: the check reads the wrong place")
        bad += 1
    print(f"{bad} complaints")
    return bad


def check_self():
    """Checks that programs with each fault are found and that one without faults passes."""
    source = "#include <stdio.h>\nint main(int n, char **v) { char b[64]; sprintf(b, \"%s %d\", v[0], n); return puts(b); }\n"
    hard = [
        "-O2", "-U_FORTIFY_SOURCE", "-D_FORTIFY_SOURCE=2", "-fstack-protector-strong", "-fPIE",
        "-pie", "-Wl,-z,relro,-z,now,-z,noexecstack"
    ]
    faults = {
        None: [],
        "empty element": ["-Wl,-rpath,$ORIGIN/../lib::"],
        "neither below": ["-Wl,-rpath,lib"],
        "which is neither": ["-Wl,-rpath,/nonexistent/libraries"],
        "stack is executable": ["-Wl,-z,execstack"],
        "BIND_NOW": ["-Wl,-z,lazy"],
        "GNU_RELRO": ["-Wl,-z,norelro"],
        "no PIE": ["-no-pie"],
        "_FORTIFY_SOURCE": ["-U_FORTIFY_SOURCE"]
    }
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "p.c").write_text(source)
        for fault, flags in faults.items():
            subprocess.run([
                os.environ.get("CC", "cc"), folder / "p.c", "-o", folder / "p", *hard,
                "-Wl,-rpath,$ORIGIN", *flags
            ],
                           check=True,
                           capture_output=True)
            found = list(complaints(folder / "p", True))
            if (fault is None) == bool(found) or (fault and
                                                  not any(fault in text for text in found)):
                print(f"fault {fault}: {found}")
                bad += 1
    print(f"{len(faults)} programs, {bad} complaints")
    return bad


def main():
    options = {a for a in sys.argv[1:] if a.startswith("--")}
    places = [a for a in sys.argv[1:] if a and not a.startswith("--")]
    if not shutil.which("readelf"):
        print("readelf is not installed (binutils)")
        return 77
    if "--self" in options:
        return bool(check_self())
    return bool(check(places, "--plain" in options, "--partial" in options))


if __name__ == "__main__":
    sys.exit(main())
