#!/usr/bin/env python3
"""Writes a VRML97 world of one large IndexedFaceSet: a wavy grid of N x N cells, two triangles
each.

usage: make_big_ifs.py [N] > big.wrl

N = 632 gives about 800,000 triangles and 30 MB, as in docs/benchmarks.md.
"""
import math
import sys


def main() -> None:
    cells = int(sys.argv[1]) if len(sys.argv) > 1 else 632
    out = sys.stdout
    out.write("#VRML V2.0 utf8\nShape {\n  appearance Appearance { material Material { } }\n")
    out.write("  geometry IndexedFaceSet {\n    solid FALSE\n    coord Coordinate { point [\n")
    for j in range(cells + 1):
        for i in range(cells + 1):
            out.write(
                f"{i * 0.01 - 3.16:.6g} {math.sin(i * 0.05) * math.cos(j * 0.03):.6g} {j * 0.01 - 3.16:.6g},\n"
            )
    out.write("    ] }\n    coordIndex [\n")
    row = cells + 1
    for j in range(cells):
        for i in range(cells):
            a = j * row + i
            out.write(f"{a}, {a + row}, {a + row + 1}, -1,\n{a}, {a + row + 1}, {a + 1}, -1,\n")
    out.write("    ]\n  }\n}\nViewpoint { position 0 5 7 orientation 1 0 0 -0.6 }\n")


if __name__ == "__main__":
    main()
