"""Exports worlds as glTF for tests."""
from gltf_check import document_of


def export(vv, world, name="out.glb", *more):
    """Exports a world, given as text or path; returns the document, the checker and what vv said."""
    if isinstance(world, str):
        vv.write("in.wrl", world)
        world = "in.wrl"
    done = vv(world, "--write", name, *more)
    assert done.returncode == 0, done.talk
    document, problems, checker = document_of(vv.folder / name)
    assert problems == []
    return document, checker, done.talk


def node(document, name):
    found = [one for one in document["nodes"] if one.get("name") == name]
    assert found, name
    return found[0]
