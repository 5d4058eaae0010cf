"""Random sequences of SDK calls. Whatever the order of calls, and whatever is destroyed before the
objects it belongs to, the outcome is a result or an exception. $XVRML_SEQUENCES sets the number of
sequences (make python-sequences: 100,000)."""
import gc
import os

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
hypothesis = pytest.importorskip("hypothesis")
from hypothesis import strategies as st  # noqa: E402
from xvrml import rt  # noqa: E402

SEQUENCES = int(os.environ.get("XVRML_SEQUENCES", 150))
EXPECTED = (ValueError, TypeError, KeyError, AttributeError, IndexError, RuntimeError)

WORLD = b"""#VRML V2.0 utf8
PROTO Dot [ exposedField MFVec3f where [0 0 0, 1 0 0, 0 1 0] exposedField SFFloat size 1 ] {
  Shape { geometry IndexedFaceSet { coord Coordinate { point IS where } coordIndex [0 1 2] } }
}
DEF Clock TimeSensor { loop TRUE }
DEF Way PositionInterpolator { key [0, 1] keyValue [0 0 0, 1 1 1] }
DEF Place Transform { children [ DEF D Dot { }, DEF Ball Shape { geometry DEF Round Sphere { } appearance Appearance { material DEF M Material { } } } ] }
DEF Choice Switch { choice [ USE Ball, Group { } ] whichChoice 0 }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Place.set_translation
"""
NAMES = ("Clock", "Way", "Place", "D", "Ball", "Round", "M", "Choice", "New", "Nobody")
CLASSES = ("Group", "Transform", "Shape", "Box", "Sphere", "Coordinate", "IndexedFaceSet",
           "Appearance", "Material", "Inline", "Script", "PointSet", "Switch", "TimeSensor",
           "PositionInterpolator", "Viewpoint", "LOD")
FIELDS = ("children", "translation", "geometry", "coord", "point", "where", "size", "radius",
          "material", "appearance", "choice", "whichChoice", "key", "keyValue", "diffuseColor",
          "fraction_changed", "set_fraction", "level", "loop", "coordIndex", "nothing")
EVENTS = ("Clock.fraction_changed", "Way.value_changed", "Place.translation", "M.diffuseColor",
          "D.size", "Way.set_fraction", "Place.children", "New.translation", "nothing")


class Player:
    """Objects that calls have returned. Any of them may be used in the next call, or dropped."""

    def __init__(self):
        self.worlds, self.nodes, self.others = [xvrml.load(WORLD)], [], []

    def pick(self, pool, number):
        return pool[number % len(pool)] if pool else None

    def value(self, a, b):
        kinds = (lambda: self.pick(self.nodes, b),
                 lambda: [self.pick(self.nodes, b),
                          self.pick(self.nodes, b // 7)], lambda: [], lambda: None, lambda:
                 (1.0, 0.5, 0.25), lambda: np.ones(
                     (b % 5, 3)), lambda: b / 7, lambda: b, lambda: "text", lambda: True,
                 lambda: np.arange(b % 9), lambda: self.pick(self.others, b))
        return kinds[a % len(kinds)]()

    def play(self, name, a, b, c):
        world = self.pick(self.worlds, a)
        node = self.pick(self.nodes, b)
        if name == "load":
            self.worlds.append(xvrml.load(WORLD) if a % 3 else xvrml.Browser(WORLD))
        elif name == "empty":
            self.worlds.append(xvrml.World())
        elif name == "make":
            self.nodes.append(getattr(xvrml, CLASSES[a % len(CLASSES)])())
        elif name == "make with":
            self.nodes.append(
                getattr(xvrml, CLASSES[a % len(CLASSES)])(**{
                    FIELDS[b % len(FIELDS)]: self.value(c, a)
                }))
        elif name == "find":
            self.nodes.append(world[NAMES[b % len(NAMES)]])
        elif name == "roots":
            self.nodes.extend(world.roots)
        elif name == "read":
            got = getattr(node, FIELDS[c % len(FIELDS)])
            (self.nodes if isinstance(got, xvrml.Node) else self.others).append(got)
            if isinstance(got, tuple):
                self.nodes.extend(one for one in got if isinstance(one, xvrml.Node))
        elif name == "write":
            setattr(node, FIELDS[c % len(FIELDS)], self.value(a, b))
        elif name == "edit":
            with node.edit(FIELDS[c % len(FIELDS)]) as array:
                array[...] = a
        elif name == "add":
            world.add(node, *(("New",) if c % 3 == 0 else ()))
        elif name == "remove":
            world.remove(node)
        elif name == "route":
            (world.route if c % 3 else world.unroute)(EVENTS[b % len(EVENTS)],
                                                      EVENTS[c % len(EVENTS)])
        elif name == "on":

            def called(value, time, player=self):
                if c % 4 == 0:
                    player.nodes.clear()
                elif c % 4 == 1:
                    world["Place"].scale = (1, 1, 1 + time)
                elif c % 4 == 2:
                    raise KeyError("mine")
                else:
                    player.others.append(value)

            world.on(EVENTS[b % len(EVENTS)], called)
        elif name == "listen":
            self.others.append(world.listen(node, FIELDS[c % len(FIELDS)],
                                            lambda value, time: None))
        elif name == "unlisten":
            world.unlisten(node, c)
        elif name == "time":
            world.time = world.time + b / 10
        elif name == "text":
            world.to_vrml()
        elif name == "names":
            self.others.append((world.names, len(world), world.warnings, repr(world), repr(node),
                                dir(node), hash(node)))
        elif name == "meshes":
            for mesh in world.meshes(spheres=c % 4):
                self.others += [mesh.vertices, mesh.faces, mesh]
                self.nodes.append(mesh.node)
        elif name == "look":
            for other in self.others:
                if isinstance(other, np.ndarray):
                    other.sum()
                elif isinstance(other, xvrml.Mesh):
                    other.world_vertices.sum()
                elif isinstance(other, rt.Raycaster):
                    other.cast_rays(np.ones((2, 6)))
        elif name == "render":
            self.others.append(world.render(size=(4, 3), spp=1).array)
        elif name == "caster":
            self.others.append(world.raycaster())
        elif name == "viewpoints":
            self.others.append(world.viewpoints)
        elif name == "forget":
            pool = (self.worlds, self.nodes, self.others)[a % 3]
            if pool:
                del pool[b % len(pool)]
        elif name == "collect":
            gc.collect(0)


CHEAP = ("load", "empty", "make", "make with", "find", "roots", "read", "write", "edit", "add",
         "remove", "route", "on", "listen", "unlisten", "time", "text", "names", "meshes", "look",
         "forget", "collect")
NUMBERS = st.integers(0, 40)
STEP = st.tuples(
    st.one_of(st.sampled_from(CHEAP), st.sampled_from(CHEAP),
              st.sampled_from(("find", "read", "write", "add", "make"))), NUMBERS, NUMBERS, NUMBERS)
DEAR = st.tuples(st.sampled_from(("render", "caster", "viewpoints")), NUMBERS, NUMBERS, NUMBERS)


@hypothesis.settings(max_examples=SEQUENCES,
                     deadline=None,
                     database=None,
                     derandomize=True,
                     suppress_health_check=list(hypothesis.HealthCheck))
@hypothesis.given(st.lists(STEP, min_size=5, max_size=30), st.lists(DEAR, max_size=1),
                  st.lists(STEP, max_size=10))
def test_any_sequence_of_calls(first, dear, then):
    player = Player()
    for step in (*first, *(dear if len(first) % 4 == 0 else ()), *then):
        try:
            player.play(*step)
        except EXPECTED:
            pass
