"""Tests the Python SDK as its users write it: fields and views, nodes by their classes, events,
time, pictures, meshes."""
import io
import gc
import os
import signal
import subprocess
import sys
import threading
import time
import weakref

import pytest
from conftest import ROOT

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

CAR = (ROOT / "examples/python/car.wrl").read_text()
SMALL = dict(size=(32, 24), spp=1)


@pytest.fixture
def world():
    return xvrml.load(CAR.encode())


def test_the_sample_of_the_documentation(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "car.wrl").write_text(CAR)
    world = xvrml.load("car.wrl")
    assert world.warnings == []
    world["Lamp"].intensity = 0.5
    coord = world["Hull"].geometry.coord
    assert coord.point.shape == (4, 3) and not coord.point.flags.writeable
    with coord.edit("point") as p:
        p[:, 2] += 1
    assert coord.point[:, 2].tolist() == [1, 1, 1, 1]
    box = xvrml.Shape(geometry=xvrml.Box(size=(1, 2, 3)),
                      appearance=xvrml.Appearance(material=xvrml.Material()))
    world.add(box, name="Crate")
    world.route("Clock.fraction_changed", "Spin.set_fraction")
    heard = []

    @world.on("Clock.fraction_changed")
    def tick(value, time):
        heard.append((value, time))

    world.time = 2.5
    assert heard == [(0.625, 2.5)] and world["Spin"].value_changed == 0.625
    image = world.render(size=(64, 48), error=0.2, viewpoint="Front", progress=True)
    assert image.array.shape == (48, 64, 4) and image["z"].shape == (
        48, 64) and image.error.shape == (48, 64, 3)
    assert image.stats["triangles"] == 14 and np.asarray(image).shape == (
        48, 64, 4) and image._repr_png_().startswith(b"\x89PNG")
    frames = [frame for frame in world.animate(3, 3.5, fps=4, size=(8, 6), spp=1)]
    assert [frame.time for frame in frames] == [3, 3.25]
    world.save("out.wrl")
    again = xvrml.load("out.wrl")
    assert again["Crate"].geometry.size == (1, 2, 3) and again["Lamp"].intensity == 0.5
    caster = world.raycaster()
    rays = np.array([[[0, 0, 10, 0, 0, -1], [0, 9, 10, 0, 0, -1]]], np.float32)
    hits = caster.cast_rays(rays)
    assert hits["t_hit"].shape == (1, 2) and hits["t_hit"][0, 0] == pytest.approx(
        8.5, abs=0.6) and np.isinf(hits["t_hit"][0, 1])
    assert caster.meshes[hits["geometry_ids"][0, 0]].node in (box, world["Hull"])
    assert caster.test_occlusions(rays).tolist() == [[True, False]]
    assert caster.list_intersections(rays)["ray_splits"].tolist()[0] == 0
    assert caster.compute_closest_points([[0, 0, 5]])["distances"][0] > 0


# Views ------------------------------------------------------------------------------------------


def test_a_view_shows_what_the_field_held(world):
    points = world["Points"]
    before = points.point
    assert before is not points.point and np.shares_memory(before, points.point), "no copy"
    points.point = np.zeros((2, 3))
    assert before.shape == (4, 3) and before[1].tolist() == [1, -1, 0], "what was looked at stays"
    assert points.point.tolist() == [[0, 0, 0], [0, 0, 0]]
    for array in (before, points.point):
        with pytest.raises(ValueError):
            array.setflags(write=True)
    del world, points
    gc.collect()
    assert before.sum() == 0


def test_a_view_survives_events_and_its_world():
    world = xvrml.load(b"""#VRML V2.0 utf8
DEF Clock TimeSensor { cycleInterval 1 loop TRUE }
DEF Way CoordinateInterpolator { key [0, 1] keyValue [0 0 0, 1 1 1] }
Shape { geometry PointSet { coord DEF C Coordinate { point 5 5 5 } } }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO C.set_point""")
    views = []
    for step in range(1, 9):
        views.append(world["C"].point)
        world.time = step / 8
    expected = [[5, 5, 5]] + [[step / 8] * 3 for step in range(1, 8)]
    del world
    gc.collect()
    assert [view[0].tolist() for view in views] == expected


def test_an_edit_that_fails_changes_nothing(world):
    coord = world["Points"]
    with pytest.raises(KeyError):
        with coord.edit("point") as p:
            p[:] = 7
            raise KeyError
    with pytest.raises(ValueError):
        with coord.edit("point") as p:
            p[0, 0] = np.nan
    assert coord.point[0].tolist() == [-1, -1, 0]
    with pytest.raises(TypeError, match="assign"):
        with world["Lamp"].edit("intensity"):
            pass
    shown = world.render(**SMALL).array
    with coord.edit("point") as p:
        p *= 3
    assert not np.array_equal(world.render(**SMALL).array, shown)


# Node classes -----------------------------------------------------------------------------------


def test_a_class_for_every_node():
    made = 0
    for name in xvrml.nodes.__all__:
        cls = getattr(xvrml, name)
        assert issubclass(cls, xvrml.Node) and cls.__name__ == name and cls.__doc__
        if name == "Script":
            with pytest.raises(TypeError, match="files alone"):
                cls()
            continue
        assert cls().node_type == name
        made += 1
    assert made >= 53
    with pytest.raises(TypeError, match="xvrml.Box"):
        xvrml.Node()


def test_nodes_are_of_their_classes(world):
    hull = world["Hull"]
    assert isinstance(hull, xvrml.Shape) and type(hull.geometry) is xvrml.IndexedFaceSet and type(
        world["Lamp"]) is xvrml.PointLight
    assert isinstance(world.roots[0], xvrml.Viewpoint)

    class Crate(xvrml.Box):
        pass

    assert Crate(size=(1, 1, 1)).size == (1, 1, 1)


def test_constructors_check(world):
    with pytest.raises(ValueError, match="radius"):
        xvrml.Sphere(radius=-1)
    with pytest.raises(AttributeError, match="did you mean size"):
        xvrml.Box(sise=1)
    with pytest.raises(ValueError, match="geometry.*Material"):
        xvrml.Shape(geometry=xvrml.Material())
    with pytest.raises(TypeError):
        xvrml.Box((1, 2, 3))


def test_nodes_join_worlds(world):
    paint = xvrml.Material(diffuseColor=(0, 1, 0))
    shape = xvrml.Shape(appearance=xvrml.Appearance(material=paint))
    ball = xvrml.Sphere(radius=0.5)
    shape.geometry = ball
    assert shape.geometry == ball and isinstance(shape.geometry, xvrml.Sphere)
    group = xvrml.Group(children=[shape])
    world.add(group)
    other = xvrml.World()
    for wrong in (lambda: other.add(shape), lambda: other.add(group),
                  lambda: xvrml.Group(children=[shape, other.add(xvrml.Group())])):
        with pytest.raises(ValueError, match="world"):
            wrong()
    heard = []
    world.on((paint, "diffuseColor"), lambda value, time: heard.append(value))
    paint.diffuseColor = (0, 0, 1)
    assert heard == [(0, 0, 1)] and world["Hull"].appearance.material.diffuseColor != (0, 0, 1)
    late = xvrml.Cone()
    shape.geometry = late  # into a running world
    world.on((late, "bottomRadius") if "bottomRadius" in () else (shape, "geometry"),
             lambda value, time: heard.append(value))
    world.remove(group)
    assert group not in world.roots


def test_a_node_is_not_part_of_itself(world):
    a, b = xvrml.Group(), xvrml.Group()
    a.children = [b]
    with pytest.raises(ValueError, match="itself"):
        b.children = [a]
    with pytest.raises(ValueError, match="itself"):
        a.children = [a]
    world.add(a)
    for time in (None, 1):
        with pytest.raises(ValueError, match="itself"):
            b.children = [a]
        if time is None:
            world.time = 1


def test_add_and_names(world):
    box = world.add(xvrml.Transform(), name="Crate")
    assert world["Crate"] == box and box.def_name == "Crate" and world.add(box) == box and list(
        world.roots).count(box) == 1
    with pytest.raises(ValueError, match="Lamp"):
        world.add(xvrml.Group(), name="Lamp")
    for name in ("", "1st", "a b", "x.y", "a\x07", "a\0", "a\x7f", "IS", "NULL", "exposedField"):
        with pytest.raises(ValueError, match="DEF"):
            world.add(xvrml.Group(), name=name)
    with pytest.raises(ValueError, match="Material cannot stand at the root"):
        world.add(xvrml.Material(), name="Varnish")
    assert "Varnish" not in world.names
    with pytest.raises(AttributeError, match="did you mean time"):
        world.tme = 5


def test_an_empty_world_is_filled(tmp_path):
    world = xvrml.World()
    world.add(xvrml.Viewpoint(position=(0, 0, 5)))
    world.add(
        xvrml.Shape(geometry=xvrml.Sphere(),
                    appearance=xvrml.Appearance(material=xvrml.Material(diffuseColor=(1, 0, 0)))),
        "Ball")
    assert world.render(**SMALL).array[12, 16, 0] > 0.1
    world.save(tmp_path / "ball.wrl")
    assert np.array_equal(
        xvrml.load(tmp_path / "ball.wrl").render(**SMALL).array,
        world.render(**SMALL).array)


# Events and time --------------------------------------------------------------------------------


def test_callbacks_come_after_the_events(world):
    told = []

    @world.on("Body.rotation")
    def turned(value, time):
        # Rendering a picture is allowed here.
        told.append((threading.current_thread(), world.render(**SMALL).array.shape, time))
        if time < 2:
            world.time = 2  # and so is setting the time

    assert world.on("Clock.isActive", print) is print
    world.time = 1
    assert [entry[2] for entry in told
           ] == [1, 2] and told[0][0] is threading.current_thread() and world.time == 2
    assert turned.__name__ == "turned"
    for wrong, error in (("Clok.isActive", KeyError), ("Clock.isActiv", AttributeError),
                         ("isActive", ValueError)):
        with pytest.raises(error):
            world.on(wrong)(print)


def test_callbacks_without_end_are_ended(world):

    @world.on("Lamp.intensity")
    def again(value, time):
        world["Lamp"].intensity = 1 - value

    with pytest.raises(RuntimeError, match="callbacks"):
        world["Lamp"].intensity = 0.25


def test_worlds_are_written_as_x3d(tmp_path):
    world = xvrml.loads("#VRML V2.0 utf8\nDEF S Switch { choice Group { } }")
    classic = world.to_x3d("classic")
    assert classic.startswith("#X3D V3.3 utf8\n") and "children" in classic
    assert xvrml.loads(classic).to_x3d("classic") == classic
    assert "<Switch DEF='S'>" in world.to_x3d()
    assert xvrml.loads(world.to_x3d("json")).to_x3d("classic") == classic
    for name, start in [("w.x3d", "<?xml"), ("w.x3dv", "#X3D"), ("w.json", "{"), ("w.wrl", "#VRML")]:
        world.save(tmp_path / name)
        assert (tmp_path / name).read_text().startswith(start)
    with pytest.raises(ValueError, match="'xml', 'classic' or 'json' expected, not 'yaml'"):
        world.to_x3d("yaml")


def test_routes_are_written(world):
    world.route("Clock.fraction_changed", "Paint.transparency")
    world.time = 1
    world.route("Clock.fraction_changed", (world["Lamp"], "intensity"))
    world.time = 2
    assert world["Paint"].transparency == 0.5 == world["Lamp"].intensity
    text = world.to_vrml()
    assert "Clock.fraction_changed TO Paint." in text and "TO Lamp." in text
    assert world.unroute("Clock.fraction_changed", "Lamp.intensity") and not world.unroute(
        "Clock.fraction_changed", "Lamp.intensity")
    assert "TO Lamp." not in world.to_vrml()
    with pytest.raises(TypeError):
        world.route("Clock.fraction_changed", "Body.translation")


def test_time_goes_on(world):
    assert world.time == 0
    world.time = 1
    with pytest.raises(ValueError, match="back"):
        world.time = 0.5
    with pytest.raises(ValueError):
        world.time = float("nan")
    with pytest.raises(ValueError, match="back"):
        next(world.animate(0, 1))
    assert next(world.animate(1, 2, fps=10, **SMALL)).time == 1


def test_a_film_does_not_depend_on_what_was_pictured():
    whole = list(xvrml.load(CAR.encode()).animate(0, 1, fps=4, **SMALL))
    part = list(xvrml.load(CAR.encode()).animate(0.5, 1, fps=4, **SMALL))
    assert len(whole) == 4 and len(part) == 2
    for a, b in zip(whole[2:], part):
        assert np.array_equal(a.array, b.array)


def test_worlds_in_callbacks_are_collected():

    def make():
        world = xvrml.load(CAR.encode())
        body = world["Body"]

        @world.on("Clock.fraction_changed")
        def tick(value, time):
            body.translation = (value, 0, 0)
            return world

        world.time = 1
        return weakref.ref(tick)

    tick = make()
    gc.collect()
    assert tick() is None


# Pictures ---------------------------------------------------------------------------------------


def test_channels_by_default(world):
    image = world.render(**SMALL)
    assert image.channels == ("rgba", "z")
    with pytest.raises(AttributeError, match="error="):
        image.error
    assert world.render(size=(8, 6), error=0.5).error.shape == (6, 8, 3)


def test_progress_is_told_and_may_stop(world):
    told = []
    world.render(size=(400, 300), spp=64, threads=1, progress=told.append)
    assert told == sorted(told) and all(0 <= done <= 1 for done in told)

    class Enough(Exception):
        pass

    def stop(done):
        with pytest.raises(ValueError, match="picture"):
            world["Lamp"].intensity = 0
        with pytest.raises(xvrml.RenderError):
            world.render(**SMALL)
        raise Enough

    with pytest.raises(Enough) as caught:
        world.render(size=(1000, 1000), spp=65536, progress=stop)
    assert caught.value.image.array.shape == (1000, 1000, 4)


def test_progress_as_a_bar(world, capsys):
    world.render(size=(300, 200), spp=64, threads=1, progress=True)
    assert "\n" not in capsys.readouterr().err


def test_ctrl_c_hands_over_what_was_finished(tmp_path):
    (tmp_path / "car.wrl").write_text(CAR)
    code = """
import os, signal, threading, xvrml
w = xvrml.load("car.wrl")
def soon(done, sent=[]):
    if not sent:
        sent.append(os.kill(os.getpid(), signal.SIGINT))
try:
    w.render(size=(1000, 800), spp=65536, progress=soon)
except KeyboardInterrupt as stopped:
    print(stopped.image.shape, stopped.image.stats["transport"])
w["Lamp"].intensity = 0.5
"""
    done = subprocess.run([sys.executable, "-c", code],
                          cwd=tmp_path,
                          capture_output=True,
                          text=True,
                          timeout=120)
    assert done.stdout == "(800, 1000, 4) direct\n", done.stderr


@pytest.mark.parametrize("what", ["render", "load", "cast_rays", "save"])
@pytest.mark.timed
def test_a_thread_goes_on_ticking(world, tmp_path, what):
    big = xvrml.World()
    points = np.random.default_rng(1).normal(size=(100_000, 3))
    big.add(xvrml.Shape(geometry=xvrml.PointSet(coord=xvrml.Coordinate(point=points))))
    text = big.to_vrml().encode()
    caster = world.raycaster()
    rays = np.random.default_rng(2).normal(size=(1_000_000, 6))
    work = {
        "render": lambda: world.render(size=(500, 400), spp=32, threads=1),
        "load": lambda: xvrml.load(text),
        "cast_rays": lambda: caster.cast_rays(rays),
        "save": lambda: big.save(tmp_path / "big.wrl")
    }[what]
    stop, ticks = threading.Event(), []

    def tick():
        while not stop.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.01)

    ticker = threading.Thread(target=tick)
    ticker.start()
    while not ticks:
        time.sleep(0.001)
    begin = time.perf_counter()
    work()
    end = time.perf_counter()
    stop.set()
    ticker.join()
    within = sum(begin < at < end for at in ticks)
    assert within >= (
        end - begin) / 0.01 / 20 - 1, "far fewer ticks than time has passed: the GIL was held"


# Meshes and memory ------------------------------------------------------------------------------


def test_meshes(world):
    (hull,) = world.meshes()
    assert hull.kind == "triangles" and hull.node == world["Hull"] and hull.faces.shape == (
        2, 3) and hull.vertices.dtype == np.float32
    world["Body"].translation = (1, 2, 3)
    placed = world.meshes()[0]
    assert placed.matrix[:3, 3].tolist() == [1, 2, 3] and np.allclose(placed.world_vertices,
                                                                      placed.vertices + [1, 2, 3])
    assert not placed.vertices.flags.writeable
    balls = xvrml.load(
        b"#VRML V2.0 utf8\nDEF S Shape { geometry Sphere { radius 2 } } Transform { scale 2 1 1 children USE S }"
        b" Switch { choice USE S } LOD { range 5 level [ USE S, Group { } ] }")
    cut, exact = balls.meshes(), balls.meshes(spheres=0)
    assert len(cut) == 3 and np.allclose(np.linalg.norm(cut[0].vertices, axis=1), 2, atol=1e-5)
    assert [m.kind for m in exact] == ["sphere"] * 3 and exact[0].radius == 2
    assert np.shares_memory(cut[0].vertices, cut[1].vertices), "one geometry, three places"
    corners = cut[0].vertices[cut[0].faces]
    outward = np.einsum("ij,ij->i",
                        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                        corners[:, 0])
    assert (outward > 0).all(), "faces are seen from outside"


def memory():
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"),
                    reason="memory is asked for as Linux tells it")
def test_a_thousand_worlds_leave_nothing():

    def one():
        world = xvrml.load(CAR.encode())
        crate = world.add(xvrml.Shape(geometry=xvrml.Box()), name="Crate")
        world.on("Clock.fraction_changed", lambda value, time: (world, crate))
        world.time = 1
        view = world["Points"].point
        world["Points"].point = view * 2

    for _ in range(100):
        one()
    gc.collect()
    before = memory()
    for _ in range(1000):
        one()
    gc.collect()
    assert memory() - before < 4 << 20  # 4 KB per world


def test_stubs_name_everything():
    folder = os.path.dirname(xvrml.__file__)
    with open(os.path.join(folder, "nodes.pyi")) as stub:
        text = stub.read()
    for name in xvrml.nodes.__all__:
        if name not in ("Spring", "Counter"):  # classes of the example plug-in, once it is loaded
            assert f"class {name}(Node):" in text
    with open(os.path.join(folder, "__init__.pyi")) as stub:
        text = stub.read()
    for cls in (xvrml.World, xvrml.Picture, xvrml.Mesh, xvrml.Node):
        for name in vars(cls):
            if not name.startswith("_"):
                assert f"def {name}(" in text, f"{cls.__name__}.{name}"
