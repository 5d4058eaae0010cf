"""Tests the panel of examples/scenes/chess.tcl under Xvfb: clicks in it move the pieces.
$CHESS_PICTURES names a folder that keeps pictures of it."""
import os
import shutil
import subprocess
import sys
import textwrap
import time

import pytest
from conftest import ROOT, find_vv
from xserver import display

pytest.importorskip("numpy")
pytest.importorskip("xvrml")

if not (find_vv().parents[1] / "lib/xvrml/scripts/tcl.so").exists():
    pytest.skip("the Tcl engine is not built", allow_module_level=True)
for program in ("Xvfb", "xdotool"):
    if not shutil.which(program):
        pytest.skip(f"{program} is not installed", allow_module_level=True)

# The Script, and a way to query it.
DRIVER = """
source [file join [file dirname [info script]] chess.tcl]
proc ask {script time} {if {[catch {uplevel #0 $script} answer]} {set answer "error: $answer"}; set ::answer $answer}
"""

START = """
import subprocess, sys, time
import xvrml
b = xvrml.Browser(sys.argv[1], trust=True)
now = 0.0
def some(seconds=0.2):
    global now
    end = now + seconds
    while now < end:
        now += 1 / 60
        b.tick(now)
        time.sleep(0.004)
def ask(script):
    b["Chess"].ask = script
    answer = b["Chess"].answer
    assert not answer.startswith("error: "), answer
    return answer
def until(condition):
    end = time.monotonic() + 30
    while not condition():
        assert time.monotonic() < end, (b["Chess"].status, b.warnings)
        some()
def click(window):
    x, y, w, h = map(int, ask(f"list [winfo rootx {window}] [winfo rooty {window}] [winfo width {window}] [winfo height {window}]").split())
    subprocess.run(["xdotool", "mousemove", str(x + w // 2), str(y + h // 2)], check=True)
    some()
    subprocess.run(["xdotool", "click", "1"], check=True)
    some()
def fen(): return b["Chess"].position
def place(name): return tuple(round(x, 4) for x in b[name].translation)
def keep(name):
    import os
    folder = os.environ.get("CHESS_PICTURES")
    if folder: subprocess.run(["import", "-window", "root", f"{folder}/{name}.png"], check=True)
until(lambda: ask("winfo ismapped .board.e2") == "1")
some(0.5)
"""


@pytest.fixture
def panel(tmp_path):
    scenes = ROOT / "examples/scenes"
    for name in ("chess.tcl", "chess_panel.tcl", "studio.png"):
        shutil.copy(scenes / name, tmp_path / name)
    (tmp_path / "driver.tcl").write_text(DRIVER)
    text = (scenes / "chess.wrl").read_text()
    changed = text.replace('url "chess.tcl"',
                           'url "driver.tcl" eventIn SFString ask eventOut SFString answer')
    assert changed != text
    (tmp_path / "chess.wrl").write_text(changed)
    (tmp_path / "plain.wrl").write_text(text)

    def run(program):
        with display():
            done = subprocess.run([
                sys.executable, "-c", START + textwrap.dedent(program),
                str(tmp_path / "chess.wrl")
            ],
                                  capture_output=True,
                                  text=True,
                                  timeout=120,
                                  env=os.environ)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    return run


def test_three_moves_are_made_with_the_pointer(panel):
    panel("""
        for start, end in (("e2", "e4"), ("e7", "e5"), ("g1", "f3")):
            click(".board." + start)
            keep("selected_" + start)
            click(".board." + end)
            some(1.2)
        keep("three_moves")
        assert fen() == "rnbqkbnr/pppp1ppp/8/4p3/4P3/5N2/PPPP1PPP/RNBQKB1R b KQkq - 1 2"
        assert b["Chess"].status == "Black to move"
        assert place("Piece_e2") == (0.5, 0, 0.5) and place("Piece_e7") == (0.5, 0, -0.5) and place("Piece_g1") == (1.5, 0, 1.5)
        assert place("Piece_d2") == (-0.5, 0, 2.5)
        assert ask(".board.f3 cget -text") == "\\u265e"
        assert ask(".tabs.game.moves get 0 end").split() == ["{", "1.", "e4", "e5}", "{", "2.", "Nf3", "}"]
        # A square that is no move of the piece: nothing happens.
        click(".board.d7"); click(".board.d4"); some(1)
        assert fen().startswith("rnbqkbnr/pppp1ppp/8/4p3/4P3/5N2/PPPP1PPP/RNBQKB1R")
        assert b.warnings == []
    """)


def test_the_picture_is_the_one_of_the_same_moves(panel):
    panel("""
        for start, end in (("d2", "d4"), ("g8", "f6"), ("c1", "g5")):
            click(".board." + start)
            click(".board." + end)
            some(1.2)
        other = xvrml.Browser(sys.argv[1].replace("chess.wrl", "plain.wrl"))  # not trusted: no panel, the Script in its own process
        before = other.render(size=(64, 48), spp=1).display.tobytes()
        for i, move in enumerate(("d4", "Nf6", "Bg5")):
            other["Chess"].play = move
            other.tick(2.0 * i + 1)
            other.tick(2.0 * i + 2)
        assert other["Chess"].position == fen() == "rnbqkb1r/pppppppp/5n2/6B1/3P4/8/PPP1PPPP/RN1QKBNR b KQkq - 2 2"
        seen, wanted = (x.render(size=(64, 48), spp=1).display.tobytes() for x in (b, other))
        assert seen == wanted and seen != before
    """)


def test_beside_the_picture_of_vv(vv):
    """Runs vv's window and the panel in one program and makes three moves with the pointer."""
    scenes = ROOT / "examples/scenes"
    for name in ("chess.tcl", "chess_panel.tcl", "studio.png"):
        shutil.copy(scenes / name, vv.folder / name)
    # The driver moves the panel away from the picture, prints where its squares are, and writes
    # down each position.
    vv.write(
        "driver.tcl", DRIVER + """
set folder [file dirname [info script]]
proc keep {name text} {
  set channel [open [file join $::folder $name.new] w]
  puts $channel $text
  close $channel
  file rename -force [file join $::folder $name.new] [file join $::folder $name]
}
trace add variable position write {apply {args {keep position $::position}}}
proc where {} {
  if {[winfo ismapped .board.e2] && [winfo rootx .] >= 340} {
    keep squares [lmap name {e2 e4 e7 e5 g1 f3} {
      list [expr {[winfo rootx .board.$name] + 20}] [expr {[winfo rooty .board.$name] + 20}]
    }]
  } else {
    after 100 where
  }
}
after 200 {wm geometry . +340+0; where}
""")
    vv.write("chess.wrl", (scenes / "chess.wrl").read_text().replace('url "chess.tcl"',
                                                                     'url "driver.tcl"'))
    read = lambda name: (vv.folder / name).read_text() if (vv.folder / name).exists() else ""
    with display("1280x800"):
        program = vv.start("chess.wrl", "--trust", "--size", "160x120")
        try:

            def until(condition):
                end = time.monotonic() + 90
                while not condition():
                    if program.poll() is not None and b"no window" in (talk :=
                                                                       program.stderr.read()):
                        pytest.skip("vv is built without a window")
                    assert program.poll() is None and time.monotonic() < end, (read("position"),
                                                                               program.poll())
                    time.sleep(0.1)

            until(lambda: read("squares"))
            squares = [
                tuple(pair.split())
                for pair in read("squares").replace("} {", "\n").strip("{}\n ").splitlines()
            ]
            for i, placement in enumerate(("rnbqkbnr/pppppppp/8/8/4P3/8/PPPP1PPP/RNBQKBNR",
                                           "rnbqkbnr/pppp1ppp/8/4p3/4P3/8/PPPP1PPP/RNBQKBNR",
                                           "rnbqkbnr/pppp1ppp/8/4p3/4P3/5N2/PPPP1PPP/RNBQKB1R")):
                for x, y in squares[2 * i:2 * i + 2]:
                    subprocess.run([
                        "xdotool", "mousemove", x, y, "sleep", "0.3", "click", "1", "sleep", "0.3"
                    ],
                                   check=True)
                until(lambda: read("position").startswith(placement))
            names = subprocess.run(["xdotool", "search", "--onlyvisible", "--name", "chess.wrl"],
                                   capture_output=True,
                                   text=True).stdout.split()
            assert names  # the picture's own window is there
        finally:
            program.terminate()
            program.communicate(timeout=60)


def test_its_game_is_stepped_played_and_taken_back(panel):
    panel("""
        game = ".tabs.game.buttons."
        for _ in range(3): click(game + "step")
        some(1.2)
        assert fen().split()[0] == "rnbqkbnr/pppp1ppp/8/4p3/4P3/5N2/PPPP1PPP/RNBQKB1R"
        click(game + "back"); some(1.2)
        assert place("Piece_g1") == (2.5, 0, 3.5) and fen().split()[1] == "w"
        click(game + "play")
        until(lambda: fen().split()[5] == "4")
        click(game + "play")
        some(1.5)
        stopped = fen()
        some(3)
        assert fen() == stopped
        click(game + "reset"); some(0.2)
        assert fen() == "rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR w KQkq - 0 1"
        assert place("Piece_e2") == (0.5, 0, 2.5) and place("Piece_g8") == (2.5, 0, -3.5)
        assert b.warnings == []
    """)


def test_a_pgn_file_is_opened_and_a_move_is_typed(panel):
    panel(r"""
        ask(r'panel::openText "\[White \"A\"\]\n1. d4 {x} d5 (1... Nf6) 2. c4 dxc4 *\n\[White \"B\"\]\n1. c4 *"')
        assert ask(".tabs.game.games cget -values") == "{A - ? } {B - ? }"
        for _ in range(4):
            ask("panel::step")
            some(1.2)
        keep("captured")
        assert fen() == "rnbqkbnr/ppp1pppp/8/8/2pP4/8/PP2PPPP/RNBQKBNR w KQkq - 0 3"
        assert place("Piece_c2")[0] > 4.8
        ask(".tabs.game.enter.move insert 0 Qa4+; panel::enter")
        some(1.2)
        assert b["Chess"].status == "Black to move, in check"
        assert place("Piece_d1") == (-3.5, 0, 0.5)
        keep("check")
        ask("panel::openFile /no/such/file")
        assert "no such file" in ask(".status cget -text")
        ask('panel::openText "1. e4 e5 2. Ke3"')
        assert "illegal move: Ke3" in ask(".status cget -text")
    """)


def test_looks_change_materials_shaders_and_the_light(panel):
    panel("""
        ask(".tabs select .tabs.looks"); some(0.5)
        ask(".tabs.looks.red set 0.25"); some()
        assert abs(b["White_Material"].diffuseColor[0] - 0.25) < 1e-6
        keep("looks")
        ask("set panel::kind Marble; panel::changed"); some()
        assert b["White_Shader"].file == "marble" and b["White_Shader"].name == "Marble"
        kind, name, *stone = list(b["White_Shader"].options)[0].split()
        assert (kind, name) == ("color", "stone")
        for got, screen in zip(stone, (0.25, 0.87, 0.72)):
            assert abs(float(got) - ((screen + 0.055) / 1.055) ** 2.4) < 1e-3
        ask("set panel::part {Dark squares}; panel::choosePart"); some(0.3)
        ask("set panel::kind Glass; panel::changed"); some()
        assert b["Dark_Squares_Shader"].file == "glass" and b["Board_Shader"].file == "plastic"
        ask(".tabs.looks.light set 2"); some()
        assert list(b["Lamp_Shader"].options) == ["color reflectance 0 0 0", "color emission 26 24 20.4"]
        assert b.warnings == []
    """)


def test_closing_the_panel_leaves_the_set(panel):
    panel("""
        b["Chess"].play = "e4"; some(1.2)
        ask("destroy .")
        b["Chess"].play = "e5"; some(1.2)
        assert fen().split()[0] == "rnbqkbnr/pppp1ppp/8/4p3/4P3/8/PPPP1PPP/RNBQKBNR"
        assert place("Piece_e7") == (0.5, 0, -0.5)
        assert b.warnings == [], b.warnings
    """)
