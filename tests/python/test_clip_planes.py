"""ClipPlane (ISO/IEC 19775-1 11.4.1) in pictures and in what programs ask: what remains looks as it
did before, and meshes, bounds and rays see the same as pictures."""
import numpy as np
import pytest

xvrml = pytest.importorskip("xvrml")

HEAD = "#X3D V3.3 utf8\nViewpoint { position 0 0 8 }\nNavigationInfo { headlight FALSE }\n"
LIGHT = "DirectionalLight { direction 0 0 -1 }\n"
SQUARE = ("coord Coordinate { point [ -2 -2 0 2 -2 0 2 2 0 -2 2 0 ] } coordIndex [ 0 1 2 3 ]")
FACES = {
    "colours": "color Color { color [ 1 0 0 0 1 0 0 1 0 1 0 0 ] }",
    "opacities": "color ColorRGBA { color [ 1 0 0 1 0 1 0 .2 0 1 0 .2 1 0 0 1 ] }",
    "normals": "normal Normal { vector [ -1 0 .1 1 0 .1 1 0 .1 -1 0 .1 ] }",
    "texture": "texCoord TextureCoordinate { point [ 0 0 3 0 3 1 0 1 ] }",
}


def world(body):
    return xvrml.loads(HEAD + body)


@pytest.mark.parametrize("name", FACES)
@pytest.mark.parametrize("colour", ["linear", "vrml97"])
def test_what_remains_looks_as_before(name, colour):
    appearance = "Appearance { material Material { } %s }" % (
        "texture PixelTexture { image 4 1 3 0xff0000 0x00ff00 0x0000ff 0xffffff }"
        if name == "texture" else "")
    text = LIGHT + "%s Shape { appearance " + appearance + " geometry IndexedFaceSet { %s %s } }" % (
        SQUARE, FACES[name])
    whole, part = (world(text % plane).render(size=(64, 48), spp=1, colour=colour).array
                   for plane in ("", "ClipPlane { plane 1 0 0 -0.31 }"))
    left = np.abs(part).max(axis=2) > 0
    assert 100 < left.sum() < (np.abs(whole).max(axis=2) > 0).sum()
    assert not left[:, :32].any()
    assert np.abs(whole - part)[left].max() < 1e-5


def test_meshes_bounds_and_rays_see_what_is_left():
    cut = world("Transform { translation 5 0 0 children [ ClipPlane { plane 1 0 0 0 } Shape { geometry "
                "Box { } } Shape { geometry Sphere { } } Transform { translation 9 0 0 children Shape "
                "{ geometry Sphere { } } } Transform { translation -9 0 0 children Shape { geometry "
                "Sphere { } } } ] }")
    assert cut.bounds == pytest.approx(np.array([[5, -1, -1], [15, 1, 1]]))
    kinds = [mesh.kind for mesh in cut.meshes(spheres=0)]
    assert kinds == ["triangles", "triangles", "sphere"], "a sphere that is not cut stays exact"
    caster = cut.raycaster()
    rays = np.array([[4.5, 0, 9, 0, 0, -1], [5.5, .9, 9, 0, 0, -1]], dtype=np.float32)
    hits = caster.cast_rays(rays)["t_hit"]
    assert np.isinf(hits[0]) and hits[1] == pytest.approx(8)


def test_spheres_that_no_plane_meets_have_no_facets():
    spheres = "".join(f"Transform {{ translation {i} 0 0 children Shape {{ geometry Sphere {{ }} }} }}\n"
                      for i in range(3000))
    plenty = world("ClipPlane { plane 1 0 0 10 }\n" + spheres)
    image = plenty.render(size=(8, 6), spp=1)
    assert image.stats["triangles"] == 0


def test_frames_are_those_of_sequences():
    text = (LIGHT + "DEF C ClipPlane { } Shape { appearance Appearance { material Material { } } geometry "
            "Sphere { } } DEF T TimeSensor { cycleInterval 1 loop TRUE } DEF S Script { inputOnly "
            "SFFloat f outputOnly SFVec4f p url \"ecmascript: function f(v) { p = new SFVec4f(1, v, 0, "
            "v - 0.5); }\" } ROUTE T.fraction_changed TO S.f ROUTE S.p TO C.plane")
    frames = list(world(text).animate(0, 0.44, fps=25, size=(32, 24), spp=2))
    later = list(world(text).animate(0.4, 0.44, fps=25, size=(32, 24), spp=2))
    assert np.array_equal(frames[10].array, later[0].array)
    assert not np.array_equal(frames[2].array, later[0].array)
