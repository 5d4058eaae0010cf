"""Tests daylight: --sky, daylight factors, and the analytic cases 5.9 to 5.14 of CIE 171:2006."""
import csv
import io
import json

import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD = "#VRML V2.0 utf8\nNavigationInfo { headlight FALSE }\n"
EPW = """LOCATION,Bremen,-,DEU,IWEC Data,102240,53.05,8.80,1.0,5.0
DESIGN CONDITIONS,0
DATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31
1995,6,21,12,60,?9,20.0,11.0,56,101325,1100,1330,330,750,600,200,9999,9999,9999,9999
1995,6,21,13,60,?9,20.0,11.0,56,101325,1100,1330,330,750,650,210,9999,9999,9999,9999
1995,12,21,2,60,?9,1.0,0.0,90,101325,0,0,300,0,0,0,0,0,0,0
"""


def quad(*points, shader='name "Diffuse" file "diffuse" options "color reflectance 0 0 0"'):
    numbers = ", ".join("%.9g %.9g %.9g" % tuple(p) for p in points)
    return f"""Shape {{ appearance ORTAppearance {{ shader ORTShader {{ {shader} }} }}
  geometry IndexedFaceSet {{ solid FALSE coordIndex [ 0 1 2 3 ]
    coord Coordinate {{ point [ {numbers} ] }} }} }}\n"""


def sensor(at, normal, more=""):
    return ("ORTSensor { position %.9g %.9g %.9g direction %g %g %g %s }\n" %
            (tuple(at) + tuple(normal) + (more, )))


@pytest.fixture
def world(tmp_path):

    def load(text):
        (tmp_path / "world.wrl").write_text(HEAD + text)
        return xvrml.load(tmp_path / "world.wrl")

    return load


# A reference of its own: the standard's equation, and integrals over openings by the midpoint rule.
PARAMETERS = {  # ISO 15469:2004, table 1
    1: (4, -.7, 0, -1, 0), 4: (1.1, -.8, 2, -1.5, .15), 7: (0, -1, 5, -2.5, .3),
    12: (-1, -.32, 10, -3, .45), 14: (-1, -.15, 16, -3, .3)}


class Reference:

    def __init__(self, kind, altitude=35, azimuth=90, lux=10000, ground=0):
        self.kind, self.ground, self.lux = kind, ground, lux
        a, z = np.radians([altitude, azimuth])
        self.sun = np.array([np.cos(a) * np.sin(z), np.sin(a), -np.cos(a) * np.cos(z)])
        self.words = f"cie:{kind},sun={altitude}/{azimuth},lux={lux},ground={ground}"
        mu = np.sqrt((np.arange(800) + .5) / 800)[:, None]
        turn = 2 * np.pi * (np.arange(400) + .5) / 400
        side = np.sqrt(1 - mu * mu)
        d = np.stack(np.broadcast_arrays(side * np.cos(turn), mu, side * np.sin(turn)), -1)
        self.scale = lux / (np.pi * self.relative(d).mean())

    def relative(self, d):
        up = np.maximum(d[..., 1], 1e-9)
        if self.kind == 16:
            return (1 + 2 * up) / 3
        a, b, c, e, f = PARAMETERS[self.kind]
        x = np.arccos(np.clip(d @ self.sun, -1, 1))
        return (1 + a * np.exp(b / up)) * (1 + c * (np.exp(e * x) - np.exp(e * np.pi / 2)) +
                                           f * np.cos(x)**2)

    def luminance(self, d):
        return np.where(d[..., 1] > 0, self.scale * self.relative(d),
                        self.ground * self.lux / np.pi)

    def through(self, at, normal, corner, u, v, passes=lambda d, at: 1):
        """The illuminance at a point by what is seen through a rectangle: corner, and two sides."""
        n = 500
        s, t = np.meshgrid((np.arange(n) + .5) / n, (np.arange(n) + .5) / n)
        u, v, at, normal = (np.asarray(x, float) for x in (u, v, at, normal))
        points = np.asarray(corner, float) + s[..., None] * u + t[..., None] * v
        way = points - at
        square = (way**2).sum(-1)
        d = way / np.sqrt(square)[..., None]
        area = np.cross(u, v) / (n * n)
        form = np.maximum(d @ normal, 0) * np.abs(d @ area) / square
        return (self.luminance(d) * form * passes(d, at)).sum()


def expect(reading, expected, tolerance=.012):
    value, half = float(reading.values[0, 0]), float(reading.half_widths[0, 0])
    assert abs(value - expected) < 1.7 * half + .002 * expected, (value, half, expected)
    assert half < tolerance * expected, (value, half, expected)


# A black room of 4 m x 4 m x 3 m around the y axis.
FLOOR = quad((-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2))
CEILING = quad((-2, 3, 2), (2, 3, 2), (2, 3, -2), (-2, 3, -2))


def walls(sides):
    return "".join(quad(*[(x, y, z) for x, z, y in ((p, q, 0), (r, s, 0), (r, s, 3), (p, q, 3))])
                   for name, (p, q, r, s) in {
                       "east": (2, 2, 2, -2), "north": (2, -2, -2, -2), "west": (-2, -2, -2, 2),
                       "south": (-2, 2, 2, 2)}.items() if name in sides)


ROOF = "".join(
    quad(*points)
    for points in (((-2, 3, 2), (2, 3, 2), (2, 3, .5), (-2, 3, .5)),
                   ((-2, 3, -.5), (2, 3, -.5), (2, 3, -2), (-2, 3, -2)),
                   ((-2, 3, .5), (-.5, 3, .5), (-.5, 3, -.5), (-2, 3, -.5)),
                   ((.5, 3, .5), (2, 3, .5), (2, 3, -.5), (.5, 3, -.5))))
OPENING = ((-.5, 3, -.5), (1, 0, 0), (0, 0, 1))  # in the roof
# A window in the east: 2 m wide, from 1 m to 2 m above the floor.
FACADE = "".join(
    quad((2, low, south), (2, low, north), (2, high, north), (2, high, south))
    for low, high, south, north in ((0, 1, 2, -2), (2, 3, 2, -2), (1, 2, 2, 1), (1, 2, -1, -2)))
WINDOW = ((2, 1, -1), (0, 1, 0), (0, 0, 2))

# The pane of case 5.5: its transmittance by the angle, with all reflections inside.
GLASS = 'name "Glass" file "glass" options "1f index 1.52"'


def clear(cosine):
    c = np.abs(cosine)
    t = np.sqrt(1 - (1 - c * c) / 1.52**2)
    r = (((c - 1.52 * t) / (c + 1.52 * t))**2 + ((1.52 * c - t) / (1.52 * c + t))**2) / 2
    return (1 - r) / (1 + r)


@pytest.mark.parametrize("kind", [1, 4, 7, 12, 14, 16])
def test_cie_171_5_9_sky_component_under_a_roof_opening(world, kind):
    reference = Reference(kind)
    points = [((.5, 1e-3, .5), (0, 1, 0)), ((-1.999, 1.5, .5), (1, 0, 0)),
              ((.5, 1.5, 1.999), (0, 0, -1))]
    room = world(FLOOR + ROOF + walls("east north west south") +
                 "".join(sensor(*p) for p in points))
    for reading, (at, normal) in zip(room.measure(spp=65536, sky=reference.words), points):
        expect(reading, reference.through(at, normal, *OPENING), .025)


def test_cie_171_5_10_sky_component_under_a_glazed_roof_opening(world):
    reference = Reference(1)
    at, normal = (.5, 1e-3, .5), (0, 1, 0)
    panes = "".join(quad((-2, y, 2), (2, y, 2), (2, y, -2), (-2, y, -2), shader=GLASS)
                    for y in (3.1, 3.106))
    solid = panes.replace("solid FALSE", "solid TRUE")
    # the lower face of the sheet points down
    lower = solid.index("coordIndex [ 0 1 2 3 ]")
    solid = solid[:lower] + "coordIndex [ 3 2 1 0 ]" + solid[lower + 22:]
    room = world(FLOOR + ROOF + walls("east north west south") + solid + sensor(at, normal))
    (reading, ) = room.measure(spp=65536, sky=reference.words)
    expected = reference.through(at, normal, *OPENING, passes=lambda d, p: clear(d[..., 1]))
    expect(reading, expected, .03)


def facade_points():
    # the floor sees the sky, the ceiling the ground, the wall opposite both
    return [((0, 1e-3, .3), (0, 1, 0)), ((0, 2.999, .3), (0, -1, 0)), ((-1.999, 1.5, .3), (1, 0, 0))]


@pytest.mark.parametrize("kind", [1, 12])
def test_cie_171_5_11_sky_and_ground_through_a_facade_opening(world, kind):
    reference = Reference(kind, ground=.3)
    room = world(FLOOR + CEILING + FACADE + walls("north west south") +
                 "".join(sensor(*p) for p in facade_points()))
    readings = room.measure(spp=65536, sky=reference.words)
    for reading, (at, normal) in zip(readings, facade_points()):
        expect(reading, reference.through(at, normal, *WINDOW), .025)


def mask(corner, u, v):
    """Returns what of the light passes a black rectangle: 0 where a ray meets it."""
    corner, u, v = (np.asarray(x, float) for x in (corner, u, v))
    n = np.cross(u, v)

    def passes(d, at):
        along = d @ n
        t = ((corner - at) @ n) / np.where(along == 0, 1e-12, along)
        hit = at + t[..., None] * d - corner
        a, b = hit @ u / (u @ u), hit @ v / (v @ v)
        return ~((t > 0) & (a > 0) & (a < 1) & (b > 0) & (b < 1))

    return passes, quad(corner, corner + u, corner + u + v, corner + v)


@pytest.mark.parametrize("name, rectangle", [
    ("5.13", ((2, 2.2, -500), (1.5, 0, 0), (0, 0, 1000))),
    ("5.14", ((8, -.01, -500), (0, 3.5, 0), (0, 0, 1000)))])
def test_cie_171_5_13_and_5_14_masks_before_a_facade_opening(world, name, rectangle):
    reference = Reference(1, ground=.3)
    passes, shape = mask(*rectangle)
    points = facade_points()
    if name == "5.14":  # a part of the window is hidden from these
        points = [((-1.5, 1e-3, .3), (0, 1, 0)), ((-1.999, .5, .3), (1, 0, 0))]
    room = world(FLOOR + CEILING + FACADE + walls("north west south") + shape +
                 "".join(sensor(*p) for p in points))
    for reading, (at, normal) in zip(room.measure(spp=65536, sky=reference.words), points):
        expect(reading, reference.through(at, normal, *WINDOW, passes=passes), .03)


def test_cie_171_5_12_sky_through_a_glazed_facade_opening(world):
    reference = Reference(1, ground=.3)
    at, normal = (0, 1e-3, .3), (0, 1, 0)
    panes = "".join(
        quad((x, -9, 9), (x, -9, -9), (x, 9, -9), (x, 9, 9), shader=GLASS).replace(
            "solid FALSE", "solid TRUE") for x in (2.1, 2.106))
    inner = panes.index("coordIndex [ 0 1 2 3 ]")
    panes = panes[:inner] + "coordIndex [ 3 2 1 0 ]" + panes[inner + 22:]
    room = world(FLOOR + CEILING + FACADE + walls("north west south") + panes + sensor(at, normal))
    (reading, ) = room.measure(spp=65536, sky=reference.words)
    expect(reading, reference.through(at, normal, *WINDOW, passes=lambda d, p: clear(d[..., 0])),
           .03)


def test_a_sensor_in_the_open_reads_the_sky(world):
    open_air = world(sensor((0, 0, 0), (0, 1, 0)) + sensor((0, 0, 0), (0, -1, 0)))
    for kind in (1, 12, 16):
        up, down = open_air.measure(spp=16384, sky=f"cie:{kind},sun=40/180,lux=8000,ground=.25")
        assert up.values[0, 0] == pytest.approx(8000, rel=.004)
        assert down.values[0, 0] == pytest.approx(2000, rel=.004)
        assert up.outdoors == (0 if kind == 12 else 8000)


def test_a_sun_shines_from_its_place_and_casts_shadows(world):
    wall = quad((-50, 0, 1), (50, 0, 1), (50, 3, 1), (-50, 3, 1))  # in the south of the sensors
    text = (sensor((0, 0, 0), (0, 1, 0)) + sensor((0, 2.5, 0), (0, 1, 0)) +
            sensor((0, 8, 0), (0, 0, 1)) + sensor((0, 8, 0), (0, 0, -1)))
    shaded, above, south, north = world(wall + text).measure(
        spp=4096, sky="cie:5,lux=0,sun=60/180,direct=80000,ground=0")
    assert shaded.values[0, 0] < 1
    assert above.values[0, 0] == pytest.approx(80000 * np.sin(np.radians(60)), rel=.01)
    assert south.values[0, 0] == pytest.approx(80000 * np.cos(np.radians(60)), rel=.01)
    assert north.values[0, 0] < 1


def test_a_sun_that_has_set_is_told(vv, world):
    sky = "cie:12,sun=-3/90,direct=80000"
    (vv.folder / "open.wrl").write_text(HEAD + "ORTSensor { size 1 1 columns 1 rows 1 }")
    done = vv("open.wrl", "--measure", "out.csv", "--sky", sky)
    assert done.returncode == 0 and "sun is not above the horizon (altitude -3.00" in done.talk
    done = vv("open.wrl", "--measure", "out.csv", "--sky", sky, "--quiet")
    assert "horizon" not in done.talk
    with pytest.warns(RuntimeWarning, match="not above the horizon"):
        world(sensor((0, 0, 0), (0, 1, 0))).measure(sky=sky)


def test_intervals_under_a_clear_sky_hold(world):
    """The room of case 5.9 under a clear sky: 400 readings with seeds of their own."""
    reference = Reference(12)
    at, normal = (.5, 1e-3, .5), (0, 1, 0)
    room = world(FLOOR + ROOF + walls("east north west south") +
                 sensor(at, normal, "size 1e-3 1e-3 columns 20 rows 20"))
    (grid, ) = room.measure(spp=1024, sky=reference.words)
    expected = reference.through(at, normal, *OPENING)
    held = np.abs(grid.values - expected) <= grid.half_widths
    assert held.mean() > .91, held.mean()
    assert grid.values.mean() == pytest.approx(expected, rel=.01)


def test_daylight_factors_in_files(vv):
    (vv.folder / "open.wrl").write_text(
        HEAD + 'DEF Out ORTSensor { size 1 1 columns 2 rows 2 }\n'
        'ORTSensor { quantity "LUMINANCE" direction 0 1 0 }')
    run = lambda *a: vv("open.wrl", "--spp", "4096", *a)
    done = run("--measure", "out.csv", "--sky", "cie:16,lux=5000")
    assert done.returncode == 0 and "daylight factor" in done.talk, done.talk
    rows = list(csv.DictReader(io.StringIO((vv.folder / "out.csv").read_text())))
    for row in rows[:4]:
        assert float(row["daylight factor [%]"]) == pytest.approx(100, abs=.5)
    # the zenith of the traditional sky is 9 / (7 pi) of the illuminance
    assert rows[4]["daylight factor [%]"] == ""
    assert float(rows[4]["value [unit]"]) == pytest.approx(5000 * 9 / (7 * np.pi), rel=.005)
    assert run("--measure", "out.json", "--sky", "cie:1", "-q").returncode == 0
    said = json.loads((vv.folder / "out.json").read_text())["sensors"]
    assert said[0]["outdoors"] == 10000
    assert said[0]["daylight_factor_percent"] == pytest.approx(100, abs=.5)
    assert run("--measure", "-", "--sky", "cie:12,sun=30/0", "-q").stdout.count(b"daylight") == 0


def test_a_weather_file_gives_the_sky_of_an_hour(vv):
    (vv.folder / "open.wrl").write_text(HEAD + "ORTSensor { }")
    (vv.folder / "a.epw").write_text(EPW)
    measure = lambda sky: vv("open.wrl", "--measure", "-", "--spp", "4096", "-q", "--sky", sky)
    read = lambda done: float(
        next(csv.DictReader(io.StringIO(done.stdout.decode())))["value [unit]"])
    noon = measure("epw:a.epw@06-21T12:30")
    assert noon.returncode == 0, noon.talk
    # the hour by its numbers: 650 and 210 W/m2, and where the sun stands
    same = measure("perez:650/210,place=53.05/8.80,time=1995-06-21T12:30+01:00")
    assert read(noon) == pytest.approx(read(same), rel=.002)
    assert 80000 < read(noon) < 110000
    for sky, code, text in (("epw:a.epw@12-21T01:30", 2, "no diffuse light"),
                            ("epw:a.epw@07-01T12:00", 3, "it has no such hour"),
                            ("epw:gone.epw@07-01T12:00", 3, "gone.epw"),
                            ("cie:17", 2, "from 1 to 16")):
        done = measure(sky)
        assert done.returncode == code and text in done.talk, (sky, done.talk)


def test_the_same_bytes_for_any_number_of_threads(vv):
    (vv.folder / "open.wrl").write_text(HEAD + FLOOR + sensor((0, 1, 0), (0, 0, 1)))
    sky = "perez:700/150,sun=40/180"
    texts = {
        vv("open.wrl", "--measure", "-", "--spp", "64", "-q", "--sky", sky, "--threads", n).stdout
        for n in (1, 3)
    }
    assert len(texts) == 1


def test_a_sky_goes_with_no_other_surroundings(vv, world):
    (vv.folder / "open.wrl").write_text(HEAD)
    for other in (("--environment", "a.hdr"), ("--background", "white"), ("--studio", "grey")):
        done = vv("open.wrl", "-o", "a.png", "--sky", "cie:1", *other)
        assert done.returncode == 2 and "--sky" in done.talk, done.talk
    with pytest.raises(ValueError, match="sky: .*cie:TYPE"):
        world("").measure(sky="blue")
    with pytest.raises(ValueError, match="not with background"):
        world("").render(size=(8, 8), sky="cie:1", background="white")


def test_pictures_show_the_sky_in_candela(world):
    picture = world("Viewpoint { orientation 1 0 0 1.5707963 }").render(
        size=(9, 9), spp=16, fov=1, sky="cie:16,lux=7000")
    zenith = np.asarray(picture.array)[4, 4, :3]
    assert zenith == pytest.approx([7000 * 9 / (7 * np.pi)] * 3, rel=.01)
