#!/usr/bin/env python3
"""Times the readers of worlds: one mesh in VRML97 and in the encodings of X3D.

bench_encodings.py build/release/bin/vv [--triangles 808000] [--repeat 3]

Prints megabytes parsed a second, and the seconds from the file to a small picture with their ratio
to those of VRML97. Each time is the least of all repetitions. Numbers measured while
anything else runs say nothing."""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

PICTURE = ("--size", "64x48", "--spp", "1")


def mesh(triangles):
    """Returns points and corners of a wavy grid, as text and as numbers for JSON."""
    side = max(1, math.isqrt(triangles // 2))
    points = [(x / side - .5, y / side - .5, .05 * math.sin(20 * x / side) * math.cos(9 * y / side))
              for y in range(side + 1) for x in range(side + 1)]
    corners = []
    for y in range(side):
        for x in range(side):
            a = y * (side + 1) + x
            b = a + side + 1
            corners += [a, a + 1, b, -1, a + 1, b + 1, b, -1]
    points = [f"{x:.6g} {y:.6g} {z:.6g}" for x, y, z in points]
    corners = [str(c) for c in corners]
    return points, corners


def worlds(triangles):
    """Returns the text of the mesh in each encoding, by the name of its file."""
    points, corners = mesh(triangles)
    rows = ",\n".join(points)
    faces = " ".join(corners).replace(" -1 ", " -1\n")
    nodes = ("Viewpoint { position 0 0 2 }\nShape { geometry IndexedFaceSet { coord Coordinate { "
             f"point [\n{rows} ]\n}} coordIndex [\n{faces} ]\n}} }}\n")
    numbers = ",".join(points).replace(" ", ",")
    geometry = ('{"IndexedFaceSet":{"@coordIndex":[' + ",".join(corners) +
                '],"-coord":{"Coordinate":{"@point":[' + numbers + "]}}}}")
    return {
        "a.wrl": "#VRML V2.0 utf8\n" + nodes,
        "a.x3dv": "#X3D V3.3 utf8\nPROFILE Immersive\n" + nodes,
        "a.x3d": "<X3D version='3.3'><Scene><Viewpoint position='0 0 2'/><Shape><IndexedFaceSet "
                 f"coordIndex='{faces}'><Coordinate point='{rows}'/></IndexedFaceSet></Shape>"
                 "</Scene></X3D>\n",
        "a.x3dj": '{"X3D":{"@version":"3.3","Scene":{"-children":[{"Viewpoint":{"@position":[0,0,2]}},'
                  '{"Shape":{"-geometry":' + geometry + "}}]}}}\n",
    }


def seconds(vv, path, repeat):
    """Returns the least seconds in which vv parses a file, and shows it."""
    command = [vv, path, "-o", path.parent / "x.ppm", "--stats", "-", *PICTURE]
    times = [
        json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["time"]
        for _ in range(repeat)
    ]
    return min(t["parse"] for t in times), min(t["total"] for t in times)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("vv")
    parser.add_argument("--triangles", type=int, default=808_000)
    parser.add_argument("--repeat", type=int, default=3)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        results = {}
        for name, text in worlds(given.triangles).items():
            path = folder / name
            path.write_text(text)
            parse, picture = seconds(given.vv, path, given.repeat)
            results[name] = {"megabytes": len(text) / 1e6, "parse": parse, "picture": picture}
        print(f"{given.triangles} triangles, least of {given.repeat}")
        print("file        MB  parse s   MB/s  picture s  ratio to .wrl")
        for name, one in results.items():
            print(f"{name:7} {one['megabytes']:6.1f}  {one['parse']:7.3f}  "
                  f"{one['megabytes'] / max(one['parse'], 1e-6):5.0f}  {one['picture']:9.2f}  "
                  f"{one['picture'] / results['a.wrl']['picture']:6.2f}")
        print(json.dumps(results))


if __name__ == "__main__":
    main()
