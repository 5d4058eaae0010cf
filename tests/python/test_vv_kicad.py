"""Tests what --preset pcb makes of exports whose Materials have no names: KiCad 10 in VRML, and
files of glTF. Also parts that are missing."""
import collections
import importlib.util
import json
import struct

import pytest
from conftest import HEADER, ROOT

# Materials of KiCad's parts: name, diffuse colour, transparency. None differs from another by less
# than .015, but for the pairs that a transparency tells apart.
PALETTE = [
    ("IC-BODY-EPOXY-04", (.148, .145, .145), 0), ("PIN-01", (.824, .82, .781), 0),
    ("PIN-02", (.859, .738, .496), 0), ("IC-LABEL-01", (.691, .664, .598), 0),
    ("PLASTIC-GREEN-01", (.34, .68, .445), 0), ("PLASTIC-WHITE-01", (.895, .891, .813), 0),
    ("PLASTIC-BLUE-01", (.137, .402, .727), 0), ("CAP-CERAMIC-05", (.273, .273, .273), 0),
    ("RED-BODY", (.7, .1, .05), 0), ("PLASTIC-ORANGE-01", (.809, .426, .148), 0),
    ("RES-THT-01", (.883, .711, .492), 0), ("CAP-CERAMIC-06", (.379, .27, .215), 0),
    ("PLASTIC-YELLOW-01", (.832, .68, .066), 0), ("RES-SMD-01", (.082, .086, .094), 0),
    ("IC-BODY-EPOXY-01", (.25, .262, .281), 0), ("MET-01", (.298, .298, .298), 0),
    ("CAP-CERAMIC-02", (.578, .336, .352), 0), ("GLASS-19", (.400769, .441922, .459091), .37),
    ("GLASS-13", (0, .631244, .748016), .39), ("LED-RED", (.7, .1, .05), .1),
    ("LED-GREEN", (.4, .7, .15), .1), ("LED-BLUE", (.1, .25, .7), .1),
    ("LED-YELLOW", (.98, .84, .066), .1), ("LED-WHITE", (.895, .891, .813), .1),
    ("GLASS-29", (.566681, .580872, .580874), .38), ("MET-SILVER", (.50754, .50754, .50754), 0),
    ("MET-ALUMINUM", (.372322, .371574, .373173), 0), ("MET-COPPER", (.7038, .27048, .0828), 0),
    ("BOARD-GREEN-02", (.07, .3, .12), 0), ("BOARD-BLUE-01", (.07, .12, .3), 0),
    ("BOARD-BLACK-03", (.16, .16, .16), 0), ("MET-BRONZE", (.714, .4284, .18144), 0),
    ("GLASS-GREEN", (0, .75, .44), .39), ("GLASS-ORANGE", (.75, .44, 0), .39),
    ("LED-GREY", (.27, .25, .27), .1), ("LED-BLACK", (.1, .05, .1), .15),
    ("GLASS-29", (.859, .738, .496), .39),
    ("PLASTIC-GREEN-27", (.135944, .190588, .122239), 0)
]
BOX = """Shape { appearance Appearance { material %s Material { diffuseColor %s transparency %g } }
  geometry Box { size %g %g %g } }
"""


def decoded(value):
    return value / 12.92 if value <= .04045 else ((value + .055) / 1.055)**2.4


def encoded(value):
    return value * 12.92 if value <= .0031308 else 1.055 * value**(1 / 2.4) - .055


def rounded(value):
    return round(value * 255) / 255


def box(colour, name="", clear=0, size=1):
    return BOX % (name and "DEF " + name, " ".join(f"{c:.6g}" for c in colour), clear, *3 * [size])


def materials_of(vv, world, *options):
    done = vv(world, "--preset", "pcb", "--explain", "--json", *options)
    assert done.returncode == 0, done.talk
    return json.loads(done.text)["materials"]


def tool(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / f"tools/{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("form", [float, decoded, encoded, rounded])
def test_a_colour_tells_the_material(vv, form):
    """As KiCad's numbers, as their linear form, as if they had been linear, and in 8 bits."""
    vv.write("board.wrl", HEADER + "".join(
        box([form(c) for c in colour], "", clear) for _, colour, clear in PALETTE))
    found = collections.Counter()
    for one in materials_of(vv, "board.wrl"):
        assert one["by_colour"] and one["rule"], one
        found[one["name"]] += one["shapes"]
    assert found == collections.Counter(name for name, _, _ in PALETTE)


def test_a_name_wins_over_the_colour(vv):
    red, pin = (.7, .1, .05), (.824, .82, .781)
    vv.write("board.wrl", HEADER + box(red, "PIN-02") + box(pin, "mat_3") + box(red, "LED-PINK", .1))
    found = {one["name"]: one for one in materials_of(vv, "board.wrl")}
    assert set(found) == {"PIN-02", "PIN-01", "LED-PINK"}
    assert not found["PIN-02"]["by_colour"] and "n=.143" in found["PIN-02"]["rule"]
    assert found["PIN-01"]["by_colour"]  # mat_3 is a name of the exporter, not of KiCad's library


def test_a_colour_beside_the_tolerance_is_unknown_and_told_with_its_area(vv):
    grey = .298
    vv.write("board.wrl", HEADER + box(3 * [grey + .0045]) + box(3 * [grey + .0055], size=2))
    known, unknown = sorted(materials_of(vv, "board.wrl"), key=lambda one: one["area"])
    assert known["name"] == "MET-01" and known["area"] == pytest.approx(6)
    assert unknown["rule"] is None and unknown["area"] == pytest.approx(24)
    text = vv("board.wrl", "--preset", "pcb", "--explain").text
    assert "80.0 % of the area is of materials that no rule but * knows" in text
    assert "no name, colour:0.303,0.303,0.303: no rule knows it" in text


@pytest.mark.parametrize("file, clear, name", [("C_Rect.wrl", 0, "RED-BODY"),
                                               ("C_Rect.wrl", .1, "LED-RED"),
                                               ("LED_D5.0mm.wrl", 0, "LED-RED")])
def test_red_plastic_is_an_led_if_it_is_clear_or_in_an_led(vv, file, clear, name):
    vv.write(file, HEADER + box((.7, .1, .05), "", clear))
    vv.write("board.wrl", HEADER + f'Inline {{ url "{file}" }}')
    assert [one["name"] for one in materials_of(vv, "board.wrl")] == [name]


def test_own_rules_reach_materials_without_names(vv):
    vv.write("board.wrl", HEADER + box((.7, .1, .05), "", .1) + box((.824, .82, .781)))
    done = vv("board.wrl", "--preset", "pcb", "--shader", "kicad:LED-*=Glass:index=1.4", "--write",
              "out.wrl")
    assert done.returncode == 0 and done.talk == "", done.talk
    text = (vv.folder / "out.wrl").read_text()
    assert text.count('"Glass"') == 1 and text.count('"Metal"') == 1
    assert vv("board.wrl", "--shader", "kicad:=Glass", "-o", "x.png").returncode == 2


@pytest.mark.parametrize("form", [decoded, encoded])
def test_parts_have_the_same_look_in_each_form(vv, form):
    """A colour that is known in another form is drawn as KiCad means it."""
    red = (.809, .426, .148)
    pictures = []
    for colour in (red, [form(c) for c in red]):
        vv.write("board.wrl", HEADER + box(colour))
        pictures.append(vv.floats("--preset", "pcb"))
    assert pictures[0] == pictures[1]


@pytest.mark.parametrize("form", ["own", "linear", "encoded"])
def test_parts_of_a_board_without_names_get_their_materials(vv, form):
    """But for one plastic of the example that is not KiCad's."""
    board = tool("make_kicad_board")
    areas = []
    for named in (True, False):
        folder = vv.folder / f"named-{named}"
        board.write_board(folder, None, 12, form, named)
        areas.append(collections.Counter())
        for one in materials_of(vv, folder / "board.wrl"):
            areas[-1][one["rule"]] += one["area"]
        done = vv(folder / "board.wrl", "--check")
        assert done.returncode == 0, done.talk
    plastic = areas[0].pop("kicad:PLASTIC-*=Plastic:roughness=.35")
    assert areas[1].pop(None) == pytest.approx(plastic + areas[0].pop(None, 0), rel=1e-6)
    assert set(areas[1]) == set(areas[0]) and len(areas[0]) >= 8
    for rule, area in areas[0].items():
        assert areas[1][rule] == pytest.approx(area, rel=1e-6), rule


# glTF --------------------------------------------------------------------------------------------


def as_kicad_glb(data):
    """Turns a .glb that vv has written of a board into one like KiCad's: meshes of layers and their
    materials have names, parts have none, and the colours of layers are sRGB in linear fields."""
    length = struct.unpack("<I", data[12:16])[0]
    model = json.loads(data[20:20 + length])
    layers = {
        (.43, .45, .3): ("PCB", "board"),
        (.75, .61, .23): ("copper", "copper"),
        (.0784, .2, .141): ("soldermask", "soldermask"),
        (.961, .961, .961): ("silkscreen", "silkscreen"),
        (.5, .5, .5): ("pad", "pad")
    }
    kinds = {}
    for number, material in enumerate(model["materials"]):
        material.pop("extensions", None)
        pbr = material["pbrMetallicRoughness"]
        factor = pbr.get("baseColorFactor", [1, 1, 1, 1])
        colour = [encoded(c) for c in factor[:3]]
        layer = next((names for own, names in layers.items()
                      if max(abs(a - b) for a, b in zip(own, colour)) < .002), None)
        material["name"] = layer[1] if layer else f"mat_{number}"
        pbr["metallicFactor"], pbr["roughnessFactor"] = 0, .6
        if layer:
            pbr["baseColorFactor"] = [*colour, factor[3]]
            kinds[number] = layer[0]
    for mesh in model["meshes"]:
        kind = kinds.get(mesh["primitives"][0].get("material"))
        mesh["name"] = "blinker_" + kind if kind else "part"
    text = json.dumps(model).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length:]
    return (struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)) +
            struct.pack("<I4s", len(text), b"JSON") + text + rest)


@pytest.fixture
def glb(vv):
    done = vv(ROOT / "examples/kicad/blinker.wrl", "--write", "plain.glb")
    assert done.returncode == 0, done.talk
    vv.write("blinker.glb", as_kicad_glb((vv.folder / "plain.glb").read_bytes()))
    return "blinker.glb"


def test_layers_of_a_glb_are_known_by_their_names(vv, glb):
    found = {one["name"]: one["rule"] for one in materials_of(vv, glb)}
    for layer in ("copper", "pad", "soldermask", "silkscreen", "board"):
        assert found["layer-" + layer].startswith("kicad:layer-" + layer), found
    assert {"PIN-01", "PIN-02", "IC-BODY-EPOXY-04", "LED-RED", "RES-SMD-01"} < set(found)


def test_a_glb_looks_like_the_vrml_of_the_same_board(vv, glb):
    """Also where glTF has y up. The mean difference of both pictures is within their noise."""
    pictures = []
    for world in (ROOT / "examples/kicad/blinker.wrl", glb):
        done = vv(world, "--preset", "pcb", "--size", "80x60", "--spp", "64", "-o", "pfm:-")
        assert done.returncode == 0, done.talk
        pictures.append(struct.unpack(f"<{80 * 60 * 3}f", done.stdout[-80 * 60 * 12:]))
    differences = [abs(a - b) for a, b in zip(*pictures)]
    assert sum(differences) / len(differences) < .03 * sum(pictures[0]) / len(pictures[0])


def test_names_in_a_world_of_vrml_are_no_layers(vv):
    vv.write("board.wrl", HEADER + "DEF main_copper Transform { children " +
             box((.2, .5, .3)) + "}")
    assert materials_of(vv, "board.wrl")[0]["name"] == ""


# Missing parts -----------------------------------------------------------------------------------

MISSING = HEADER + """DEF Board Transform { children [
  Shape { geometry Box { size 40 20 1.6 } }
  DEF R12 Transform { translation 3 0 1 scale 2.54 2.54 2.54 children
    Inline { url "shapes3D/R_0805_2012Metric.wrl" } }
  DEF U1 Transform { translation -5 0 1 children Inline { url "U.wrl" bboxSize 4 5 30 bboxCenter 0 0 15 } }
  Transform { children Inline { url "shapes3D/Thing.wrl" } } ] }
"""


def test_missing_parts_are_listed_with_their_reference(vv):
    vv.write("board.wrl", MISSING)
    done = vv("board.wrl", "--check")
    assert done.returncode == 4
    assert ("3 parts are missing: Board/R12 (shapes3D/R_0805_2012Metric.wrl), Board/U1 (U.wrl), "
            "Board (shapes3D/Thing.wrl)") in done.talk
    vv.write("whole.wrl", HEADER + "Shape { geometry Box { } }")
    assert "missing" not in vv("whole.wrl", "--check").talk


def test_boxes_stand_for_missing_parts_of_a_known_size(vv):
    vv.write("board.wrl", MISSING)
    plain, boxes = (json.loads(vv("board.wrl", "--info", "--json", *options).text)["bounds"]
                    for options in ((), ("--preset", "pcb")))
    height = lambda bounds: bounds["max"][2] if "max" in bounds else bounds["maximum"][2]
    assert height(plain) == pytest.approx(.8)
    assert height(boxes) == pytest.approx(31)
    done = vv("board.wrl", "--preset", "pcb", "--size", "8x6", "--spp", "1", "-o", "x.png")
    assert done.returncode == 0
    assert "3 parts are missing" in done.talk and "boxes stand for 2 of them" in done.talk
    assert "parts are missing" not in vv("board.wrl", "--size", "8x6", "--spp", "1", "-o", "y.png").talk


# Boards ------------------------------------------------------------------------------------------


def brightness(rows):
    return sum(sum(pixel) for row in rows for pixel in row)


def test_top_and_bottom_have_the_same_light(vv):
    vv.write("board.wrl", HEADER + box((.14, .3, .2)).replace("size 1 1 1", "size 40 20 1.6"))
    sides = []
    for side in ("top", "bottom"):
        rows = vv.floats("--preset", "pcb", "--from", side, "--spp", "256")[4:12]
        sides.append([brightness([row[at:at + 6] for row in rows]) for at in (3, 9, 15)])
    assert sides[0] == pytest.approx(sides[1], rel=.04)
    assert sides[0][0] > 1.05 * sides[0][2]  # the light comes from the left in both


def test_a_board_that_stands_on_edge_is_seen_whole_from_its_front(vv):
    vv.write("board.wrl", HEADER + box((.14, .3, .2)).replace("size 1 1 1", "size 40 1.6 20"))
    flat = vv.floats("--preset", "pcb", "--from", "top", "--up", "y", "--spp", "64")
    edge = vv.floats("--preset", "pcb", "--from", "front", "--spp", "64")
    assert brightness(flat) == pytest.approx(brightness(edge), rel=.2)


def test_a_panel_of_boards_is_drawn_like_one_board(vv):
    vv.write("one.wrl", HEADER + box((.824, .82, .781)))
    vv.write("board.wrl", HEADER + "".join(
        f'Transform {{ translation {3 * x} {3 * y} 0 children Inline {{ url "one.wrl" }} }}'
        for x in range(3) for y in range(2)))
    (only,) = materials_of(vv, "board.wrl")
    assert only["name"] == "PIN-01" and only["area"] == pytest.approx(36)
