"""gltf_check.py: says what is wrong with a glTF 2.0 file: structure, bounds of arrays, numbers and
references, by the rules of the specification that a reader relies on. It shares nothing with the
writer and the reader of this project.

    python3 gltf_check.py FILE...
"""
import array
import base64
import json
import math
import pathlib
import struct
import sys

SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
CODES = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
# How many numbers of which type an attribute has.
ATTRIBUTES = {"POSITION": (5126, ("VEC3",)), "NORMAL": (5126, ("VEC3",)), "TEXCOORD_0": (5126, ("VEC2",)),
              "COLOR_0": (5126, ("VEC3", "VEC4"))}
LISTS = ("accessors", "animations", "bufferViews", "buffers", "cameras", "images", "materials", "meshes", "nodes",
         "samplers", "scenes", "textures")
CORNERS = {0: 1, 1: 2, 4: 3}  # indices of an element, by mode


def refuse(word):
    raise ValueError(f"{word} is no number of JSON")


class Checker:

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.problems = []
        self.arrays = {}

    def say(self, text):
        if len(self.problems) < 50:
            self.problems.append(text)

    def need(self, condition, text):
        if not condition:
            self.say(text)
        return condition

    def check(self):
        try:
            self.read()
            self.check_lists()
            self.check_views()
            for number in range(len(self.list("accessors"))):
                self.check_accessor(number)
            for kind in ("meshes", "materials", "textures", "images", "cameras", "animations"):
                for number, item in enumerate(self.list(kind)):
                    getattr(self, "check_" + kind)(item, f"{kind}[{number}]")
            self.check_nodes()
            self.check_lights()
            self.check_uses()
            self.check_extensions()
        except (KeyError, IndexError, TypeError, ValueError, struct.error) as error:
            self.say(f"{type(error).__name__}: {error}")
        return self.problems

    # The file ------------------------------------------------------------------------------------

    def read(self):
        data = self.path.read_bytes()
        self.binary = None
        if data[:4] == b"glTF":
            version, length = struct.unpack_from("<II", data, 4)
            self.need(version == 2, f"version {version} of the container")
            self.need(length == len(data), f"the length is {length}, the file has {len(data)} bytes")
            chunks, at = [], 12
            while at < len(data):
                size, kind = struct.unpack_from("<II", data, at)
                self.need(size % 4 == 0, "a chunk's length is no multiple of 4")
                self.need(at + 8 + size <= len(data), "a chunk ends behind the file")
                chunks.append((kind, data[at + 8:at + 8 + size]))
                at += 8 + size
            self.need([kind for kind, _ in chunks] in ([0x4E4F534A], [0x4E4F534A, 0x004E4942]), "chunks: JSON, then BIN")
            text = chunks[0][1]
            if len(chunks) > 1:
                self.binary = chunks[1][1]
        else:
            text = data
        self.json = json.loads(text.decode("utf-8"), parse_constant=refuse)
        self.need(self.json["asset"]["version"] == "2.0", "asset.version is not 2.0")
        self.buffers = [self.read_buffer(i, one) for i, one in enumerate(self.list("buffers"))]

    def read_buffer(self, number, item):
        uri = item.get("uri")
        if uri is None:
            data = self.binary if number == 0 and self.binary is not None else b""
        elif uri.startswith("data:"):
            data = base64.b64decode(uri.split(",", 1)[1], validate=True)
        else:
            self.need("/" not in uri and "\\" not in uri and ".." not in uri and uri.isascii(), f"uri {uri!r}")
            data = (self.path.parent / uri).read_bytes()
        self.need(item["byteLength"] >= 1 and len(data) >= item["byteLength"], f"buffers[{number}]: {len(data)} bytes")
        return data[:item["byteLength"]]

    def list(self, kind):
        return self.json.get(kind, [])

    def check_lists(self):
        for kind in LISTS:
            self.need(kind not in self.json or (isinstance(self.json[kind], list) and self.json[kind]), f"{kind} is empty")
        for key in self.json:
            self.need(key in LISTS or key in ("asset", "scene", "extensions", "extensionsUsed", "extensionsRequired"),
                      f"member {key}")

    def index(self, value, kind, where):
        good = isinstance(value, int) and 0 <= value < len(self.list(kind))
        return self.need(good, f"{where}: {value} is no place in {kind}")

    # Arrays ----------------------------------------------------------------------------------------

    def check_views(self):
        for number, view in enumerate(self.list("bufferViews")):
            where = f"bufferViews[{number}]"
            if not self.index(view["buffer"], "buffers", where):
                continue
            offset, length = view.get("byteOffset", 0), view["byteLength"]
            self.need(length >= 1, f"{where} is empty")
            self.need(offset >= 0 and offset + length <= len(self.buffers[view["buffer"]]), f"{where} ends behind the buffer")
            self.need(offset % 4 == 0, f"{where} is not aligned")
            self.need(view.get("target", 34962) in (34962, 34963), f"{where}: target")

    def check_accessor(self, number):
        item, where = self.json["accessors"][number], f"accessors[{number}]"
        kind, width, count = item["componentType"], WIDTHS[item["type"]], item["count"]
        self.need(count >= 1, f"{where} is empty")
        view = self.json["bufferViews"][item["bufferView"]]
        size = SIZES[kind] * width
        self.need("byteStride" not in view, f"{where}: a stride is not expected")
        start = item.get("byteOffset", 0)
        if not self.need(start + size * count <= view["byteLength"], f"{where} ends behind its view"):
            return
        data = self.buffers[view["buffer"]]
        begin = view.get("byteOffset", 0) + start
        values = array.array(CODES[kind])
        values.frombytes(data[begin:begin + size * count])
        if sys.byteorder == "big":
            values.byteswap()
        self.arrays[number] = values
        if kind == 5126:
            self.need(all(map(math.isfinite, values)), f"{where} has numbers that are not finite")
        for name, choose in (("min", min), ("max", max)):
            if name in item:
                true = [choose(values[i::width]) for i in range(width)]
                self.need(len(item[name]) == width and all(single(x) == y for x, y in zip(item[name], true)),
                          f"{where}.{name} is {item[name]}, not {true}")

    def count(self, number):
        return self.json["accessors"][number]["count"]

    def vectors(self, number):
        width = WIDTHS[self.json["accessors"][number]["type"]]
        values = self.arrays[number]
        return [values[i:i + width] for i in range(0, len(values), width)]

    # Objects -----------------------------------------------------------------------------------------

    def check_meshes(self, mesh, where):
        self.need(mesh["primitives"], f"{where} has no primitives")
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            if not self.need("POSITION" in attributes, f"{where} has no positions"):
                continue
            count = self.count(attributes["POSITION"])
            for name, number in attributes.items():
                kind, types = ATTRIBUTES[name]
                item = self.json["accessors"][number]
                self.need(item["componentType"] == kind and item["type"] in types, f"{where}: type of {name}")
                self.need(item["count"] == count, f"{where}: {name} has {item['count']} elements of {count}")
            position = self.json["accessors"][attributes["POSITION"]]
            self.need("min" in position and "max" in position, f"{where}: positions without min and max")
            if "NORMAL" in attributes:
                lengths = [math.hypot(*n) for n in self.vectors(attributes["NORMAL"])]
                self.need(all(abs(length - 1) < 1e-3 for length in lengths), f"{where}: normals of another length than 1")
            if "COLOR_0" in attributes:
                self.need(all(0 <= c <= 1 for c in self.arrays[attributes["COLOR_0"]]), f"{where}: colours beyond 0 and 1")
            mode = primitive.get("mode", 4)
            indices = self.arrays[primitive["indices"]]
            item = self.json["accessors"][primitive["indices"]]
            self.need(item["type"] == "SCALAR" and item["componentType"] in (5121, 5123, 5125), f"{where}: type of indices")
            restart = 256**SIZES[item["componentType"]] - 1
            self.need(max(indices) < count and max(indices) != restart, f"{where}: an index is {max(indices)} of {count}")
            self.need(len(indices) % CORNERS[mode] == 0, f"{where}: {len(indices)} indices for mode {mode}")
            for material in materials_of(primitive):
                if self.index(material, "materials", where):
                    used = [info.get("texCoord", 0) for info in texture_infos(self.json["materials"][material])]
                    for number in used:
                        self.need(f"TEXCOORD_{number}" in attributes, f"{where}: TEXCOORD_{number} is missing")
            self.check_variants(primitive, where)

    def check_variants(self, primitive, where):
        names = self.json.get("extensions", {}).get("KHR_materials_variants", {}).get("variants", [])
        self.need(len({one["name"] for one in names}) == len(names), "two variants have one name")
        mappings = primitive.get("extensions", {}).get("KHR_materials_variants", {}).get("mappings", [])
        variants = [variant for mapping in mappings for variant in mapping["variants"]]
        self.need(len(set(variants)) == len(variants), f"{where}: a variant twice")
        self.need(all(0 <= variant < len(names) for variant in variants), f"{where}: a variant that is not there")

    def check_materials(self, material, where):
        pbr = material.get("pbrMetallicRoughness", {})
        for name in ("metallicFactor", "roughnessFactor"):
            self.need(0 <= pbr.get(name, 0) <= 1, f"{where}.{name}")
        for name, values in (("baseColorFactor", pbr.get("baseColorFactor", [1] * 4)),
                             ("emissiveFactor", material.get("emissiveFactor", [0] * 3))):
            self.need(len(values) == (4 if name[0] == "b" else 3) and all(0 <= v <= 1 for v in values), f"{where}.{name}")
        self.need(material.get("alphaMode", "OPAQUE") in ("OPAQUE", "MASK", "BLEND"), f"{where}.alphaMode")
        self.need("alphaCutoff" not in material or material["alphaMode"] == "MASK", f"{where}.alphaCutoff")
        for info in texture_infos(material):
            self.index(info["index"], "textures", where)
        more = material.get("extensions", {})
        self.need(more.get("KHR_materials_ior", {}).get("ior", 1.5) >= 1, f"{where}: ior")
        volume = more.get("KHR_materials_volume", {})
        self.need(volume.get("attenuationDistance", 1) > 0 and volume.get("thicknessFactor", 0) >= 0, f"{where}: volume")
        self.need(all(0 <= v <= 1 for v in volume.get("attenuationColor", [])), f"{where}: attenuationColor")

    def check_textures(self, texture, where):
        self.index(texture["source"], "images", where)
        self.index(texture["sampler"], "samplers", where)

    def check_images(self, image, where):
        self.need(("uri" in image) != ("bufferView" in image), f"{where}: one of uri and bufferView")
        if "bufferView" in image:
            self.need(image["mimeType"] in ("image/png", "image/jpeg"), f"{where}.mimeType")
            view = self.json["bufferViews"][image["bufferView"]]
            data = self.buffers[view["buffer"]][view["byteOffset"]:view["byteOffset"] + view["byteLength"]]
            self.need("target" not in view, f"{where}: a target")
            png = image["mimeType"] == "image/png"
        else:
            data = (self.path.parent / image["uri"]).read_bytes()
            png = image["uri"].endswith(".png")
        self.need(data.startswith(b"\x89PNG\r\n\x1a\n" if png else b"\xff\xd8\xff"), f"{where}: the picture has another format")

    def check_cameras(self, camera, where):
        if camera["type"] == "perspective":
            values = camera["perspective"]
            self.need(0 < values["yfov"] < math.pi and values["znear"] > 0, f"{where}: {values}")
        else:
            values = camera["orthographic"]
            self.need(values["xmag"] > 0 and values["ymag"] > 0 and 0 <= values["znear"] < values["zfar"], f"{where}: {values}")

    def check_nodes(self):
        parents = {}
        for number, node in enumerate(self.list("nodes")):
            where = f"nodes[{number}]"
            for name, width in (("translation", 3), ("rotation", 4), ("scale", 3)):
                if name in node:
                    self.need(len(node[name]) == width and all(isinstance(x, (int, float)) for x in node[name]), f"{where}.{name}")
            if "rotation" in node:
                self.need(abs(math.hypot(*node["rotation"]) - 1) < 1e-4, f"{where}: the rotation has another length than 1")
            self.need("matrix" not in node, f"{where}: a matrix is not expected")
            for child in node.get("children", []):
                self.need(self.index(child, "nodes", where) and child not in parents, f"{where}: child {child} has two parents")
                parents[child] = number
            self.need(node.get("children", [0]), f"{where}: no children")
            for name, kind in (("mesh", "meshes"), ("camera", "cameras")):
                if name in node:
                    self.index(node[name], kind, where)
        for scene in self.list("scenes"):
            roots = scene.get("nodes", [])
            self.need("nodes" not in scene or roots, "a scene has an empty list of nodes")
            self.need(len(set(roots)) == len(roots), "a root stands twice in its scene")
            for root in roots:
                self.need(self.index(root, "nodes", "scene") and root not in parents, f"root {root} has a parent")
        seen, open_nodes = set(), [n for scene in self.list("scenes") for n in scene.get("nodes", [])]
        while open_nodes:
            node = open_nodes.pop()
            if node not in seen:
                seen.add(node)
                open_nodes += self.json["nodes"][node].get("children", [])
        self.need(len(seen) == len(self.list("nodes")), f"{len(self.list('nodes')) - len(seen)} nodes are in no scene")

    def check_animations(self, animation, where):
        taken = set()
        self.need(animation["channels"] and animation["samplers"], f"{where} is empty")
        for channel in animation["channels"]:
            target = channel["target"]
            key = target["node"], target["path"]
            self.need(key not in taken, f"{where}: {key} twice")
            taken.add(key)
            self.index(target["node"], "nodes", where)
            sampler = animation["samplers"][channel["sampler"]]
            times, values = self.arrays[sampler["input"]], self.vectors(sampler["output"])
            item = self.json["accessors"][sampler["input"]]
            self.need("min" in item and "max" in item and times[0] >= 0, f"{where}: times")
            self.need(all(a < b for a, b in zip(times, times[1:])), f"{where}: times do not increase")
            self.need(len(values) == len(times), f"{where}: {len(values)} values for {len(times)} times")
            self.need(len(values[0]) == (4 if target["path"] == "rotation" else 3), f"{where}: width")
            if target["path"] == "rotation":
                self.need(all(abs(math.hypot(*q) - 1) < 1e-3 for q in values), f"{where}: rotations of another length than 1")

    def check_lights(self):
        lights = self.json.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
        for number, light in enumerate(lights):
            where = f"lights[{number}]"
            self.need(light["type"] in ("directional", "point", "spot"), f"{where}.type")
            self.need(all(0 <= c <= 1 for c in light["color"]) and light["intensity"] >= 0, f"{where}: {light}")
            self.need("range" not in light or (light["type"] != "directional" and light["range"] > 0), f"{where}.range")
            if light["type"] == "spot":
                inner, outer = light["spot"]["innerConeAngle"], light["spot"]["outerConeAngle"]
                self.need(0 <= inner < outer <= math.pi / 2 + 1e-6, f"{where}: cone {inner} {outer}")
        for number, node in enumerate(self.list("nodes")):
            light = node.get("extensions", {}).get("KHR_lights_punctual")
            if light is not None:
                self.need(0 <= light["light"] < len(lights), f"nodes[{number}]: light")

    def check_uses(self):
        """Everything but nodes, scenes and animations is there because something refers to it."""
        used = {kind: set() for kind in LISTS}
        for mesh in self.list("meshes"):
            for primitive in mesh["primitives"]:
                used["accessors"].update(primitive["attributes"].values(), [primitive["indices"]])
                used["materials"].update(materials_of(primitive))
        for animation in self.list("animations"):
            channels = {channel["sampler"] for channel in animation["channels"]}
            self.need(channels == set(range(len(animation["samplers"]))), "an animation has a sampler without a channel")
            for sampler in animation["samplers"]:
                used["accessors"].update((sampler["input"], sampler["output"]))
        for material in self.list("materials"):
            used["textures"].update(info["index"] for info in texture_infos(material))
        for texture in self.list("textures"):
            used["images"].add(texture["source"])
            used["samplers"].add(texture["sampler"])
        for node in self.list("nodes"):
            for name, kind in (("mesh", "meshes"), ("camera", "cameras")):
                used[kind].update([node[name]] if name in node else [])
        for kind, member in (("accessors", "bufferView"), ("images", "bufferView"), ("bufferViews", "buffer")):
            target = "buffers" if member == "buffer" else "bufferViews"
            used[target].update(item[member] for item in self.list(kind) if member in item)
        for kind in ("accessors", "materials", "textures", "images", "samplers", "meshes", "cameras", "bufferViews", "buffers"):
            unused = set(range(len(self.list(kind)))) - used[kind]
            self.need(not unused, f"nothing refers to {kind} {sorted(unused)[:5]}")

    def check_extensions(self):
        found, open_items = set(), [self.json]
        while open_items:
            item = open_items.pop()
            if isinstance(item, dict):
                found.update(item.get("extensions", {}))
                open_items += item.values()
            elif isinstance(item, list):
                open_items += item
        self.need(found == set(self.json.get("extensionsUsed", [])), f"extensionsUsed is not {sorted(found)}")
        self.need("extensionsRequired" not in self.json, "extensions are required")


def single(x):
    """Returns the float of 32 bits that a number of JSON stands for."""
    return struct.unpack("f", struct.pack("f", x))[0]


def materials_of(primitive):
    """Returns the material of a primitive, and those of its variants."""
    mappings = primitive.get("extensions", {}).get("KHR_materials_variants", {}).get("mappings", [])
    return [primitive["material"]] + [mapping["material"] for mapping in mappings]


def texture_infos(material):
    pbr = material.get("pbrMetallicRoughness", {})
    named = [pbr.get("baseColorTexture"), pbr.get("metallicRoughnessTexture")]
    named += [material.get(name) for name in ("normalTexture", "occlusionTexture", "emissiveTexture")]
    return [info for info in named if info is not None]


def problems_of(path):
    """Returns what is wrong with a file, as a list of texts."""
    return Checker(path).check()


def document_of(path):
    """Returns the JSON of a file, and what is wrong with it."""
    checker = Checker(path)
    problems = checker.check()
    return checker.json, problems, checker


if __name__ == "__main__":
    bad = 0
    for name in sys.argv[1:]:
        for problem in problems_of(name):
            bad += 1
            print(f"{name}: {problem}")
    sys.exit(bad > 0)
