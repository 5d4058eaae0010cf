"""Large meshes that deform: each frame of a film has the bytes of a picture of that time that a
process of its own makes."""
import math

import pytest

SIDE = 180  # 2 x 179 x 179 triangles: enough to be refitted


def write_world(path, crease, colours):
    """Writes a wave between two phases that a CoordinateInterpolator moves."""
    def points(phase):
        return " ".join(
            f"{x / SIDE:.4f} {.06 * math.sin(9 * x / SIDE + phase):.4f} {z / SIDE:.4f},"
            for z in range(SIDE)
            for x in range(SIDE))

    faces = []
    for z in range(SIDE - 1):
        for x in range(SIDE - 1):
            a, c = z * SIDE + x, (z + 1) * SIDE + x
            faces.append(f"{a} {c} {a + 1} -1 {a + 1} {c} {c + 1} -1")
    colour = ("color Color { color [ " +
              " ".join(f"{x / SIDE:.2f} .5 .2," for z in range(SIDE)
                       for x in range(SIDE)) + " ] }" if colours else "")
    path.write_text(f"""#VRML V2.0 utf8
DEF T TimeSensor {{ cycleInterval 1 loop TRUE startTime 0 }}
DEF I CoordinateInterpolator {{ key [ 0 .5 1 ] keyValue [ {points(0)} {points(1)} {points(0)} ] }}
Viewpoint {{ position .5 .9 1.6 orientation 1 0 0 -.5 }}
Shape {{
  appearance Appearance {{ material Material {{ diffuseColor .8 .6 .4 }} }}
  geometry IndexedFaceSet {{
    solid FALSE creaseAngle {crease} {colour}
    coord DEF C Coordinate {{ point [ {points(0)} ] }}
    coordIndex [ {' '.join(faces)} ]
  }}
}}
ROUTE T.fraction_changed TO I.set_fraction
ROUTE I.value_changed TO C.set_point
""")


@pytest.mark.parametrize("crease, colours", [(0, False), (2, False), (2, True)])
def test_frames_of_a_film_are_those_of_their_time(vv, tmp_path, crease, colours):
    write_world(tmp_path / "wave.wrl", crease, colours)
    options = ["--size", "80x60", "--spp", "1", "--fps", "10", "--transport", "direct"]
    film = vv("wave.wrl", "--frames", "0-3", "-o", "film.png", *options)
    assert film.returncode == 0, film.talk
    frames = sorted(tmp_path.glob("film*.png"))
    assert len(frames) == 4
    assert frames[0].read_bytes() != frames[2].read_bytes()
    for number in (1, 3):
        alone = vv("wave.wrl", "--time", str(number / 10), "-o", "alone.png", *options)
        assert alone.returncode == 0, alone.talk
        assert (tmp_path / "alone.png").read_bytes() == frames[number].read_bytes()
