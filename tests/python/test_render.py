"""Tests that Python renders worlds: pictures, channels, options, threads, interruption."""
import os
import signal
import subprocess
import sys
import threading
import time

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")


def test_render_by_transport(box):
    world = xvrml.load(box)
    assert world.render(size=(8, 6), spp=1).stats["transport"] == "direct"
    for transport in ("direct", "whitted", "path"):
        stats = world.render(size=(8, 6), spp=1, transport=transport, clamp=2).stats
        assert stats["transport"] == transport and stats["transport_reason"]
        assert set(stats["left_out"]) == {
            "cut_by_depth", "cut_by_energy", "clipped", "unreached_lights", "shader_faults",
            "wrong_hits", "rejected_rays"
        }  # fmt: skip
        assert stats["transport_leaves_out"] == ([] if transport == "path" else ["interreflection"])
    stats = world.render(size=(8, 6), spp=32, channels=["rgba", "error"]).stats
    assert stats["error_mean"] >= 0 and stats["error_mean_interval"] >= 0
    for wrong in ({
            "transport": "paths"
    }, {
            "error": 2
    }, {
            "time_limit": -1
    }, {
            "clamp": float("nan")
    }):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            world.render(size=(8, 6), **wrong)


def test_render(box):
    w = xvrml.load(box)
    p = w.render(size=(40, 30), spp=2)
    assert p.shape == (30, 40, 4) and p.array.shape == p.shape and p.array.dtype == np.float32
    assert np.asarray(p).shape == p.shape and np.array(p, dtype=np.float64).dtype == np.float64
    assert p[15, 20].tolist() == p.array[15, 20].tolist()
    assert p.array[15, 20, 0] > 3 * p.array[15, 20, 1] > 0, "a red box in the middle"
    assert not p.array[0, 0, :3].any(), "nothing in the corner"
    assert p.channels == (
        "rgba", "z") and p.stats["camera_rays"] == 40 * 30 * 2 and p.stats["triangles"] == 12
    assert p.display.shape == (30, 40, 3) and p.display.dtype == np.uint8
    with pytest.raises(KeyError, match="rgba"):
        p["normal"]


def test_channels(box):
    w = xvrml.load(box)
    p = w.render(size=(40, 30),
                 spp=1,
                 channels=("z", "normal", "albedo", "position", "id", "samples"),
                 colour="vrml97")
    assert p["z"][15, 20] == pytest.approx(4, abs=1e-4) and np.isinf(p["z"][0, 0])
    assert p["normal"][15, 20] == pytest.approx([0, 0, 1], abs=1e-5)
    assert p["albedo"][15, 20] == pytest.approx([0.8, 0.2, 0.1], abs=1e-5)
    assert p["position"][15, 20, 2] == pytest.approx(1, abs=1e-4)
    assert p["samples"].min() == p["samples"].max() == 1
    assert p["id"][0, 0] == 0 and p.names[p["id"][15, 20]] in ("Thing", "Cube", "Place")
    assert w.render(size=(4, 3), spp=1, channels="z")["z"].shape == (3, 4)


def test_a_shape_in_place_of_another_is_new():
    """It has not moved from there."""
    shape = "Transform { translation %d 0 0 children Shape { geometry Box { } } }"
    world = xvrml.loads("#VRML V2.0 utf8\nViewpoint { position 0 0 9 } DEF G Group { children " +
                        shape % 2 + " }")
    frames = world.animate(0, 0.3, fps=10, size=(16, 12), spp=1, channels=("id", "motion"))
    for i, frame in enumerate(frames):
        hit = frame["id"] != 0
        assert hit.any() and np.isnan(frame["motion"][hit]).all() == (i < 2), i
        if i == 0:
            world["G"].children = []
            world.add(xvrml.Transform(translation=(-2, 0, 0), children=[xvrml.Shape(geometry=xvrml.Box())]))


def test_motion():
    world = xvrml.loads("""#VRML V2.0 utf8
        Viewpoint { position 0 0 8 }
        DEF Clock TimeSensor { cycleInterval 100 loop TRUE }
        DEF Way PositionInterpolator { key [ 0 1 ] keyValue [ 0 0 0, 100 50 0 ] }
        DEF Car Transform { children Shape { geometry Box { } } }
        ROUTE Clock.fraction_changed TO Way.set_fraction
        ROUTE Way.value_changed TO Car.set_translation""")
    frames = list(world.animate(0, 0.3, fps=10, size=(16, 12), spp=1, channels=("id", "motion")))
    for number, frame in enumerate(frames):
        hit, motion = frame["id"] != 0, frame["motion"]
        assert hit.any() and not motion[~hit].any()
        if number == 0:
            assert np.isnan(motion[hit]).all(), "everything is new"
        else:
            assert motion[hit] == pytest.approx(np.tile([0.1, 0.05, 0], (hit.sum(), 1)), abs=1e-4)
    assert len(frames) == 3


def test_images_in_mirrors_are_followed():
    world = xvrml.loads("""#VRML V2.0 utf8
        Viewpoint { position 0 0 5 }
        Shape { appearance ORTAppearance { shader ORTShader { name "Mirror" } }
                geometry IndexedFaceSet { coordIndex [ 0 1 2 3 -1 ]
                    coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } } }
        Transform { translation 0 0 9
                    children DEF Wall Shape { geometry Box { size 90 90 2 } } }""")
    options = {"size": (9, 9), "spp": 1, "channels": ("z", "id")}
    seen = world.render(follow_images=True, **options)
    assert seen["z"][4, 4] == pytest.approx(5 + 8, abs=1e-3)
    assert seen.names[seen["id"][4, 4]] == "Wall"
    assert world.render(**options)["z"][4, 4] == pytest.approx(5, abs=1e-3)


def test_changes_show(box):
    w = xvrml.load(box)
    before = w.render(size=(40, 30), spp=1).array
    w["Paint"].diffuseColor = (0, 0, 1)
    blue = w.render(size=(40, 30), spp=1).array
    assert blue[15, 20, 2] > blue[15, 20, 0] == 0
    w["Place"].translation = (100, 0, 0)
    assert not w.render(size=(40, 30), spp=1).array[..., :3].any()
    w["Place"].translation = (0, 0, 0)
    w["Paint"].diffuseColor = (0.8, 0.2, 0.1)
    assert np.array_equal(w.render(size=(40, 30), spp=1).array, before)
    w["Cube"].size = (0.2, 0.2, 0.2)
    assert 0 < (w.render(size=(40, 30), spp=1).array[..., 0]
                > 0).sum() < (before[..., 0] > 0).sum() / 20
    w["Place"].children = []
    assert not w.render(size=(40, 30), spp=1).array[..., :3].any()


def test_views(box):
    w = xvrml.load(box)
    assert [(v.name, v.description) for v in w.viewpoints] == [("", "front"),
                                                               ("Back", "from behind")]
    assert w.viewpoints[0].matrix.shape == (4, 4)
    z = lambda **more: w.render(size=(8, 6), spp=1, channels="position", **more)["position"][3, 4, 2
                                                                                            ]
    assert z() == pytest.approx(1, abs=1e-4) and z(viewpoint=0) == z(viewpoint="front") == z()
    assert z(viewpoint="Back") == z(viewpoint=1) == z(viewpoint=-1) == pytest.approx(-1, abs=1e-4)
    assert z(camera=((0, 0, -9), (0, 0, 0))) == pytest.approx(-1, abs=1e-4)
    assert z(camera=[(0, 0, 9), (0, 0, 0), (1, 0, 0)]) == pytest.approx(1, abs=1e-4)
    assert z(fit=True) == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize("wrong, error", [
    ({
        "size": (0, 5)
    }, ValueError),
    ({
        "size": (5,)
    }, ValueError),
    ({
        "size": (65536, 65536)
    }, ValueError),
    ({
        "size": "big"
    }, Exception),
    ({
        "spp": 0
    }, ValueError),
    ({
        "spp": 2.5
    }, TypeError),
    ({
        "seed": -1
    }, ValueError),
    ({
        "depth": -1
    }, ValueError),
    ({
        "threads": -1
    }, ValueError),
    ({
        "viewpoint": "Bck"
    }, KeyError),
    ({
        "viewpoint": 2
    }, IndexError),
    ({
        "viewpoint": 1.5
    }, TypeError),
    ({
        "colour": "srgb"
    }, ValueError),
    ({
        "headlight": "dim"
    }, ValueError),
    ({
        "channels": ("depth",)
    }, ValueError),
    ({
        "camera": (1, 2)
    }, ValueError),
    ({
        "camera": ((0, 0, 0), (0, 0, 0))
    }, ValueError),
    ({
        "fit": True,
        "viewpoint": 0
    }, ValueError),
    ({
        "fov": 0
    }, ValueError),
    ({
        "nonsense": 1
    }, TypeError),
])
def test_wrong_options(box, wrong, error):
    with pytest.raises(error):
        xvrml.load(box).render(**wrong)


def test_headlight(box):
    w = xvrml.load(box)
    r = lambda value: w.render(size=(8, 6), spp=1, headlight=value).array[..., :3].any()
    assert r(True) and r("on") and r("auto") and not r(False) and not r("off")


def test_same_bytes_as_vv(box, vv):
    assert vv("box.wrl", "-o", "vv.exr", "--size", "40x30", "--spp", "3", "--threads",
              "1").returncode == 0
    w = xvrml.load(box)
    pictures = [w.render(size=(40, 30), spp=3, threads=t, channels="rgba") for t in (1, 2)]
    assert np.array_equal(pictures[0].array, pictures[1].array)
    pictures[0].save(vv.folder / "python.exr")
    assert (vv.folder / "python.exr").read_bytes() == (vv.folder / "vv.exr").read_bytes()


def test_shapes_without_facets(vv):
    """exact_shapes is the option of vv: the same bytes, and another picture than without."""
    path = vv.folder / "can.wrl"
    path.write_text("""#VRML V2.0 utf8
Shape { geometry Cylinder { } appearance DEF A Appearance { material Material { } } }
Transform { translation 3 0 0 children Shape { geometry Cone { } appearance USE A } }
ORTSensor { position 0 5 0 }""")
    world = xvrml.load(path)
    options = {"size": (64, 48), "spp": 1}
    facets = world.render(**options)
    exact = world.render(exact_shapes=True, **options)
    assert facets.stats["triangles"] > 0 and exact.stats["triangles"] == 0
    assert (facets.array != exact.array).any()
    assert (world.render(**options).array == facets.array).all(), "it holds for one picture"
    exact.save(path.with_suffix(".png"))
    done = vv("can.wrl", "-o", "vv.png", "--exact-shapes", "--size", "64x48", "--spp", "1")
    assert done.returncode == 0, done.talk
    image = pytest.importorskip("PIL.Image")
    with image.open(vv.folder / "vv.png") as a, image.open(path.with_suffix(".png")) as b:
        assert a.tobytes() == b.tobytes()
    assert len(world.measure(spp=1, exact_shapes=True)) == 1
    with pytest.raises(TypeError, match="exact_shapes"):
        world.render(exact_shapes="yes")


def test_instruction_sets(box):
    w = xvrml.load(box)
    size = {"size": (40, 30), "spp": 8, "transport": "path"}
    with pytest.raises(ValueError,
                       match="isa: expected auto, or one that this machine has: ") as no:
        w.render(isa="mmx", **size)
    known = str(no.value).split("has: ")[1].split(", not")[0].split(", ")
    automatic = w.render(**size).array
    for isa in known:
        one = w.render(isa=isa, threads=1, **size).array
        assert np.array_equal(one, w.render(isa=isa, threads=2, **size).array), isa
        assert np.abs(one - automatic).mean() < 0.01, isa
    assert np.array_equal(w.render(isa=known[0], **size).array, automatic)


def test_save(box, tmp_path):
    p = xvrml.load(box).render(size=(16, 12), spp=1)
    for name, start in (("a.png", b"\x89PNG"), ("a.jpg", b"\xff\xd8"),
                        ("a.exr", b"\x76\x2f\x31\x01"), ("a.ppm", b"P6"), ("a.pfm", b"PF"),
                        ("a.hdr", b"#?RADIANCE")):
        p.save(tmp_path / name)
        assert (tmp_path / name).read_bytes().startswith(start)
    assert p._repr_png_() == (tmp_path / "a.png").read_bytes()
    with pytest.raises(ValueError, match="suffix"):
        p.save(tmp_path / "a.bmp")
    with pytest.raises(OSError):
        p.save(tmp_path / "no/such/a.png")


def test_a_picture_outlives_its_object(box):
    array = xvrml.load(box).render(size=(16, 12), spp=1).array
    assert array[6, 8, 0] > 0


def test_other_threads_run_meanwhile(box):
    w = xvrml.load(box)
    counted, stop = [0], threading.Event()

    def count():
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    w.render(size=(400, 300), spp=16, threads=1)
    stop.set()
    counter.join()
    assert counted[0] > 3


def test_changes_wait_for_the_picture(box):
    w = xvrml.load(box)
    expected = w.render(size=(200, 150), spp=16).array
    pictures = []
    worker = threading.Thread(
        target=lambda: pictures.append(w.render(size=(200, 150), spp=16).array))
    worker.start()
    for i in range(200):
        w["Place"].translation = (0, 0, 0)
    worker.join()
    assert np.array_equal(pictures[0], expected)


def test_keyboard_interrupt(box):
    code = f"""
import os, signal, threading, time, xvrml
w = xvrml.load({str(box)!r})
threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    w.render(size=(2000, 2000), spp=65536)
except KeyboardInterrupt:
    print("interrupted", w.render(size=(4, 3), spp=1).shape)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.stdout == "interrupted (3, 4, 4)\n", done.stderr
