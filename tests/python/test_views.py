"""Tests exposure, view curves, parts of pictures, depth and COCO masks in Python."""
import copy
import json
import pickle

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from exr_tools import read_exr, window  # noqa: E402

SCENE = """#VRML V2.0 utf8
Viewpoint { position 0 0 9 }
DEF Left Transform { translation -2 0 0 children DEF Cube Shape {
  appearance Appearance { material Material { diffuseColor .8 .3 .2 } } geometry Box { size 2 2 2 } } }
Transform { translation 2 0 0 children DEF Ball Shape {
  appearance Appearance { material Material { } } geometry Sphere { radius 1 } } }
"""
SMALL = {"size": (64, 48), "spp": 4}


@pytest.fixture
def world():
    return xvrml.load(SCENE.encode())


# --- exposure and view ---


def test_a_picture_is_shown_with_exposure_and_curve(world):
    plain = world.render(**SMALL)
    assert plain.exposure == 0 and plain.view == "standard"
    bright = world.render(exposure=1, **SMALL)
    assert np.array_equal(bright.array, plain.array), "the light stays"
    linear = plain.array[:, :, :3].astype(float)
    linear[:] = np.clip(2 * linear, 0, 1)
    shown = np.floor(
        np.where(linear <= .0031308, 12.92 * linear, 1.055 * linear**(1 / 2.4) - .055) * 255 + .5)
    assert np.abs(bright.display - shown).max() <= 1
    plain.exposure = 1
    assert np.array_equal(plain.display, bright.display)
    plain.exposure = np.float32(0)
    plain.view = "agx"
    assert np.array_equal(plain.display, world.render(view="agx", **SMALL).display)
    assert not np.array_equal(plain.display, bright.display)


def test_a_fitting_exposure(world, tmp_path):
    image = world.render(exposure="auto", **SMALL)
    assert image.exposure != 0 and image.exposure * 64 == round(image.exposure * 64)
    other = world.render(**SMALL)
    other.exposure = "auto"
    assert other.exposure == image.exposure
    image.save(tmp_path / "x.exr")
    attributes, _ = read_exr((tmp_path / "x.exr").read_bytes())
    assert np.frombuffer(attributes["viewExposure"][1], "<f4")[0] == image.exposure


def test_copies_keep_what_is_shown(world, tmp_path):
    image = world.render(exposure=-1.5,
                         view="filmic",
                         crop=(10, 8, 30, 20),
                         depth_along="ray",
                         **SMALL)
    for again in (copy.copy(image), pickle.loads(pickle.dumps(image))):
        assert again.exposure == -1.5 and again.view == "filmic"
        assert np.array_equal(again.display, image.display)
        assert np.array_equal(again.camera.K, image.camera.K)
        for name, one in (("a", image), ("b", again)):
            one.save(tmp_path / f"{name}.exr")
        assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()
    state = list(image.__getstate__())
    for place, wrong in ((9, 99), (10, "aces"), (10, 3), (11, (5, 5, 0, 0)), (11, (-1, 0, 0, 0)),
                         (11, (64, 48, 40, 8))):
        damaged = [*state[:place], wrong, *state[place + 1:]]
        with pytest.raises(ValueError):
            xvrml.Picture.__new__(xvrml.Picture).__setstate__(tuple(damaged))


@pytest.mark.parametrize("options,words", [
    ({
        "exposure": "bright"
    }, "exposure: 'auto' or a number of stops from -32 to 32 expected"),
    ({
        "exposure": float("nan")
    }, "exposure: "),
    ({
        "exposure": 33
    }, "exposure: "),
    ({
        "exposure": True
    }, "exposure: "),
    ({
        "exposure": None
    }, "exposure: "),
    ({
        "view": "aces"
    }, "view: standard, filmic or agx expected, not 'aces'"),
    ({
        "view": "agx",
        "colour": "vrml97"
    }, "linear light"),
    ({
        "crop": (0, 0, 0, 1)
    }, "crop: .x, y, width, height. within the picture of 64x48"),
    ({
        "crop": (60, 0, 5, 1)
    }, "crop: "),
    ({
        "crop": (0, 0, 2**31 - 1, 1)
    }, "crop: "),
    ({
        "crop": "all"
    }, "crop: "),
    ({
        "crop": (1, 2, 3)
    }, "crop: "),
    ({
        "crop": (1, 1, 4, 4),
        "error": .1
    }, "crop: with a target error"),
    ({
        "crop": (0, 1, 4, 4),
        "channels": "error"
    }, "crop: errors at the border"),
    ({
        "depth_along": "z"
    }, "depth_along: axis or ray"),
])
def test_wrong_arguments_are_named(world, options, words):
    with pytest.raises(ValueError, match=words):
        world.render(**SMALL, **options)


def test_wrong_values_of_properties_are_named(world):
    image = world.render(colour="vrml97", **SMALL)
    image.exposure = 0
    with pytest.raises(ValueError, match="no linear light"):
        image.exposure = 1
    with pytest.raises(ValueError, match="no linear light"):
        image.view = "agx"
    with pytest.raises(ValueError, match="view: "):
        image.view = "nothing"
    assert image.exposure == 0 and image.view == "standard"


# --- parts ---


def test_a_part_has_the_numbers_of_the_whole(world, tmp_path):
    channels = ("z", "position", "normal", "id", "samples")
    whole = world.render(channels=channels, **SMALL)
    part = world.render(channels=channels, crop=(10, 8, 30, 20), **SMALL)
    assert part.shape == (20, 30, 4)
    for name in part.channels:
        assert np.array_equal(part[name], whole[name][8:28, 10:40], equal_nan=True), name
    part.save(tmp_path / "x.exr")
    attributes, _ = read_exr((tmp_path / "x.exr").read_bytes())
    assert window(attributes, "dataWindow") == (10, 8, 30, 20)
    assert window(attributes, "displayWindow") == (0, 0, 64, 48)


@pytest.mark.parametrize("given", [None, xvrml.Pinhole([[60, 0, 20], [0, 70, 30], [0, 0, 1]],
                                                       [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 9]])])
def test_the_camera_of_a_part(world, given):
    """The position in a pixel of the part projects to this pixel."""
    part = world.render(size=(64, 48),
                        spp=1,
                        camera=given,
                        channels=("z", "position"),
                        crop=(8, 14, 30, 20))
    seen = np.isfinite(part["z"])
    assert seen.sum() > 50
    rows, columns = np.nonzero(seen)
    projected = part.camera.project(part["position"][seen])
    assert np.abs(projected[:, 0] - columns).max() < 1e-3
    assert np.abs(projected[:, 1] - rows).max() < 1e-3
    assert np.allclose(projected[:, 2], part["z"][seen], rtol=1e-5)


def test_depth_along_the_ray(world):
    camera = xvrml.Pinhole([[60, 3, 10], [0, 70, 30], [0, 0, 1]],
                           [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 9]])
    options = {"size": (64, 48), "spp": 1, "camera": camera, "channels": ("z", "position")}
    axis, ray = (world.render(depth_along=along, **options) for along in ("axis", "ray"))
    seen = np.isfinite(axis["z"])
    assert seen.sum() > 100 and np.array_equal(seen, np.isfinite(ray["z"]))
    assert np.allclose(axis["z"][seen], 9 - axis["position"][seen][:, 2], rtol=1e-5)
    away = np.linalg.norm(axis["position"][seen] - [0, 0, 9], axis=1)
    assert np.allclose(ray["z"][seen], away, rtol=1e-5)
    assert not np.allclose(ray["z"][seen], axis["z"][seen], rtol=1e-3)


# --- COCO ---


def mask_of(segmentation):
    """Draws runs as COCO defines them: column by column, first those outside."""
    counts, size = segmentation["counts"], segmentation["size"]
    if isinstance(counts, str):
        counts = unpacked(counts)
    flat = np.concatenate([np.full(n, i % 2) for i, n in enumerate(counts)])
    return flat.reshape(size[::-1]).T.astype(bool)


def unpacked(text):
    """The inverse of rleToString of pycocotools."""
    counts, at = [], 0
    while at < len(text):
        value = shift = 0
        while True:
            c = ord(text[at]) - 48
            value |= (c & 31) << shift
            at, shift = at + 1, shift + 5
            if not c & 32:
                value |= -1 << shift if c & 16 else 0
                break
        counts.append(value + (counts[-2] if len(counts) > 2 else 0))
    return counts


def test_mattes_are_shares_of_pixels():
    """A square of 2 at the distance 8, seen at 45 degrees across 48 rows: 7.24 pixels each way."""
    world = xvrml.load(b"""#VRML V2.0 utf8
Viewpoint { position 0 0 9 }
DEF Square Shape { appearance Appearance { material Material { } } geometry Box { size 2 2 2 } }""")
    image = world.render(size=(64, 48), spp=1024, channels="cryptomatte")
    matte = image.matte("Square")
    half = 1 / 8 / np.tan(np.pi / 8) * 24
    assert matte.shape == (48, 64) and matte.dtype == np.float32
    assert matte.sum() == pytest.approx(4 * half * half, abs=.2)
    part = half - int(half)
    assert matte[24, 32 + 7] == pytest.approx(part, abs=.01)
    assert matte[24 - 8, 32 + 7] == pytest.approx(part * part, abs=.01)
    assert matte[24, 32] == 1 and matte[0, 0] == 0
    assert image["cryptomatte"].shape == (48, 64, 16)


def test_files_have_the_hashes_of_the_manifest(world, tmp_path):
    image = world.render(channels="cryptomatte", **SMALL)
    image.save(tmp_path / "x.exr")
    header, planes = read_exr((tmp_path / "x.exr").read_bytes())
    manifest = json.loads(header["cryptomatte/3ae39a5/manifest"][1])
    assert set(manifest) == {"Cube", "Ball"}
    hashes = [planes[f"CryptoObject{n:02}.{c}"].view(np.uint32) for n in range(4) for c in "RB"]
    shares = [planes[f"CryptoObject{n:02}.{c}"] for n in range(4) for c in "GA"]
    for name, digits in manifest.items():
        matte = sum(np.where(h == int(digits, 16), s, 0) for h, s in zip(hashes, shares))
        assert np.array_equal(matte, image.matte(name)) and matte.any()


def test_shapes_of_one_name_have_one_matte():
    """However many they are, and however few pixels they share with whatever else."""
    boxes = "".join(f"Transform {{ translation {i / 20 - .975} 0 0 children Shape {{ "
                    "geometry Box { size .05 2 .1 } } } " for i in range(40))
    world = xvrml.loads("#VRML V2.0 utf8\nViewpoint { position 0 0 5 fieldOfView .3 } "
                        f"DEF Grass Group {{ children [ {boxes} ] }} DEF Wall Transform {{ "
                        "translation 0 0 -1 children Shape { geometry Box { size 9 9 .1 } } }")
    for size in ((1, 1), (4, 4), (16, 16)):
        image = world.render(size=size, spp=64, channels="cryptomatte")
        assert np.allclose(image.matte("Grass"), 1), size
    assert image.names.count("Grass") == 40


def test_mattes_of_a_context_have_numbers():
    """Two triangles that share a square's diagonal, each half of the picture."""
    context = xvrml.rt.Context()
    for name, corner in ((3, (-1, 1, 0)), (7, (1, -1, 0))):
        context.instance(context.mesh([(-1, -1, 0), (1, 1, 0), corner], [(0, 1, 2)], name=name))
    context.camera((0, 0, 5), (0, 0, 0), height=2)
    image = context.render(size=(16, 16), spp=64, channels="cryptomatte")
    for names, share in (((3, ), .5), ((7, ), .5), ((3, 7), 1), ((), 0), ((4, ), 0)):
        assert image.matte(*names).mean() == pytest.approx(share, abs=.01), names
    found = context.render(size=(16, 16), spp=1, channels="id").coco()
    assert [one["name"] for one in found["categories"]] == ["3", "7"]
    assert sum(one["area"] for one in found["annotations"]) == 256
    for name, error in (("3", TypeError), (.5, TypeError), (0, ValueError), (1 << 32, ValueError)):
        with pytest.raises(error, match="matte: a name of a Context"):
            image.matte(name)


def test_mattes_of_several_shapes_add_up(world):
    image = world.render(channels=("id", "cryptomatte"), **SMALL)
    ball, cube = image.matte("Ball"), image.matte("Cube")
    assert ball.any() and cube.any()
    assert np.array_equal(image.matte("Ball", "Cube", "Ball"), ball + cube)
    assert not image.matte().any()
    assert np.array_equal(pickle.loads(pickle.dumps(image)).matte("Ball"), ball)
    with pytest.raises(KeyError, match="Bal.*Ball, Cube"):
        image.matte("Bal")
    with pytest.raises(KeyError, match="there is none"):
        xvrml.loads("#VRML V2.0 utf8").render(channels="cryptomatte", **SMALL).matte("Ball")
    with pytest.raises(TypeError, match="matte"):
        image.matte(3)
    with pytest.raises(AttributeError, match="channel cryptomatte"):
        world.render(**SMALL).matte("Ball")


@pytest.mark.parametrize("compressed", [False, True])
def test_annotations_are_the_shapes(world, compressed):
    image = world.render(channels="id", **SMALL)
    found = image.coco(image_id=7, file_name="x.png", compressed=compressed)
    assert found["images"] == [{"id": 7, "width": 64, "height": 48, "file_name": "x.png"}]
    names = {c["id"]: c["name"] for c in found["categories"]}
    assert set(names.values()) == {"Cube", "Ball"}
    assert [one["id"] for one in found["annotations"]] == [1, 2]
    for one in found["annotations"]:
        name = names[one["category_id"]]
        mask = image["id"] == image.names.index(name)
        assert np.array_equal(mask_of(one["segmentation"]), mask)
        assert one["area"] == mask.sum() > 50 and one["image_id"] == 7 and one["iscrowd"] == 0
        x, y, w, h = one["bbox"]
        assert mask[y:y + h, x:x + w].sum() == mask.sum()
        assert mask[y].any() and mask[y + h - 1].any()
        assert mask[:, x].any() and mask[:, x + w - 1].any()


def test_the_box_of_a_square_is_known():
    """A square of 2 at the distance 9 - 1 = 8, seen at 45 degrees across 48 rows."""
    world = xvrml.load(b"""#VRML V2.0 utf8
Viewpoint { position 0 0 9 }
DEF Square Shape { appearance Appearance { material Material { } } geometry Box { size 2 2 2 } }""")
    one, = world.render(size=(64, 48), spp=1, channels="id").coco()["annotations"]
    half = 1 / 8 / np.tan(np.pi / 8) * 24  # in pixels
    assert half == pytest.approx(7.24, abs=.01)
    assert one["bbox"] == [32 - 7, 24 - 7, 14, 14] and one["area"] == 14 * 14
    outside = (32 - 7) * 48 + (24 - 7)
    assert one["segmentation"]["counts"] == [outside, 14, *[34, 14] * 13, 64 * 48 - outside - 14 - 48 * 13]


def test_runs_may_begin_inside():
    world = xvrml.load(b"""#VRML V2.0 utf8
Viewpoint { position 0 0 9 }
DEF Wall Shape { appearance Appearance { material Material { } } geometry Box { size 90 90 1 } }""")
    for compressed in (False, True):
        one, = world.render(size=(8, 6), spp=1,
                            channels="id").coco(compressed=compressed)["annotations"]
        assert one["area"] == 48 and one["bbox"] == [0, 0, 8, 6]
        assert mask_of(one["segmentation"]).all()


def test_packed_runs_are_those_of_pycocotools():
    """The text of the runs 6 1 40 4 5 4 5 4 21 is in the documentation of COCO's API."""
    from xvrml._masks import _packed
    for counts in ([6, 1, 40, 4, 5, 4, 5, 4, 21], [0, 5], [100000, 1, 2, 99999, 3], [0, 0, 7, 0, 7]):
        assert unpacked(_packed(counts)) == counts
    assert _packed([6, 1, 40, 4, 5, 4, 5, 4, 21]) == "61X13mN000`0"


def test_categories(world):
    image = world.render(channels="id", **SMALL)
    for categories in ({
            "Nothing": "none",
            "Ball": "toy"
    }, lambda name: "toy" if name == "Ball" else None):
        found = image.coco(categories=categories, first_id=30)
        one, = found["annotations"]
        assert {c["id"]: c["name"] for c in found["categories"]}[one["category_id"]] == "toy"
        assert one["id"] == 30
    assert [c["name"] for c in image.coco(categories={"Nothing": "none"})["categories"]] == ["none"]


def test_wrong_arguments_of_coco(world):
    image = world.render(channels="id", **SMALL)
    for options in ({"image_id": "x"}, {"file_name": 3}, {"categories": 3}, {
            "categories": lambda name: 3
    }):
        with pytest.raises(TypeError, match=next(iter(options))):
            image.coco(**options)
    with pytest.raises(ValueError, match="first_id"):
        image.coco(first_id=-1)
    with pytest.raises(AttributeError, match="channel id"):
        world.render(**SMALL).coco()
