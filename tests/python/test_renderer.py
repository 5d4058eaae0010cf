"""Tests xvrml.Renderer and World.render_with(): which methods are called for what, what they get, and
how a walk ends."""
import threading

import pytest
from conftest import ROOT

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

WORLD = b"""#VRML V2.0 utf8
PROTO Pair [ exposedField MFNode parts [] ] {
  Transform { children [ Group { children IS parts } Transform { translation 0 1 0 children IS parts } ] }
}
DEF Place Transform { translation 1 2 3 children [
  DEF Cube Shape {
    appearance Appearance {
      material Material { diffuseColor .2 .4 .6 transparency .25 }
      texture PixelTexture { image 1 1 3 0xff8000 }
      textureTransform TextureTransform { scale 2 1 }
    }
    geometry DEF Form Box { size 1 2 3 }
  }
  Transform { scale 2 2 2 children Shape { geometry USE Form } }
  DEF Choice Switch { whichChoice 1 choice [ Shape { geometry Cone { } } Shape { geometry Sphere { } } ] }
  DEF Two Pair { parts Shape { geometry IndexedLineSet { coord Coordinate { point [0 0 0, 1 0 0] } coordIndex [0 1] } } }
] }
"""


@pytest.fixture
def world():
    return xvrml.load(WORLD)


class Log(xvrml.Renderer):
    """Writes down what is called."""

    def __init__(self):
        self.lines, self.shapes = [], []

    def draw(self, shape):
        self.lines.append(f"draw {shape.name}")
        self.shapes.append((shape.geometry, shape.mesh, shape.uses))


class Everything(Log):

    def render(self, node, state):
        self.lines.append(node.node_type)

    def leave(self, node, state):
        self.lines.append(f"/{node.node_type}")


def test_shapes_are_drawn_with_arrays(world):
    log = Log()
    world.render_with(log)
    assert log.lines == ["draw Cube", "draw Place", "draw Choice", "draw Two", "draw Two"]
    (form, cube, uses), (_, larger, _) = log.shapes[:2]
    assert form == world["Form"] and uses == 2 and cube.node == world["Cube"]
    assert cube.kind == "triangles" and cube.vertices.dtype == np.float32
    assert not cube.vertices.flags.writeable and len(cube.faces) == 12
    assert np.shares_memory(cube.vertices, larger.vertices), "a geometry has its arrays once"
    assert np.allclose(np.abs(cube.vertices).max(0), (0.5, 1, 1.5))
    assert np.array_equal(cube.matrix[:3, 3], (1, 2, 3))
    assert np.array_equal(larger.matrix[:3, :3], 2 * np.eye(3))
    assert [mesh.kind for _, mesh, _ in log.shapes[2:]] == ["triangles", "lines", "lines"]
    world.render_with(log, spheres=0)
    assert log.shapes[7][1].kind == "sphere" and log.shapes[7][1].radius == 1


@pytest.mark.parametrize("name", ("python/car.wrl", "scenes/globe.wrl", "scenes/still_life.wrl",
                                  "kicad/blinker.wrl"))
def test_meshes_are_what_a_renderer_draws(name):
    world = xvrml.load(ROOT / "examples" / name)
    view = world.viewpoints[0].matrix if world.viewpoints else np.eye(4)
    log = Log()
    world.render_with(log, view=view)
    drawn = [mesh for _, mesh, _ in log.shapes if mesh.kind != "empty"]
    meshes = world.meshes(view=view)
    assert len(drawn) == len(meshes) > 0
    for a, b in zip(drawn, meshes):
        assert (a.node, a.kind) == (b.node, b.kind)
        for one, other in ((a.matrix, b.matrix), (a.vertices, b.vertices), (a.faces, b.faces)):
            assert np.array_equal(one, other)


def test_each_node_has_its_callback(world):
    log = Everything()
    world.render_with(log)
    assert log.lines[0] == "Transform" and log.lines[-1] == "/Transform"
    assert log.lines[1:7] == [
        "Shape", "draw Cube", "Appearance", "Material", "/Material", "PixelTexture"
    ]
    for word in ("Switch", "Pair", "Box", "Sphere", "IndexedLineSet"):
        assert log.lines.count(word) == log.lines.count(f"/{word}") > 0, word
    assert "Cone" not in log.lines
    world.render_with(log, all_choices=True)
    assert "Cone" in log.lines


def test_methods_of_types_go_before_the_general_one(world):

    class One(Everything):

        def render_transform(self, node, state):
            self.lines.append(f"transform {node.translation}")
            return "skip" if node.scale != (1, 1, 1) else "children"

        def render_switch(self, node, state):
            return "skip"

        def render_shape(self, node, state):
            return "draw"

        def render_instance(self, node, state):
            self.lines.append(f"instance {node.def_name} in {state.name}")

    log = One()
    world.render_with(log)
    assert log.lines[:2] == ["transform (1.0, 2.0, 3.0)", "draw Cube"]
    assert not {"Box", "Appearance", "/Switch", "/Shape", "draw Choice"} & set(log.lines)
    assert log.lines.count("draw Two") == 2 and "instance Two in Two" in log.lines


def test_states_tell_the_place(world):

    class States(xvrml.Renderer):

        def render_box(self, node, state):
            self.path = [one.def_name for one in state.path]
            self.parent, self.name, self.matrix = state.parent, state.name, state.matrix
            return "skip" if node == world["Form"] else None

        def render_transform(self, node, state):
            assert np.array_equal(state.inner, state.matrix @ state.local)
            assert state.planes.shape == (0, 4)

        def render_indexed_line_set(self, node, state):
            self.types = [one.node_type for one in state.path]

    states = States()
    world.render_with(states)
    assert states.path == ["Place", "", "", "Form"] and states.name == "Form"
    assert states.parent.node_type == "Shape"
    assert np.array_equal(states.matrix, [[2, 0, 0, 1], [0, 2, 0, 2], [0, 0, 2, 3], [0, 0, 0, 1]])
    assert states.types == [
        "Transform", "Pair", "Transform", "Transform", "Shape", "IndexedLineSet"
    ]


def test_appearances_are_resolved(world):

    class Looks(xvrml.Renderer):

        def __init__(self):
            self.parts = []

        def draw(self, shape):
            self.parts.append(shape.appearance)

    looks = Looks()
    world.render_with(looks)
    first, second = looks.parts[:2]
    assert isinstance(first.material, xvrml.Material) and first.back is None
    assert isinstance(first.texture, xvrml.PixelTexture) and first.shader is None
    assert first.front.model == "phong" and first.front.transparency == 0.25
    assert np.allclose(first.front.color, (0.2, 0.4, 0.6)) and not first.textures_multiply
    layer, = first.layers
    assert layer.texture == first.texture and layer.transform[0, 0] == 2 and layer.mode == ""
    assert second.appearance is None and second.front.model == "none" and second.layers == []


def test_textures_have_pictures(world, tmp_path):
    shown = world.render(size=(16, 12), spp=1)
    shown.save(tmp_path / "shown.png")
    (tmp_path / "a.wrl").write_text("""#VRML V2.0 utf8
Shape { appearance Appearance { texture DEF File ImageTexture { url ["none.png", "shown.png"] } }
  geometry Box { } }
Shape { appearance Appearance { texture DEF Missing ImageTexture { url "none.png" } } geometry Box { } }
Shape { appearance Appearance { texture DEF Pixels PixelTexture { image 1 2 3 0xff0000 0x0000ff } }
  geometry Box { } }
""")
    other = xvrml.load(tmp_path / "a.wrl")
    file = other.texture_picture(other["File"])
    assert np.array_equal(file.array[..., :3], shown.display[..., :3])
    assert file.file == (tmp_path / "shown.png").read_bytes() and file.type == "image/png"
    assert file.path.endswith("shown.png") and not file.error
    raw = other.texture_picture(other["File"], decode=False)
    assert raw.array is None and raw.file == file.file
    missing = other.texture_picture(other["Missing"])
    assert missing.array is None and "none.png" in missing.error and missing.file == b""
    pixels = other.texture_picture(other["Pixels"])
    assert pixels.array.tolist() == [[[0, 0, 255]], [[255, 0, 0]]] and pixels.type == ""


def test_clip_planes_cut_meshes():
    world = xvrml.load(b"""#X3D V3.3 utf8
PROFILE Full
Group { children [ ClipPlane { plane 1 0 0 0 } Transform { translation 0 0 2 children Shape { geometry Box { } } } ] }
""")
    seen = []

    class Cut(xvrml.Renderer):

        def draw(self, shape):
            seen.append((shape.planes, shape.mesh))

    world.render_with(Cut())
    (planes, mesh), = seen
    assert planes.tolist() == [[1, 0, 0, 0]]
    assert mesh.vertices[np.unique(mesh.faces)][:, 0].min() >= 0


def test_what_events_reach_is_known():
    world = xvrml.load(ROOT / "examples/python/car.wrl")
    world.time = 0
    found = {}

    class Reaches(xvrml.Renderer):

        def draw(self, shape):
            for part, reach in shape.reaches.items():
                found.setdefault(part, set()).add(reach.reason)

    world.render_with(Reaches())
    assert "matrix" in found and any("ROUTE from" in reason for reason in found["matrix"])


def test_exceptions_pass_through(world):

    class Failing(xvrml.Renderer):

        def draw(self, shape):
            raise KeyError("no colour")

    for _ in range(2):
        with pytest.raises(KeyError, match="no colour"):
            world.render_with(Failing())
    world["Place"].translation = (0, 0, 0)
    assert len(world.meshes()) == 5


def test_methods_cannot_change_or_render_the_world(world):

    class Meddling(xvrml.Renderer):
        failures = []

        def draw(self, shape):
            for action in (lambda: setattr(world["Place"], "translation", (0, 0, 0)),
                           lambda: world.render(size=(8, 8), spp=1),
                           lambda: world.render_with(Log())):
                with pytest.raises((ValueError, xvrml.RenderError)) as failure:
                    action()
                self.failures.append(str(failure.value))
            assert world["Place"].translation == (1, 2, 3) and len(world.meshes()) == 5

    world.render_with(Meddling())
    assert len(Meddling.failures) == 15


def test_states_and_shapes_end_with_their_callback_but_meshes_do_not(world):

    class Keeping(xvrml.Renderer):
        kept = []

        def render_box(self, node, state):
            self.kept.append(state)

        def draw(self, shape):
            self.kept.append(shape)
            self.mesh = shape.mesh
            errors = []

            def use():
                try:
                    shape.matrix
                except RuntimeError as error:
                    errors.append(error)

            thread = threading.Thread(target=use)
            thread.start()
            thread.join()
            assert len(errors) == 1

    keeping = Keeping()
    world.render_with(keeping)
    for one in keeping.kept:
        with pytest.raises(RuntimeError, match="only during the callback"):
            one.matrix
        with pytest.raises(RuntimeError):
            one.path
    del world
    assert keeping.mesh.kind == "lines" and len(keeping.mesh.vertices) == 2


def test_wrong_renderers_are_told(world):

    class Misspelt(xvrml.Renderer):

        def render_trasnform(self, node, state):
            pass

    class Helper(xvrml.Renderer):

        def render_to_paper(self):
            pass

    class Answer(xvrml.Renderer):

        def render_box(self, node, state):
            return 7

    with pytest.raises(TypeError, match="Misspelt.render_trasnform.*did you mean render_transform"):
        world.render_with(Misspelt())
    world.render_with(Helper())
    with pytest.raises(ValueError, match="the callback for Box returned the int 7: None"):
        world.render_with(Answer())
    with pytest.raises(TypeError, match="derived from xvrml.Renderer"):
        world.render_with(Log)
    with pytest.raises(ValueError, match="spheres"):
        world.render_with(Log(), spheres=1001)
    with pytest.raises(ValueError, match="view"):
        world.render_with(Log(), view=[1, 2])
    with pytest.raises(ValueError):
        world.render_with(Log(), max_visits=3)
    with pytest.raises(TypeError):
        xvrml.DrawnShape()


def test_levels_of_detail_are_those_of_the_viewer():
    world = xvrml.load(b"""#VRML V2.0 utf8
LOD { range 10 level [ Shape { geometry Box { } } Shape { geometry Cone { } } ] }
""")
    types = []

    class Types(xvrml.Renderer):

        def draw(self, shape):
            types.append(shape.geometry.node_type)

    far = np.eye(4)
    far[2, 3] = 20
    world.render_with(Types())
    world.render_with(Types(), view=far)
    world.render_with(Types(), all_choices=True)
    assert types == ["Box", "Cone", "Box", "Cone"]


def test_names_of_methods():
    from xvrml import _renderer
    names = {
        "Transform": "render_transform",
        "IndexedFaceSet": "render_indexed_face_set",
        "LOD": "render_lod",
        "ORTShader": "render_ort_shader",
        "CADFace": "render_cad_face",
        "ArcClose2D": "render_arc_close2d"
    }
    for node_type, name in names.items():
        assert _renderer.callback_name(node_type) == name
    every = [_renderer.callback_name(name) for name in xvrml.nodes.__all__]
    assert len(set(every)) == len(every)
