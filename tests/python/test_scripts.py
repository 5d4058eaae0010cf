"""Tests Scripts in Python inside a Python program: they use the running interpreter and the node
objects of the binding."""
import gc
import os
import pathlib
import subprocess
import sys
import threading
import weakref

import pytest

pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")

ENGINES = pathlib.Path(xvrml.__file__).resolve().parents[2] / "lib/xvrml/scripts"
HEADER = b"#VRML V2.0 utf8\n"
pytestmark = pytest.mark.skipif(not (ENGINES / "python.so").exists(),
                                reason="the engine python is not built")


def browser(world, **options):
    options.setdefault("trust", True)
    return xvrml.Browser(HEADER + world.encode(), script_path=ENGINES, **options)


def messages(b):
    return [f"{w.line}: {w.message}" for w in b.warnings]


ECHO = """DEF T Transform { children DEF G Shape { } }
DEF S Script { directOutput TRUE eventIn SFNode node eventIn MFNode nodes eventIn MFVec3f points field SFNode t USE T
  eventOut SFNode out eventOut MFVec3f moved
  url "python:
import xvrml
seen = []
def initialize():
    seen.append(script.t)
    script.t.translation = 1, 2, 3
def node(value, timestamp):
    seen.append(value)
    script.out = value
    value.translation = 4, 5, timestamp
    seen.append(value.translation)
def points(value):
    seen.append(value)
    script.moved = value + 1
import builtins
builtins.seen_by_script = seen
" }"""


def test_a_script_sees_the_same_nodes():
    b = browser(ECHO, epoch=0)  # a translation cannot hold the digits of seconds since 1970
    seen = sys.modules["builtins"].seen_by_script
    assert messages(b) == []
    assert b["T"].translation == (1, 2, 3)  # sent by initialize(), while the browser is created
    assert seen[0] == b["T"] and hash(seen[0]) == hash(b["T"]) and type(seen[0]) is xvrml.Transform
    b.tick(7)
    b["S"].node = b["T"]
    assert messages(b) == []
    assert seen[1] == b["T"] == b["S"].out
    assert seen[2] == (1, 2, 3)  # the assignment is sent when the function returns
    assert b["T"].translation == (4, 5, 7)
    b["S"].points = [[1, 2, 3], [4, 5, 6]]
    assert not seen[3].flags.writeable and seen[3].shape == (2, 3)
    assert (b["S"].moved == [[2, 3, 4], [5, 6, 7]]).all()


def test_nodes_of_a_script_are_taken_where_nodes_are():
    b = browser(ECHO)
    kept = sys.modules["builtins"].seen_by_script[0]
    b["S"].node = kept
    assert b["S"].out == b["T"]
    heard = []
    b.listen(kept, "translation_changed", lambda value, now: heard.append(value))
    kept.translation = 9, 9, 9  # outside of functions: immediately, as with any node
    assert heard == [(9, 9, 9)] and b["T"].translation == (9, 9, 9)
    other = browser("DEF T Transform { } DEF S Script { field SFNode t NULL }")
    with pytest.raises(ValueError, match="of the same world"):
        other["S"].t = kept
    with pytest.raises(ValueError, match="of this browser"):
        other.add_root(kept)


def test_a_browser_ends_although_its_script_keeps_nodes():
    b = browser(ECHO)
    kept = sys.modules["builtins"].seen_by_script[0]
    gone = weakref.ref(kept) if hasattr(type(kept), "__weakref__") else None
    del b
    gc.collect()
    assert kept.translation == (1, 2, 3)  # the node can still be read
    with pytest.raises(ValueError, match="has ended"):
        kept.translation = 0, 0, 0
    del kept, gone


def test_only_trusted_worlds_run_python():
    b = browser(ECHO, trust=False)
    assert b["T"].translation == (0, 0, 0)
    assert any("only in worlds that are trusted" in m for m in messages(b))


def test_scripts_share_the_program_modules():
    import conftest
    conftest.from_script = None
    browser('Script { url "python:import conftest\nconftest.from_script = 42" }')
    assert conftest.from_script == 42


def test_errors_are_the_worlds_not_the_programs():
    b = browser(
        'DEF S Script { eventIn SFBool go url "python:\ndef go(v):\n    raise KeyError(1)" }')
    b["S"].go = True
    assert messages(b) == ["4: Script S: KeyError: 1"]


def test_sys_exit_ends_no_program():
    b = browser(
        'DEF S Script { eventIn SFBool go url "python:import sys\ndef go(v): sys.exit(3)" }')
    b["S"].go = True
    assert messages(b) == ["3: Script S: the Script has ended itself (SystemExit: 3)"]


LOOP = 'DEF S Script { eventIn SFBool go url "python:\ndef go(v):\n    while True:\n        try: x = 1\n        except: pass" }'


def test_an_endless_loop_is_stopped():
    b = browser(LOOP)
    b["S"].go = True
    assert messages(b)[-1] == "2: Script S: event took too long: the Script is stopped"
    assert sys.gettrace() is None


def test_an_endless_loop_is_stopped_on_any_thread():
    found = []

    def work():
        b = browser(LOOP)
        b["S"].go = True
        found.extend(messages(b))
        found.append(sys.gettrace())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join(60)
    assert not thread.is_alive()
    assert found[-2:] == ["2: Script S: event took too long: the Script is stopped", None]


def test_threads_of_the_program_go_on_while_worlds_run():
    b = browser(
        'DEF S Script { eventIn SFInt32 n eventOut SFInt32 sum field SFInt32 s 0 url "python:\n'
        'def n(v):\n    script.s += v\n    script.sum = script.s" }')
    counts = [0]
    end = threading.Event()

    def count():
        while not end.is_set():
            counts[0] += 1

    thread = threading.Thread(target=count)
    thread.start()
    for i in range(200):
        b["S"].n = i
    end.set()
    thread.join()
    assert b["S"].sum == sum(range(200)) and counts[0] > 0
    assert messages(b) == []


def test_an_interrupt_of_a_script_is_one_of_the_program():
    b = browser(
        'DEF S Script { eventIn SFBool go url "python:import signal\ndef go(v):\n    signal.raise_signal(2)\n    x = 1" }'
    )
    with pytest.raises(KeyboardInterrupt):
        b["S"].go = True
        for _ in range(1000):
            pass
    assert messages(b) == ["4: Script S: KeyboardInterrupt"]


def test_a_program_may_end_before_its_worlds():
    code = f"""import xvrml
world = '#VRML V2.0 utf8\\nScript {{ field SFNode n Group {{ }} url "python:kept = script.n\\ndef shutdown(): print(1)" }}'
browser = xvrml.Browser(world.encode(), script_path={str(ENGINES)!r}, trust=True)
other = xvrml.Browser(world.encode(), script_path={str(ENGINES)!r}, trust=True)
print(len(browser.warnings))"""
    done = subprocess.run([sys.executable, "-c", code],
                          capture_output=True,
                          text=True,
                          timeout=60,
                          env={
                              **os.environ, "PYTHONPATH":
                                  str(pathlib.Path(xvrml.__file__).parents[1])
                          })
    assert done.returncode == 0 and done.stderr == "" and done.stdout == "0\n", (done.stdout,
                                                                                 done.stderr)


def test_memory_is_limited_for_scripts_alone():
    b = browser(
        'DEF S Script { eventIn SFBool go eventOut SFBool out url "python:\ndef go(v):\n    x = bytearray(10**9)" }'
    )
    b["S"].go = True
    assert messages(b) == ["4: Script S: MemoryError (a Script may use 256 MiB)"]
    assert len(bytearray(300 << 20)) == 300 << 20
