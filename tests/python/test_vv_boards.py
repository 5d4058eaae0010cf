"""Tests the preset pcb of vv: what the layers of KiCad's boards are made of, and how boards lie."""
import base64
import json
import struct

import pytest
from conftest import HEADER

# The materials that KiCad's exporter writes for the layers of a board: diffuse colour, shininess,
# transparency. 6 to 9 write the colours of the stackup; an unset one of the board is black.
LAYER = """Transform { translation %g 0 %g children Shape {
  appearance Appearance { material Material { diffuseColor %s shininess %s transparency %s } }
  geometry IndexedFaceSet { coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }
    coordIndex [ 0 1 2 3 ] } } }
"""
GOLD, COPPER, SILVER, TIN = "n .143", "n .21", "n .05", "n 1.48"


@pytest.mark.parametrize("name, colour, shininess, what", [
    ("6 to 9, no finish", "0.75 0.61 0.23", "0.9", GOLD),
    ("6 to 9, ENIG", "0.698 0.612 0", "0.9", GOLD),
    ("6 to 9, OSP", "0.722 0.451 0.196", "0.9", COPPER),
    ("6 to 9, silver", "0.83529413 0.83529413 0.83529413", "0.89999998", SILVER),
    ("6 to 9, HASL", "0.627 0.627 0.627", "0.9", TIN),
    ("6 to 9, paste", "0.5 0.5 0.5", "0.7", TIN),
    ("5, pads", "0.749 0.756 0.761", "0.8", TIN),
    ("a part that is as grey as HASL", "0.627 0.627 0.627", "0.1", "Plastic"),
    ("a part that is as grey as paste", "0.5 0.5 0.5", "0.2", "Plastic"),
    ("6 to 9, board without a colour", "0 0 0", "0.01", "color .155 .171 .073"),
    ("a black part", "0 0 0", "0.1", "roughness .2"),
    ("a black part that does not shine", "0 0 0", "0", "roughness .2"),
    ("black silkscreen", "0 0 0", "0.02", "roughness .2"),
    ("6 to 9, silkscreen", "0.961 0.961 0.961", "0.02", "Plastic"),
])
def test_the_preset_knows_the_layers_of_each_kicad(vv, name, colour, shininess, what):
    vv.write("layer.wrl", HEADER + LAYER % (0, 0, colour, shininess, 0))
    assert vv("layer.wrl", "--preset", "pcb", "--write", "out.wrl").returncode == 0, name
    text = (vv.folder / "out.wrl").read_text()
    assert what in text.replace(" 0.", " ."), text


def test_a_board_without_a_colour_is_as_bright_as_one_of_fr4(vv):
    """Which is .43 .45 .3 in the colours of a Material."""
    grey = []
    for colour in ("0 0 0", "0.43 0.45 0.3"):
        vv.write("layer.wrl", HEADER + "Viewpoint { position 0 0 9 }\n" + LAYER % (0, 0, colour, .01, 0))
        grey.append(sum(vv.picture("--preset", "pcb", "--viewpoint", "0", "--spp", "64",
                                   world="layer.wrl")[12][16]))
    assert grey[0] == pytest.approx(grey[1], rel=.1)


@pytest.mark.parametrize("place", ["0 0 0", "20 10 0", "150 -100 3"])
def test_boards_lie_wherever_their_origin_is(vv, place):
    """KiCad's exports have z up, and say so nowhere. A file of glTF has y up."""
    vv.write("board.wrl", HEADER + f"Transform {{ translation {place} children Shape {{ "
             "appearance Appearance { material Material { } } geometry Box { size 40 20 1.6 } } }")
    top = vv.floats("--preset", "pcb", "--from", "top", "--shader", "*=Diffuse:reflectance=0:emission=1,0,0", world="board.wrl")
    wide = [sum(v[0] > 2 * v[1] for v in row) for row in top]
    tall = sum(n > 0 for n in wide)
    assert max(wide) / tall == pytest.approx(2, abs=.4)


@pytest.mark.parametrize("mask", ["0.0784 0.2 0.141", "0.71 0.0745 0.0824", "0.00784 0.231 0.635"])
def test_tracks_show_through_solder_mask(vv, mask):
    body = LAYER % (0, -.1, "0.427 0.455 0.294", ".01", 0)
    track = LAYER % (1, -.05, "0.75 0.61 0.23", ".9", 0)
    over = [LAYER % (0, 0, mask, ".3", alpha) for alpha in ("0.17", "0")]
    view = HEADER + "Viewpoint { position 0 0 6 fieldOfView .3 }\n"

    def left_and_right(text):
        vv.write("mask.wrl", view + text)
        rows = vv.floats("--preset", "pcb", "--viewpoint", "0", "--spp", "64", world="mask.wrl")
        middle = rows[4:12]
        return [[sum(row[x][c] for row in middle for x in part) / 8 / len(part) for c in range(3)]
                for part in (range(7, 10), range(14, 17))]

    board, copper = left_and_right(body + track + over[0])
    strongest = max(range(3), key=lambda c: float(mask.split()[c]))
    assert copper[strongest] > 1.12 * board[strongest]  # a brighter shade of the mask
    assert max(copper) == copper[strongest]
    board, copper = left_and_right(body + track + over[1])
    assert copper == pytest.approx(board, rel=.1)


def test_a_board_is_the_same_on_any_number_of_threads(vv):
    layers = ((-.1, ("0.427 0.455 0.294", ".01", 0.034)), (-.05, ("0.75 0.61 0.23", ".9", 0)),
              (0, ("0.08 0.2 0.14", ".3", .17)))
    vv.write("mask.wrl", HEADER + "".join(LAYER % (0, z, *layer) for z, layer in layers))
    one, three = (vv.floats("--preset", "pcb", "--threads", n, world="mask.wrl") for n in "13")
    assert one == three


def test_colours_of_a_glb_stay(vv):
    """Its materials are PhysicalMaterials, whose colour is baseColor. All were dark red, the default
    of Plastic."""
    corners = struct.pack("<12f", -1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1)
    faces = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    model = {
        "asset": {
            "version": "2.0"
        },
        "scene": 0,
        "scenes": [{
            "nodes": [0]
        }],
        "nodes": [{
            "mesh": 0
        }],
        "materials": [{
            "pbrMetallicRoughness": {
                "baseColorFactor": [.02, .3, .05, 1],
                "metallicFactor": 0
            }
        }],
        "meshes": [{
            "primitives": [{
                "attributes": {
                    "POSITION": 0
                },
                "indices": 1,
                "material": 0
            }]
        }],
        "accessors": [{
            "bufferView": 0,
            "componentType": 5126,
            "count": 4,
            "type": "VEC3",
            "min": [-1, 0, -1],
            "max": [1, 0, 1]
        }, {
            "bufferView": 1,
            "componentType": 5123,
            "count": 6,
            "type": "SCALAR"
        }],
        "bufferViews": [{
            "buffer": 0,
            "byteLength": len(corners)
        }, {
            "buffer": 0,
            "byteOffset": len(corners),
            "byteLength": len(faces)
        }],
        "buffers": [{
            "byteLength": len(corners + faces),
            "uri": "data:application/octet-stream;base64," + base64.b64encode(corners + faces).decode()
        }],
    }
    vv.write("board.gltf", json.dumps(model))
    red, green, blue = vv.picture("--preset", "pcb", world="board.gltf")[12][16]
    assert green > 1.3 * max(red, blue), (red, green, blue)
