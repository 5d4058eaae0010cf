"""Tests that no edit is lost, whatever ends the session: vv is killed while a program or a user edits, and
the next vv offers the edits, which it keeps beside the file."""
import os
import re
import signal
import subprocess
import threading
import time

import pytest

from conftest import HEADER, find_vv
from control_server import SMALL, module, refused, start  # noqa: F401
from editor_window import skip_without_editor
from window_driver import screen, window  # noqa: F401

WORLD = HEADER + """# The hall
DEF LAMP PointLight { intensity 0.80 # by day
}
DEF LEG Shape { geometry Box { size 1 1 1 } } # oak
"""
MOST_LOST = 5  # seconds


@pytest.fixture
def file(tmp_path):
    (tmp_path / "hall.wrl").write_text(WORLD)
    return tmp_path / "hall.wrl"


@pytest.fixture
def hall(start, file):
    """Returns a function that starts vv with the file, and gives the server."""
    return lambda: start("hall.wrl", *SMALL)


def journal_of(file, suffix=""):
    return file.with_name(f".{file.name}.vv-edits{suffix}")


def dim(vv, intensity):
    with vv.edit("Dim") as step:
        step.set("LAMP", "intensity", intensity)


def dimmed(intensity):
    return WORLD.replace("0.80", f"{intensity:g}")


def names(folder):
    """Lists the files of a folder, but for one that the fixture `start` writes."""
    return sorted(path.name for path in folder.iterdir() if path.name != "world.wrl")


def said(server, words):
    return server.wait(lambda: [line for line in server.err if words in line], words)


def kept(server, file, test=lambda text: True, suffix=""):
    """Waits until the journal holds a text like this."""

    def holds():
        path = journal_of(file, suffix)
        return path.exists() and path.stat().st_size > 0 and test(path.read_text())

    server.wait(holds, "the journal")


def kill(server):
    server.program.kill()
    server.program.wait()


@pytest.mark.parametrize("writes", [0, 1, 3])
def test_a_killed_session_loses_at_most_five_seconds(hall, file, writes):
    """Edits go on while vv is killed, after so many writes of the journal."""
    server = hall()
    vv = server.connect()
    seen, done = set(), []  # done: time and value of each edit
    killer = None
    try:
        for i in range(1, 100_000):
            value = i / 100_000
            dim(vv, value)
            done.append((time.monotonic(), value))
            if journal_of(file).exists():
                seen.add(journal_of(file).stat().st_ino)
            if len(seen) > writes and killer is None:
                killer = threading.Thread(target=kill, args=(server,))
                killer.start()
    except (ConnectionError, OSError):
        pass
    end = time.monotonic()
    killer.join()
    assert file.read_text() == WORLD

    after = hall()
    vv = after.connect()
    left = vv.edits()["recoverable"]
    if left is None:
        assert writes == 0 and end - done[0][0] < MOST_LOST
        return
    assert left["file"] == str(journal_of(file)) and abs(left["time"] - time.time()) < 60
    assert said(after, "unsaved edits")
    assert vv.recover() == "hall.wrl"
    state = vv.edits(text=True)
    assert state["changed"] and state["recoverable"] is None and state["undo"] is None
    word = re.search(r"intensity (\S+)", state["text"])[1]
    value = float(word)
    assert vv.get("LAMP", "intensity") == pytest.approx(value)
    first_lost = next((when for when, edited in done if edited > value * 1.000001), end)
    assert end - first_lost < MOST_LOST
    assert state["text"] == WORLD.replace("0.80", word)
    vv.save()
    assert file.read_text() == state["text"] and names(file.parent) == ["hall.wrl"]


def test_edits_that_were_taken_over_can_be_lost_no_more(hall, file):
    server = hall()
    vv = server.connect()
    dim(vv, 0.5)
    kept(server, file)
    kill(server)
    server = hall()
    server.connect().recover()
    kill(server)  # before anything else is done
    server = hall()
    vv = server.connect()
    vv.recover()
    with vv.edit("More") as step:
        step.remove("LEG")
    kept(server, file, lambda text: "LEG" not in text)
    kill(server)
    vv = hall().connect()
    vv.recover()
    vv.save()
    text = file.read_text()
    assert "intensity 0.5 # by day" in text and "LEG" not in text
    assert names(file.parent) == ["hall.wrl"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_vv_with_all_edits(hall, file, number):
    server = hall()
    vv = server.connect()
    for i in range(1, 50):
        dim(vv, i / 100)
    server.program.send_signal(number)
    assert server.program.wait(20) == 130
    server.reader.join(20)
    lines = [line for line in server.err if "unsaved edits" in line]
    assert len(lines) == 1 and str(journal_of(file)) in lines[0]
    vv = hall().connect()
    vv.recover()
    assert vv.edits(text=True)["text"] == dimmed(0.49)


def test_quit_keeps_edits_or_discards_them(hall, file):
    server = hall()
    vv = server.connect()
    dim(vv, 0.5)
    vv.quit()
    assert server.program.wait(20) == 0
    said(server, str(journal_of(file)))
    server = hall()
    vv = server.connect()
    assert vv.edits()["recoverable"]
    assert vv.recover(use=False) is None
    assert vv.edits()["recoverable"] is None and names(file.parent) == ["hall.wrl"]
    refused("edit", "no edits", vv.recover)
    dim(vv, 0.25)
    kept(server, file)
    vv.quit(discard=True)
    assert server.program.wait(20) == 0
    assert names(file.parent) == ["hall.wrl"] and file.read_text() == WORLD
    assert not [line for line in server.err if "are in" in line]


def test_another_world_takes_no_edits_away(hall, file):
    other = file.with_name("other.wrl")
    other.write_text(HEADER)
    server = hall()
    vv = server.connect()
    dim(vv, 0.5)
    vv.load("other.wrl")
    said(server, str(journal_of(file)))
    vv.load("hall.wrl")
    assert vv.edits()["recoverable"]
    vv.recover()
    assert vv.edits(text=True)["text"] == dimmed(0.5)
    dim(vv, 0.25)
    vv.replace_world([vv.create("Group {}").nodes[0]])
    said(server, "has taken the place")
    refused("edit", "has taken the place", vv.save)
    vv.load("hall.wrl")
    vv.recover()
    vv.save()
    assert file.read_text() == dimmed(0.25)
    assert names(file.parent) == ["hall.wrl", "other.wrl"]


def test_a_script_takes_no_edits_away(start, file):
    file.write_text(WORLD + """DEF CLOCK TimeSensor { }
DEF END Script { eventIn SFTime go url "javascript:
  function go() { Browser.loadURL(new MFString('other.wrl'), new MFString()); }" }
ROUTE CLOCK.startTime TO END.go
""")
    file.with_name("other.wrl").write_text(HEADER)
    server = start("hall.wrl", *SMALL)
    vv = server.connect()
    dim(vv, 0.5)
    vv.set("CLOCK", "startTime", 1)
    said(server, str(journal_of(file)))
    assert "intensity 0.5 " in journal_of(file).read_text()


def test_undo_to_what_was_saved_leaves_nothing(hall, file):
    server = hall()
    vv = server.connect()
    dim(vv, 0.5)
    kept(server, file)
    vv.undo()
    server.wait(lambda: names(file.parent) == ["hall.wrl"], "the journal")
    vv.redo()
    kept(server, file)
    vv.save()
    assert names(file.parent) == ["hall.wrl"]


def test_two_sessions_keep_their_own(hall, file):
    servers = [hall(), hall()]
    clients = [server.connect() for server in servers]
    for client, value in zip(clients, (0.5, 0.25)):
        dim(client, value)
    texts = {}

    def both():
        for suffix in ("", "-2"):
            path = journal_of(file, suffix)
            if not path.exists() or path.stat().st_size == 0:
                return False
            texts[suffix] = path.read_text()
        return True

    servers[0].wait(both, "two journals")
    assert sorted(re.search(r"intensity (\S+)", text)[1] for text in texts.values()) == ["0.25", "0.5"]
    third = hall()
    assert third.connect().edits()["recoverable"] is None, "both are in use"
    for server in servers:
        kill(server)
    vv = hall().connect()
    vv.recover()
    vv.save()  # the other one belongs to another text now
    last = hall()
    assert last.connect().edits()["recoverable"] is None
    said(last, "has changed since")


def link(path, good):
    path.with_name("precious").write_text("precious")
    path.symlink_to("precious")


def large(path, good):
    with open(path, "wb") as out:
        out.truncate(100 << 20)


HOSTILE = {
    "truncated": lambda path, good: path.write_text(good[:-5]),
    "a piece of the head": lambda path, good: path.write_text(good[:30]),
    "a link": link,
    "a link to nothing": lambda path, good: path.symlink_to("nowhere"),
    "a folder": lambda path, good: path.mkdir(),
    "a pipe": lambda path, good: os.mkfifo(path),
    "100 MB": large,
    "of another file": lambda path, good: path.write_text(good.replace("base 1", "base 2", 1)),
    "garbage": lambda path, good: path.write_bytes(bytes(range(256)) * 20),
    "changed": lambda path, good: path.write_text(good.replace("0.5", "0.6")),
}


@pytest.mark.parametrize("kind", HOSTILE)
def test_what_is_no_journal_is_refused_with_one_message(hall, file, kind):
    server = hall()
    dim(server.connect(), 0.5)
    kept(server, file)
    kill(server)
    journal = journal_of(file)
    good = journal.read_text()
    journal.unlink()
    HOSTILE[kind](journal, good)
    status = journal.lstat()
    before = names(file.parent)
    server = hall()
    vv = server.connect()
    assert vv.edits()["recoverable"] is None
    refused("edit", "no edits", vv.recover)
    assert len(said(server, str(journal))) == 1
    dim(vv, 0.25)
    kept(server, file, suffix="-2")
    vv.save()
    assert file.read_text() == dimmed(0.25)
    assert names(file.parent) == before
    now = journal.lstat()
    assert (now.st_ino, now.st_size, now.st_mode) == (status.st_ino, status.st_size, status.st_mode)
    if kind == "a link":
        assert journal.with_name("precious").read_text() == "precious"
    assert len([line for line in server.err if str(journal) in line]) == 1


def test_an_empty_journal_is_spoken_of_and_removed(hall, file):
    journal_of(file).write_bytes(b"")
    server = hall()
    vv = server.connect()
    assert vv.edits()["recoverable"] is None
    assert len(said(server, f"{journal_of(file)} was empty")) == 1
    assert names(file.parent) == ["hall.wrl"]
    dim(vv, 0.5)
    kept(server, file)


def test_a_text_that_is_no_world_any_more_is_refused(hall, file):
    """Its hashes are right: somebody has made it so."""
    server = hall()
    dim(server.connect(), 0.5)
    kept(server, file)
    kill(server)
    head = journal_of(file).read_text().splitlines(keepends=True)[:2]
    # XXH3 of an empty text, with 64 bits
    journal_of(file).write_text("".join(head) + "text 0 2d06800538d394c2\n\n")
    vv = hall().connect()
    assert vv.edits()["recoverable"]
    with pytest.raises(module().ControlError):
        vv.recover()
    assert vv.get("LAMP", "intensity") == pytest.approx(0.8) and journal_of(file).exists()


def test_where_nothing_can_be_written_it_is_spoken_of_once(hall, file):
    """Root may write everywhere; so all names that a journal may have are taken."""
    for suffix in ("", *(f"-{number}" for number in range(2, 10))):
        journal_of(file, suffix).mkdir()
    server = hall()
    vv = server.connect()
    dim(vv, 0.5)
    said(server, "kept nowhere")
    dim(vv, 0.25)
    assert vv.undo() and vv.redo()
    server.program.send_signal(signal.SIGTERM)
    assert server.program.wait(20) == 130
    server.reader.join(20)
    assert len([line for line in server.err if "kept nowhere" in line]) == 1
    assert len([line for line in server.err if "are lost" in line]) == 1


def test_a_picture_says_that_there_are_edits(hall, file):
    server = hall()
    dim(server.connect(), 0.5)
    kept(server, file)
    kill(server)
    done = subprocess.run([find_vv(), "hall.wrl", "-o", "x.png", *SMALL],
                          cwd=file.parent,
                          capture_output=True,
                          text=True)
    assert done.returncode == 0
    assert len([line for line in done.stderr.splitlines() if str(journal_of(file)) in line]) == 1


# --- In the window ---


@pytest.fixture
def editor(window, vv):
    """Returns a function that opens a window for a file."""
    skip_without_editor(vv)
    (vv.folder / "hall.wrl").write_text(STAGE)
    return lambda: window("hall.wrl", "--size", "600x400")


STAGE = HEADER + """
Viewpoint { position 0 0 10 fieldOfView 0.785398 }
DEF LEFT Transform { # moved by hand
  translation -1 0 0 children Shape { appearance Appearance { material Material { diffuseColor 1 0 0 } } geometry Box {} } }
DEF RIGHT Transform { translation 2 0 0 children
  Shape { appearance Appearance { material Material { diffuseColor 0 0 1 } } geometry Box {} } }
"""


def remove_left(w):
    w.key("e")
    w.click(-0.12, 0)
    w.key("Delete")


def removed(path):
    return path.exists() and path.stat().st_size > 0 and "diffuseColor 1 0 0" not in path.read_text()


def test_a_window_offers_what_a_killed_one_has_left(editor, vv):
    world, journal = vv.folder / "hall.wrl", vv.folder / ".hall.wrl.vv-edits"
    w = editor()
    remove_left(w)
    w.wait(lambda: removed(journal), "the journal")
    w.program.kill()
    w.program.wait()
    assert world.read_text() == STAGE

    w = editor()
    w.said("unsaved edits")
    w.key("e", "Escape")  # later
    w.key("q")
    assert w.program.wait(20) == 0 and removed(journal)

    w = editor()
    w.key("e", "Return")  # uses them
    w.said("first picture", 2)
    w.key("ctrl+s")
    w.wait(lambda: world.read_text() != STAGE, "the file")
    text = world.read_text()
    assert "diffuseColor 1 0 0" not in text and "# moved by hand" in text
    w.wait(lambda: not journal.exists(), "the journal")
    assert w.end() == 0


def test_a_window_that_gets_a_signal_keeps_edits(editor, vv):
    journal = vv.folder / ".hall.wrl.vv-edits"
    w = editor()
    remove_left(w)
    w.wait(lambda: removed(journal), "the journal")
    w.key("ctrl+z")
    w.wait(lambda: not journal.exists(), "no journal")
    w.key("ctrl+y")
    w.wait(lambda: removed(journal), "the journal")
    w.program.send_signal(signal.SIGTERM)
    assert w.program.wait(20) == 130
    assert removed(journal)


def test_what_is_typed_at_once_answers_the_question(editor, vv):
    world = vv.folder / "hall.wrl"
    w = editor()
    remove_left(w)
    w.key("q", "Return")  # saves, and ends
    assert w.program.wait(20) == 0
    assert "diffuseColor 1 0 0" not in world.read_text()
    assert ".hall.wrl.vv-edits" not in names(vv.folder)


def test_a_file_that_has_changed_is_not_replaced_by_what_is_typed(editor, vv):
    world = vv.folder / "hall.wrl"
    w = editor()
    remove_left(w)
    w.wait(lambda: removed(vv.folder / ".hall.wrl.vv-edits"), "the journal")
    world.write_text(STAGE + "# by another program\n")
    w.key("ctrl+s", "Return", "Delete", "Escape", "ctrl+z", "ctrl+s")
    # The question got Escape, and nothing before; then the edit was undone.
    w.wait(lambda: not (vv.folder / ".hall.wrl.vv-edits").exists(), "the undo")
    assert world.read_text() == STAGE + "# by another program\n"
