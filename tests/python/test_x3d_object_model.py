"""Compares the nodes and fields that vv lists with those of X3D 4 (x3d_fields.tsv), and its
messages with the nodes that it does not have."""
import json
import pathlib
import re

TABLE = pathlib.Path(__file__).parent / "x3d_fields.tsv"

# Fields that are not there: docs/worlds.md says what happens to them.
LEFT_OUT = {
    "acousticProperties", "attrib", "autoRefresh", "autoRefreshTimeLimit", "load", "shaders"
}
LEFT_OUT_OF = {("AudioClip", "enabled"), ("MovieTexture", "enabled"), ("Sound", "enabled"),
               ("AudioClip", "gain"), ("MovieTexture", "gain"), ("MovieTexture", "pitch"),
               ("IndexedLineSet", "normal"), ("LineSet", "normal"), ("PointSet", "normal"),
               ("HAnimHumanoid", "children"), ("HAnimHumanoid", "displacers"),
               ("ComposedCubeMapTexture", "textureProperties")}
# VRML97's names, which X3D gives to no field of the same node.
OURS = {("Switch", "children"): "choice", ("LOD", "children"): "level",
        ("Collision", "enabled"): "collide", ("LoadSensor", "children"): "watchList",
        ("ParticleSystem", "color"): "colorRamp", ("ParticleSystem", "texCoord"): "texCoordRamp"}
OURS.update({("ComposedCubeMapTexture", side + "Texture"): side
             for side in ("back", "bottom", "front", "left", "right", "top")})
# Where the text of the standard differs from the object model (ISO/IEC 19775-1:2013 20.4.1, 32.4.3;
# :2023 17.4.2), and what only the XML of a Script has.
TEXT_DIFFERS = {("CADLayer", "visible"), ("CylinderSensor", "axisRotation"),
                ("EnvironmentLight", "global"), ("Script", "sourceCode"), ("Script", "url"), ("Script", "field")}


def rows():
    for line in TABLE.read_text().splitlines():
        if not line.startswith("#"):
            yield line.split("\t")


def listed(vv):
    nodes = json.loads(vv("--list-nodes", "--json").stdout)["nodes"]
    return {node["name"]: {field["name"]: field for field in node["fields"]} for node in nodes}


def same(a, b):
    """Returns whether two defaults are equal, up to the decimals of the object model."""
    words = [re.findall(r'"[^"]*"|[^\s,\[\]]+', text) for text in (a, b)]
    if len(words[0]) != len(words[1]):
        return False
    for one, other in zip(*words):
        try:
            if abs(float(one) - float(other)) > 1e-3 * max(1, abs(float(one))):
                return False
        except ValueError:
            if one != other:
                return False
    return True


def test_every_field_is_that_of_x3d_4(vv):
    nodes, wrong, compared = listed(vv), [], 0
    for node, name, access, kind, default in rows():
        if node not in nodes or (node, name) in TEXT_DIFFERS | LEFT_OUT_OF or name in LEFT_OUT:
            continue
        field = nodes[node].get(OURS.get((node, name), name))
        if field is None:
            # Texts that X3D 4 adds to nodes, and that nothing shows.
            if name != "description":
                wrong.append(f"{node}.{name} is missing")
            continue
        said = field.get("versions", [field])[-1]  # the last version says it
        compared += 1
        if (field["type"], said["access"]) != (kind, access) or not same(said["default"], default):
            wrong.append(f"{node}.{name}: {field['type']} {said['access']} {said['default']}, "
                         f"not {kind} {access} {default}")
    assert wrong == []
    assert compared > 1000


def test_every_version_names_its_clause(vv):
    revised = [version for node in listed(vv).values() for field in node.values()
               for version in field.get("versions", [])]
    assert len(revised) > 20
    for version in revised:
        assert re.fullmatch(r"[34]\.\d", version["since"])
        assert re.fullmatch(r"\d+(\.\d+){1,2}", version["clause"])


def test_nodes_that_are_left_out_are_said_with_what_is_lost(vv):
    known = listed(vv)
    absent = sorted({row[0] for row in rows()} - set(known))
    assert len(absent) > 60
    vv.write("absent.x3dv", "#X3D V4.0 utf8\n" + "\n".join(f"{name} {{ }}" for name in absent))
    said = vv("absent.x3dv", "--check").stderr.decode()
    programs = 0
    for name in absent:
        line = re.search(rf"warning: nodes of type '{name}' \((\w+)\) are not supported and are left "
                         r"out here and below, with all that they hold: \w", said)
        programs += line is None
        assert line or name in ("ComposedShader", "FloatVertexAttribute", "Matrix3VertexAttribute",
                                "Matrix4VertexAttribute", "PackagedShader", "ProgramShader",
                                "ShaderPart", "ShaderProgram"), name
    assert programs == 8
    assert ": error:" not in said
