"""One world in every encoding that is read gives the same bytes of picture, and is checked, told
about, inlined and loaded in Python alike."""
import gzip
import json

import pytest

NODES = """
Viewpoint { position 0 0 6 description "a \\"view\\"" }
DEF Sun DirectionalLight { direction -1 -1 -2 intensity .8 }
Background { skyColor [ .2 .3 .5 ] }
PROTO Ball [ inputOutput SFColor colour 1 0 0  initializeOnly SFFloat size 1 ] {
  Shape {
    appearance Appearance { material Material { diffuseColor IS colour } }
    geometry Sphere { radius IS size }
  }
}
DEF Left Transform {
  translation -1.5 0 0
  children [ Ball { colour 0 .8 .2 } DEF Box Shape { geometry Box { size .5 3 .5 } } ]
}
Transform { translation 1.5 0 0 rotation 0 0 1 .5 children [ Ball { size .7 } USE Box ] }
Shape {
  appearance Appearance { material Material { } texture PixelTexture { image 2 1 3 0xff0000 255 } }
  geometry IndexedFaceSet {
    coord Coordinate { point [ -.5 -1 1, .5 -1 1, 0 1 1 ] }
    coordIndex [ 0 1 2 -1 ]
    solid FALSE
  }
}
"""
CLASSIC = "#X3D V3.3 utf8\nPROFILE Immersive\n" + NODES
XML = """<?xml version="1.0" encoding="UTF-8"?>
<X3D profile='Immersive' version='3.3'>
<Scene>
<Viewpoint position='0 0 6' description='a "view"'/>
<DirectionalLight DEF='Sun' direction='-1 -1 -2' intensity='.8'/>
<Background skyColor='.2 .3 .5'/>
<ProtoDeclare name='Ball'>
  <ProtoInterface>
    <field accessType='inputOutput' type='SFColor' name='colour' value='1 0 0'/>
    <field accessType='initializeOnly' type='SFFloat' name='size' value='1'/>
  </ProtoInterface>
  <ProtoBody>
    <Shape>
      <Appearance><Material><IS><connect nodeField='diffuseColor' protoField='colour'/></IS></Material></Appearance>
      <Sphere><IS><connect nodeField='radius' protoField='size'/></IS></Sphere>
    </Shape>
  </ProtoBody>
</ProtoDeclare>
<Transform DEF='Left' translation='-1.5 0 0'>
  <ProtoInstance name='Ball'><fieldValue name='colour' value='0 .8 .2'/></ProtoInstance>
  <Shape DEF='Box'><Box size='.5 3 .5'/></Shape>
</Transform>
<Transform translation='1.5 0 0' rotation='0 0 1 .5'>
  <ProtoInstance name='Ball'><fieldValue name='size' value='.7'/></ProtoInstance>
  <Shape USE='Box'/>
</Transform>
<Shape>
  <Appearance><Material/><PixelTexture image='2 1 3 0xff0000 255'/></Appearance>
  <IndexedFaceSet coordIndex='0 1 2 -1' solid='false'>
    <Coordinate point='-.5 -1 1, .5 -1 1, 0 1 1'/>
  </IndexedFaceSet>
</Shape>
</Scene>
</X3D>
"""


def ball(**values):
    """Returns an instance of the prototype in JSON."""
    given = [{"@name": name, "@value": value} for name, value in values.items()]
    return {"ProtoInstance": {"@name": "Ball", "fieldValue": given}}


def connected(node, field, interface):
    """Returns a node in JSON whose field is connected to the prototype's interface."""
    return {node: {"IS": {"connect": [{"@nodeField": field, "@protoField": interface}]}}}


MATERIAL = connected("Material", "diffuseColor", "colour")
BODY = {
    "Shape": {
        "-appearance": {
            "Appearance": {
                "-material": MATERIAL
            }
        },
        "-geometry": connected("Sphere", "radius", "size")
    }
}
INTERFACE = [{
    "@accessType": "inputOutput",
    "@type": "SFColor",
    "@name": "colour",
    "@value": [1, 0, 0]
}, {
    "@accessType": "initializeOnly",
    "@type": "SFFloat",
    "@name": "size",
    "@value": 1
}]
JSON = json.dumps({
    "X3D": {
        "@profile": "Immersive",
        "@version": "3.3",
        "Scene": {
            "-children": [{
                "Viewpoint": {
                    "@position": [0, 0, 6],
                    "@description": 'a "view"'
                }
            }, {
                "DirectionalLight": {
                    "@DEF": "Sun",
                    "@direction": [-1, -1, -2],
                    "@intensity": .8
                }
            }, {
                "Background": {
                    "@skyColor": [.2, .3, .5]
                }
            }, {
                "ProtoDeclare": {
                    "@name": "Ball",
                    "ProtoBody": {
                        "-children": [BODY]
                    },
                    "ProtoInterface": {
                        "field": INTERFACE
                    }
                }
            }, {
                "Transform": {
                    "-children": [
                        ball(colour=[0, .8, .2]), {
                            "Shape": {
                                "@DEF": "Box",
                                "-geometry": {
                                    "Box": {
                                        "@size": [.5, 3, .5]
                                    }
                                }
                            }
                        }
                    ],
                    "@DEF": "Left",
                    "@translation": [-1.5, 0, 0]
                }
            }, {
                "Transform": {
                    "@translation": [1.5, 0, 0],
                    "@rotation": [0, 0, 1, .5],
                    "-children": [ball(size=.7), {
                        "Shape": {
                            "@USE": "Box"
                        }
                    }]
                }
            }, {
                "Shape": {
                    "-appearance": {
                        "Appearance": {
                            "-material": {
                                "Material": {}
                            },
                            "-texture": {
                                "PixelTexture": {
                                    "@image": [2, 1, 3, 0xff0000, 255]
                                }
                            }
                        }
                    },
                    "-geometry": {
                        "IndexedFaceSet": {
                            "@coordIndex": [0, 1, 2, -1],
                            "@solid": False,
                            "-coord": {
                                "Coordinate": {
                                    "@point": [-.5, -1, 1, .5, -1, 1, 0, 1, 1]
                                }
                            }
                        }
                    }
                }
            }]
        }
    }
})
# A texture replaces diffuseColor in VRML97 and multiplies it in X3D; both are the same on white, to
# which VRML97 sets it here.
VRML97 = "#VRML V2.0 utf8\n" + NODES.replace("inputOutput", "exposedField").replace(
    "initializeOnly", "field").replace("Material { }", "Material { diffuseColor 1 1 1 }")
WORLDS = {"a.x3dv": CLASSIC, "a.x3d": XML, "a.x3dj": JSON}
NAMES = {"a.x3dv": "X3D ClassicVRML", "a.x3d": "X3D XML", "a.x3dj": "X3D JSON"}
SMALL = ("--size", "64x48", "--spp", "2")


def picture(vv, name):
    done = vv(name, "-o", "ppm:-", *SMALL)
    assert done.returncode == 0, done.talk
    return done.stdout


def test_one_world_in_every_encoding_is_the_same_picture(vv):
    for name, text in WORLDS.items():
        vv.write(name, text)
    pictures = {name: picture(vv, name) for name in WORLDS}
    assert len(set(pictures.values())) == 1
    assert len(set(pictures["a.x3d"])) > 20  # something is drawn
    for name, text in WORLDS.items():
        vv.write(
            name,
            text.replace("Material { }", "Material { diffuseColor 1 1 1 }").replace(
                "<Material/>", "<Material diffuseColor='1 1 1'/>").replace(
                    '"Material": {}', '"Material": {"@diffuseColor": [1, 1, 1]}'))
    vv.write("a.wrl", VRML97)
    assert {picture(vv, name) for name in [*WORLDS, "a.wrl"]} == {picture(vv, "a.wrl")}


@pytest.mark.parametrize("name", WORLDS)
def test_check_and_info(vv, name):
    vv.write(name, WORLDS[name])
    done = vv(name, "--check")
    assert done.returncode == 0, done.talk
    told = json.loads(vv(name, "--info", "--json").text)
    assert NAMES[name] in json.dumps(told)


@pytest.mark.parametrize("name, wrong, place", [
    ("a.x3d", "position='0 0 6 7'", ":4:28: error: expected the end of the value, found '7'"),
    ("a.x3dj", '"@position": [0, 0]', "error: expected a component of SFVec3f"),
])
def test_wrong_values_are_told_with_their_places(vv, name, wrong, place):
    text = WORLDS[name].replace("position='0 0 6'", wrong).replace('"@position": [0, 0, 6]', wrong)
    vv.write(name, text)
    done = vv(name, "--check")
    assert place in done.talk + done.text
    assert done.returncode != 0


@pytest.mark.parametrize("name", WORLDS)
def test_packed_inlined_and_piped(vv, name):
    vv.write(name, WORLDS[name])
    whole = picture(vv, name)
    vv.write(name + ".gz", gzip.compress(WORLDS[name].encode()))
    assert picture(vv, name + ".gz") == whole
    vv.write("around.wrl", '#VRML V2.0 utf8\nInline { url "%s" }' % name)
    vv.write("around.x3d", "<X3D version='3.3'><Scene><Inline url='\"%s\"'/></Scene></X3D>" % name)
    assert picture(vv, "around.wrl") == picture(vv, "around.x3d")


@pytest.mark.parametrize("name", WORLDS)
def test_prototypes_in_other_files(vv, name):
    vv.write(name, WORLDS[name])
    vv.write(
        "plain.wrl", "#VRML V2.0 utf8\nShape { appearance Appearance { material Material { "
        "diffuseColor 0 0 1 } } geometry Sphere { } }")
    vv.write(
        "user.x3d", """<X3D version='3.3'><Scene>
<ExternProtoDeclare name='Ball' url='"%s#Ball"'><field accessType='inputOutput' type='SFColor' name='colour'/>
</ExternProtoDeclare><ProtoInstance name='Ball'><fieldValue name='colour' value='0 0 1'/></ProtoInstance>
</Scene></X3D>""" % name)
    assert picture(vv, "user.x3d") == picture(vv, "plain.wrl")


@pytest.mark.parametrize("name", WORLDS)
def test_python_loads_them(tmp_path, name):
    xvrml = pytest.importorskip("xvrml")
    path = tmp_path / name
    path.write_text(WORLDS[name])
    world = xvrml.load(str(path))
    assert world["Left"].node_type == "Transform"
    assert [round(x, 3) for x in world["Left"].translation] == [-1.5, 0, 0]
    assert world["Box"].geometry.node_type == "Box"


# VRML 1.0 can say this world, too: it has no prototypes, and its lights and cameras are traversed.
PLAIN = """
Viewpoint { position 0 0 6 }
Transform { translation -1.5 0 0 children Shape {
  appearance Appearance { material Material { diffuseColor 0 .8 .2 } } geometry Sphere { } } }
Transform { translation 1.5 0 0 children Shape {
  appearance Appearance { material Material { diffuseColor 1 0 0 } }
  geometry Box { size .5 3 .5 } } }
"""
FIVE = {
    "b.wrl":
        "#VRML V2.0 utf8\n" + PLAIN,
    "b.x3dv":
        "#X3D V3.3 utf8\nPROFILE Interchange\n" + PLAIN,
    "b.x3d":
        """<X3D version='3.3'><Scene><Viewpoint position='0 0 6'/>
<Transform translation='-1.5 0 0'><Shape><Appearance><Material diffuseColor='0 .8 .2'/></Appearance>
<Sphere/></Shape></Transform>
<Transform translation='1.5 0 0'><Shape><Appearance><Material diffuseColor='1 0 0'/></Appearance>
<Box size='.5 3 .5'/></Shape></Transform></Scene></X3D>""",
    "b.x3dj":
        """{"X3D":{"@version":"3.3","Scene":{"-children":[{"Viewpoint":{"@position":[0,0,6]}},
{"Transform":{"@translation":[-1.5,0,0],"-children":[{"Shape":{"-geometry":{"Sphere":{}},
"-appearance":{"Appearance":{"-material":{"Material":{"@diffuseColor":[0,0.8,0.2]}}}}}}]}},
{"Transform":{"@translation":[1.5,0,0],"-children":[{"Shape":{"-geometry":{"Box":{"@size":[0.5,3,0.5]}},
"-appearance":{"Appearance":{"-material":{"Material":{"@diffuseColor":[1,0,0]}}}}}}]}}]}}}""",
    "b1.wrl":
        """#VRML V1.0 ascii
Separator {
  PerspectiveCamera { position 0 0 6 }
  Separator { Translation { translation -1.5 0 0 } Material { diffuseColor 0 .8 .2 } Sphere { } }
  Separator { Translation { translation 1.5 0 0 } Material { diffuseColor 1 0 0 }
    Cube { width .5 height 3 depth .5 } }
}
""",
}


def test_one_world_in_five_encodings_is_the_same_picture(vv):
    for name, text in FIVE.items():
        vv.write(name, text)
    pictures = {name: picture(vv, name) for name in FIVE}
    assert [name for name in FIVE if pictures[name] != pictures["b.wrl"]] == []
    assert len(set(pictures["b.wrl"])) > 20


@pytest.mark.parametrize("name", ["out.wrl", "out.x3dv", "out.x3d", "out.json"])
@pytest.mark.parametrize("source", WORLDS)
def test_what_is_written_is_the_same_picture(vv, source, name):
    vv.write(source, WORLDS[source].replace("Material { }", "Material { diffuseColor 1 1 1 }").replace(
        "<Material/>", "<Material diffuseColor='1 1 1'/>").replace(
            '"Material": {}', '"Material": {"@diffuseColor": [1, 1, 1]}'))
    done = vv(source, "--write", name)
    assert done.returncode == 0, done.talk
    assert picture(vv, name) == picture(vv, source)


def test_units_of_inlines(vv):
    """A file in millimetres and degrees is right in a world in metres and radians."""
    vv.write(
        "mm.x3d", """<X3D version='3.3'><head>
<unit category='length' name='mm' conversionFactor='0.001'/>
<unit category='angle' name='degree' conversionFactor='0.017453292519943295'/></head><Scene>
<Transform translation='250 0 0' rotation='0 0 1 90'><Shape><Appearance><Material diffuseColor='1 0 0'/>
</Appearance><Box size='1000 250 500'/></Shape></Transform></Scene></X3D>""")
    vv.write("m.x3dv", '#X3D V3.3 utf8\nPROFILE Immersive\nViewpoint { position 0 0 4 }\n'
             'Inline { url "mm.x3d" }\n')
    vv.write(
        "plain.x3dv", "#X3D V3.3 utf8\nPROFILE Immersive\nViewpoint { position 0 0 4 }\n"
        "Transform { scale .0009765625 .0009765625 .0009765625 children Transform { translation 256 0 0 "
        "rotation 0 0 1 1.5707963 children Shape { appearance Appearance { material Material { "
        "diffuseColor 1 0 0 } } geometry Box { size 1024 256 512 } } } }\n")
    red = [pixels_in_red(picture(vv, name)) for name in ("m.x3dv", "plain.x3dv")]
    assert red[0] == red[1] > 50


def pixels_in_red(ppm):
    """Returns how many pixels of a PPM picture are more red than green."""
    pixels = ppm[-64 * 48 * 3:]
    return sum(pixels[i] > pixels[i + 1] + 20 for i in range(0, len(pixels), 3))
