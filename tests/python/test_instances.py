"""Tests that pictures show fields of prototype instances and Inlines, set before and after the
world runs."""
import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

LAMP = """#VRML V2.0 utf8
Viewpoint { position 0 0 8 }
PROTO Lamp [ exposedField SFColor c 1 0 0  field SFVec3f s 2 2 2 ] {
  Shape { appearance Appearance { material Material { diffuseColor 0 0 0 emissiveColor IS c } } geometry Box { size IS s } }
}
PROTO Pair [ exposedField SFColor both 1 0 0  exposedField MFNode kids [ ] ] {
  Group { children [ DEF One Lamp { c IS both }  Group { children IS kids } ] }
}
"""


def world(text):
    return xvrml.loads(LAMP + text)


def middle(w):
    shown = w.render(size=(9, 9), spp=1, headlight=False, fov=45).display[4, 4]
    return "".join(name for name, part in zip("rgb", shown) if part > 128)


def green_box():
    material = xvrml.Material(diffuseColor=(0, 0, 0), emissiveColor=(0, 1, 0))
    return xvrml.Shape(geometry=xvrml.Box(size=(3, 3, 3)),
                       appearance=xvrml.Appearance(material=material))


@pytest.mark.parametrize("runs", [False, True])
@pytest.mark.parametrize("instance, field", [("Lamp", "c"), ("Pair", "both")])
def test_an_exposed_field_of_an_instance_is_drawn(runs, instance, field):
    w = world(
        f"DEF L {instance} {{ }} Transform {{ translation 20 0 0 children DEF Other {instance} {{ }} }}"
    )
    if runs:
        w.time = 0
    else:
        assert middle(w) == "r"
    setattr(w["L"], field, (0, 0, 1))
    assert getattr(w["L"], field) == (0, 0, 1) and middle(w) == "b"
    w.time = 1
    assert middle(w) == "b"
    again = xvrml.loads(w.to_vrml())
    assert getattr(again["L"], field) == (0, 0, 1) and getattr(
        again["Other"], field) == (1, 0, 0) and middle(again) == "b"


@pytest.mark.parametrize("runs", [False, True])
def test_a_field_of_an_instance_is_drawn(runs):
    w = world("DEF L Lamp { }")
    if runs:
        w.time = 0
    assert middle(w) == "r"
    w["L"].s = (0.01, 0.01, 0.01)
    wide = w.render(size=(9, 9), spp=1, headlight=False).display
    assert (wide[:, 2] == 0).all() and (wide[:, 6] == 0).all()
    w["L"].s = (7, 7, 7)
    assert (w.render(size=(9, 9), spp=1, headlight=False).display[:, 2, 0] > 128).sum() > 5


@pytest.mark.parametrize("runs", [False, True])
def test_children_of_an_instance_are_drawn(runs):
    w = world("DEF P Pair { }")
    if runs:
        w.time = 0
    w["P"].kids = [green_box()]
    assert middle(w) == "g" and len(w["P"].kids) == 1
    w.time = 1
    assert middle(w) == "g"
    w["P"].kids = []
    assert middle(w) == "r"


def test_what_a_body_cannot_take_is_told():
    w = world("DEF P Pair { }")
    w["P"].kids = [xvrml.Box(), green_box()]
    assert middle(w) == "g" and any(
        "'Box' cannot be in field children" in str(one) for one in w.warnings)
    with pytest.raises(ValueError, match="would hold itself"):
        w["P"].kids = [xvrml.Group(children=[w["P"]])]
    assert middle(w) == "g"


def test_what_a_script_takes_as_an_event_is_sent_when_the_world_begins():
    w = world("""
      PROTO Told [ exposedField SFFloat x 0 ] {
        Script { eventIn SFFloat set_x IS x  eventOut SFFloat twice
          url "vrmlscript: function set_x(v, t) { print('told ' + v); }" }
      }
      DEF T Told { x 1 }""")
    w["T"].x = 2
    w.time = 0.5
    assert [one.message for one in w.warnings if "told" in one.message] and w["T"].x == 2
    assert sum("told 2" in one.message for one in w.warnings) == 1


@pytest.mark.parametrize("runs", [False, True])
def test_another_url_of_an_inline_is_loaded(tmp_path, runs):
    for name, color in (("red", "1 0 0"), ("blue", "0 0 1")):
        (tmp_path / f"{name}.wrl").write_text(LAMP + f"Lamp {{ c {color} }}")
    (tmp_path / "main.wrl").write_text(LAMP + """
      PROTO Part [ exposedField MFString url [ ] ] { Inline { url IS url } }
      Transform { translation 0 0 -1 children DEF In Inline { url "red.wrl" } } DEF Of Part { }""")
    for name in ("In", "Of"):
        w = xvrml.load(tmp_path / "main.wrl")
        assert middle(w) == "r"
        if runs:
            w.time = 0
        w[name].url = ["blue.wrl"]
        assert middle(w) == "b" and not w.warnings
        w.time = 1
        assert middle(w) == "b"
    w = xvrml.load(tmp_path / "main.wrl")
    w["In"].url = ["main.wrl"]
    assert middle(w) == "" and any("contains this Inline itself" in str(one) for one in w.warnings)
