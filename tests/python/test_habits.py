"""Tests habits of users of other packages: loading, misspelt names, arguments of wrong types,
pickle, films, logs."""
import copy
import io
import pickle
import subprocess
import sys

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

BALL = """#VRML V2.0 utf8
Viewpoint { position 0 0 6 }
DEF Clock TimeSensor { loop TRUE }
DEF Way PositionInterpolator { key [0, 1] keyValue [0 0 0, 1 0 0] }
DEF Ball Transform { children Shape { appearance Appearance { material Material { } } geometry Sphere { } } }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Ball.set_translation
"""
SMALL = dict(size=(32, 24), spp=1)


def test_loads_reads_text_and_bytes():
    for text in (BALL, BALL.encode(), bytearray(BALL.encode())):
        assert xvrml.loads(text)["Ball"].node_type == "Transform"
    with pytest.raises(TypeError, match="load\\(\\) takes files"):
        xvrml.loads(3)
    part = "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n" \
           "endloop\nendfacet\nendsolid part\n"
    assert xvrml.loads(part, path="part.stl").render(fit=True, **SMALL).stats["triangles"] == 1
    with pytest.raises(xvrml.ParseError) as caught:
        xvrml.loads("DXF is not read here", path="part.dxf")
    assert "STL" in str(caught.value) and caught.value.file == "part.dxf"


def test_urls_of_a_text_are_looked_up_beside_its_path(tmp_path):
    (tmp_path / "ball.wrl").write_text(BALL)
    world = xvrml.loads('#VRML V2.0 utf8\nInline { url "ball.wrl" }', path=tmp_path / "main.wrl")
    image = world.render(fit=True, **SMALL)
    assert image.stats["shapes"] == 1 and not world.warnings


@pytest.mark.parametrize("name, near", [("Wrold", "World"), ("sphere", "Sphere"),
                                        ("IndexedFaceset", "IndexedFaceSet"), ("lods", "loads")])
def test_a_name_written_nearly_right(name, near):
    with pytest.raises(AttributeError, match=f"no attribute {name}; did you mean {near}\\?"):
        getattr(xvrml, name)
    assert not hasattr(xvrml, "nothing_like_it")


def test_submodules_are_there_without_an_import_of_their_own():
    code = "import sys, xvrml; assert 'xvrml.rt' not in sys.modules; print(xvrml.%s.__name__, hasattr(xvrml, 'nothing'))"
    for name in ("rt", "interop", "dask", "ray"):
        done = subprocess.run([sys.executable, "-c", code % name], capture_output=True, text=True)
        assert done.stdout == f"xvrml.{name} False\n", done.stderr


def test_a_submodule_whose_package_is_missing_says_so():
    code = "import sys; sys.modules['numpy'] = None; import xvrml; print(hasattr(xvrml, 'rt')); xvrml.rt"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout == "False\n" and "xvrml.rt needs the package numpy, which is not installed" in done.stderr


@pytest.mark.parametrize("call, words", [
    (lambda w: w.render(size="x"),
     "size: (width, height) expected, whole numbers from 1 to 65536, not 'x'"),
    (lambda w: w.render(size=5),
     "size: (width, height) expected, whole numbers from 1 to 65536, not 5"),
    (lambda w: w.render(size=(4, 4), channels=5), "channels: a name or several expected"),
    (lambda w: w.render(size=(4, 4), progress="yes"),
     "progress: True, False, None or a function expected"),
    (lambda w: w.render(size=(4, 4), spp=10**30), "render(): spp: a number nearer to 0 expected"),
    (lambda w: w.render(size=(4, 4), fov=np.zeros(3)), "render(): fov: a number or None expected"),
    (lambda w: w.film("a.gif", "now", 1), "start: a number expected, not the str 'now'"),
    (lambda w: next(w.animate(0, None)), "stop: a number expected, not None"),
    (lambda w: setattr(w, "time", "now"), "World.time: a number expected, not the str 'now'"),
    (lambda w: xvrml.loads(BALL, limits=5), "limits: a dict of names and numbers expected"),
    (lambda w: xvrml.Browser(BALL.encode()).pick(5, (0, 0, 1)),
     "pick(): origin: 3 numbers expected, not the int 5"),
    (lambda w: xvrml.Browser(BALL.encode()).load_url("x.wrl"),
     "load_url(): urls: a list of texts expected, not the str 'x.wrl'"),
    (lambda w: w.raycaster("many"), "meshes(): spheres: a whole number expected"),
    (lambda w: xvrml.rt.Raycaster("all"),
     "Raycaster(): threads: a whole number expected, not the str 'all'"),
    (lambda w: xvrml.rt.Raycaster().add_sphere("here", 1),
     "center: 3 numbers expected, not the str 'here'"),
    (lambda w: xvrml.rt.Context().render(size="x"),
     "render(): size: 2 whole numbers expected, not the str 'x'"),
    (lambda w: xvrml.rt.Context().camera(eye=1, at=(0, 0, 0)),
     "camera(): eye: 3 numbers expected, not the int 1"),
    (lambda w: xvrml.Pinhole(np.eye(3), center="x"), "center: a number expected, not the str 'x'"),
    (lambda w: xvrml.Pinhole(np.eye(3)).rays(2.5, 3),
     "width: a whole number expected, not the float 2.5"),
    (lambda w: w.render(spp="many"),
     "render(): spp: a whole number or None expected, not the str 'many'"),
    (lambda w: w.render(shadows="yes"), "render(): shadows: True or False expected"),
    (lambda w: w.render(sise=(3, 4)), "render(): there is no argument sise; did you mean size?"),
    (lambda w: w.add(3), "add(): node: a Node expected, not the int 3"),
    (lambda w: w.listen(w["Ball"], "translation"), "listen(): callback must be given"),
    (lambda w: w.add_route("Ball", "a", "Ball", "b"),
     "add_route(): from_node: a Node expected, not the str 'Ball'"),
    (lambda w: xvrml.Film("x.gif", fps="fast"),
     "Film(): fps: a number expected, not the str 'fast'"),
    (lambda w: xvrml.load(), "load(): source must be given"),
    (lambda w: setattr(w, "time", "x"), "World.time: a number expected, not the str 'x'"),
    (lambda w: w.on(5), "'NAME.event' or a tuple (node, 'event') expected, not the int 5"),
    (lambda w: w.animate("a", 1), "animate(): start: a number expected, not the str 'a'"),
    (lambda w: w.film("a.gif", 0, 1, fps="a"),
     "film(): fps: a number above 0 expected, not the str 'a'"),
    (lambda w: w.render(progress=3), "progress: True, False, None or a function expected"),
    (lambda w: w.render(channels=5), "channels: a name or several expected"),
    (lambda w: xvrml.Browser(BALL.encode()).pointer_ray(
        (0, 0), (0, 0, 1)), "pointer_ray(): origin: 3 numbers expected, not the tuple (0, 0)"),
    (lambda w: setattr(xvrml.Browser(BALL.encode()), "navigation", 3),
     "Browser.navigation: a text expected, not the int 3"),
])
def test_arguments_of_wrong_types_are_named(call, words):
    with pytest.raises(TypeError) as caught:
        call(xvrml.loads(BALL))
    assert words in str(caught.value) and "incompatible" not in str(caught.value)


@pytest.mark.parametrize("call, words", [
    (lambda w: w.render(size=(1e9, 1)),
     "size: (width, height) expected, whole numbers from 1 to 65536, not (1000000000.0, 1)"),
    (lambda w: w.render(size=(10**30, 1)), "size: (width, height) expected"),
    (lambda w: w.render(size=(4, 4), viewpoint=-10**30), "viewpoint: the world has 1"),
    (lambda w: w.meshes(view="x"), "view: a 4x4 matrix expected"),
    (lambda w: xvrml.loads(BALL, limits={"arrayElements": 10**30}),
     "limits: arrayElements: a whole number of 64 bits expected"),
    (lambda w: xvrml.Pinhole(np.eye(3)).project(
        (1, 2)), "points: numbers of shape (..., 3) expected"),
    (lambda w: xvrml.Pinhole(np.eye(3), center=float("nan")), "center: a finite number expected"),
    (lambda w: xvrml.Browser(BALL.encode(), epoch=1e300),
     "epoch: a number between -1 and 100000000000 was expected, not 1e+300"),
    (lambda w: xvrml.Browser(BALL.encode(), epoch=-1),
     "epoch: a number between -1 and 100000000000 was expected, not -1"),
    (lambda w: setattr(w, "time", float("inf")),
     "time: a number of seconds below 100000000000 expected, not inf"),
])
def test_arguments_of_wrong_values_are_named(call, words):
    with pytest.raises((ValueError, IndexError)) as caught:
        call(xvrml.loads(BALL))
    assert words in str(caught.value)


def test_pictures_are_pickled():
    image = xvrml.loads(BALL).render(channels=("z", "id"), **SMALL)
    for again in (pickle.loads(pickle.dumps(image)), copy.deepcopy(image)):
        assert np.array_equal(again.array, image.array) and np.array_equal(again["z"], image["z"])
        assert again.names == image.names and again.stats == image.stats and again.channels == image.channels
        assert again.nodes == () and len(image.nodes) > 1, "nodes belong to the world"
        again.array[0, 0] = 7
        assert image.array[0, 0, 0] != 7


def test_copies_of_pictures_keep_the_camera():
    world = xvrml.loads(BALL)
    given = xvrml.Pinhole([[30, 1, 12], [0, 40, 11], [0, 0, 1]],
                          np.diag([1.0, -1, -1, 1]),
                          center=0.5)
    for image in (world.render(**SMALL), world.render(camera=given, **SMALL)):
        for again in (pickle.loads(pickle.dumps(image)), copy.copy(image),
                      copy.deepcopy(copy.copy(image))):
            assert np.array_equal(again.camera.K, image.camera.K) and np.array_equal(
                again.camera.T, image.camera.T)
            assert again.camera.center == image.camera.center


def test_damaged_pickles_are_refused():
    image = xvrml.loads(BALL).render(**SMALL)
    version, facts, planes, *rest = image.__getstate__()
    wrong_facts = [(*facts[:place], wrong, *facts[place + 1:])
                   for place, wrong in ((0, 33), (0, -1), (0, "wide"), (4, (99, "agx")), (4, (0, "no curve")),
                                        (4, 0), (6, (1, 2)), (9, 40), (11, "names"), (12, "two\nlines"), (13, 5))]
    damaged = [(99, facts, planes, *rest), (version, facts, planes), (version, 33, planes, *rest),
               (version, facts[:-1], planes, *rest), (version, facts, planes, *rest[:-1], "camera"),
               (version, facts, planes, "never", *rest[1:])]
    damaged += [(version, wrong, planes, *rest) for wrong in wrong_facts]
    damaged += [(version, facts, wrong, *rest)
                for wrong in ({}, {"rgba": np.zeros(3, np.float32)}, {"nothing": np.zeros(3)})]
    for state in damaged:
        with pytest.raises(ValueError):
            xvrml.Picture.__new__(xvrml.Picture).__setstate__(state)


def test_copies_of_pictures_are_saved_with_the_same_bytes(tmp_path):
    board = xvrml.loads(BALL.replace("Viewpoint { position 0 0 6 }", ""))
    ball = xvrml.loads(BALL)
    for name, image in (("clear.png", ball.render(background="none", **SMALL)),
                        ("model.png", board.render(**SMALL)),
                        ("part.exr", ball.render(crop=(4, 3, 9, 8), channels=("z", "id"), **SMALL))):
        image.save(tmp_path / name)
        pickle.loads(pickle.dumps(copy.copy(image))).save(tmp_path / f"again-{name}")
        assert (tmp_path / name).read_bytes() == (tmp_path / f"again-{name}").read_bytes()


def test_worlds_are_pickled(tmp_path):
    (tmp_path / "ball.wrl").write_text(BALL)
    world = xvrml.load(tmp_path / "ball.wrl")
    world["Ball"].translation = (1, 2, 3)
    again = pickle.loads(pickle.dumps(world))
    assert tuple(again["Ball"].translation) == (1, 2, 3) and again.path == world.path
    assert np.array_equal(again.render(**SMALL).array, world.render(**SMALL).array)
    other = copy.deepcopy(world)
    other["Ball"].translation = (0, 0, 0)
    assert tuple(world["Ball"].translation) == (1, 2, 3)
    with pytest.raises(TypeError, match="Browser"):
        pickle.dumps(xvrml.Browser(BALL.encode()))


def test_a_film_of_pictures_and_arrays(tmp_path):
    pil = pytest.importorskip("PIL.Image")
    world = xvrml.loads(BALL)
    world.film(tmp_path / "a.gif", 0, 0.3, fps=10, **SMALL)
    with pil.open(tmp_path / "a.gif") as film:
        assert film.n_frames == 3 and film.size == (32, 24)
    with xvrml.Film(tmp_path / "b.gif", fps=5) as film:
        for level in (0, 255):
            film.add(np.full((10, 20, 3), level, np.uint8))
    with pil.open(tmp_path / "b.gif") as film:
        assert film.n_frames == 2 and film.info["duration"] == 200
        film.seek(1)
        assert film.convert("RGB").getpixel((5, 5)) == (255, 255, 255)


def test_the_ends_of_a_film(tmp_path):
    pil = pytest.importorskip("PIL.Image")
    with pytest.raises(ValueError, match="film\\(\\): stop=0 is before start=1"):
        xvrml.loads(BALL).film(tmp_path / "a.gif", 1, 0, **SMALL)
    with pytest.raises(ValueError, match="animate\\(\\): stop=0 is before start=1"):
        xvrml.loads(BALL).animate(1, 0)
    for wrong in (float("nan"), float("inf")):
        with pytest.raises(ValueError, match="stop: a finite number expected"):
            xvrml.loads(BALL).film(tmp_path / "a.gif", 0, wrong, **SMALL)
    assert not list(tmp_path.iterdir())
    for start, stop in ((0.2, 0.2), (0, 0.001)):
        world = xvrml.loads(BALL)
        world.film(tmp_path / "a.gif", start, stop, fps=10, **SMALL)
        with pil.open(tmp_path / "a.gif") as film:
            assert getattr(film, "n_frames", 1) == 1 and world.time == start
    assert list(xvrml.loads(BALL).animate(1, 1)) == [], "the end is excluded"


def test_films_that_cannot_be(tmp_path):
    with pytest.raises(ValueError, match="mp4, webm, gif"):
        xvrml.Film(tmp_path / "a.avi")
    with pytest.raises(ValueError, match="fps"):
        xvrml.Film(tmp_path / "a.gif", fps=0)
    film = xvrml.Film(tmp_path / "a.gif")
    film.add(np.zeros((10, 20, 3), np.uint8))
    with pytest.raises(ValueError, match="one size"):
        film.add(np.zeros((20, 10, 3), np.uint8))
    with pytest.raises(TypeError, match="uint8"):
        film.add(np.zeros((10, 20, 3), np.float32))
    with pytest.raises(RuntimeError, match="stop"):
        with film:
            raise RuntimeError("stop")
    assert not list(tmp_path.iterdir())
    with pytest.raises(OSError, match="cannot write .*nowhere/a.gif"):
        xvrml.Film(tmp_path / "nowhere/a.gif")


class Clock:

    def __init__(self, monkeypatch):
        self.now = 0.0
        monkeypatch.setattr("xvrml._progress.time.monotonic", lambda: self.now)


def test_progress_in_a_log_is_a_line_every_five_seconds(monkeypatch):
    from xvrml._progress import Bar
    clock, log = Clock(monkeypatch), io.StringIO()
    bar = Bar(log)
    for second in range(12):
        clock.now = second
        bar(second / 20)
    bar.close()
    lines = log.getvalue().splitlines()
    assert lines == ["xvrml: 25 %, 5 s, 15 s left", "xvrml: 50 %, 10 s, 10 s left"]
