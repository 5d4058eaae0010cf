"""Sensors of worlds against closed forms: form factors near and far, tilted planes under a
luminaire that differs in every direction, and luminance in glass."""
import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEADER = "#VRML V2.0 utf8\nNavigationInfo { headlight FALSE }\n"
LAMP = """appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
  options [ "color emission 100 100 100", "color reflectance 0 0 0" ] } }"""  # 100 cd/m2


def check(text, lux, tolerance, **options):
    """Compares a reading with its closed form. The interval must be narrow enough to tell."""
    (sensor,) = xvrml.loads(HEADER + text).measure(**options)
    value, width = float(sensor.values[0, 0]), float(sensor.half_widths[0, 0])
    assert sensor.trusted.all() and width < tolerance * lux
    assert abs(value - lux) < max(1.5 * width, 1e-6 * lux)


def factor_of_polygon(normal, corners):
    """Returns the form factor of a polygon in front of a plane element at the origin: Lambert's
    formula (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B)."""
    total = 0
    for p, q in zip(corners, corners[1:] + corners[:1]):
        across = np.cross(p, q)
        angle = np.arctan2(np.linalg.norm(across), np.dot(p, q))
        total += angle * np.dot(across / np.linalg.norm(across), normal)
    return abs(total) / (2 * np.pi)


@pytest.mark.parametrize("height", (1, .1, .01, .001))
@pytest.mark.parametrize("normal", ((0, 0, 1), (1, 0, 0), (.6, 0, .8)))
def test_a_rectangle_over_its_corner(height, normal):
    corners = [(0, 0, height), (2, 0, height), (2, 3, height), (0, 3, height)]
    text = f"""Shape {{ {LAMP} geometry IndexedFaceSet {{ solid FALSE coordIndex [ 0 1 2 3 ]
      coord Coordinate {{ point [ {", ".join("%g %g %g" % c for c in corners)} ] }} }} }}
    ORTSensor {{ direction {"%g %g %g" % normal} }}"""
    check(text, 100 * np.pi * factor_of_polygon(normal, corners), .02, spp=2048)


@pytest.mark.parametrize("tilt", (0, 30, 60))
def test_a_tilted_plane_under_a_ball(tilt):
    """Howell B-42: the factor of a sphere above the horizon of a plane element is that of its
    centre."""
    angle = np.radians(tilt)
    text = f"""Transform {{ translation 0 0 3 children Shape {{ {LAMP} geometry Sphere {{ }} }} }}
    ORTSensor {{ direction 0 {np.sin(angle):.9g} {np.cos(angle):.9g} }}"""
    check(text, 100 * np.pi * np.cos(angle) / 9, .02, spp=2048)


@pytest.mark.parametrize("exact", (False, True))
def test_a_disc_from_beside_its_axis(exact):
    """Howell B-13, a plane element parallel to a disc."""
    height, radius, aside = 1, .5, .8
    text = f"""Transform {{ translation {aside} 0 {height} rotation 1 0 0 1.57079633 children Shape {{
      {LAMP} geometry Cylinder {{ radius {radius} height .0002 side FALSE top FALSE }} }} }}
    ORTSensor {{ position 0 0 -.0001 direction 0 0 1 }}"""
    h, r = height / aside, radius / aside
    z = 1 + h * h + r * r
    factor = .5 * (1 - (1 + h * h - r * r) / np.sqrt(z * z - 4 * r * r))
    # Facets of the round outline leave out a part of the area.
    tolerance = .02
    if exact:
        check(text, 100 * np.pi * factor, tolerance, spp=2048, exact_shapes=True)
    else:
        (sensor,) = xvrml.loads(HEADER + text).measure(spp=2048)
        assert .98 < sensor.values[0, 0] / (100 * np.pi * factor) < 1.005


@pytest.mark.parametrize("index", (1, 1.5, 2))
def test_luminance_in_glass_is_that_outside_times_the_square_of_the_index(index):
    text = f"""Background {{ skyColor 1 1 1 }}
    Shape {{ geometry Sphere {{ }} appearance ORTAppearance {{ shader ORTShader {{
      name "Glass" file "glass" options "1f index {index}" }} }} }}
    ORTSensor {{ quantity "LUMINANCE" direction .6 0 .8 }}"""
    (sensor,) = xvrml.loads(HEADER + text).measure(spp=1024)
    assert sensor.values[0, 0] == pytest.approx(index**2, rel=4e-3)


def test_tilted_planes_under_a_luminaire_without_symmetry(tmp_path):
    """E = I cos / d^2, with another intensity in each of four half planes."""
    planes = {0: (900, 700, 300), 90: (500, 200, 50), 180: (300, 100, 20), 270: (800, 600, 400)}
    rows = [f"1000 {a} {b} {c} 0" for a, b, c in planes.values()]
    (tmp_path / "odd.ies").write_text("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 5 5 1 2 0 0 0\n1 1 0\n"
                                      "0 22.5 45 67.5 90\n0 90 180 270 360\n" +
                                      "\n".join(rows + rows[:1]) + "\n")
    normal = np.array([.3, -.2, 1]) / np.linalg.norm([.3, -.2, 1])
    for angle, (_, candela, _) in planes.items():
        phi = np.radians(angle)
        place = 3 * np.array([np.cos(phi), np.sin(phi), 0])
        to = np.array([0, 0, 3]) - place
        distance = np.linalg.norm(to)
        world = tmp_path / "odd.wrl"
        world.write_text(HEADER +
                         f"""Transform {{ translation 0 0 3 children ORTLight {{ shader ORTShader {{
          name "Luminaire" file "luminaire" options [ "file profile odd.ies", "3f direction 0 0 -1",
          "3f reference 1 0 0" ] }} }} }}
        ORTSensor {{ position {"%.9g %.9g %.9g" % tuple(place)} direction {"%.9g %.9g %.9g" % tuple(normal)} }}"""
                        )
        (sensor,) = xvrml.load(world).measure(spp=4)
        lux = candela * np.dot(to, normal) / distance**3
        assert sensor.values[0, 0] == pytest.approx(lux, rel=1e-5)
