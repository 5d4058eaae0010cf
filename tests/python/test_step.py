"""Tests STEP models: areas, volumes, units, colours, names and instances against closed forms, and
what vv says about them. Open CASCADE wrote the models."""
import gzip
import itertools
import math
import re
import shutil

import numpy as np
import pytest
from conftest import ROOT, SMALL

import xvrml

MODELS = ROOT / "tests/unit/models"
pytestmark = pytest.mark.skipif(not xvrml.features()["step"].available,
                                reason="built without Open CASCADE")


def sizes(mesh):
    """Returns area and volume of a mesh, in mm2 and mm3."""
    points = np.asarray(mesh.world_vertices, dtype=float) * 1000
    a, b, c = (points[np.asarray(mesh.faces)[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return area, np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def box(mesh):
    points = np.asarray(mesh.world_vertices, dtype=float) * 1000
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


# area and volume of the parts of round.step, in mm
ROUND = ((2 * math.pi * 5 * 20 + 2 * math.pi * 5**2, math.pi * 5**2 * 20),
         (math.pi * 6 * (6 + math.hypot(6, 12)), math.pi * 6**2 * 12 / 3),
         (4 * math.pi**2 * 10 * 3, 2 * math.pi**2 * 10 * 3**2))


@pytest.mark.parametrize("error", [.2, .02, .004])
def test_surfaces_are_as_near_as_asked(error):
    meshes = xvrml.load(str(MODELS / "round.step"), step_error=error).meshes()
    assert len(meshes) == 3
    for mesh, (area, volume) in zip(meshes, ROUND):
        got_area, got_volume = sizes(mesh)
        # Between the surface and its triangles lies at most its area times the error.
        assert abs(got_volume - volume) <= area * error * 1.05
        assert abs(got_area - area) <= .02 * area
    points = np.asarray(meshes[2].world_vertices, dtype=float) * 1000
    faces = np.asarray(meshes[2].faces)
    middles = points[faces].mean(axis=1)
    away = np.abs(3 - np.hypot(np.hypot(middles[:, 0], middles[:, 1]) - 10, middles[:, 2]))
    assert away.max() < error, away.max()


def test_a_smaller_error_makes_more_triangles():
    count = lambda error: sum(
        len(m.faces) for m in xvrml.load(str(MODELS / "round.step"), step_error=error).meshes())
    assert count(.2) < count(.02) < count(.004)
    assert count(0) == count(0)
    for wrong in (-1, math.nan, math.inf, 1e-30, 1e300):
        with pytest.raises(ValueError, match="step_error"):
            xvrml.load(str(MODELS / "round.step"), step_error=wrong)


def test_normals_are_those_of_the_surface():
    mesh = xvrml.load(str(MODELS / "inch.step")).meshes()[0]
    points = np.asarray(mesh.vertices, dtype=float)
    faces = np.asarray(mesh.faces)
    normals = np.asarray(mesh.normals, dtype=float)
    assert len(normals) == len(points)
    out = points / np.linalg.norm(points, axis=1)[:, None]
    used = np.unique(faces)
    assert np.einsum("ij,ij->i", normals, out)[used].min() > .9


def test_inches_become_metres():
    mesh, = xvrml.load(str(MODELS / "inch.step")).meshes()
    np.testing.assert_allclose(box(mesh), np.repeat([-25.4, 25.4], 3), atol=.1)
    area, volume = sizes(mesh)
    assert abs(area - 4 * math.pi * 25.4**2) < .004 * area
    assert abs(volume - 4 / 3 * math.pi * 25.4**3) < .007 * volume


def test_an_assembly_keeps_places_names_colours_and_instances():
    world = xvrml.load(str(MODELS / "machine.step"))
    assert not world.warnings
    text = world.to_vrml()
    for name in ("Machine", "base", "left", "right_block", "green_pin", "plain_pin", "Block", "Pin"):
        assert f"DEF {name} " in text, name
    assert "USE Block" in text, "both blocks are one mesh"
    places = sorted(np.round(box(m), 2).tolist() for m in world.meshes())
    red, blue = [0, 0, 5, 0, 20, 35], [0, 0, 5, 10, 20, 35]
    for expected in (red, blue, [30, 0, 5, 50, 0, 35], [30, 0, 5, 50, 10, 35]):
        assert any(np.allclose(expected, p, atol=.02) for p in places), (expected, places)
    pins = [p for p in places if p[1] > 40]
    np.testing.assert_allclose(pins, [[-5, 45, 0, 5, 55, 20], [-5, 75, 0, 5, 85, 20]], atol=.05)
    colours = {
        tuple(round(float(c), 3) for c in m.appearance.material.diffuseColor):
        round(float(m.appearance.material.transparency), 3)
        for m in (mesh.node for mesh in world.meshes())
    }
    assert colours == {(1, 0, 0): .5, (.2, .4, .6): 0, (0, 1, 0): 0, (.8, .8, .8): 0}
    volume = sum(sizes(m)[1] for m in world.meshes())
    assert abs(volume - (2 * 6000 + 2 * math.pi * 25 * 20)) < .005 * volume


def test_each_reading_gives_the_same_bytes():
    texts = {xvrml.load(str(MODELS / "machine.step")).to_vrml() for _ in range(4)}
    assert len(texts) == 1


@pytest.fixture
def models(vv):
    for path in MODELS.iterdir():
        shutil.copy(path, vv.folder)
    return vv


def test_vv_draws_describes_and_converts(models):
    info = models("machine.step", "--info")
    assert info.returncode == 0 and "STEP, read as X3D 4.0" in info.text, info.text
    assert "z: it is a STEP model" in info.text
    assert models("machine.step", "-o", "ppm:-", *SMALL).returncode == 0
    models.write("packed.stpZ", gzip.compress((MODELS / "machine.step").read_bytes()))
    plain = models("machine.step", "-o", "ppm:-", *SMALL).stdout
    assert models("packed.stpZ", "-o", "ppm:-", *SMALL).stdout == plain
    assert models("machine.step", "--write", "machine.glb").returncode == 0
    again = xvrml.load(str(models.folder / "machine.glb"))
    high = np.max([box(m) for m in again.meshes()], axis=0)
    assert len(again.meshes()) == 6 and abs(high[4] - 35) < .01, "y is up in glTF"
    coarse = models("round.step", "--info", "--json", "--step-error", "1").text
    assert coarse != models("round.step", "--info", "--json", "--step-error", ".01").text
    for wrong in ("-1", "x", "nan", "1e-30"):
        assert models("round.step", "--info", "--step-error", wrong).returncode == 2


def test_a_bad_file_is_one_message(models):
    whole = (MODELS / "machine.step").read_bytes()
    models.write("half.step", whole[:len(whole) // 2])
    done = models("half.step", "-o", "half.png", *SMALL)
    assert done.returncode == 3 and done.talk.count("\n") == 1, done.talk
    assert "half.step: error: this STEP model cannot be read: Line " in done.talk
    models.write("many.wrl", "#VRML V2.0 utf8\n" + 'Inline { url "half.step" }\n' * 2 +
                 'Inline { url "machine.step" }\n')
    done = models("many.wrl", "--check")
    assert done.talk.count("Inline is empty: ") == 2 and "itself" not in done.talk, done.talk


def test_without_the_program_it_says_what_is_missing(models):
    done = models("inch.step", "-o", "x.png", *SMALL,
                  env={"XVRML_STEP_READER": "/nonexistent/xvrml-step-reader"})
    assert done.returncode == 3 and "libocct-data-exchange-dev" in done.talk, done.talk


def moved(text, by, chosen):
    """Returns a STEP file in which points in space are moved, if chosen() takes their number."""
    point = r"(?<=CARTESIAN_POINT\('',\()([^,()]+),([^,()]+),([^,()]+)(?=\)\))"
    numbers = itertools.count()
    there = lambda m: ",".join(f"{float(n) + b:.17E}" for n, b in zip(m.groups(), by))
    return re.sub(point, lambda m: there(m) if chosen(next(numbers)) else m[0], text)


def local_sizes(mesh):
    points = np.asarray(mesh.vertices, dtype=float) * 1000
    a, b, c = (points[np.asarray(mesh.faces)[:, i]] for i in range(3))
    return (np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2, abs(
        np.einsum("ij,ij->", a, np.cross(b, c)) / 6), np.ptp(points, axis=0))


@pytest.mark.parametrize("by", [(1e7, 0, 0), (0, -1e9, 3e8), (1e12, 1e12, 1e12)])
def test_a_part_far_away_keeps_its_shape(tmp_path, by):
    near = xvrml.load(str(MODELS / "inch.step"))
    inches = [b / 25.4 for b in by]
    # The first point is that of the frame to which all others belong.
    text = moved((MODELS / "inch.step").read_text(), inches, lambda i: i > 0)
    (tmp_path / "far.step").write_text(text)
    world = xvrml.load(str(tmp_path / "far.step"))
    expected, = map(local_sizes, near.meshes())
    got, = map(local_sizes, world.meshes())
    # The double precision of the file itself has steps of 1e-4 mm at 1e12 mm.
    for one, other in zip(got, expected):
        np.testing.assert_allclose(one, other, rtol=1e-4)
    middle = box(world.meshes()[0]).reshape(2, 3).mean(axis=0)
    np.testing.assert_allclose(middle, by, rtol=2e-7, atol=.1)
    said, = (w.message for w in world.warnings)
    assert "metres away from the origin" in said and "the model's size is 0.0879" in said, said
    assert not near.warnings


def test_parts_of_an_assembly_far_away_keep_their_places_to_each_other(tmp_path):
    text = (MODELS / "machine.step").read_text()
    (tmp_path / "far.step").write_text(moved(text, (0, 2e9, 0), lambda i: i in (1, 2, 3)))
    near, far = xvrml.load(str(MODELS / "machine.step")), xvrml.load(str(tmp_path / "far.step"))
    assert len(near.warnings) == 0 and len(far.warnings) == 1
    for one, other in zip(near.meshes(), far.meshes()):
        np.testing.assert_allclose(local_sizes(one)[2], local_sizes(other)[2], rtol=1e-5)
    # Under the node that carries the whole, all places are as small as those of the near model.
    places = [[float(n) for n in t] for t in re.findall(r"translation (\S+) (\S+) (\S+)", far.to_vrml())]
    assert sorted(max(map(abs, p)) for p in places)[-2] < 1, places


@pytest.mark.parametrize(
    "number", ["1.E400", "-2.5E+999", "1" * 400 + ".", "NAN", "-nan", "INF", "-Infinity", "1.#INF"])
def test_a_number_out_of_range_is_named_with_its_line(models, number):
    text = (MODELS / "round.step").read_text()
    middle = text.index("CARTESIAN_POINT('',(", len(text) // 2) + len("CARTESIAN_POINT('',(")
    end = text.index(",", middle)
    models.write("wide.step", (text[:middle] + number + text[end:]).encode())
    done = models("wide.step", "--info")
    line = text[:middle].count("\n") + 1
    assert done.returncode == 3 and done.talk.count("\n") == 1, done.talk
    assert f"Line {line}: the number {number.strip('-')[:40]}" in done.talk, done.talk
    assert "out of range" in done.talk
    named = text.replace("FILE_NAME('", "FILE_NAME('it''s (NAN,1.E400 /* 2.E999 ", 1)
    named = named.replace("DATA;", "/* (inf, 1.E400 ' */ DATA;", 1)
    models.write("named.step", named.encode())
    assert models("named.step", "--info").returncode == 0, "names and comments hold no numbers"
