#!/usr/bin/env python3
"""Counts which node types a folder of worlds holds, and says which of them libxvrml has.

tools/count_nodes.py FOLDER [--at-least N] [--missing]

FOLDER holds X3D files (.x3dv, .x3d, .x3dj, gzipped or not), or a MANIFEST.tsv that lists them
(folder, path, bytes). The column .x3d also counts files in JSON. The table in docs/worlds.md is its
output. Prototypes that a file declares are not counted.
"""
import argparse
import collections
import gzip
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Elements of the XML encoding that are no nodes (ISO/IEC 19776-1).
STATEMENTS = {
    "X3D", "Scene", "ProtoDeclare", "ProtoInterface", "ProtoBody", "ProtoInstance",
    "ExternProtoDeclare", "ROUTE", "IS", "IMPORT", "EXPORT"
}
CLASSIC = re.compile(r'"(?:\\.|[^"\\])*"|#[^\n]*|(?:PROTO|EXTERNPROTO)\s+(\w+)|([A-Za-z_]\w*)\s*\{')
JSON = re.compile(r'"([A-Z]\w*)"\s*:')
KINDS = {".x3dv": ".x3dv", ".x3dvz": ".x3dv", ".x3d": ".x3d", ".x3dz": ".x3d", ".x3dj": ".x3d"}
XML = re.compile(r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<([A-Z]\w*)", re.DOTALL)


def known_nodes():
    """Returns the names of the node types that the .node files describe."""
    names = set()
    for path in (ROOT / "libxvrml" / "nodes").glob("*.node"):
        names |= set(re.findall(r"^(?!abstract)(\w+)\s*(?::[^\n{]*)?\{", path.read_text(), re.M))
    return names


def nodes_of(path):
    """Returns the types of the nodes in a file."""
    packed = path.read_bytes()
    text = (gzip.decompress(packed) if packed[:2] == b"\x1f\x8b" else packed).decode(
        "utf-8", "replace")
    if path.suffix == ".x3dj":
        return set(JSON.findall(text)) - STATEMENTS
    if KINDS[path.suffix] == ".x3d":
        return {m[1] for m in XML.finditer(text) if m[1]} - STATEMENTS
    found = list(CLASSIC.finditer(text))
    return {m[2] for m in found if m[2]} - {m[1] for m in found if m[1]}


def files_of(folder):
    """Returns the X3D files of a folder."""
    manifest = folder / "MANIFEST.tsv"
    if manifest.exists():
        rows = [line.split("\t") for line in manifest.read_text().splitlines()[1:]]
        paths = [folder / row[0] / row[1] for row in rows]
    else:
        paths = sorted(folder.rglob("*"))
    return [path for path in paths if path.suffix in KINDS and path.is_file()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--at-least", type=int, default=1, metavar="N", help="files that hold it")
    parser.add_argument("--missing", action="store_true", help="only what libxvrml lacks")
    given = parser.parse_args()
    counts = collections.Counter()
    of_suffix = collections.Counter()
    paths = files_of(given.folder)
    for path in paths:
        for node in nodes_of(path):
            counts[node] += 1
            of_suffix[node, KINDS[path.suffix]] += 1
    known = known_nodes()
    print(f"{len(paths)} files.\n")
    print("| node | files | .x3dv | .x3d | libxvrml |\n| --- | --- | --- | --- | --- |")
    for node, files in sorted(counts.items(), key=lambda item: (-item[1], item[0])):
        if files >= given.at_least and not (given.missing and node in known):
            print(f"| {node} | {files} | {of_suffix[node, '.x3dv']} | {of_suffix[node, '.x3d']} "
                  f"| {'yes' if node in known else 'no'} |")


if __name__ == "__main__":
    main()
