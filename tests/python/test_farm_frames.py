"""Tests that a worker of a farm keeps the world of a film between its frames (xvrml._frames)."""
import threading

import pytest

np = pytest.importorskip("numpy")
xvrml = pytest.importorskip("xvrml")
from xvrml import _frames

# The Script counts its events: a step too many or too few changes the colour.
COUNTING = """#VRML V2.0 utf8
DEF Clock TimeSensor { cycleInterval 1 loop TRUE }
DEF Count Script { eventIn SFFloat step eventOut SFColor colour field SFFloat n 0
  url "javascript: function step(v) { n = n + 1; colour = new SFColor((n % 10) / 10, v, (n % 7) / 7); }" }
Shape { appearance Appearance { material DEF Paint Material { } } geometry Box { } }
ROUTE Clock.fraction_changed TO Count.step
ROUTE Count.colour TO Paint.diffuseColor
"""
SMALL = {"size": (8, 6), "spp": 1, "threads": 1}


@pytest.fixture
def counted(monkeypatch):
    """Counts the worlds that are read and the steps that they take."""
    counts = {"read": 0, "steps": 0}

    class Counting(xvrml.Browser):

        def __init__(self, *given, **named):
            counts["read"] += 1
            super().__init__(*given, **named)

        def tick(self, *given):
            counts["steps"] += 1
            return super().tick(*given)

    monkeypatch.setattr(_frames, "Browser", Counting)
    monkeypatch.setattr(_frames, "_mine", threading.local())
    return counts


def frame(film, time, fps=30.0):
    return _frames.render_frame(film, (COUNTING.encode(), ""), time, fps, None, SMALL, {})


def alone(time, fps=30.0):
    """Returns the frame of a world that has made no other one."""
    made = []
    thread = threading.Thread(target=lambda: made.append(frame("alone", time, fps)))
    thread.start()
    thread.join()
    return made[0]


def test_a_film_costs_one_parse_and_a_step_for_each_frame(counted):
    for number in range(40):
        frame("film", number / 30)
    assert counted == {"read": 1, "steps": 40}


def test_frames_are_those_of_a_world_of_their_own(counted):
    for number in (0, 3, 4, 4, 11, 25):
        assert np.array_equal(frame("film", number / 30), alone(number / 30)), number
    assert counted["read"] == 1 + 6


def test_an_earlier_frame_another_film_and_a_time_between_steps_begin_anew(counted):
    frame("film", 10 / 30)
    for film, time in (("film", 5 / 30), ("other", 6 / 30), ("other", .25), ("other", 8 / 30)):
        before = counted["read"]
        assert np.array_equal(frame(film, time), alone(time)), (film, time)
        assert counted["read"] - before == (2 if (film, time) != ("other", .25) else 1)


def test_a_world_that_fails_is_not_kept(counted):
    frame("film", 0)
    with pytest.raises(KeyError):
        _frames.render_frame("film", (COUNTING.encode(), ""), 1 / 30, 30.0, None,
                             dict(SMALL, viewpoint="none such"), {})
    frame("film", 2 / 30)
    assert counted["read"] == 2


def test_frames_on_ray():
    """As on Dask: the bytes of a world of its own, and errors as they are."""
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        times = [0, .1, .4, .5]
        arrays = list(xvrml.ray.render_frames(COUNTING.encode(), times, **SMALL))
        assert len(arrays) == 4
        for time, array in zip(times, arrays):
            assert np.array_equal(array, alone(time)), time
        with pytest.raises(xvrml.ParseError):
            list(xvrml.ray.render_frames(b"nonsense", [0], retries=0))
    finally:
        ray.shutdown()
