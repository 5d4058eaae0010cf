"""Tests that groups of X3D without a full implementation draw what they hold, where their
Transform fields place it, in two encodings (ISO/IEC 19775-1 25, 26, 28, 35 to 38)."""
import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

VIEW = "Viewpoint { position 0 0 10 fieldOfView 0.4 } NavigationInfo { headlight FALSE }\n"
RED = ("Shape { appearance Appearance { material Material { emissiveColor 1 0 0 diffuseColor 0 0 0 "
       "} } geometry Box { size 1 1 1 } }")
# A Transform moves the square one to the right, another group leaves it in the middle.
GROUPS = {
    "LayerSet { order [ 0 1 ] layers [ Layer { children %s } ] }": 0,
    "LayerSet { order [ 2 ] layers [ Layer { } LayoutLayer { children %s } ] }": 0,
    "Viewport { children %s }": 0,
    "LayoutGroup { layout Layout { } children %s }": 0,
    "ScreenGroup { children %s }": 0,
    "PickableGroup { children %s }": 0,
    "EspduTransform { translation 1 0 0 children %s }": 1,
    "HAnimHumanoid { translation 1 0 0 skeleton %s }": 1,
    "HAnimHumanoid { skin %s }": 0,
    "HAnimHumanoid { skeleton HAnimJoint { translation 1 0 0 children %s } }": 1,
    # Half a turn about a center at (0.5, 0, 0) moves the middle to (1, 0, 0).
    "HAnimJoint { center 0.5 0 0 rotation 0 0 1 3.14159265 children %s }": 1,
    "HAnimSite { translation 1 0 0 children HAnimSegment { children %s } }": 1,
    "GeoLocation { geoCoords 37 -122 0 children %s }": 0,
    # At 0 0 of the globe, up is the x axis.
    "GeoTransform { translation 0 1 0 children %s }": 1,
    "GeoLOD { rootNode %s }": 0,
    "CollidableShape { translation 1 0 0 shape %s }": 1,
    "CollidableOffset { translation 1 0 0 collidable CollidableShape { shape %s } }": 1,
}


def middle_of_red(world, **view):
    picture = world.render(size=(64, 64), spp=4, **view)
    rows, columns = np.nonzero(picture.display[..., 0] > 128)
    assert len(rows) > 20, "nothing is drawn"
    assert abs(rows.mean() - 31.5) < 1
    # 4.05 units are seen at a distance of 10.
    return (columns.mean() - 31.5) / 64 * 4.054


def worlds(text):
    """Returns the world as it is read from ClassicVRML, and after it was written as XML."""
    classic = xvrml.loads(b"#X3D V4.0 utf8\nPROFILE Full\n" + (VIEW + text).encode())
    return classic, xvrml.loads(classic.to_x3d(encoding="xml").encode())


@pytest.mark.parametrize("group", GROUPS)
def test_content_is_drawn_in_its_place(group):
    for world in worlds(group % RED):
        assert middle_of_red(world) == pytest.approx(GROUPS[group], abs=0.08)
        assert not [one for one in world.warnings if one.severity == "error"]


def test_layers_outside_of_the_order_are_not_drawn():
    world, _ = worlds(f"LayerSet {{ layers Layer {{ children {RED} }} }}")
    assert world.render(size=(16, 16), spp=1).display[..., 0].max() == 0


def test_nodes_that_are_named_again_are_drawn_once():
    """The joints of a figure are listed twice: in the skeleton they are drawn."""
    text = ("HAnimHumanoid { joints [ DEF J HAnimJoint { translation 1 0 0 children %s } ] "
            "skeleton HAnimJoint { translation -2 0 0 children USE J } }" % RED)
    for world in worlds(text):
        assert middle_of_red(world) == pytest.approx(-1, abs=0.08)


def test_groups_move_with_events():
    browser = xvrml.Browser(("#X3D V4.0 utf8\n" + VIEW +
                             "DEF J HAnimJoint { children %s }" % RED).encode())
    assert middle_of_red(browser) == pytest.approx(0, abs=0.08)
    browser["J"].translation = (1, 0, 0)
    assert middle_of_red(browser) == pytest.approx(1, abs=0.08)
    browser["J"].visible = False
    assert browser.render(size=(16, 16), spp=1).display[..., 0].max() == 0


@pytest.mark.parametrize("text", [
    "HAnimHumanoid { joints DEF J HAnimJoint { children %s } skeleton USE J }",
    "RigidBodyCollection { bodies RigidBody { geometry DEF C CollidableShape { shape %s } } }\n"
    "Transform { translation 1 0 0 children USE C }",
    "LoadSensor { watchList DEF I Inline { url \"box.x3dv\" } }\nTransform { children USE I }",
])
def test_lists_of_nodes_are_no_second_copy(tmp_path, text):
    """Nodes that another one only lists are not exported a second time."""
    (tmp_path / "box.x3dv").write_text("#X3D V3.3 utf8\n" + RED)
    (tmp_path / "a.x3dv").write_text("#X3D V3.3 utf8\n" + (text % RED if "%s" in text else text))
    world = xvrml.load(tmp_path / "a.x3dv")
    world.save(tmp_path / "a.stl")
    facets = int.from_bytes((tmp_path / "a.stl").read_bytes()[80:84], "little")
    assert facets == 12


def test_a_viewpoint_on_the_globe_sees_what_stands_below_it():
    text = ("GeoViewpoint { position 47 11 20 orientation 1 0 0 -1.5707963 }\n"
            "NavigationInfo { headlight FALSE }\nGeoLocation { geoCoords 47 11 0 children Shape { "
            "appearance Appearance { material Material { emissiveColor 1 0 0 diffuseColor 0 0 0 } } "
            "geometry Box { size 10 1 10 } } }")
    classic = xvrml.loads(("#X3D V3.3 utf8\nPROFILE Full\n" + text).encode())
    for world in (classic, xvrml.loads(classic.to_x3d(encoding="xml").encode())):
        assert not world.warnings
        red = world.render(size=(64, 64), spp=4).display[..., 0] > 128
        # 10 of 16.15 units that are seen at a distance of 19.5.
        assert red.mean() == pytest.approx((10 / 16.15)**2, abs=0.03)
        rows, columns = np.nonzero(red)
        assert rows.mean() == pytest.approx(31.5, abs=0.5)
        assert columns.mean() == pytest.approx(31.5, abs=0.5)
    # A running world has the same view.
    browser = xvrml.Browser(("#X3D V3.3 utf8\n" + text).encode())
    assert (browser.render(size=(64, 64), spp=4).display[..., 0] > 128).mean() > 0.3
