"""TextureCoordinateGenerator in the camera's frame (ISO/IEC 19775-1 18.4.8), in pictures: the
coordinates are read off a picture whose colours are its coordinates."""
import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

SIDE = 64  # texels of the ramp


def ramp():
    """A picture with red along s and green along t, from 0 to 1."""
    texels = [f"0x{255 * s // (SIDE - 1):02X}{255 * t // (SIDE - 1):02X}00"
              for t in range(SIDE) for s in range(SIDE)]
    return f"PixelTexture {{ repeatS FALSE repeatT FALSE image {SIDE} {SIDE} 3 {' '.join(texels)} }}"


def world(mode, geometry, place="", camera="", more=""):
    """A surface with the ramp, seen from (0, 0, 10) unless the camera is moved."""
    return xvrml.loads(f"""#X3D V4.0 utf8
PROFILE Full
NavigationInfo {{ headlight FALSE }}
Transform {{ {camera} children OrthoViewpoint {{ fieldOfView [ -2 -2 2 2 ] position 0 0 10 }} }}
Transform {{ {place} children Shape {{ appearance Appearance {{ texture {ramp()} }}
  geometry {geometry.replace('GENERATOR', f'TextureCoordinateGenerator {{ mode "{mode}" }}')} }} }}
{more}""", "a.x3dv")


SQUARE = """IndexedFaceSet { solid FALSE coordIndex [ 0 1 2 3 -1 ] texCoord GENERATOR
  coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } }"""
# A square whose normals lean outwards.
CAP = """IndexedTriangleSet { solid FALSE index [ 0 1 2 0 2 3 ] texCoord GENERATOR
  coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }
  normal Normal { vector [ -.5 -.5 .7071, .5 -.5 .7071, .5 .5 .7071, -.5 .5 .7071 ] } }"""


def seen(w, x=0.0, y=0.0):
    """The colour of a pixel. The picture goes from -2 to 2."""
    image = np.asarray(w.render(size=(80, 80), spp=1, colour="vrml97"))
    assert not w.warnings
    return image[row(y), column(x), :2]


def column(x):
    return int((2 + x) * 20)


def row(y):
    return int((2 - y) * 20)


def px(x):
    """The x of the middle of the pixel that has x."""
    return (column(x) + .5) / 20 - 2


def py(y):
    return 2 - (row(y) + .5) / 20


def near(found, *wanted):
    """Compares a colour with that of the ramp at s and t, half a texel beside its edges."""
    ramped = np.clip((np.array(wanted) * SIDE - .5) / (SIDE - 1), 0, 1)
    assert np.allclose(found, ramped, atol=.01), (found, ramped)


def test_sphere_takes_the_normal_in_the_frame_of_the_camera():
    near(seen(world("SPHERE", SQUARE)), .5, .5)
    near(seen(world("SPHERE", SQUARE, place="rotation 0 1 0 .785398")), .5 + .7071 / 2, .5)
    near(seen(world("SPHERE", SQUARE, place="rotation 1 0 0 -.785398")), .5, .5 + .7071 / 2)
    # The camera goes around the square, which then looks turned to the other side.
    near(seen(world("SPHERE", SQUARE, camera="rotation 0 1 0 .785398")), .5 - .7071 / 2, .5)


def test_normals_are_interpolated():
    # Half way to the edge the normal is about (.25, 0, .7071), made unit.
    x, y = px(.5) / 2, py(0) / 2
    long = np.sqrt(x * x + y * y + .5)
    near(seen(world("SPHERE", CAP), x=.5), .5 + x / long / 2, .5 + y / long / 2)


def test_the_camera_space_normal_is_not_halved():
    near(seen(world("CAMERASPACENORMAL", SQUARE, place="rotation 0 1 0 .523599")), .5, 0)


@pytest.mark.parametrize("mode", ("CAMERASPACEPOSITION", "COORD-EYE"))
def test_the_camera_space_position_moves_with_the_camera(mode):
    near(seen(world(mode, SQUARE), x=.5, y=.25), px(.5), py(.25))
    # The square is seen where it was; its place in the frame is that in the picture.
    near(seen(world(mode, SQUARE, camera="translation .25 0 0"), x=.5, y=.25), px(.5), py(.25))
    near(seen(world(mode, SQUARE, place="translation .5 .5 0"), x=.75, y=.5), px(.75), py(.5))


def reflected(x=0.0):
    """x and y of the direction from the viewer to a pixel of a surface through (x, 0, 0) that is
    turned by 22.5 degrees, reflected there."""
    normal = np.array((np.sin(.392699), 0, np.cos(.392699)))
    place = np.array((px(x), py(0), -(px(x) - x) * np.tan(.392699)))
    sight = place - (0, 0, 10)
    sight /= np.linalg.norm(sight)
    return (sight - 2 * sight.dot(normal) * normal)[:2]


def test_reflections():
    turned = "rotation 0 1 0 .392699"
    s, t = reflected()
    near(seen(world("CAMERASPACEREFLECTIONVECTOR", SQUARE, place=turned)), s, t)
    near(seen(world("SPHERE-REFLECT", SQUARE, place=turned)), .5 + s / 2, .5 + t / 2)


def test_local_modes_stay_with_the_shape():
    turned = "rotation 0 1 0 .785398"
    near(seen(world("SPHERE-LOCAL", SQUARE, place=turned)), .5, .5)
    near(seen(world("COORD", SQUARE, place=turned), x=.25, y=.5),
         px(.25) * np.sqrt(2), py(.5))


def test_equal_meshes_with_other_modes_are_kept_apart():
    """Two squares whose coordinates in the frame of the shape are equal."""
    other = ("Transform { translation 1.5 0 0 rotation 0 1 0 .392699 scale .4 .4 .4 children Shape { "
             f"appearance Appearance {{ texture {ramp()} }} geometry " +
             SQUARE.replace("GENERATOR", 'TextureCoordinateGenerator { mode "SPHERE-REFLECT" }') +
             " } }")
    w = world("SPHERE", SQUARE, place="translation -1 0 0 rotation 0 1 0 .392699 scale .4 .4 .4",
              more=other)
    near(seen(w, x=-1), .5 + .3827 / 2, .5)
    s, t = reflected(1.5)
    near(seen(w, x=1.5), .5 + s / 2, .5 + t / 2)


def test_events_change_the_mode():
    text = SQUARE.replace("GENERATOR", 'DEF G TextureCoordinateGenerator { mode "SPHERE" }')
    w = world("", text, place="rotation 0 1 0 .785398")
    near(seen(w), .5 + .7071 / 2, .5)
    w["G"].mode = "SPHERE-LOCAL"
    near(seen(w), .5, .5)
    w["G"].mode = "SPHERE"
    near(seen(w), .5 + .7071 / 2, .5)


def test_a_mirror_shows_the_coordinates_of_the_camera():
    """The frame is that of the camera that makes the picture: the mirror image of a place has the
    position of the place itself."""
    mirror = """Transform { rotation 0 1 0 .785398 children Shape { appearance Appearance {
      material PhysicalMaterial { baseColor 1 1 1 metallic 1 roughness 0 } }
      geometry Rectangle2D { size 1 1 } } }"""
    w = world("COORD-EYE",
              SQUARE,
              place="translation 1.5 0 0 rotation 0 1 0 -1.570796 scale .4 .4 .4",
              more=mirror)
    # The ray down to (0, .2) goes on along +x, to (1.5, .2): s is 1 at most, because repeatS is FALSE.
    near(seen(w, x=0, y=.2), 1, py(.2))
