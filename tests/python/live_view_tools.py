"""Shared by the tests of live views: a world, and what a user does in a view."""
import time

WORLD = """#VRML V2.0 utf8
DEF Front Viewpoint { position 0 0 8 description "front" }
DEF Side Viewpoint { position 8 0 0 orientation 0 1 0 1.5708 description "side" }
DEF Clock TimeSensor { cycleInterval 2 loop TRUE enabled FALSE }
DEF Way PositionInterpolator { key [0, 1] keyValue [-2 0 0, 2 0 0] }
DEF Place Transform { children [
  DEF Touch TouchSensor { }
  Shape { appearance Appearance { material DEF Paint Material { emissiveColor 1 1 1 } } geometry DEF Cube Box { size 1 1 1 } } ] }
ROUTE Clock.fraction_changed TO Way.set_fraction
ROUTE Way.value_changed TO Place.set_translation
"""
SIZE = dict(size=(64, 48), spp=4)


def steps(view, until, limit=60, now=None):
    """Steps the view until a condition holds."""
    end = time.monotonic() + limit
    while not until():
        assert time.monotonic() < end, view.facts
        time.sleep(min(view.step(now) or 0.01, 0.01))


def at(view, now):
    """Steps the view to a time. A step does nothing while a frame reads the world."""
    steps(view, lambda: view._clock._last == now and not view._events, now=now)


def click(view, x, y, button=1, **more):
    for kind in ("pointer_move", "pointer_down", "pointer_up"):
        view.event({"type": kind, "x": x, "y": y, "button": button, "modifiers": (), **more})


def drag(view, start, end, button=1, modifiers=()):
    for kind, (x, y) in (("pointer_move", start), ("pointer_down", start), ("pointer_move", end),
                         ("pointer_up", end)):
        view.event({"type": kind, "x": x, "y": y, "button": button, "modifiers": modifiers})


def key(view, name, *modifiers):
    for kind in ("key_down", "key_up"):
        view.event({"type": kind, "key": name, "modifiers": modifiers})
