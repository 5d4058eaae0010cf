#!/usr/bin/env python3
"""Checks every function that the headers declare: the library exports it, its comment states on
which thread it may be called, and it has a manual page that describes it.

man_pages.py LIBRARY FOLDER HEADER..."""
import ctypes
import pathlib
import re
import shutil
import subprocess
import sys

library, folder = ctypes.CDLL(sys.argv[1]), pathlib.Path(sys.argv[2])
header = "\n".join(pathlib.Path(name).read_text() for name in sys.argv[3:])
complaints = []
declared = re.findall(r"^RT_API [^;(]*?\b(rt\w+)\(", header, re.M)
if len(declared) < 100 or len(set(declared)) != len(declared):
    complaints.append(
        f"{len(declared)} functions found in the header, {len(set(declared))} different ones")
for run in re.findall(r"^(/\*(?:[^*]|\*(?!/))*\*/\n)?((?:RT_API [^;]*;\n)+)", header, re.M):
    if len(re.findall(r"\[(?:context|any)-thread\]", re.sub(r"\s*\n \* ", " ", run[0]))) != 1:
        complaints.append(f"no thread tag in the comment of: {run[1].splitlines()[0]}")
for function in declared:
    if not hasattr(library, function):
        complaints.append(f"{function} is declared, but not exported")
    page = folder / f"{function}.3"
    if not page.exists():
        complaints.append(f"{function} has no manual page")
        continue
    link = re.fullmatch(r"\.so man3/(\S+)\n", page.read_text())
    if not link or not (folder / link.group(1)).exists():
        complaints.append(f"{page.name} leads nowhere")
        continue
    text = (folder / link.group(1)).read_text()
    name, description = text.split(".SH NAME\n")[1].split("\n")[0], text.split(
        ".SH DESCRIPTION\n")[1]
    if not re.search(rf"\b{function}\b", name) or f" {function}(" not in description:
        complaints.append(f"{link.group(1)} does not describe {function}")
exported = {
    line.split()[-1] for line in subprocess.run(["nm", "-D", "--defined-only", sys.argv[1]],
                                                capture_output=True,
                                                text=True).stdout.splitlines()
} if shutil.which("nm") else set()
for symbol in sorted(s for s in exported if re.fullmatch(r"rt[A-Z]\w*", s) and s not in declared):
    complaints.append(f"{symbol} is exported, but not declared")

pages = sorted(p for p in folder.glob("openrt*.3"))
if len(pages) < 12:
    complaints.append(f"only {len(pages)} pages")
for page in pages:
    text = page.read_text()
    for section in ("NAME", "SYNOPSIS", "DESCRIPTION", "SEE ALSO"):
        if f".SH {section}\n" not in text:
            complaints.append(f"{page.name} has no section {section}")
    for other in re.findall(r"^\.BR (\S+) \(3\)", text, re.M):
        if not (folder / f"{other}.3").exists():
            complaints.append(f"{page.name} refers to {other}(3), which is not there")
    if re.search(r"/\*(?!.*\*/)", re.sub(r"\.nf\n.*?\.fi\n", "", text, flags=re.S)):
        complaints.append(f"{page.name} has half a comment in its text")
    if shutil.which("groff"):
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z",
                               str(page)],
                              capture_output=True,
                              text=True)
        if done.stderr.strip():
            complaints.append(done.stderr.strip())

print(*complaints,
      f"{len(declared)} functions, {len(pages)} pages, {len(complaints)} complaints",
      sep="\n")
sys.exit(bool(complaints))
