"""Tests STEP models: areas, volumes, units, colours, names and instances against closed forms, and
what vv says about them. Open CASCADE wrote the models."""
import gzip
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
    for wrong in (-1, math.nan, math.inf, 1e-30, 1e-7, 1e10):
        with pytest.raises(ValueError, match="step_error"):
            xvrml.load(str(MODELS / "round.step"), step_error=wrong)


def moved(text, offset):
    """Returns a STEP file with another place of its points."""

    def point(match):
        numbers = [float(n) for n in match[2].split(",")]
        if len(numbers) != 3:  # of a curve in a surface
            return match[0]
        return match[1] + ",".join(f"{n + o:.17E}" for n, o in zip(numbers, offset)) + match[3]

    return re.sub(r"(CARTESIAN_POINT\('[^']*',\()([^)]*)(\))", point, text, flags=re.S)


@pytest.mark.parametrize("far", [1e4, 1e7, 1e9])  # mm
@pytest.mark.parametrize("name", ["round.step", "machine.step"])
def test_parts_far_away_keep_their_shape_and_place(tmp_path, name, far):
    offset = np.array([1.0003 * far, .77 * far, -1.1 * far])
    (tmp_path / name).write_text(moved((MODELS / name).read_text(), offset))
    there = xvrml.load(str(tmp_path / name), step_error=.02).meshes()
    here = xvrml.load(str(MODELS / name), step_error=.02).meshes()
    assert len(there) == len(here)
    for a, b in zip(there, here):
        assert abs(sizes_about_middle(a) - sizes_about_middle(b)) < 1e-4
    if name == "round.step":  # its parts have moved, and their places with them
        for a, b in zip(there, here):
            moved_box = box(b) + 2 * np.tile(offset, 2)
            np.testing.assert_allclose(box(a), moved_box, rtol=1e-15, atol=2e-3)


def sizes_about_middle(mesh):
    """Returns the cube root of the volume, which does not depend on the place, in mm."""
    points = np.asarray(mesh.vertices, dtype=float) * 1000
    a, b, c = ((points - points.mean(axis=0))[np.asarray(mesh.faces)[:, i]] for i in range(3))
    return np.cbrt(abs(np.einsum("ij,ij->", a, np.cross(b, c)) / 6))


@pytest.mark.parametrize("number", [
    "1.E999", "1.E+31", "1" + "0" * 400 + ".", "NAN", "-inf", "1.#INF", "-1.#IND", "1.E"
])
def test_numbers_that_are_not_finite_are_refused_at_once(tmp_path, number):
    text = (MODELS / "round.step").read_text()
    point = "CARTESIAN_POINT('',(5.,-1.224646799147E-15,20.))"
    line = text[:text.index(point)].count("\n") + 1
    (tmp_path / "huge.step").write_text(text.replace(point, point.replace("5.", number)))
    with pytest.raises(xvrml.ParseError, match=f"line {line}: a number up to 1e30 was expected"):
        xvrml.load(str(tmp_path / "huge.step"))


def test_words_in_strings_and_comments_are_no_numbers(tmp_path):
    text = (MODELS / "round.step").read_text()
    text = text.replace("DATA;", "DATA;/* (1.E999,NAN) */", 1)
    text = text.replace("CARTESIAN_POINT('',", "CARTESIAN_POINT('it''s (NAN,1.E999)',", 1)
    (tmp_path / "words.step").write_text(text.replace("1.224646799147E-15", "1.2E-999"))
    assert len(xvrml.load(str(tmp_path / "words.step")).meshes()) == 3


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
    for wrong in ("-1", "x", "nan", "1e-30", "0"):
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
