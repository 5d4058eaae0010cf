"""Tests that figures of H-Anim bend their skin where it is seen: in pictures of worlds that run and
that do not, in exports, and after a world was written (ISO/IEC 19775-1 26)."""
import json

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

# A red square between 1 and 2 on the x axis, which the joint at 1 0 0 turns.
FIGURE = """#X3D V4.0 utf8
PROFILE Immersive
COMPONENT HAnim:1
Viewpoint { position 0 0 10 fieldOfView 0.4 }
NavigationInfo { headlight FALSE }
HAnimHumanoid {
  skinCoord DEF C Coordinate { point [ 1 -0.5 0, 2 -0.5 0, 2 0.5 0, 1 0.5 0 ] }
  skeleton DEF Root HAnimJoint { children DEF J HAnimJoint {
    center 1 0 0 rotation 0 0 1 %s skinCoordIndex [ 0 1 2 3 ] skinCoordWeight [ 1 1 1 1 ] } }
  joints [ USE Root USE J ]
  skin Shape {
    appearance Appearance { material Material { emissiveColor 1 0 0 diffuseColor 0 0 0 } }
    geometry IndexedFaceSet { coord USE C solid FALSE coordIndex [ 0 1 2 3 -1 ] }
  }
}
"""
QUARTER = 1.5707963


def middle_of_red(world):
    picture = world.render(size=(64, 64), spp=4)
    rows, columns = np.nonzero(picture.display[..., 0] > 128)
    assert len(rows) > 20, "nothing is drawn"
    # 4.05 units are seen at a distance of 10.
    return (columns.mean() - 31.5) / 64 * 4.054, (31.5 - rows.mean()) / 64 * 4.054


def near(x, y):
    return pytest.approx((x, y), abs=0.08)


def test_a_skin_is_bent_in_every_encoding():
    classic = xvrml.loads((FIGURE % QUARTER).encode())
    assert not classic.warnings
    for world in (classic, xvrml.loads(classic.to_x3d(encoding="xml").encode())):
        assert middle_of_red(world) == near(1, 0.5)


def test_a_skin_follows_events():
    browser = xvrml.Browser((FIGURE % 0).encode())
    assert middle_of_red(browser) == near(1.5, 0)
    for _ in range(2):  # the first change may divide the scene anew, the second one may not
        browser["J"].rotation = (0, 0, 1, QUARTER)
        assert middle_of_red(browser) == near(1, 0.5)
        browser["J"].rotation = (0, 0, 1, -QUARTER)
        assert middle_of_red(browser) == near(1, -0.5)
    # The rest is written, so that reading it again bends it once.
    again = xvrml.loads(browser.to_x3d(encoding="xml").encode())
    assert middle_of_red(again) == near(1, -0.5)
    browser["J"].skinCoordIndex = ()
    assert middle_of_red(browser) == near(1.5, 0)


def test_a_skin_that_loses_its_figure_goes_back_to_rest():
    """In a world that does not run: it is taken out of the figure, or the figure out of the world."""
    text = (FIGURE % QUARTER).replace("HAnimHumanoid", "DEF H HAnimHumanoid").replace("Shape", "DEF S Shape")
    for runs in (False, True):
        world = xvrml.loads(text.encode())
        assert middle_of_red(world) == near(1, 0.5)
        coordinates = world["C"]
        world["H"].skinCoord = None
        if runs:
            world.time = 0
        assert middle_of_red(world) == near(1.5, 0)
        world["H"].skinCoord = coordinates
        assert middle_of_red(world) == near(1, 0.5)
        skin = world["S"]
        world.remove(world["H"])
        world.add(skin)
        assert middle_of_red(world) == near(1.5, 0)


def test_exports_and_rays_meet_the_bent_skin(tmp_path):
    world = xvrml.loads((FIGURE % QUARTER).encode())
    world.save(tmp_path / "a.stl")
    facets = np.frombuffer((tmp_path / "a.stl").read_bytes()[84:], np.uint8).reshape(-1, 50)
    points = facets[:, 12:48].copy().view("<f4").reshape(-1, 3)
    assert sorted(np.ptp(points, axis=0)) == pytest.approx([0, 1, 1], abs=1e-5)
    assert points[:, 0].min() == pytest.approx(0.5, abs=1e-5)
    browser = xvrml.Browser((FIGURE % QUARTER).encode())
    assert browser.pick((1, 0.9, 5), (0, 0, -1))
    assert not browser.pick((1.9, 0, 5), (0, 0, -1))


def test_a_skin_of_gltf_is_drawn_bent_and_exported(tmp_path):
    """A triangle whose only joint is moved by 1 0 0, before and after an export."""
    import base64
    points = np.array([[-1, -1, 0], [0, -1, 0], [-1, 1, 0]], "<f4").tobytes()
    weights = np.array([[1, 0, 0, 0]] * 3, "<f4").tobytes()
    binary = points + weights + bytes(12)
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(binary),
                     "uri": "data:;base64," + base64.b64encode(binary).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 84, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
                      {"bufferView": 1, "componentType": 5126, "type": "VEC4", "count": 3},
                      {"bufferView": 2, "componentType": 5121, "type": "VEC4", "count": 3}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "WEIGHTS_0": 1, "JOINTS_0": 2}}]}],
        "skins": [{"joints": [1]}],
        "nodes": [{"mesh": 0, "skin": 0}, {"translation": [1, 0, 0]}],
        "scenes": [{"nodes": [0, 1]}], "scene": 0}
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    world = xvrml.load(tmp_path / "a.gltf")
    assert not world.warnings
    world.save(tmp_path / "b.glb")
    for name in ("a.gltf", "b.glb"):
        found = xvrml.Browser(tmp_path / name).pick((0.2, -0.9, 5), (0, 0, -1))
        assert found, name
        assert not xvrml.Browser(tmp_path / name).pick((-0.8, -0.9, 5), (0, 0, -1)), name
