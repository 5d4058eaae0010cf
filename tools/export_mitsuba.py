#!/usr/bin/env python3
"""Exports a VRML world to Mitsuba 3, with our stock shaders as equivalent BSDFs.

export_mitsuba.py WORLD.wrl FOLDER [--size WxH] [--vv PROGRAM] [--replay PROGRAM]

Writes FOLDER/scene.xml, the triangles of our mapper as PLY, and the surroundings, rendered by our
panorama camera, as PFM. Features without a counterpart are reported on standard error and left out
or replaced (see SURFACES). It needs only Python and our programs; Mitsuba is needed only to render
the result. As a module: export(world, folder, size, vv, replay) -> list of remarks.
"""
import argparse
import array
import json
import math
import pathlib
import struct
import subprocess
import sys
from xml.sax.saxutils import quoteattr

ROOT = pathlib.Path(__file__).resolve().parents[1]
BIN = ROOT / "build/release/bin"

# Matrices: column-major lists of 16, as in the export --------------------------------------------


def point(m, p):
    return [m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k] for k in range(3)]


def inverse_transpose(m):
    """Returns the rows of the inverse of the upper 3x3, which normals are multiplied with; not
    scaled."""
    a, b, c = m[0:3], m[4:7], m[8:11]

    def cross(u, v):
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]

    r = [cross(b, c), cross(c, a), cross(a, b)]
    det = sum(x * y for x, y in zip(a, r[0]))
    return [[x if det >= 0 else -x for x in row] for row in r], det


def normalised(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v] if length > 0 else v


# XML --------------------------------------------------------------------------------------------


def rgb(name, values):
    return f'<rgb name={quoteattr(name)} value="{" ".join(repr(float(v)) for v in values)}"/>'


def number(name, value):
    return f'<float name={quoteattr(name)} value="{float(value)!r}"/>'


def bsdf(kind, *inside, twosided=False):
    text = f'<bsdf type="{kind}">{"".join(inside)}</bsdf>'
    return f'<bsdf type="twosided">{text}</bsdf>' if twosided else text


class Exporter:

    def __init__(self, data, arrays, folder):
        self.data, self.arrays, self.folder = data, arrays, folder
        self.remarks = []

    def remark(self, text):
        if text not in self.remarks:
            self.remarks.append(text)

    def array(self, place, kind):
        values = array.array(kind)
        values.frombytes(self.arrays[place["offset"]:place["offset"] + 4 * place["count"]])
        return values

    # Surfaces: the parameters of one of our classes as a BSDF ------------------------------------

    def diffuse(self, p):
        return bsdf("diffuse", rgb("reflectance", p["reflectance"]), twosided=True)

    def vrml97(self, p):
        if any(p["specularColor"]) or p["transparency"] > 0:
            self.remark("VRML97: the highlight and the transparency of materials are left out")
        return bsdf("diffuse",
                    rgb("reflectance", p["diffuseColor"] if p["lit"] else [0, 0, 0]),
                    twosided=True)

    def glass(self, p):
        if any(p["absorption"]) or any(p.get("scattering", ())) or p.get("abbe"):
            self.remark("Glass: absorption, scattering and dispersion are left out")
        if p["tint"] != [1, 1, 1]:
            self.remark("Glass: the tint is left out")
        return bsdf("dielectric", number("int_ior", p["index"]), number("ext_ior", 1))

    def rough_glass(self, p):
        return bsdf("roughdielectric", '<string name="distribution" value="ggx"/>',
                    number("alpha", p["roughness"]), number("int_ior", p["index"]),
                    number("ext_ior", 1))

    def metal(self, p):
        spectra = rgb("eta", p["n"]) + rgb("k", p["k"])
        if p["roughness"] <= 1e-4:
            return bsdf("conductor", spectra, twosided=True)
        return bsdf("roughconductor",
                    spectra,
                    '<string name="distribution" value="ggx"/>',
                    number("alpha", p["roughness"]),
                    twosided=True)

    def reflector(self, p):
        if p["lacquer"] > 1.001 or p["dust"] > 0:
            self.remark("Reflector: taken as bare metal")
        return self.metal(p)

    def mirror(self, p):
        return bsdf("conductor",
                    '<string name="material" value="none"/>',
                    rgb("specular_reflectance", p["reflectance"]),
                    twosided=True)

    def plastic(self, p):
        common = rgb("diffuse_reflectance", p["color"]) + number(
            "int_ior", p["index"]) + '<boolean name="nonlinear" value="true"/>'
        if p["roughness"] <= 1e-4:
            return bsdf("plastic", common, twosided=True)
        return bsdf("roughplastic",
                    common,
                    '<string name="distribution" value="ggx"/>',
                    number("alpha", p["roughness"]),
                    twosided=True)

    SURFACES = {
        "Diffuse": diffuse,
        "VRML97": vrml97,
        "GlobalIllumination": vrml97,
        "Glass": glass,
        "RoughGlass": rough_glass,
        "Metal": metal,
        "Reflector": reflector,
        "Mirror": mirror,
        "Plastic": plastic
    }

    def surface(self, shader):
        make = self.SURFACES.get(shader["class"])
        if make:
            if shader["parameters"].get("texture"):
                self.remark(f"{shader['class']}: textures are left out")
            return make(self, shader["parameters"])
        self.remark(f"{shader['class']}: no counterpart, grey instead")
        return bsdf("diffuse", rgb("reflectance", [.5, .5, .5]), twosided=True)

    @staticmethod
    def emission(shader):
        p = shader["parameters"]
        light = p.get("emission") or p.get("emissiveColor") or [0, 0, 0]
        return f'<emitter type="area">{rgb("radiance", light)}</emitter>' if any(light) else ""

    # Shapes --------------------------------------------------------------------------------------

    def sphere(self, mesh, inside):
        m = mesh["matrix"]
        scales = [math.sqrt(sum(x * x for x in m[4 * k:4 * k + 3])) for k in range(3)]
        if max(scales) - min(scales) > 1e-4 * max(scales):
            self.remark("an ellipsoid is taken as a sphere")
        x, y, z = m[12:15]
        return (f'<shape type="sphere"><point name="center" x="{x!r}" y="{y!r}" z="{z!r}"/>'
                f'{number("radius", mesh["radius"] * scales[0])}{inside}</shape>')

    def triangles(self, mesh, number_, inside):
        m = mesh["matrix"]
        rows, det = inverse_transpose(m)
        local = self.array(mesh["points"], "f")
        points = array.array("f",
                             [x for i in range(0, len(local), 3) for x in point(m, local[i:i + 3])])
        indices = self.array(mesh["indices"], "I")
        normals = None
        if mesh["normals"]:
            given = self.array(mesh["normals"], "f")
            normals = array.array("f", [
                x for i in range(0, len(given), 3) for x in normalised(
                    [sum(rows[k][j] * given[i + k] for k in range(3)) for j in range(3)])
            ])
        turned = bool(mesh["clockwise"]) != (det < 0)
        name = f"mesh{number_}.ply"
        count = len(points) // 3
        with open(self.folder / name, "wb") as out:
            fields = "property float x\nproperty float y\nproperty float z\n"
            if normals:
                fields += "property float nx\nproperty float ny\nproperty float nz\n"
            out.write((
                f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{fields}"
                f"element face {len(indices) // 3}\nproperty list uchar int vertex_indices\nend_header\n"
            ).encode())
            for i in range(count):
                out.write(struct.pack("<3f", *points[3 * i:3 * i + 3]))
                if normals:
                    out.write(struct.pack("<3f", *normals[3 * i:3 * i + 3]))
            for i in range(0, len(indices), 3):
                a, b, c = indices[i:i + 3]
                out.write(struct.pack("<B3i", 3, *((a, c, b) if turned else (a, b, c))))
        flat = "" if normals else '<boolean name="face_normals" value="true"/>'
        return f'<shape type="ply"><string name="filename" value="{name}"/>{flat}{inside}</shape>'

    def shapes(self):
        out = []
        for n, mesh in enumerate(self.data["meshes"]):
            shader = self.data["shaders"].get(str(mesh["shader"]))
            if not shader or mesh["kind"] in ("lines", "points"):
                self.remark(f"{mesh['kind']} are left out"
                            if shader else "a shape without a shader is left out")
                continue
            inside = self.surface(shader) + self.emission(shader)
            out.append(
                self.sphere(mesh, inside) if mesh["kind"] ==
                "sphere" else self.triangles(mesh, n, inside))
        return out

    # Camera, lights ------------------------------------------------------------------------------

    def sensor(self, width, height):
        camera = self.data["shaders"][str(self.data["camera"]["shader"])]
        if camera["class"] not in ("PerspectiveCamera", "ThinLens"):
            raise SystemExit(f"export_mitsuba.py: the camera {camera['class']} has no counterpart")
        m = self.data["camera"]["matrix"]
        eye, back, up = m[12:15], m[8:11], m[4:7]
        target = [e - b for e, b in zip(eye, back)]

        def triple(v):
            return ", ".join(repr(float(x)) for x in v)

        lens = ""
        kind = "perspective"
        p = camera["parameters"]
        if camera["class"] == "ThinLens" and p["radius"] > 0:
            kind, lens = "thinlens", number("aperture_radius", p["radius"]) + number(
                "focus_distance", p["focus"])
        return (
            f'<sensor type="{kind}"><string name="fov_axis" value="y"/>{number("fov", p["fovy"])}{lens}'
            f'{number("near_clip", 1e-3)}{number("far_clip", 1e5)}'
            f'<transform name="to_world"><lookat origin="{triple(eye)}" target="{triple(target)}" up="{triple(up)}"/></transform>'
            f'<film type="hdrfilm"><integer name="width" value="{width}"/><integer name="height" value="{height}"/>'
            '<rfilter type="box"/><string name="pixel_format" value="rgb"/></film>'
            '<sampler type="independent"><integer name="sample_count" value="16"/></sampler></sensor>'
        )

    def lights(self):
        for light in self.data["lights"]:
            self.remark(
                f"{self.data['shaders'][str(light['shader'])]['class']}: lights without extent are left out"
            )
        return []


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"export_mitsuba.py: {command[0]} failed: {done.stderr.strip()}")


def write_pfm(path, width, height, values):
    with open(path, "wb") as out:
        out.write(f"PF\n{width} {height}\n-1.0\n".encode())
        out.write(values.tobytes())


def read_pfm(path):
    """Returns width, height, floats; rows from the bottom up, as in the file."""
    data = pathlib.Path(path).read_bytes()
    head = data.split(b"\n", 3)
    width, height = map(int, head[1].split())
    values = array.array("f")
    values.frombytes(head[3][:12 * width * height])
    return width, height, values


def panorama(world, folder, vv, size):
    """Renders the surroundings for Mitsuba's envmap, from so far away that the whole world is
    smaller than a pixel."""
    width, height = size
    run(vv, world, "-o", folder / "around.pfm", "--size", f"{width}x{height}", "--spp", "16",
        "--transport", "direct", "--quiet", "--camera", "0,1e9,0:0,1e9,-1", "--camera-shader",
        "Panorama")
    _, _, values = read_pfm(folder / "around.pfm")
    if not any(values):
        return ""
    # the centre of our picture looks along -z, which is the left edge of Mitsuba's
    rolled = array.array("f")
    for y in range(height):
        row = values[3 * width * y:3 * width * (y + 1)]
        rolled += row[3 * (width // 2):] + row[:3 * (width // 2)]
    write_pfm(folder / "around.pfm", width, height, rolled)
    return '<emitter type="envmap"><string name="filename" value="around.pfm"/></emitter>'


def export(world,
           folder,
           size=(320, 240),
           vv=BIN / "vv",
           replay=BIN / "openrt-replay",
           surroundings=(1024, 512)):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    width, height = size
    run(vv, world, "-o", folder / "first.pfm", "--size", f"{width}x{height}", "--spp", "1",
        "--depth", "0", "--quiet", "--record", folder / "scene.rec")
    run(replay, folder / "scene.rec", "--export", folder / "scene.json")
    data = json.loads((folder / "scene.json").read_text())
    exporter = Exporter(data, (folder / "scene.json.bin").read_bytes(), folder)
    around = panorama(world, folder, vv, surroundings) if data["environment"]["shader"] else ""
    parts = [exporter.sensor(width, height), *exporter.shapes(), *exporter.lights(), around]
    integrator = '<integrator type="path"><integer name="max_depth" value="26"/></integrator>'
    (folder /
     "scene.xml").write_text('<scene version="3.0.0">\n' +
                             "\n".join([integrator] + [p for p in parts if p]) + "\n</scene>\n")
    for name in ("first.pfm", "scene.rec", "scene.json", "scene.json.bin"):
        (folder / name).unlink()
    return exporter.remarks


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("world")
    parser.add_argument("folder")
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--vv", default=BIN / "vv")
    parser.add_argument("--replay", default=BIN / "openrt-replay")
    options = parser.parse_args()
    for remark in export(options.world, options.folder, tuple(map(int, options.size.split("x"))),
                         options.vv, options.replay):
        print(f"export_mitsuba.py: {remark}", file=sys.stderr)


if __name__ == "__main__":
    main()
