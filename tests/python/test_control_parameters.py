"""Tests that programs learn from vv --control which parameters a shader class has."""
import pytest

from control_server import SMALL, refused, start  # noqa: F401


def test_parameters_of_a_class(start):
    vv = start("world.wrl", *SMALL).connect()
    by_name = {one["name"]: one for one in vv.parameters("Glass")}
    assert by_name["index"] == {
        "name": "index", "type": "SFFloat", "text": by_name["index"]["text"], "default": 1.5,
        "minimum": pytest.approx(0.1), "maximum": 10
    }  # yapf: disable
    assert "refraction" in by_name["index"]["text"]
    assert by_name["tint"]["type"] == "SFColor" and by_name["tint"]["default"] == [1, 1, 1]
    assert vv.parameters("Glass", "glass") == vv.parameters("Glass")
    refused("value", "no shader class \"Glas\"", vv.parameters, "Glas")
    refused("value", "in \"mirror\"", vv.parameters, "Glass", "mirror")
