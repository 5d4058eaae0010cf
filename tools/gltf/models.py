"""models.py: ten small glTF models that hold every feature of the shader Physical, made by a program
so that they are the same everywhere. Each is a function that returns a Builder. Left out is
MIRRORED_REPEAT, which libopenrt does not have."""

import base64
import io
import json
import math
import struct

import numpy as np
from PIL import Image

NEAREST, LINEAR = 9728, 9729
REPEAT, CLAMP = 10497, 33071


class Builder:
    """A glTF document that grows part by part. Methods return indices."""

    def __init__(self):
        self.bytes = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "tools/compare_gltf.py"}, "scene": 0, "scenes": [{"nodes": []}]}

    def add(self, kind, item):
        items = self.json.setdefault(kind, [])
        items.append(item)
        return len(items) - 1

    def view(self, data):
        while len(self.bytes) % 4:
            self.bytes.append(0)
        offset = len(self.bytes)
        self.bytes += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": offset, "byteLength": len(data)})

    def accessor(self, array, normalized=False):
        array = np.ascontiguousarray(array)
        kinds = {"float32": 5126, "uint32": 5125, "uint16": 5123, "uint8": 5121}
        shape = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[1 if array.ndim == 1 else array.shape[1]]
        item = {"bufferView": self.view(array.tobytes()), "componentType": kinds[array.dtype.name], "count": len(array), "type": shape}
        if normalized:
            item["normalized"] = True
        if shape == "VEC3" and array.dtype == np.float32:
            item.update(min=array.min(axis=0).tolist(), max=array.max(axis=0).tolist())
        return self.add("accessors", item)

    def texture(self, pixels, wrap=(REPEAT, REPEAT), magnified=LINEAR):
        """pixels: uint8 (height, width, 3 or 4), first row at the top."""
        file = io.BytesIO()
        Image.fromarray(pixels).save(file, "PNG")
        image = self.add("images", {"bufferView": self.view(file.getvalue()), "mimeType": "image/png"})
        sampler = self.add("samplers", {"magFilter": magnified, "minFilter": LINEAR, "wrapS": wrap[0], "wrapT": wrap[1]})
        return self.add("textures", {"source": image, "sampler": sampler})

    def use(self, *names):
        used = self.json.setdefault("extensionsUsed", [])
        used += [name for name in names if name not in used]

    def material(self, base=(1, 1, 1, 1), metallic=0.0, roughness=1.0, unlit=False, strength=None, pbr=None, **members):
        item = {"pbrMetallicRoughness": {"baseColorFactor": list(base), "metallicFactor": metallic, "roughnessFactor": roughness,
                                         **(pbr or {})}, **members}
        extensions = {}
        if unlit:
            extensions["KHR_materials_unlit"] = {}
        if strength is not None:
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        if extensions:
            item["extensions"] = extensions
            self.use(*extensions)
        return self.add("materials", item)

    def mesh(self, shape, material, **more):
        attributes = {name: values if isinstance(values, int) else self.accessor(values) for name, values in {**shape, **more}.items()
                      if name != "indices"}
        return self.add("meshes", {"primitives": [{"attributes": attributes, "indices": self.accessor(shape["indices"]),
                                                   "material": material}]})

    def node(self, parent=None, **members):
        number = self.add("nodes", members)
        if parent is None:
            self.json["scenes"][0]["nodes"].append(number)
        else:
            self.json["nodes"][parent].setdefault("children", []).append(number)
        return number

    def camera(self, eye, at, yfov=0.7, ortho=None):
        """Looks from eye at a point; ortho: (xmag, ymag)."""
        if ortho:
            camera = {"type": "orthographic", "orthographic": {"xmag": ortho[0], "ymag": ortho[1], "znear": 0.01, "zfar": 100}}
        else:
            camera = {"type": "perspective", "perspective": {"yfov": yfov, "aspectRatio": 4 / 3, "znear": 0.01}}
        self.node(camera=self.add("cameras", camera), matrix=look(eye, at))

    def light(self, kind, intensity, color=(1, 1, 1), eye=(0, 0, 0), at=(0, 0, -1), **members):
        self.use("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"type": kind, "intensity": intensity, "color": list(color), **members})
        self.node(matrix=look(eye, at), extensions={"KHR_lights_punctual": {"light": len(lights) - 1}})

    def save(self, path):
        self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        if path.suffix == ".glb":
            while len(self.bytes) % 4:
                self.bytes.append(0)
            text = json.dumps(self.json).encode()
            text += b" " * (-len(text) % 4)
            path.write_bytes(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(self.bytes), len(text), 0x4E4F534A) + text +
                             struct.pack("<II", len(self.bytes), 0x004E4942) + self.bytes)
        else:
            self.json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
            path.write_text(json.dumps(self.json))
        return path


def look(eye, at):
    """The matrix of a node at `eye` whose -z axis leads to `at`, as the 16 numbers of glTF."""
    z = np.subtract(eye, at).astype(float)
    z /= np.linalg.norm(z)
    x = np.cross((0, 1, 0) if abs(z[1]) < 0.99 else (0, 0, 1), z)
    x /= np.linalg.norm(x)
    return [*map(float, (*x, 0, *np.cross(z, x), 0, *z, 0, *eye, 1))]


def sphere(columns=64, rows=32):
    """A ball of radius 1 with normals, texture coordinates and tangents."""
    v, u = np.mgrid[0:rows + 1, 0:columns + 1]
    theta, phi = np.pi * v / rows, 2 * np.pi * u / columns
    n = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], -1).reshape(-1, 3)
    tangent = np.stack([np.cos(phi), 0 * phi, -np.sin(phi), 1 + 0 * phi], -1).reshape(-1, 4)
    uv = np.stack([u / columns, v / rows], -1).reshape(-1, 2)
    a = (v[:-1, :-1] * (columns + 1) + u[:-1, :-1]).ravel()
    b, c, d = a + 1, a + columns + 1, a + columns + 2
    faces = np.concatenate([np.stack([a, c, d], -1), np.stack([a, d, b], -1)])
    p = n[faces]
    faces = faces[np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) > 1e-9]
    f = np.float32
    return {"POSITION": n.astype(f), "NORMAL": n.astype(f), "TEXCOORD_0": uv.astype(f), "TANGENT": tangent.astype(f),
            "indices": faces.ravel().astype(np.uint16)}


def square(size=1.0, repeats=1.0):
    """A square in the plane of x and y that faces +z; its picture stands upright."""
    p = np.array([[-size, -size, 0], [size, -size, 0], [size, size, 0], [-size, size, 0]], np.float32)
    uv = np.array([[0, 1], [1, 1], [1, 0], [0, 0]], np.float32) * np.float32(repeats)
    return {"POSITION": p, "NORMAL": np.tile(np.float32([0, 0, 1]), (4, 1)), "TEXCOORD_0": uv,
            "TANGENT": np.tile(np.float32([1, 0, 0, 1]), (4, 1)), "indices": np.array([0, 1, 2, 0, 2, 3], np.uint16)}


def cube():
    """A cube with corners at +-1 without normals: flat faces."""
    p = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [[q[0], q[1], q[2]] for q in quads] + [[q[0], q[2], q[3]] for q in quads]
    return {"POSITION": p, "indices": np.array(faces, np.uint16).ravel()}


def without(shape, *names):
    return {name: values for name, values in shape.items() if name not in names}


FLOOR = [-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]  # turns a square that faces +z to +y


def room(b, size=6.0, colors=((0.9, 0.8, 0.7), (0.2, 0.3, 0.6))):
    """All around: a cube seen from inside that emits, from the first colour above to the second below."""
    shape = cube()
    shade = np.where(shape["POSITION"][:, 1:2] > 0, np.float32(colors[0]), np.float32(colors[1]))
    shade = shade * (1 - 0.4 * (shape["POSITION"][:, :1] > 0)) * (1 - 0.3 * (shape["POSITION"][:, 2:] > 0))
    shape["indices"] = shape["indices"].reshape(-1, 3)[:, ::-1].ravel().copy()
    mesh = b.mesh(shape, b.material(unlit=True), COLOR_0=shade.astype(np.float32))
    b.node(mesh=mesh, scale=[size] * 3)


def floor(b, y=-1.0, size=4.0, base=(0.6, 0.6, 0.6, 1)):
    b.node(mesh=b.mesh(without(square(), "TANGENT", "TEXCOORD_0"), b.material(base, roughness=0.9)), translation=[0, y, 0], rotation=FLOOR,
           scale=[size] * 3)


def noise(seed, shape, low=0, high=256):
    return np.random.default_rng(seed).integers(low, high, shape, np.uint8)


def bumps(width=12, height=12, steep=0.7):
    """A normal map of gentle hills."""
    v, u = (np.mgrid[0:height, 0:width] + 0.5) * (2 * np.pi) / np.array([height, width]).reshape(2, 1, 1)
    n = np.stack([steep * np.sin(u + v), steep * np.cos(2 * v), np.ones_like(u)], -1)
    n /= np.linalg.norm(n, axis=-1, keepdims=True)
    return np.round((n * 0.5 + 0.5) * 255).astype(np.uint8)


def row_of_balls(b, materials, y=0.0, radius=0.45, shape=None):
    shape = {name: b.accessor(values) if name != "indices" else values for name, values in (shape or sphere()).items()
             if name in ("POSITION", "NORMAL", "indices")}
    for i, material in enumerate(materials):
        b.node(mesh=b.mesh(shape, material), translation=[(i - (len(materials) - 1) / 2), y, 0], scale=[radius] * 3)


def metals():
    """Metals from polished to rough, and mixtures of metal and dielectric."""
    b = Builder()
    room(b)
    row_of_balls(b, [b.material((0.95, 0.7, 0.35, 1), 1, r) for r in (0, 0.15, 0.3, 0.6, 1)], 0.5)
    row_of_balls(b, [b.material((0.7, 0.25, 0.15, 1), m, 0.35) for m in (0, 0.25, 0.5, 0.75, 1)], -0.5)
    b.camera((0, 0, 5.2), (0, 0, 0))
    return b


def dielectrics():
    """Dielectrics from polished to rough on a floor, under a sky."""
    b = Builder()
    room(b)
    floor(b, -0.5)
    row_of_balls(b, [b.material((0.2, 0.4, 0.9, 1), 0, r) for r in (0, 0.15, 0.3, 0.6, 1)])
    b.camera((0, 1.6, 5), (0, -0.1, 0))
    return b


def base_textures():
    """Base colours from pictures: wrapping, KHR_texture_transform, a second set of coordinates."""
    b = Builder()
    room(b, colors=((0.9, 0.9, 0.9), (0.9, 0.9, 0.9)))
    pixels = noise(1, (4, 5, 3), 20)
    transforms = [(REPEAT, {}), (CLAMP, {}), (REPEAT, {}), (REPEAT, {}), (REPEAT, {"rotation": 0.5}),
                  (REPEAT, {"offset": [0.3, 0.1], "rotation": -0.4, "scale": [0.7, 0.4]}), (CLAMP, {"offset": [0.5, 0.7], "scale": [1, -1]}),
                  (REPEAT, {"texCoord": 1})]
    for i, (wrap, transform) in enumerate(transforms):
        info = {"index": b.texture(pixels, (wrap, CLAMP if i in (0, 2) else wrap), NEAREST if i == 3 else LINEAR)}
        if transform:
            info["extensions"] = {"KHR_texture_transform": transform}
            b.use("KHR_texture_transform")
        shape = square(0.58, 2)
        shape["TEXCOORD_0"] = shape["TEXCOORD_0"] - np.float32(0.7)
        shape["TEXCOORD_1"] = (shape["TEXCOORD_0"][:, ::-1] * 0.8).copy()
        mesh = b.mesh(shape, b.material((1, 0.8, 0.6, 1), 0, 0.7, pbr={"baseColorTexture": info}))
        b.node(mesh=mesh, translation=[1.25 * (i % 4 - 1.5), 0.7 - 1.4 * (i // 4), 0], rotation=[0.1, 0.15, 0.0, math.sqrt(1 - 0.0325)])
    b.camera((0, 0, 5.4), (0, 0, 0))
    return b


def roughness_textures():
    """metallicRoughnessTexture beside its factors."""
    b = Builder()
    room(b)
    floor(b)
    pixels = noise(2, (8, 8, 3))
    picture = b.texture(pixels, (REPEAT, CLAMP))
    for i, (metallic, roughness) in enumerate(((1, 1), (0.6, 0.8))):
        material = b.material((0.9, 0.8, 0.5, 1), metallic, roughness, pbr={"metallicRoughnessTexture": {"index": picture}})
        b.node(mesh=b.mesh(sphere(), material), translation=[2.1 * i - 1.05, 0, 0], rotation=[0, 0.3827, 0, 0.9239])
    b.camera((0, 0.8, 5), (0, 0, 0))
    return b


def normal_textures():
    """normalTexture with scales, with and without tangents, mirrored coordinates, seen from behind."""
    b = Builder()
    room(b)
    picture = b.texture(bumps())

    def bumpy(scale, **members):
        return b.material((0.7, 0.7, 0.7, 1), 0.2, 0.4, normalTexture={"index": picture, "scale": scale}, **members)

    turned = {"rotation": [0.1, 0.2, 0.0, math.sqrt(0.95)]}
    mirrored = square(0.7)
    mirrored["TEXCOORD_0"] = (mirrored["TEXCOORD_0"] * np.float32([-1, 1])).copy()
    mirrored["TANGENT"] = (mirrored["TANGENT"] * np.float32([-1, 1, 1, -1])).copy()
    b.node(mesh=b.mesh(square(0.7), bumpy(1)), translation=[-1.6, 0.8, 0], **turned)
    b.node(mesh=b.mesh(without(square(0.7), "TANGENT"), bumpy(0.4)), translation=[0, 0.8, 0], **turned)
    b.node(mesh=b.mesh(mirrored, bumpy(1)), translation=[1.6, 0.8, 0], **turned)
    b.node(mesh=b.mesh(sphere(96, 64), bumpy(0.5)), translation=[-1.6, -0.8, 0], scale=[0.7] * 3)
    b.node(mesh=b.mesh(square(0.7), bumpy(1, doubleSided=True)), translation=[0, -0.8, 0], rotation=[0.1, 0.97, 0, 0.2216])
    info = {"index": picture, "extensions": {"KHR_texture_transform": {"rotation": 0.8, "scale": [1.5, 0.8]}}}
    b.use("KHR_texture_transform")
    b.node(mesh=b.mesh(without(square(0.7), "TANGENT"), b.material((0.9, 0.6, 0.2, 1), 1, 0.3, normalTexture=info)),
           translation=[1.6, -0.8, 0], **turned)
    b.camera((0, 0, 5), (0, 0, 0))
    return b


def emission():
    """Emissive pictures and strengths as the only light; occlusion, which traced light must ignore."""
    b = Builder()
    floor(b, -1, 2.5)
    glow = b.texture(noise(3, (4, 4, 3), 60), (CLAMP, CLAMP))
    panel = b.material((0, 0, 0, 1), emissiveTexture={"index": glow}, emissiveFactor=[0.4, 0.35, 0.3], strength=2.5)
    b.node(mesh=b.mesh(square(2.2), panel), translation=[0, 1.8, 0], rotation=[math.sqrt(0.5), 0, 0, math.sqrt(0.5)])
    b.node(mesh=b.mesh(square(1.6), b.material((0.5, 0.5, 0.5, 1), emissiveFactor=[0.2, 0.5, 0.8])), translation=[0, 0.4, -2])
    dark = b.texture(noise(4, (4, 4, 3), 0, 128))
    shaded = b.material((0.8, 0.5, 0.4, 1), 0, 0.5, occlusionTexture={"index": dark, "strength": 0.9})
    b.node(mesh=b.mesh(sphere(), shaded), translation=[-1, -0.3, 0], scale=[0.7] * 3)
    b.node(mesh=b.mesh(cube(), b.material((0.9, 0.9, 0.9, 1), 1, 0.3)), translation=[1, -0.5, 0], scale=[0.5] * 3, rotation=[0, 0.2588, 0, 0.9659])
    b.camera((0, 0.5, 5), (0, 0, 0))
    return b


def holes(seed, high=256):
    pixels = noise(seed, (6, 6, 4), 0, high)
    pixels[..., :3] |= 64
    return pixels


def masks():
    """alphaMode MASK: alpha of the picture, the factor and the vertices against cutoffs; shadows through holes."""
    b = Builder()
    floor(b)
    picture = b.texture(holes(5))
    b.light("directional", 2.0, (1, 0.9, 0.8), (1, 3, 1.5), (0, 0, 0))
    b.light("point", 6.0, (0.7, 0.8, 1), (-2, 2, 2))
    for i, members in enumerate(({}, {"alphaCutoff": 0.25}, {"alphaCutoff": 0.6})):
        material = b.material((0.9, 0.9, 0.9, 0.9), 0, 0.6, pbr={"baseColorTexture": {"index": picture}}, alphaMode="MASK", doubleSided=True,
                              **members)
        more = {"COLOR_0": np.float32([[1, 1, 1, 1], [1, 0.5, 1, 0.3], [1, 1, 0.5, 1], [0.5, 1, 1, 0.6]])} if i == 2 else {}
        b.node(mesh=b.mesh(square(0.8), material, **more), translation=[1.8 * (i - 1), 0, 0], rotation=[0, 0.1, 0, math.sqrt(0.99)])
    b.camera((0, 0.8, 5), (0, -0.1, 0))
    return b


def blends():
    """alphaMode BLEND in several layers, back faces that are culled or doubleSided, OPAQUE that ignores alpha."""
    b = Builder()
    floor(b)
    b.light("directional", 2.5, (1, 1, 1), (1, 3, 2), (0, 0, 0))
    b.light("point", 5.0, (1, 0.9, 0.7), (-2, 1.5, 2))
    picture = b.texture(holes(6))
    textured = {"pbr": {"baseColorTexture": {"index": picture}}, "alphaMode": "BLEND", "doubleSided": True}
    b.node(mesh=b.mesh(square(0.8), b.material((1, 1, 1, 0.8), 0, 0.5, **textured)), translation=[-1.6, 0, 0])
    b.node(mesh=b.mesh(square(0.5), b.material((0.9, 0.2, 0.1, 0.5), 0.5, 0.3, alphaMode="BLEND")), translation=[-1.4, 0.2, 0.6])
    colors = np.float32([[1, 0, 0, 1], [0, 1, 0, 0.2], [0, 0, 1, 0.8], [1, 1, 1, 0]])
    b.node(mesh=b.mesh(square(0.6), b.material(alphaMode="BLEND"), COLOR_0=colors), translation=[0, 0.1, 0.2])
    behind = {"rotation": [0.0, 1.0, 0.0, 0.0]}
    b.node(mesh=b.mesh(square(0.4), b.material((0.1, 0.6, 0.9, 1), 0, 0.4, doubleSided=True)), translation=[1.0, 0.4, 0], **behind)
    b.node(mesh=b.mesh(square(0.4), b.material((0.1, 0.6, 0.9, 1), 0, 0.4)), translation=[2.0, 0.4, 0], **behind)
    b.node(mesh=b.mesh(square(0.35), b.material((0.2, 0.8, 0.3, 0.2), 0, 0.4, pbr={"baseColorTexture": {"index": picture}})),
           translation=[1.5, -0.5, 0.3])
    b.camera((0, 0.6, 5), (0, -0.1, 0))
    return b


def colors_and_nodes():
    """COLOR_0 in floats and bytes beside factors, KHR_materials_unlit, nodes with TRS and with matrices."""
    b = Builder()
    room(b)
    corners = np.random.default_rng(7).uniform(0, 1, (8, 3)).astype(np.float32)
    colored = b.mesh(cube(), b.material((1, 0.6, 0.4, 1), 0, 0.6), COLOR_0=corners)
    shape = without(square(), "TEXCOORD_0", "TANGENT")
    byte = b.accessor(np.uint8([[255, 128, 0, 255], [0, 255, 128, 255], [128, 0, 255, 255], [200, 200, 40, 255]]), True)
    bytes_ = b.mesh(shape, b.material((0.8, 0.8, 0.8, 1), 0.3, 0.4, doubleSided=True), COLOR_0=byte)
    flat = b.material((0.5, 0.7, 0.9, 1), unlit=True, pbr={"baseColorTexture": {"index": b.texture(noise(8, (3, 4, 3)))}})
    textured = b.mesh(square(), flat, COLOR_0=np.float32([[1, 1, 1], [0.3, 1, 1], [1, 0.3, 1], [1, 1, 0.3]]))
    group = b.node(translation=[-1.4, 0.6, 0], rotation=[0.2, 0.3, 0.1, math.sqrt(0.86)])
    b.node(group, mesh=colored, scale=[0.6, 0.4, 0.5])
    b.node(mesh=colored, matrix=[0.5, 0.1, 0, 0, 0.25, 0.5, 0.1, 0, 0, 0.2, 0.5, 0, 0.2, 0.7, 0, 1])
    b.node(mesh=colored, matrix=[-0.4, 0.1, 0, 0, 0.1, 0.4, 0, 0, 0, 0, 0.4, 0, 1.6, 0.7, 0, 1])
    b.node(mesh=bytes_, translation=[-1.2, -0.8, 0], scale=[0.6, 0.6, 0.6], rotation=[-0.3, 0, 0, math.sqrt(0.91)])
    b.node(mesh=textured, translation=[1.1, -0.8, 0.2], scale=[0.7, 0.6, 1], rotation=[0, -0.2, 0, math.sqrt(0.96)])
    b.camera((0, 0, 4.8), (0, 0, 0))
    return b


def lamps():
    """Point, spot and directional lights before an orthographic camera."""
    b = Builder()
    floor(b, -0.6, 3, (0.8, 0.8, 0.8, 1))
    b.light("point", 8.0, (1, 0.5, 0.3), (-1.6, 1.2, 1))
    b.light("spot", 20.0, (0.5, 0.8, 1), (1.6, 2.2, 1), (0.8, -0.6, 0), spot={"innerConeAngle": 0.299, "outerConeAngle": 0.3})
    b.light("directional", 0.8, (0.9, 1, 0.6), (-1, 2, 0.5), (0, 0, 0))
    row_of_balls(b, [b.material((0.7, 0.7, 0.7, 1), 0, 0.4), b.material((0.9, 0.6, 0.3, 1), 1, 0.5), b.material((0.3, 0.7, 0.4, 1), 0, 1)],
                 -0.1, shape=sphere(96, 64))
    b.camera((0.5, 2.2, 4), (0, -0.2, 0), ortho=(2.0, 1.5))
    return b


MODELS = {"metals": (metals, ".glb"), "dielectrics": (dielectrics, ".glb"), "base-textures": (base_textures, ".gltf"),
          "roughness-textures": (roughness_textures, ".glb"), "normal-textures": (normal_textures, ".gltf"), "emission": (emission, ".gltf"),
          "masks": (masks, ".glb"), "blends": (blends, ".gltf"), "colors-and-nodes": (colors_and_nodes, ".glb"), "lamps": (lamps, ".gltf")}


def write(name, folder):
    make, suffix = MODELS[name]
    return make().save(folder / (name + suffix))
