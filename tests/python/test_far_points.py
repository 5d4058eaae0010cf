"""Meshes whose points are far from the origin lose digits of single precision: one message says so."""
import pytest

import xvrml

CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def text_of(kind, by):
    points = [f"{x + by!r} {y!r} {z!r}" for x, y, z in CORNERS]
    if kind == "stl":
        facet = lambda f: "facet normal 0 0 0 outer loop " + " ".join(
            f"vertex {points[i]}" for i in f) + " endloop endfacet"
        halves = ("\n".join(map(facet, FACES[:2])), "\n".join(map(facet, FACES[2:])))
        return "".join(f"solid {n}\n{half}\nendsolid {n}\n" for n, half in zip("ab", halves))
    if kind == "obj":
        return "".join(f"v {p}\n" for p in points) + "".join(
            "o part\nf " + " ".join(str(i + 1) for i in f) + "\n" for f in FACES)
    rows = "\n".join(points) + "\n" + "\n".join("3 " + " ".join(map(str, f)) for f in FACES) + "\n"
    if kind == "off":
        return "OFF\n4 4 0\n" + rows
    return ("ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
            "property double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n" +
            rows)


@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "off"])
@pytest.mark.parametrize("away, told", [(0, False), (1000, False), (5000, True), (4e6, True)])
def test_points_far_away_are_one_warning(tmp_path, kind, away, told):
    file = tmp_path / f"far.{kind}"
    file.write_text(text_of(kind, away))
    said = [w.message for w in xvrml.load(str(file)).warnings]
    far = [s for s in said if "away from the origin" in s]
    assert len(far) == told, said
    if away == 4e6:
        assert "points are 4e+06 units away from the origin, where single precision has steps of " \
               "0.25 units; the model's size is 1.73" in far[0]
