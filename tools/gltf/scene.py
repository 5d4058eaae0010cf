"""scene.py: reads the glTF files of models.py into arrays for the reference. It follows the
specification of glTF 2.0 and shares nothing with the reader of libxvrml."""

import base64
import io
import json
import struct

import numpy as np
from PIL import Image

TYPES = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def normalize(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300)


def from_srgb(c):
    """IEC 61966-2-1."""
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055)**2.4)


class Texture:
    """A picture with its sampler (3.8.4), as far as it is enlarged. Centres of texels are at halves."""

    def __init__(self, pixels, sampler, srgb):
        self.values = pixels / 255.0
        if srgb:
            self.values[..., :3] = from_srgb(self.values[..., :3])
        self.wrap = sampler.get("wrapS", 10497), sampler.get("wrapT", 10497)
        self.nearest = sampler.get("magFilter") == 9728

    def place(self, x, axis):
        size, mode = self.values.shape[1 - axis], self.wrap[axis]
        if mode == 33071:
            return np.clip(x, 0, size - 1)
        if mode == 33648:
            x = x % (2 * size)
            return np.minimum(x, 2 * size - 1 - x)
        return x % size

    def at(self, uv):
        x, y = uv[:, 0] * self.values.shape[1] - 0.5, uv[:, 1] * self.values.shape[0] - 0.5
        i, j = np.floor(x).astype(int), np.floor(y).astype(int)
        fx, fy = (x - i)[:, None], (y - j)[:, None]
        v = self.values
        if self.nearest:
            return v[self.place(np.floor(y + 0.5).astype(int), 1), self.place(np.floor(x + 0.5).astype(int), 0)]
        left, right = self.place(i, 0), self.place(i + 1, 0)
        top, bottom = self.place(j, 1), self.place(j + 1, 1)
        return (v[top, left] * (1 - fx) + v[top, right] * fx) * (1 - fy) + (v[bottom, left] * (1 - fx) + v[bottom, right] * fx) * fy


class TextureInfo:
    """A texture of a material, with its set of coordinates and their transformation."""

    def __init__(self, scene, info, srgb):
        texture = scene.json["textures"][info["index"]]
        sampler = scene.json["samplers"][texture["sampler"]] if "sampler" in texture else {}
        self.texture = Texture(scene.image(texture["source"]), sampler, srgb)
        more = info.get("extensions", {}).get("KHR_texture_transform", {})
        self.set = more.get("texCoord", info.get("texCoord", 0))
        c, s = np.cos(more.get("rotation", 0)), np.sin(more.get("rotation", 0))
        # Counter-clockwise as seen in the picture, whose v runs downwards. The extension's first
        # example says so; its GLSL has the transposed matrix.
        self.matrix = np.array([[c, s], [-s, c]]) @ np.diag(more.get("scale", [1, 1]))
        self.offset = np.array(more.get("offset", [0, 0]), float)

    def place(self, uvs):
        return uvs[self.set] @ self.matrix.T + self.offset

    def at(self, uvs):
        return self.texture.at(self.place(uvs))


class Material:
    def __init__(self, scene, item):
        pbr, extensions = item.get("pbrMetallicRoughness", {}), item.get("extensions", {})
        self.base = np.array(pbr.get("baseColorFactor", [1, 1, 1, 1]), float)
        self.metallic, self.roughness = pbr.get("metallicFactor", 1), pbr.get("roughnessFactor", 1)
        self.emissive = np.array(item.get("emissiveFactor", [0, 0, 0]), float)
        self.emissive = self.emissive * extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        self.unlit = "KHR_materials_unlit" in extensions
        self.double = item.get("doubleSided", False)
        self.mode, self.cutoff = item.get("alphaMode", "OPAQUE"), item.get("alphaCutoff", 0.5)
        self.normal_scale = item.get("normalTexture", {}).get("scale", 1)

        def info(holder, name, srgb):
            return TextureInfo(scene, holder[name], srgb) if name in holder else None

        self.base_texture = info(pbr, "baseColorTexture", True)
        self.roughness_texture = info(pbr, "metallicRoughnessTexture", False)
        self.normal_texture = info(item, "normalTexture", False)
        self.emissive_texture = info(item, "emissiveTexture", True)


class Light:
    def __init__(self, item, matrix):
        self.kind, self.color = item["type"], np.array(item.get("color", [1, 1, 1]), float) * item.get("intensity", 1)
        self.position, self.direction = matrix[:3, 3], normalize(-matrix[:3, 2])
        cone = item.get("spot", {})
        self.inner, self.outer = cone.get("innerConeAngle", 0), cone.get("outerConeAngle", np.pi / 4)

    def reach(self, points):
        """Returns unit vectors to the light, distances, and what arrives on a surface that faces it."""
        if self.kind == "directional":
            return np.tile(-self.direction, (len(points), 1)), np.full(len(points), 1e3), np.tile(self.color, (len(points), 1))
        to = self.position - points
        distance = np.linalg.norm(to, axis=1)
        to /= distance[:, None]
        factor = 1 / distance**2
        if self.kind == "spot":  # the extension's own falloff between the angles
            scale = 1 / max(0.001, np.cos(self.inner) - np.cos(self.outer))
            factor = factor * np.clip(-to @ self.direction * scale - np.cos(self.outer) * scale, 0, 1)**2
        return to, distance, factor[:, None] * self.color


class Scene:
    """Triangles in the world: points, normals, tangents, uvs (two sets), colors, by corner; their
    materials, and the lights and the camera."""

    def __init__(self, path):
        self.read(path.read_bytes())
        self.materials = [Material(self, item) for item in self.json.get("materials", [])]
        self.parts, self.lights, self.camera = [], [], None
        for node in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            self.visit(node, np.eye(4))
        for name in ("points", "normals", "tangents", "uvs", "colors", "material"):
            setattr(self, name, np.concatenate([part[name] for part in self.parts]))
        self.double = np.array([m.double for m in self.materials])[self.material]
        self.has_tangents = np.abs(self.tangents).sum(axis=(1, 2)) > 0

    def read(self, data):
        if data[:4] != b"glTF":
            self.json = json.loads(data)
            self.bytes = base64.b64decode(self.json["buffers"][0]["uri"].split(",")[1])
            return
        size, = struct.unpack_from("<I", data, 12)
        self.json, self.bytes = json.loads(data[20:20 + size]), data[28 + size:]

    def view(self, number):
        view = self.json["bufferViews"][number]
        begin = view.get("byteOffset", 0)
        return self.bytes[begin:begin + view["byteLength"]]

    def accessor(self, number):
        item = self.json["accessors"][number]
        values = np.frombuffer(self.view(item["bufferView"]), TYPES[item["componentType"]])
        width = WIDTHS[item["type"]]
        values = values[:item["count"] * width].reshape(-1, width) if width > 1 else values[:item["count"]]
        return values / np.iinfo(values.dtype).max if item.get("normalized") else values

    def image(self, number):
        picture = Image.open(io.BytesIO(self.view(self.json["images"][number]["bufferView"])))
        return np.asarray(picture.convert("RGBA"), float)

    def visit(self, number, parent):
        node = self.json["nodes"][number]
        if "matrix" in node:
            own = np.array(node["matrix"], float).reshape(4, 4).T
        else:
            x, y, z, w = node.get("rotation", [0, 0, 0, 1])
            turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
            own = np.eye(4)
            own[:3, :3] = turn @ np.diag(node.get("scale", [1, 1, 1]))
            own[:3, 3] = node.get("translation", [0, 0, 0])
        matrix = parent @ own
        if "mesh" in node:
            for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                self.parts.append(self.triangles(primitive, matrix))
        if "camera" in node:
            self.camera = self.json["cameras"][node["camera"]], matrix
        light = node.get("extensions", {}).get("KHR_lights_punctual")
        if light:
            self.lights.append(Light(self.json["extensions"]["KHR_lights_punctual"]["lights"][light["light"]], matrix))
        for child in node.get("children", []):
            self.visit(child, matrix)

    def triangles(self, primitive, matrix):
        index = self.accessor(primitive["indices"]).reshape(-1, 3).astype(int)
        mirrored = np.linalg.det(matrix[:3, :3]) < 0
        if mirrored:  # 3.7.4: the front is the other side
            index = index[:, ::-1]
        names = primitive["attributes"]
        values = {name: self.accessor(number).astype(float)[index] for name, number in names.items()}
        points = values["POSITION"] @ matrix[:3, :3].T + matrix[:3, 3]
        flat = normalize(np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]))
        normals = np.repeat(flat[:, None], 3, axis=1)
        if "NORMAL" in values:
            normals = normalize(values["NORMAL"] @ np.linalg.inv(matrix[:3, :3]))
        tangents = np.zeros((len(index), 3, 4))
        if "TANGENT" in values:
            tangents[..., :3] = normalize(values["TANGENT"][..., :3] @ matrix[:3, :3].T)
            tangents[..., 3] = values["TANGENT"][..., 3] * (-1 if mirrored else 1)
        none = np.zeros((len(index), 3, 2))
        uvs = np.stack([values.get("TEXCOORD_0", none), values.get("TEXCOORD_1", none)], axis=1)
        colors = np.ones((len(index), 3, 4))
        if "COLOR_0" in values:
            colors[..., :values["COLOR_0"].shape[-1]] = values["COLOR_0"]
        return {"points": points, "normals": normals, "tangents": tangents, "uvs": uvs, "colors": colors,
                "material": np.full(len(index), primitive["material"])}
