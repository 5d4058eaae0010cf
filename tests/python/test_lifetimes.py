"""Tests objects that were never initialised, the end of the interpreter while threads work, and
graphs built from the leaf up. Each test has a Python process of its own, because a failure ends the
process."""
import inspect
import subprocess
import sys
import textwrap
import time

import pytest

xvrml = pytest.importorskip("xvrml")

BOX = """#VRML V2.0 utf8
Shape { appearance Appearance { material Material { } } geometry Box { } }
"""


def python(code, *arguments, timeout=120):
    return subprocess.run(
        [sys.executable, "-X", "faulthandler", "-c",
         textwrap.dedent(code), *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=timeout)


# Objects without __init__ -----------------------------------------------------------------------

# Uses all methods, attributes and operators of a class, and passes the object as an argument to
# every function.
EMPTY = """
import importlib, inspect, operator, sys
sys.setrecursionlimit(200)
place, name = sys.argv[1].rsplit(".", 1)
module = importlib.import_module(place) if place != "xvrml._xvrml.rt" else __import__("xvrml._xvrml")._xvrml.rt
made = getattr(module, name)
try:
    one = made.__new__(made)
except TypeError:
    print("is not made without __init__")
    sys.exit()

def attempt(what, *arguments):
    try:
        return what(*arguments)
    except Exception as error:
        return error

for attribute in sorted(set(dir(made)) | set(dir(type(made)))):
    if attribute in ("__new__", "__class__", "__init__", "__init_subclass__", "__subclasshook__", "mro", "__abstractmethods__"):
        continue
    found = attempt(getattr, one, attribute)
    if callable(found) and not isinstance(found, type):
        for arguments in ((), (one,), (0,), ("x",), (one, one), (0, "x")):
            attempt(found, *arguments)
    attempt(setattr, one, attribute, 1)
for what in (repr, str, hash, len, iter, bool, list, memoryview, operator.index, bytes):
    attempt(what, one)
for what in (operator.eq, operator.lt, operator.getitem, operator.contains, operator.add):
    attempt(what, one, one)
    attempt(what, one, 0)
try:
    import numpy
    attempt(numpy.asarray, one)
except ImportError:
    pass
import xvrml
functions = [f for space in (xvrml, xvrml._xvrml, xvrml._xvrml.rt) for f in vars(space).values() if callable(f)]
for function in functions:
    if getattr(function, "__module__", "").startswith("xvrml"):
        attempt(function, one)
attempt(lambda: xvrml.Group(children=[one]))
attempt(lambda: xvrml.Shape(geometry=one))
attempt(lambda: xvrml.World([one]))
print("all of it refused or answered")
"""


def all_classes():
    import xvrml._xvrml
    found = {}
    modules = [
        m for name, m in sys.modules.items() if name == "xvrml" or name.startswith("xvrml.")
    ] + [xvrml._xvrml.rt]
    for module in modules:
        where = "xvrml._xvrml.rt" if module is xvrml._xvrml.rt else module.__name__
        for name, one in vars(module).items():
            if inspect.isclass(one) and str(getattr(one, "__module__", "")).startswith("xvrml"):
                found.setdefault(one, f"{where}.{name}")
    return found


def test_objects_made_by_new_alone_raise_and_never_crash():
    classes = all_classes()
    names = {place.rsplit(".", 1)[1] for place in classes.values()}
    assert {
        "Node", "Box", "Transform", "Picture", "Mesh", "World", "Browser", "Diagnostic",
        "ViewpointInfo", "Worker", "Context", "Texture", "Light", "Shader", "Instance"
    } <= names
    # Node types share a class in C++, so a few of them stand for all.
    nodes = [c for c in classes if issubclass(c, xvrml.Node)]
    chosen = [c for c in classes if c not in nodes
             ] + [xvrml.Node, xvrml.Box, xvrml.Transform, xvrml.IndexedFaceSet]
    bad = []
    running = []
    for one in chosen:
        running.append((one,
                        subprocess.Popen([sys.executable, "-c", EMPTY, classes[one]],
                                         stdout=subprocess.PIPE,
                                         stderr=subprocess.PIPE,
                                         text=True)))
        if len(running) == 4 or one is chosen[-1]:
            for made, process in running:
                out, err = process.communicate(timeout=120)
                if process.returncode != 0 or not out.strip():
                    bad.append(f"{classes[made]}: {process.returncode}: {err[-300:]}")
            running = []
    assert not bad, "\n".join(bad)


@pytest.mark.parametrize("name, attribute", [("Node", "fields"), ("Box", "size"),
                                             ("Picture", "shape"), ("Mesh", "vertices")])
def test_the_message_says_what_is_missing(name, attribute):
    made = getattr(xvrml, name)
    empty = made.__new__(made)
    with pytest.raises(TypeError, match="__init__"):
        getattr(empty, attribute)


def test_copies_are_made_or_refused_and_never_crash():
    """Python's copy protocol makes objects with __new__ of a base class."""
    done = python("""
        import copy, pickle, xvrml, xvrml.rt
        world = xvrml.load(b"#VRML V2.0 utf8\\nDEF B Shape { geometry Box { } }")
        context = xvrml.rt.Context(threads=1)
        for one in (xvrml.Box(), world, world["B"], xvrml.Browser(b"#VRML V2.0 utf8\\n"), world.render(size=(4, 3), spp=1), context,
                    world.viewpoints, xvrml.Box):
            for way in (copy.copy, copy.deepcopy, *(lambda x, p=p: pickle.loads(pickle.dumps(x, p)) for p in range(6))):
                try:
                    repr(way(one))
                except (TypeError, AttributeError, ValueError, RuntimeError, pickle.PicklingError):
                    pass
        for base in xvrml.Box.__mro__:
            try:
                base()
            except TypeError:
                pass
        print("done")
    """)
    assert done.returncode == 0 and done.stdout == "done\n", (done.returncode, done.stderr[-800:])


def test_a_class_that_forgets_its_base_is_told():

    class Mine(xvrml.Box):

        def __init__(self):
            pass

    with pytest.raises(TypeError, match="__init__"):
        Mine()


# The interpreter's end --------------------------------------------------------------------------

ENDING = """
import sys, threading, time, xvrml
world = xvrml.load(b'''{world}''')
browser = xvrml.Browser(b'''{world}''')
started = threading.Event()
def run():
    while True:
        started.set()
        {work}
for _ in range({threads}):
    threading.Thread(target=run, daemon=True).start()
started.wait()
time.sleep({pause})
print("ends", flush=True)
"""


@pytest.mark.parametrize("work", [
    "world.render(size=(400, 300), spp=64)", "world.render(size=(64, 48), spp=1)",
    "browser.tick(0.001)",
    "world.occluded([[0, 0, 5]], [[0, 0, -1]]) if hasattr(world, 'occluded') else world.bounds",
    "xvrml.load(b'#VRML V2.0 utf8 Group { }')", "xvrml.Group(children=[xvrml.Group()])",
    "world.render(size=(400, 300), spp=16, progress=lambda f: None)"
])
def test_the_interpreter_ends_while_a_daemon_thread_works(work):
    for pause in (0.02, 0.1, 0.3):
        code = ENDING.format(world=BOX.replace("\n", " ").replace("utf8 ", "utf8\\n", 1),
                             work=work,
                             threads=2,
                             pause=pause)
        begin = time.monotonic()
        done = python(code)
        assert done.returncode == 0, (pause, done.returncode, done.stderr[-1000:])
        assert done.stdout == "ends\n" and "FATAL" not in done.stderr and "terminate" not in done.stderr
        assert time.monotonic() - begin < 60


@pytest.mark.parametrize("work", [
    "world.meshes()", "world.to_vrml()", "xvrml.loads('#VRML V2.0 utf8 Group { }')",
    "browser.tick(browser.now)"
])
@pytest.mark.timed
def test_the_end_does_not_wait_for_threads_that_begin_again_and_again(work):
    code = ENDING.format(world=BOX.replace("\n", " ").replace("utf8 ", "utf8\\n", 1),
                         work=work,
                         threads=3,
                         pause=0.1)
    code = code.replace('print("ends"', 'begin = time.monotonic()\nprint("ends"')
    code = "import atexit, time\natexit.register(lambda: print('took', time.monotonic() - begin))\n" + code
    done = python(code)  # handlers run in reverse order of registration
    assert done.returncode == 0, done.stderr
    assert float(done.stdout.split("took")[1]) < 3, done.stdout


def test_the_main_thread_may_render_while_the_interpreter_ends():
    done = python("""
        import atexit, xvrml
        world = xvrml.load(b"#VRML V2.0 utf8\\nShape { geometry Box { } }")
        def last():
            print(world.render(size=(8, 6), spp=1).shape)
        atexit.register(last)
    """)
    assert done.returncode == 0 and done.stdout == "(6, 8, 4)\n", done.stderr


def test_a_child_process_does_not_wait_for_threads_that_it_has_not():
    done = python("""
        import os, sys, threading, time, xvrml
        world = xvrml.load(b"#VRML V2.0 utf8\\nShape { geometry Box { } }")
        threading.Thread(target=lambda: world.render(size=(800, 600), spp=64), daemon=True).start()
        time.sleep(0.2)
        begin = time.monotonic()
        child = os.fork()
        if child == 0:
            sys.exit(7)
        print(os.waitpid(child, 0)[1] >> 8, time.monotonic() - begin < 4)
    """)
    assert done.returncode == 0 and done.stdout == "7 True\n", (done.stdout, done.stderr)


# Graphs from the leaf up ------------------------------------------------------------------------


@pytest.mark.parametrize("build", [
    "chain = xvrml.Group(children=[chain])",
    "above = xvrml.Group(); above.children = [chain]; chain = above",
    "above = xvrml.Transform(); above.children = [chain]; kept.append(chain); chain = above"
])
def test_a_chain_from_the_leaf_up_takes_time_by_its_length(build):
    """Eight times as many nodes take about eight times as long, not 64 times."""
    done = python(f"""
        import time, xvrml
        def seconds(count):
            kept, scope = [], {{}}
            best = 1e9
            for _ in range(3):
                chain = xvrml.Group()
                begin = time.process_time()
                for _ in range(count):
                    {build}
                best = min(best, time.process_time() - begin)
            return best
        few, many = seconds(1000), seconds(8000)
        print(many / few, flush=True)
    """)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 24, done.stdout


def test_a_long_chain_ends_without_deep_recursion():
    done = python("""
        import xvrml
        leaf = chain = xvrml.Group()
        for _ in range(200_000):
            chain = xvrml.Group(children=[chain])
        del chain  # all above the leaf goes, and the leaf is still in the world of all of them
        leaf.children = [xvrml.Shape()]
        del leaf
        root = leaf = xvrml.Group()
        for _ in range(50_000):
            below = xvrml.Group()
            leaf.children = [below]
            leaf = below
        del root
        del leaf
        print("done")
    """)
    assert done.returncode == 0 and done.stdout == "done\n", (done.returncode, done.stderr[-500:])


def test_a_node_cannot_hold_itself_however_it_was_made():
    group = xvrml.Group()
    with pytest.raises(ValueError, match="hold itself"):
        group.children = [group]
    lower = xvrml.Group()
    upper = xvrml.Group(children=[xvrml.Group(children=[lower])])
    with pytest.raises(ValueError, match="hold itself"):
        lower.children = [upper]
    fresh = xvrml.Group()
    with pytest.raises(ValueError, match="hold itself"):
        fresh.children = [xvrml.Group(children=[fresh])]
    assert len(fresh.children) == 0


# Small stacks -----------------------------------------------------------------------------------


def test_threads_with_small_stacks_read_and_write_deep_worlds(tmp_path):
    (tmp_path / "deep.wrl").write_text("#VRML V2.0 utf8\n" + "Group { children [ " * 990 +
                                       "Shape { geometry Box { } }" + " ] }" * 990)
    (tmp_path / "bad.wrl").write_text("no world")
    done = python(
        """
        import sys, threading, xvrml
        said = []
        def work():
            world = xvrml.load(sys.argv[1])
            said.append(world.to_vrml().count("Group"))
            xvrml.Browser(sys.argv[1]).tick(0.1)
            said.append(world.render(size=(4, 3), spp=1).shape)
            try:
                xvrml.load(sys.argv[2])
            except xvrml.ParseError as error:
                said.append("refused")
        threading.stack_size(256 * 1024)
        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        print(said)
    """, tmp_path / "deep.wrl", tmp_path / "bad.wrl")
    assert done.returncode == 0 and done.stdout == "[990, (3, 4, 4), 'refused']\n", (
        done.returncode, done.stdout, done.stderr[-500:])


# The first arrays of two threads -----------------------------------------------------------------


def test_two_threads_may_make_the_first_arrays():
    """Two threads that both need numpy first must not wait for each other for ever."""
    result = python("""
        import sys, threading
        sys.setswitchinterval(1e-6)
        import xvrml
        WORLD = b"#VRML V2.0 utf8\\nShape { geometry PointSet { coord DEF Points Coordinate { point [0 0 0, 1 0 0, 0 1 0] } } }"
        worlds = [xvrml.load(WORLD) for _ in range(4)]
        seen = []
        start = threading.Barrier(len(worlds))
        def work(world):
            start.wait()
            world["Points"].point = [(0, 0, 0), (1, 0, 0), (0, 2, 0)]
            seen.append(world["Points"].point[2, 1])
        threads = [threading.Thread(target=work, args=(world,)) for world in worlds]
        for thread in threads: thread.start()
        for thread in threads: thread.join()
        print(*seen)
    """)
    assert (result.returncode, result.stdout.split()) == (0, 4 * ["2.0"]), result.stderr


def test_two_threads_may_import_at_once():
    """All modules, by threads that import and use them in another order."""
    result = python("""
        import importlib, sys, threading
        sys.setswitchinterval(1e-6)
        modules = ["xvrml", "xvrml.rt", "xvrml.interop", "xvrml.control", "numpy"]
        seen = []
        start = threading.Barrier(2)
        def work(names):
            start.wait()
            for name in names: importlib.import_module(name)
            import xvrml.rt
            seen.append(len(xvrml.Coordinate(point=[(0, 0, 0)]).point))
        threads = [threading.Thread(target=work, args=(names,)) for names in (modules, modules[::-1])]
        for thread in threads: thread.start()
        for thread in threads: thread.join()
        print(*seen)
    """)
    assert (result.returncode, result.stdout.split()) == (0, ["1", "1"]), result.stderr
