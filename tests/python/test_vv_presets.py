"""Tests rules for shaders, presets, vv.toml, --studio and --from of vv, and World.set_shader."""
import os

import pytest
from conftest import HEADER, ROOT, SMALL, read_pfm

PART = HEADER + """Transform { translation %s children Shape {
  appearance Appearance { material DEF %s Material { diffuseColor %s } }
  geometry IndexedFaceSet { solid FALSE coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }
    coordIndex [ 0 1 2 3 ] } } }
"""
# pins at the left in an Inline, a body in the middle in a prototype, a board at the right
BOARD = HEADER + """Viewpoint { position 0 0 5 fieldOfView 1.2 }
NavigationInfo { headlight FALSE }
Inline { url "pin.wrl" }
PROTO Body [ field SFColor c 1 0 0 ] { Shape {
  appearance Appearance { material DEF IC-BODY-01 Material { diffuseColor IS c } }
  geometry IndexedFaceSet { solid FALSE coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }
    coordIndex [ 0 1 2 3 ] } } }
DEF Chip Body { }
Transform { translation 2.5 0 0 children Shape {
  appearance Appearance { material Material { diffuseColor .72 .45 .2 } }
  geometry IndexedFaceSet { solid FALSE coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] }
    coordIndex [ 0 1 2 3 ] } } }
"""


def glow(colour):
    return "Diffuse:reflectance=0:emission=" + colour


def written(text):
    """Replaces words that stand for what is too large for a test's name."""
    if isinstance(text, bytes):
        return text
    chain = "[[files]]\npreset = 'p0'\n" + "".join(f"[preset.p{i}]\npreset = 'p{i + 1}'\n"
                                                   for i in range(18)) + "[preset.p18]\nspp = 1\n"
    return text.replace("deep", "[" * 5000).replace("long", "#" * (1 << 20) + "##").replace(
        "chain", chain)


RED, GREEN, BLUE = glow("1,0,0"), glow("0,1,0"), glow("0,0,1")


@pytest.fixture
def board(vv):
    vv.write("pin.wrl", PART % ("-2.5 0 0", "PIN-01", "0 0 1"))
    vv.write("board.wrl", BOARD)
    return vv


def colours(vv, *arguments):
    """Returns which of r, g, b the three parts glow in; - if they do not."""
    row = vv.picture(*arguments, world="board.wrl")[12]
    return "".join("rgb"[p.index(255)] if sorted(p) == [0, 0, 255] else "-"
                   for p in (row[6], row[16], row[26]))


@pytest.mark.parametrize("rules, seen", [
    (["material:PIN-*=" + RED], "r--"),
    (["material:*=" + RED], "rrr"),
    (["material:?IN-0?=" + RED], "r--"),
    (["material:IC-BODY-*=" + GREEN], "-g-"),
    (["colour:.72,.47,.19=" + BLUE], "--b"),
    (["color:0,0,1=" + BLUE], "b--"),
    (["colour:0,0,1,.7=" + RED, "colour:.72,.45,.2,.2=" + BLUE], "--b"),
    (["Chip=" + BLUE], "-b-"),
    (["material:*-01=" + RED, "material:PIN-01=" + BLUE], "br-"),
    (["material:PIN-01=" + BLUE, "material:*-01=" + RED], "rr-"),
    (["*=" + RED, "material:PIN-*=" + GREEN], "grr"),
    (["material:PIN-*=" + GREEN, "*=" + RED], "grr"),
])
def test_rules_select(board, rules, seen):
    arguments = [word for rule in rules for word in ("--shader", rule)]
    assert colours(board, *arguments) == seen
    board.write("rules.txt", "\ufeff# a comment\n\n" +
                "\r\n".join("  " + rule.replace("=", " = ", 1) for rule in rules))
    assert colours(board, "--shader", "@rules.txt") == seen


def test_shapes_without_a_material_are_grey_for_the_rest(vv):
    """The default colour of Plastic is dark red."""
    vv.write("bare.wrl", HEADER + "Viewpoint { position 0 0 3 }\nDEF Bare Shape { geometry Box { } }")
    rest = vv.picture("--shader", "*=Plastic", world="bare.wrl")[12][16]
    assert max(rest) - min(rest) <= 1 and max(rest) > 100
    named = vv.picture("--shader", "Bare=Plastic", world="bare.wrl")[12][16]
    assert named[0] > 1.5 * named[1]


def test_a_rule_that_selects_nothing_is_a_warning(board):
    done = board("board.wrl", "-o", "x.png", "--shader", "material:PIN=" + RED, *SMALL)
    assert done.returncode == 0
    assert "--shader material:PIN=Diffuse" in done.talk and "no shape of the world" in done.talk
    done = board("board.wrl", "-o", "y.png", "--strict", "--shader", "shape:Nothing=Metal", *SMALL)
    assert done.returncode == 4 and not (board.folder / "y.png").exists()


def test_a_rule_that_throws_colours_away_is_a_warning(board):
    done = board("board.wrl", "-o", "x.png", "--shader", "*=Metal", *SMALL)
    assert "--shader *=Metal: the class has no parameter for a material's colour" in done.talk
    for rule in ("*=Plastic", "material:*=Metal"):
        assert "colour" not in board("board.wrl", "-o", "x.png", "--shader", rule, *SMALL).talk


@pytest.mark.parametrize("rules, message", [
    ("material:PIN-*=Metal\nPIN Metal\n", "rules.txt:2: SELECTOR=CLASS[:PARAM=VALUE...] was"),
    ("colour:1,2=Metal", "rules.txt:1: colour: R,G,B from 0 to 1"),
    ("colour:1,1,1,1,1=Metal", "rules.txt:1: colour: R,G,B from 0 to 1"),
    ("colour:1,1,1,=Metal", "rules.txt:1: colour: R,G,B from 0 to 1"),
    ("colour:1,1,1,-.1=Metal", "rules.txt:1: colour: R,G,B from 0 to 1"),
    ("material:=Metal", "rules.txt:1: a name was expected after material:"),
    ("\n\nmaterial:PIN-*=Metall", 'rules.txt:3: Metall: there is no shader class "Metall"'),
    ("material:PIN-*=Metal:rough=1", "Metal has no parameter rough"),
    (b"\xff\xfe\x00=", "rules.txt:1: text was expected, not a byte that is 0"),
    (b"*=Metal\n# a\x00\n", "rules.txt:2: text was expected"),
    ("long", "cannot read the rules in rules.txt: it is longer than"),
])
def test_wrong_rules(board, rules, message):
    board.write("rules.txt", written(rules))
    done = board("board.wrl", "-o", "x.png", "--shader", "@rules.txt", *SMALL)
    assert done.returncode in (2, 3)
    assert message in done.talk or "no node is called" in done.talk
    assert done.talk.count(", not ") <= 1
    assert not (board.folder / "x.png").exists()


def test_a_glob_of_stars_ends(board):
    name = "A" * 60
    board.write("pin.wrl", PART % ("-2.5 0 0", name, "0 0 1"))
    assert colours(board, "--shader", "material:" + "*A" * 30 + "*B=" + RED) == "---"
    assert colours(board, "--shader", "material:" + "*A" * 30 + "*=" + RED) == "r--"


# Presets ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["studio", "product", "technical", "pcb"])
def test_built_in_presets(board, name):
    rows = board.floats("--preset", name)
    seen = [pixel for row in rows for pixel in row]
    assert all(0 <= value < 30 for pixel in seen for value in pixel)
    assert len(set(map(tuple, seen))) > 4
    if name in ("product", "technical"):  # the corners are the white backdrop
        for corner in (rows[0][0], rows[0][-1]):
            assert min(corner) > .8


def test_a_camera_of_ones_own_wins_over_the_preset(vv):
    """--pose is a view as --camera is, and --intrinsics say what --fov says."""
    vv.write("box.wrl", HEADER + "Shape { geometry Box { } }")
    pose = ("--pose", "1,0,0,0,0,-1,0,0,0,0,-1,5,0,0,0,1")
    inside = ("--intrinsics", "60,60,15.5,11.5")
    for preset in ("technical", "studio", "product", "pcb"):
        for own in (pose, inside, pose + inside):
            done = vv("box.wrl", "--preset", preset, *own, "-o", "x.png", "--size", "32x24", "--spp", 1)
            assert done.returncode == 0, (preset, own, done.talk)


def test_technical_keeps_parallel_edges_parallel(vv):
    near_and_far = HEADER + "".join("""Transform { translation %s 0 %s children Shape {
  appearance Appearance { material Material {} } geometry Box { size 1 1 1 } } }
""" % place for place in (("-2", "-2"), ("2", "2")))
    vv.write("two.wrl", near_and_far)

    def widths(*options):
        rows = vv.picture("--from", "front", "--size", "96x64", "--spp", "4", *options,
                          world="two.wrl")
        far, near = "".join(".#"[min(p) < 250] for p in rows[32]).strip(".").replace(".", " ").split()
        return len(far), len(near)

    far, near = widths("--preset", "technical")
    assert abs(far - near) <= 1 and far > 12
    far, near = widths("--preset", "technical", "--fov", "45")
    assert near > 1.3 * far
    # its angle is not for other views
    eye = ("--camera", "0,0,20:0,0,0")
    assert vv.picture("--preset", "technical", *eye, world="two.wrl") == vv.picture(
        *eye, "--background", "white", world="two.wrl")


def test_options_win_over_presets(board):
    plain = board.floats("--from", "top", "--background", "none")
    assert board.floats("--preset", "product", "--from", "top", "--background", "none") == plain
    assert board("board.wrl", "--preset", "pcb", "--viewpoint", "0", "-o", "x.png",
                 *SMALL).returncode == 0
    red = board.floats("--preset", "pcb", "--background", "#ff0000")
    assert red[0][0][0] > .9 and red[0][0][1] < .1


FILE = """
[[files]]
match = ["nothing*", "boar?.wrl"]
shader = ["material:PIN-*=%s"]

[[files]]
match = "*.x3d"
shader = "*=%s"

[preset.mine]
shader = "material:IC-*=%s"
""" % (RED, BLUE, GREEN)


def test_a_file_beside_the_world(board):
    board.write("vv.toml", FILE)
    assert colours(board) == "r--"
    assert colours(board, "--config", "none") == "---"
    assert colours(board, "--preset", "mine") == "rg-"
    done = board("board.wrl", "-o", "x.png", *SMALL)
    assert "vv.toml sets options for this world; --config none ignores it" in done.talk
    board.write("other.toml", '[[files]]\npreset = "a"\nspp = 2\n[preset.a]\npreset = "b"\n'
                '[preset.b]\nshader = "*=' + BLUE + '"')
    assert colours(board, "--config", "other.toml") == "bbb"


@pytest.mark.parametrize("text, message", [
    ("[[files]]\nspp = \n", "vv.toml:2:"),
    ("[[files]]\nsppp = 3\n", "vv.toml:2:1: there is no option sppp; did you mean spp?"),
    ("[[files]]\noutput = 'a.png'\n", "vv.toml:2:1: output can only be set on the command line"),
    ("[[files]]\ntrust = true\n", "vv.toml:2:1: trust can only be set on the command line"),
    ("[[files]]\nallow-absolute = true\n", "allow-absolute can only be set"),
    ("[[files]]\nshader-path = '.'\n", "shader-path can only be set"),
    ("[[files]]\nspp = true\n", "vv.toml:2:7: N was expected, not a boolean"),
    ("[[files]]\nspp = [1, 2]\n", "vv.toml:2:7: spp has one value, not a list"),
    ("[[files]]\nspp = 99999999\n", "vv.toml:2:7: spp: "),
    ("[[files]]\nspp = 60000\n", "at most 4096 can be set here"),
    ("[[files]]\nsize = '9000x9000'\n", "at most 4096x4096 pixels"),
    ("[[files]]\nfit = 3\n", "vv.toml:2:7: true or false was expected"),
    ("[[files]]\npreset = 'stud'\n", 'there is no preset "stud" (did you mean studio?)'),
    ("[[files]]\npreset = 'a'\n[preset.a]\npreset = 'a'\n", "vv.toml:4:10: preset a builds on itself"),
    ("[[files]]\npreset = 'a'\n[preset.a]\npreset = 'b'\n[preset.b]\npreset = 'a'\n",
     "vv.toml:6:10: preset a builds on itself"),
    ("[[files]]\npreset = 'a'\n[preset.a]\npreset = 'x'\n", "vv.toml:4:10: there is no preset"),
    ("[[files]]\npreset = 'a'\n[preset.a]\nspp = 'x'\n", "vv.toml:4:7: spp: a whole number"),
    ("[[files]]\nmatch = 3\n", "vv.toml:2:9: a pattern for file names was expected"),
    ("files = 3\n", "vv.toml:1:9: [[files]] or [preset.NAME] was expected, not files"),
    ("[[file]]\n", "[[files]] or [preset.NAME] was expected, not file"),
    ("[[files]]\nenvironment = '/etc/passwd.hdr'\n", "a file inside"),
    ("[[files]]\nenvironment = '../x.hdr'\n", "a file inside"),
    ("[[files]]\nbackground = '../../x.png'\n", "a file inside"),
    ("[[files]]\nshader = '@/etc/passwd'\n", "a file inside"),
    ("[[files]]\nshader = '*=VRML97:texture=../x.png'\n", "a file inside"),
    ("[[files]]\nshader = '*=Marble:x=@/etc/passwd'\n", "Marble has no parameter x"),
    ("[[files]]\nturntable = 361\n", "at most 360 can be set here"),
    ("[[files]]\nroulette = 'off'\n", "there is no option roulette"),
    ("[[files]]\nshader = '@fifo'\n", '"fifo" is not an ordinary file'),
    ("[[files]]\nenvironment = 'fifo'\n", "not"),
    ("chain", "more than 16 presets build on each other"),
    ("deep", "vv.toml:1:"),
    ("a = deep", "vv.toml:1:"),
    (b"\xff\xfe\x01", "vv.toml:1:"),
    ("long", "too long for options"),
])
def test_hostile_files(board, text, message):
    board.write("vv.toml", written(text))
    os.mkfifo(board.folder / "fifo")
    done = board("board.wrl", "-o", "x.png")
    assert done.returncode in (2, 3), done.talk
    errors = [line for line in done.talk.splitlines() if "--config none" not in line]
    assert len(errors) == 1 and message in errors[0]
    assert not (board.folder / "x.png").exists()


def test_links_do_not_lead_outside(board):
    os.symlink("/etc", board.folder / "inside")
    board.write("vv.toml", "[[files]]\nbackground = 'inside/x.png'\n")
    done = board("board.wrl", "-o", "x.png", "--size", "4x4")
    assert done.returncode == 2 and "a file inside" in done.talk


def test_files_of_presets_are_relative_to_their_folder(board):
    (board.folder / "sub").mkdir()
    board.write("sub/rules.txt", "material:PIN-*=" + RED)
    board.write("sub/my.toml", "[[files]]\nshader = '@rules.txt'\n")
    assert colours(board, "--config", "sub/my.toml") == "r--"


@pytest.mark.parametrize("arguments, message", [
    (["--preset", "nothing"], '--preset: there is no preset "nothing"'),
    (["--config", "missing.toml"], "--config: cannot read missing.toml"),
    (["--config", "."], "--config: cannot read ."),
    (["--studio", "none"], "--studio: a colour"),
    (["--studio", "grey", "--environment", "a.hdr"], "--studio has a light"),
    (["--studio", "grey", "--background", "none"], "--studio has a light"),
    (["--from", "under"], "--from: sides of three-quarter, above"),
    (["--from", "top,top"], "--from: top is named twice"),
    (["--from", "top", "--viewpoint", "0"], "--from cannot be used with --viewpoint"),
])
def test_wrong_options(board, arguments, message):
    done = board("board.wrl", "-o", "x.png", "--size", "4x4", *arguments)
    assert done.returncode in (2, 3)
    assert message in done.talk
    done = board("board.wrl", "-o", "-", "--from", "top,front")
    assert done.returncode == 2 and "need file names" in done.talk


# Sides and the studio ---------------------------------------------------------------------------

CUBE = HEADER + "NavigationInfo { headlight FALSE }\n" + "".join(
    """Shape { appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse"
      options [ "color reflectance 0 0 0" "color emission %s" ] } }
    geometry IndexedFaceSet { coord Coordinate { point [ %s ] } coordIndex [ 0 1 2 3 ] } }
""" % one for one in [
        (".1 0 0", "1 0 0, 1 1 0, 1 1 1, 1 0 1"),  # right
        (".2 0 0", "0 0 0, 0 0 1, 0 1 1, 0 1 0"),  # left
        (".3 0 0", "0 0 0, 1 0 0, 1 0 1, 0 0 1"),  # front of a world whose z is up
        (".4 0 0", "0 1 0, 0 1 1, 1 1 1, 1 1 0"),  # back
        (".5 0 0", "0 0 1, 1 0 1, 1 1 1, 0 1 1"),  # top
        (".6 0 0", "0 0 0, 0 1 0, 1 1 0, 1 0 0"),  # bottom
    ])


@pytest.mark.parametrize("side, value", [("right", .1), ("left", .2), ("front", .3), ("back", .4),
                                         ("top", .5), ("bottom", .6)])
def test_sides(vv, side, value):
    vv.write("cube.wrl", CUBE)
    rows = vv.floats("--from", side, "--up", "z", world="cube.wrl")
    assert rows[8][12][0] == pytest.approx(value)


def test_several_sides_and_a_turntable_in_one_call(vv):
    vv.write("cube.wrl", CUBE)
    done = vv("cube.wrl", "--from", "above,top,bottom", "--turntable", "3", "-o", "a.png", "-o",
              "turn.gif", "--size", "8x6", "--spp", "1")
    assert done.returncode == 0, done.talk
    made = sorted(p.name for p in vv.folder.iterdir() if p.suffix in (".png", ".gif"))
    assert made == ["a-above.png", "a-bottom.png", "a-top.png", "turn-above.gif"]
    vv("cube.wrl", "--from", "top", "-o", "b.png", "--up", "z", "--size", "8x6", "--spp", "1")
    vv("cube.wrl", "--from", "top,above", "-o", "c.png", "--up", "z", "--size", "8x6", "--spp", "1")
    assert (vv.folder / "b.png").read_bytes() == (vv.folder / "c-top.png").read_bytes()
    done = vv("cube.wrl", "--from", "front,back", "--turntable", "2", "-o", "{viewpoint}.png",
              "--size", "8x6", "--spp", "1")
    made = sorted(p.name for p in vv.folder.iterdir() if p.name[:2] in ("fr", "ba"))
    assert made == ["back.png", "front-0000.png", "front-0001.png"]


def test_one_side_and_a_turntable_with_a_film(vv):
    vv.write("cube.wrl", CUBE)
    done = vv("cube.wrl", "--from", "top", "--turntable", "3", "-o", "a.png", "-o", "a.gif",
              "--size", "8x6", "--spp", "1")
    assert done.returncode == 0, done.talk
    assert sorted(p.name for p in vv.folder.glob("a*")) == ["a.gif", "a.png"]
    film = (vv.folder / "a.gif").read_bytes()
    assert film.count(b"\x21\xf9\x04") == 3  # a control block for each picture
    assert vv("cube.wrl", "--from", "top", "--turntable", "3", "-o", "b.png", "--size", "8x6",
              "--spp", "1").returncode == 0
    assert len(list(vv.folder.glob("b-*.png"))) == 3


WHITE = HEADER + """Shape { appearance ORTAppearance { shader ORTShader { name "Diffuse" file "diffuse" } }
  geometry Box { } }"""


def test_ground_and_backdrop_of_a_studio_have_one_colour(vv):
    vv.write("box.wrl", WHITE)
    linear = (188 / 255 + .055)**2.4 / 1.055**2.4
    done = vv("box.wrl", "-o", "pfm:-", "--studio", "#bcbcbc", "--from", "above", "--fov", "70",
              "--size", "24x18", "--spp", "400")
    rows = read_pfm(done.stdout)[2]
    for pixel in (rows[0][0], rows[0][-1], rows[0][12]):  # the ground far behind the box
        assert pixel[0] == pytest.approx(linear, rel=.05)
    below = vv("box.wrl", "-o", "pfm:-", "--studio", "#bcbcbc", "--from", "bottom", "--size",
               "24x18", "--spp", "4")
    for pixel in (read_pfm(below.stdout)[2][0][0], read_pfm(below.stdout)[2][-1][-1]):
        assert pixel[0] == pytest.approx(linear, rel=1e-3)  # no ground there: the backdrop alone
    # the box is lit from the camera's side, and casts a shadow
    assert read_pfm(below.stdout)[2][9][12][0] > .4
    assert min(pixel[0] for row in rows for pixel in row) < .9 * linear


def test_the_studio_turns_with_the_camera(vv):
    vv.write("box.wrl", WHITE)
    quarter = [
        vv.floats("--studio", "white", "--camera", camera, world="box.wrl")
        for camera in ("0,3,8:0,0,0", "8,3,0:0,0,0")
    ]  # a box looks the same from both sides, if the light comes along
    for a, b in zip(*quarter):
        for p, q in zip(a, b):
            assert p[0] == pytest.approx(q[0], rel=.6, abs=.15)
    mean = [sum(p[0] for row in rows for p in row) for rows in quarter]
    assert mean[0] == pytest.approx(mean[1], rel=.02)


@pytest.mark.parametrize("arguments", [
    ("--studio", "#fff"),
    ("--preset", "product"),
    ("--preset", "pcb"),
    ("--preset", "studio", "--turntable", "2"),
])
def test_a_studio_with_nothing_in_it_is_a_warning(vv, arguments):
    vv.write("empty.wrl", HEADER + "Shape { } Shape { geometry IndexedFaceSet { } }")
    vv.write("ball.wrl", HEADER + "Shape { geometry Sphere { } }")

    def talk(world, *more):
        return vv(world, "-o", "x%d.png", *arguments, *SMALL, *more).talk

    assert "empty.wrl: no shape to draw; the picture shows only the background" in talk("empty.wrl")
    assert talk("empty.wrl", "-q") == "" and "no shape" not in talk("ball.wrl")


def test_studio_is_the_same_on_any_number_of_threads(board):
    assert board.floats("--preset", "pcb", "--threads", "1") == board.floats(
        "--preset", "pcb", "--threads", "3")


def test_the_preset_knows_the_boards_materials(vv):
    done = vv(ROOT / "examples/kicad/blinker.wrl", "--preset", "pcb", "--write", "out.wrl")
    assert done.returncode == 0, done.talk
    assert 'name "Metal"' in (vv.folder / "out.wrl").read_text()


# Python -----------------------------------------------------------------------------------------

xvrml = pytest.importorskip("xvrml")


def test_set_shader(board):
    world = xvrml.load(board.folder / "board.wrl")
    assert world.set_shader("material:PIN-*", RED) == 1
    assert world.set_shader("material:IC-*", GREEN) == 1
    assert world.set_shader("*", BLUE) == 1
    row = world.render(size=(32, 24), spp=1).array[12]
    assert [tuple(row[x, :3]) for x in (6, 16, 26)] == [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    assert world.set_shader("material:PIN-01", GREEN) == 1  # in a world that runs
    row = world.render(size=(32, 24), spp=1).array[12]
    assert tuple(row[6, :3]) == (0, 1, 0)
    before = len(world.warnings)
    assert world.set_shader("material:none", RED) == 0
    assert len(world.warnings) == before + 1


@pytest.mark.parametrize("selector, shader, message", [
    ("material:PIN-*", "Metall", "there is no shader class"),
    ("Nothing", "Metal", "no node is called Nothing"),
    ("a=b", "Metal", "selector"),
    ("", "Metal", "selector"),
    ("colour:1", "Metal", "colour: R,G,B"),
    ("*", "Metal:roughness=x", "roughness"),
])
def test_wrong_set_shader(board, selector, shader, message):
    world = xvrml.load(board.folder / "board.wrl")
    with pytest.raises(ValueError, match=message):
        world.set_shader(selector, shader)
