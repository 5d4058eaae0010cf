"""Rays meet aspheres of every conic constant where their equation says, up to the rim and under
matrices that shear and mirror; the points of unusual lenses and mirrors are sharp."""
import numpy as np
import pytest

rt = pytest.importorskip("xvrml").rt

MATRICES = {
    "plain": np.eye(4),
    "sheared": np.array([[1, .5, 0, 3], [-.3, 2, .1, -1], [0, .2, .7, 5], [0, 0, 0, 1.]]),
    "mirrored": np.array([[-1, 0, 0, 0], [0, .6, .8, 2], [0, -.8, .6, 0], [0, 0, 0, 1.]]),
}


def sag(r, curvature, conic, terms):
    """ISO 10110-12."""
    z = curvature * r**2 / (1 + np.sqrt(1 - (1 + conic) * curvature**2 * r**2))
    return z + sum(a * r**(4 + 2 * i) for i, a in enumerate(terms))


def slope(r, curvature, conic, terms):
    z = curvature * r / np.sqrt(1 - (1 + conic) * curvature**2 * r**2)
    return z + sum((4 + 2 * i) * a * r**(3 + 2 * i) for i, a in enumerate(terms))


@pytest.mark.parametrize("matrix", MATRICES)
@pytest.mark.parametrize("curvature, conic, terms, rim", (
    (.5, 0, (), 1.999),
    (-.5, -1, (), 8),
    (1, -3.5, (), 5),
    (1, -1e6, (), 2),
    (.5, .7, (), 2 / np.sqrt(1.7) * .9999),
    (-2, 20, (), .5 / np.sqrt(21) * .9999),
    (.3, -.5, (.01, -.002, 3e-4), 2),
    (0, 0, (.05,), 1.5),
))
def test_rays_meet_the_equation(matrix, curvature, conic, terms, rim):
    m = MATRICES[matrix]
    context = rt.Context()
    context.instance(
        context.asphere(curvature, rim, conic=conic, terms=terms, inner_radius=.1 * rim), m)
    random = np.random.default_rng(5)
    count = 2000
    r = rim * (1 - 10.0**random.uniform(-6, -.05, count) * .9)
    phi = random.uniform(0, 2 * np.pi, count)
    points = np.stack([r * np.cos(phi), r * np.sin(phi), sag(r, curvature, conic, terms)], 1)
    rise = slope(r, curvature, conic, terms)
    normals = np.stack([-rise * np.cos(phi), -rise * np.sin(phi), np.ones(count)], 1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    # Starts close enough to the surface that no other part of it comes first.
    start = points + .01 * rim * (normals + .3 * random.normal(size=(count, 3)) / np.sqrt(3))
    place = lambda p: p @ m[:3, :3].T + m[:3, 3]
    rays = np.concatenate([place(start), place(points) - place(start)], 1)
    hits = context.cast_rays(rays, precision="double")
    inside = r < rim * (1 - 2e-6)
    size = np.abs(place(points)).max()
    found = place(start) + rays[:, 3:] * hits["t_hit"][:, None]
    assert np.isfinite(hits["t_hit"][inside]).all()
    met = np.isfinite(hits["t_hit"])
    # The place may be that of a nearer crossing, which then lies on the surface as well.
    back = (found[met] - m[:3, 3]) @ np.linalg.inv(m[:3, :3]).T
    radius = np.hypot(back[:, 0], back[:, 1])
    assert (radius <= rim * (1 + 1e-9)).all() and (radius >= .1 * rim * (1 - 1e-9)).all()
    radius = np.minimum(radius, rim)
    error = np.abs(back[:, 2] - sag(radius, curvature, conic, terms))
    steep = np.hypot(1, slope(radius, curvature, conic, terms))
    assert (error / steep).max() < 1e-9 * size
    first = np.abs(hits["t_hit"] - 1) < 1e-6
    assert first.mean() > .95
    turned = normals @ np.linalg.inv(m[:3, :3])
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    assert np.abs(hits["primitive_normals"][first] - turned[first]).max() < 1e-5
    # Beyond the aperture there is nothing: rays along the axis that pass the rim and the hole.
    for r0 in (rim * (1 + 1e-8), .1 * rim * (1 - 1e-8)):
        along = np.stack([r0 * np.cos(phi), r0 * np.sin(phi), np.full(count, 2 * rim + 100)], 1)
        rays = np.concatenate([place(along), np.tile(m[:3, :3] @ (0, 0, -1), (count, 1))], 1)
        assert not np.isfinite(context.cast_rays(rays, precision="double")["t_hit"]).any()


def refract(d, n, ratio):
    """Snell's law for unit vectors; n against d. ratio: index before over index behind."""
    n = np.where((np.sum(d * n, 1) > 0)[:, None], -n, n)
    cosine = -np.sum(d * n, 1)[:, None]
    return ratio * d + (ratio * cosine - np.sqrt(1 - ratio**2 * (1 - cosine**2))) * n


def hit(surface, origins, directions):
    """Returns places and normals where rays meet one surface."""
    context = rt.Context()
    context.instance(surface(context))
    hits = context.cast_rays(np.concatenate([origins, directions], 1), precision="double")
    assert np.isfinite(hits["t_hit"]).all()
    return origins + directions * hits["t_hit"][:, None], hits["primitive_normals"]


@pytest.mark.parametrize("index", (1.3, 1.5, 2.4, 4))
def test_a_cartesian_oval_that_is_a_conic_is_sharp(index):
    """Parallel light into glass through an ellipsoid with k = -1/n^2 meets in its far focus, at
    n R / (n - 1) (Born and Wolf, Principles of Optics, 4.2.2)."""
    random = np.random.default_rng(2)
    origins = np.concatenate([random.uniform(-.5, .5, (500, 2)), np.full((500, 1), -5)], 1)
    directions = np.tile([0., 0, 1], (500, 1))
    at, n = hit(lambda c: c.asphere(1, .9, conic=-1 / index**2), origins, directions)
    bent = refract(directions, n, 1 / index)
    focus = index / (index - 1)
    across = at + bent * ((focus - at[:, 2]) / bent[:, 2])[:, None]
    assert np.abs(across[:, :2]).max() < 2e-6


@pytest.mark.parametrize("index, first, second, thick", (
    (1.5, 2, 3, .3),
    (1.9, -4, -2.5, .5),
    (4, 1, 1.2, .1),
    (1.5, 2, -2, .4),
))
def test_menisci_have_the_focal_length_of_the_lensmaker(index, first, second, thick):
    """Back focal length of a thick lens (Hecht, Optics, 6.1), for rays close to the axis."""
    angles = np.linspace(0, 2 * np.pi, 8, endpoint=False)
    h = 1e-3
    origins = np.stack([h * np.cos(angles), h * np.sin(angles), np.full(8, -5.)], 1)
    directions = np.tile([0., 0, 1], (8, 1))
    at, n = hit(lambda c: c.asphere(1 / first, .5), origins, directions)
    bent = refract(directions, n, 1 / index)
    at[:, 2] -= thick  # into the frame of the second surface
    at, n = hit(lambda c: c.asphere(1 / second, .5), at, bent)
    bent = refract(bent, n, index)
    crossing = at[:, 2] - np.hypot(at[:, 0], at[:, 1]) * bent[:, 2] / np.sum(
        bent[:, :2] * at[:, :2], 1) * np.hypot(at[:, 0], at[:, 1])
    power = (index - 1) * (1 / first - 1 / second + (index - 1) * thick / (index * first * second))
    focal = (1 - (index - 1) * thick / (index * first)) / power
    assert crossing == pytest.approx(np.full(8, focal), rel=1e-4)
