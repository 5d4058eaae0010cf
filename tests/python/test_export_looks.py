"""Worlds that glTF can say as they are, without highlights, backgrounds and headlights: exported by vv --write
and read again by vv, they look as before."""
import json

import pytest
from conftest import HEADER
from exports import export

VIEW = "Viewpoint { position 2 2 4 orientation -0.6 0.8 0.1 0.7 }\n"
SUN = "DirectionalLight { direction -1 -2 -3 }\n"
PICTURE = "PixelTexture { image 2 2 3 0xff0000 0x00ff00 0x0000ff 0xffffff }"
SQUARE = """IndexedFaceSet { solid FALSE coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } coordIndex [ 0 1 2 3 ]
  texCoord TextureCoordinate { point [ 0 0, 2 0, 2 2, 0 2 ] } }"""


def shape(material, geometry="Box { }", more=""):
    return f"Shape {{ appearance Appearance {{ {material} {more} }} geometry {geometry} }}\n"


ALIKE = {
    "matt": SUN + shape("material Material { diffuseColor 0.2 0.5 0.8 }"),
    "light near by": "PointLight { location 1 2 3 attenuation 0 0 0.2 }\n" + shape("material Material { }", "Sphere { }"),
    "spot": "SpotLight { location 0 0 4 attenuation 0 0 0.1 cutOffAngle 0.3 beamWidth 0.2 }\n" +
            shape("material Material { }", "Box { size 4 4 1 }"),
    "emission": shape("material Material { diffuseColor 0 0 0 emissiveColor 0.3 0.6 0.1 }", "Cone { }"),
    "no material": shape("", "Cylinder { }"),
    "picture": shape(f"texture {PICTURE}", SQUARE),
    "picture on a material": SUN + shape(f"material Material {{ diffuseColor 1 0 0 }} texture {PICTURE}", SQUARE),
    "picture that is moved": shape(f"texture {PICTURE}", SQUARE,
                                   "textureTransform TextureTransform { translation 0.3 0.1 rotation 0.4 scale 2 2 }"),
    "picture that is sheared": shape(f"texture {PICTURE}", SQUARE,
                                     "textureTransform TextureTransform { rotation 0.4 scale 2 0.7 center 0.5 0.5 }"),
    "grey picture": SUN + shape("material Material { diffuseColor 1 0.5 0 } texture PixelTexture { image 1 2 1 0x80 0xff }",
                                SQUARE),
    "transparent": SUN + shape("material Material { transparency 0.5 diffuseColor 1 0 0 }") +
                   "Transform { translation 0 0 -3 " + "children " + shape("material Material { emissiveColor 0 1 0 }") + "}",
    "colours of vertices": """Shape { geometry IndexedFaceSet { coord Coordinate { point [ -1 -1 0, 1 -1 0, 0 1 0 ] }
  coordIndex [ 0 1 2 ] color Color { color [ 1 0 0, 0 0.5 0, 0.2 0.2 1 ] } } }""",
    "clockwise": SUN + """Shape { appearance Appearance { material Material { } } geometry IndexedFaceSet { ccw FALSE
  coord Coordinate { point [ -1 -1 0, 1 -1 0, 0 1 0 ] } coordIndex [ 0 2 1 ] } }""",
    "places": SUN + """Transform { translation 1 0 0 center 1 0 0 rotation 0 0 1 1 scale 1 2 0.5 scaleOrientation 1 1 0 1
  children Transform { scale -1 1 1 rotation 0 1 0 0.5 children """ +
              shape("material Material { diffuseColor 0 1 0 }", "Box { size 0.5 1 2 }") + "} }",
}


@pytest.mark.parametrize("mode", ("OPAQUE", "MASK", "BLEND", "AUTO"))
@pytest.mark.parametrize("material", ("Material { diffuseTexture", "PhysicalMaterial { metallic 0 baseTexture",
                                      "UnlitMaterial { emissiveTexture"))
def test_alpha_of_pictures(vv, material, mode):
    """The alpha of a picture in a material of X3D 4 multiplies that of the material."""
    picture_node = "PixelTexture { image 2 2 4 0xff0000ff 0x00ff0080 0x0000ff40 0xffffff00 }"
    world = "#X3D V4.0 utf8\nPROFILE Full\n" + VIEW + SUN + shape(
        f"material {material} {picture_node} transparency 0.2 }}", SQUARE, f'alphaMode "{mode}"')
    export(vv, world + "Transform { translation 0 0 -2 children " + shape("material UnlitMaterial { emissiveColor 0 1 0 }") + "}")
    assert difference(picture(vv, "in.wrl"), picture(vv, "out.glb")) < 1


def test_glass_is_read_again(vv):
    ball = """Shape { appearance ORTAppearance { shader ORTShader { name "Glass" file "glass"
  options [ "1f index 1.3" "3f absorption .1 .5 1" ] } } geometry Sphere { } }
Transform { translation 0 0 -3 children """ + shape("material Material { emissiveColor 0 1 0 }", "Box { size 1 9 1 }") + "}"
    export(vv, HEADER + VIEW + ball)
    ours, theirs = picture(vv, "in.wrl"), picture(vv, "out.glb")
    assert sum(ours) > 20000 and difference(ours, theirs) < 2


def picture(vv, name):
    done = vv(name, "-o", "ppm:-", "--size", "64x48", "--spp", "16", "--viewpoint", "0", "--headlight", "off",
              "--background", "0,0,0", "-q")
    assert done.returncode == 0, done.talk
    return done.stdout[-64 * 48 * 3:]


def difference(a, b):
    """Returns the mean difference of two pictures, of 255."""
    return sum(abs(x - y) for x, y in zip(a, b)) / len(a)


@pytest.mark.parametrize("name", ALIKE)
def test_what_is_read_again_looks_the_same(vv, name):
    export(vv, HEADER + VIEW + ALIKE[name])
    ours = picture(vv, "in.wrl")
    assert sum(ours) > 20000  # something is to be seen
    assert difference(ours, picture(vv, "out.glb")) < 1


def test_lines_keep_their_transparency(vv):
    export(vv, VIEW + """Shape { appearance Appearance { material Material { emissiveColor 1 0 0 transparency 0.25 } }
  geometry IndexedLineSet { coord Coordinate { point [ 0 0 0, 1 1 1 ] } coordIndex [ 0 1 ] } }""")
    data = (vv.folder / "out.glb").read_bytes()
    material = json.loads(data[20:20 + int.from_bytes(data[12:16], "little")])["materials"][0]
    assert material["alphaMode"] == "BLEND"
    assert material["pbrMetallicRoughness"]["baseColorFactor"] == [1, 0, 0, 0.75]
