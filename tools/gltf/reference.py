"""reference.py: a path tracer in numpy for glTF 2.0, to compare with. The BRDF is written from
appendix B of the specification: a mixture by `metallic` of a metal and of a diffuse base under a
dielectric layer, with GGX, height-correlated Smith shadowing and Schlick's Fresnel term. The base
gets T(l) T(v) / mean T with T = 1 - albedo of the layer, which is the one choice that is ours
(plugins/shaders/physical.cpp). Paths follow samples of the BRDF; lamps are asked at each place.

Rays are cast by the package's Raycaster; everything else is computed here, in double precision."""

import functools

import numpy as np

from .scene import normalize

PASSES = 40  # surfaces that one ray may pass because they are culled or transparent
STEP = 2e-5  # how far rays start off a surface


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def schlick(f0, cosine):
    return f0 + (1 - f0) * (1 - cosine)**5


def ggx(alpha, nh):
    """D of appendix B.3.2."""
    a2 = alpha**2
    return a2 / (np.pi * (nh**2 * (a2 - 1) + 1)**2)


def visibility(alpha, nl, nv):
    """V = G / (4 NL NV) of appendix B.3.2."""
    a2 = alpha**2
    return 0.5 / (nl * np.sqrt(a2 + (1 - a2) * nv**2) + nv * np.sqrt(a2 + (1 - a2) * nl**2))


class Layer:
    """Directional albedo of the layer over a dielectric, F0 = 0.04, by quadrature over half vectors
    that are spread as D NH."""

    COSINES, WIDTHS = 64, 33

    def __init__(self):
        self.mu = np.linspace(0, 1, self.COSINES)**2
        self.table = np.stack([self.row(max(r, 0.02)**2) for r in np.linspace(0, 1, self.WIDTHS)])
        self.table[0] = schlick(0.04, self.mu)
        # linear between the entries, which are spaced as squares
        x, w = np.polynomial.legendre.leggauss(200)
        mu = (x + 1) / 2
        albedo = np.stack([np.interp(np.sqrt(mu), np.sqrt(self.mu), row) for row in self.table])
        self.means = 1 - (albedo * mu * w).sum(axis=1)

    def row(self, alpha):
        n = 64
        x, phi = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n * np.pi)
        ch = np.sqrt((1 - x) / (1 + (alpha**2 - 1) * x))
        sh = np.sqrt(1 - ch**2)
        out = []
        for mu in np.maximum(self.mu, 1e-4):
            vh = sh * np.cos(phi) * np.sqrt(1 - mu**2) + ch * mu
            nl = 2 * vh * ch - mu
            ok = (nl > 0) & (vh > 0)
            vh, nl, nh = vh[ok], nl[ok], ch[ok]
            # f cos(l) / pdf(l), pdf = D NH / (4 VH)
            out.append((schlick(0.04, vh) * visibility(alpha, nl, mu) * nl * 4 * vh / nh).sum() / n**2)
        return np.array(out)

    def transmittance(self, roughness, cosine):
        r, c = np.clip(roughness, 0, 1) * (self.WIDTHS - 1), np.sqrt(np.clip(cosine, 0, 1)) * (self.COSINES - 1)
        i, j = np.minimum(r.astype(int), self.WIDTHS - 2), np.minimum(c.astype(int), self.COSINES - 2)
        fr, fc, t = r - i, c - j, self.table
        return 1 - ((t[i, j] * (1 - fc) + t[i, j + 1] * fc) * (1 - fr) + (t[i + 1, j] * (1 - fc) + t[i + 1, j + 1] * fc) * fr)

    def mean(self, roughness):
        return np.interp(roughness, np.linspace(0, 1, self.WIDTHS), self.means)


@functools.lru_cache
def layer():
    return Layer()


def basis(n):
    helper = np.where(np.abs(n[:, :1]) > 0.7, [[0.0, 1, 0]], [[1.0, 0, 0]])
    t = normalize(np.cross(helper, n))
    return t, np.cross(n, t)


class Surface:
    """The places that rays have hit, with the values of their materials."""

    def __init__(self, scene, triangle, direction, origin):
        self.scene, self.triangle = scene, triangle
        a, b, c = np.moveaxis(scene.points[triangle], 1, 0)
        cross = np.cross(b - a, c - a)
        area = dot(cross, cross)
        t = dot(a - origin, cross) / dot(direction, cross)
        self.position = origin + t[:, None] * direction
        p = self.position
        w = np.stack([dot(np.cross(c - b, p - b), cross), dot(np.cross(a - c, p - c), cross), dot(np.cross(b - a, p - a), cross)], 1)
        self.weights = np.clip(w / area[:, None], 0, 1)
        self.weights /= self.weights.sum(axis=1, keepdims=True)
        self.back = dot(direction, cross) > 0
        turn = np.where(self.back, -1.0, 1.0)[:, None]
        self.facet = turn * cross / np.sqrt(area)[:, None]
        self.normal = turn * normalize(self.corners(scene.normals))
        self.toward = -direction
        n = len(triangle)
        self.base, self.emission, self.opacity = np.ones((n, 4)), np.zeros((n, 3)), np.ones(n)
        self.metallic, self.roughness, self.lit = np.zeros(n), np.ones(n), np.ones(n, bool)
        material = scene.material[triangle]
        for number in np.unique(material):
            self.fill(scene.materials[number], np.flatnonzero(material == number))
        self.alpha_alone = self.opacity.copy()
        self.opacity[self.back & ~scene.double[triangle]] = 0  # back faces are culled

    def corners(self, values, at=slice(None)):
        return np.einsum("ij,ijk->ik", self.weights[at], values[self.triangle[at]])

    def fill(self, m, at):
        scene = self.scene
        uvs = [np.einsum("ij,ijk->ik", self.weights[at], scene.uvs[self.triangle[at], k]) for k in (0, 1)]
        base = m.base * self.corners(scene.colors, at)
        if m.base_texture:
            base = base * m.base_texture.at(uvs)
        self.base[at] = np.clip(base, 0, 1)
        if m.mode == "MASK":
            self.opacity[at] = self.base[at, 3] >= m.cutoff
        elif m.mode == "BLEND":
            self.opacity[at] = self.base[at, 3]
        self.lit[at] = not m.unlit
        if m.unlit:
            self.emission[at] = self.base[at, :3]
            return
        self.emission[at] = m.emissive * (m.emissive_texture.at(uvs)[:, :3] if m.emissive_texture else 1)
        factors = m.roughness_texture.at(uvs) if m.roughness_texture else np.ones((len(at), 4))
        self.metallic[at], self.roughness[at] = m.metallic * factors[:, 2], m.roughness * factors[:, 1]
        if m.normal_texture:
            self.bend(m, at, uvs)

    def bend(self, m, at, uvs):
        scene, turn = self.scene, np.where(self.back[at], -1.0, 1.0)[:, None]
        n = turn * self.normal[at]
        given = scene.has_tangents[self.triangle[at]][:, None]
        own = self.corners(scene.tangents, at)
        # Without tangents: along the axes of the picture, on which the transformation acts.
        p, uv = scene.points[self.triangle[at]], scene.uvs[self.triangle[at], m.normal_texture.set] @ m.normal_texture.matrix.T
        e1, e2, d1, d2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0], uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
        det = d1[:, :1] * d2[:, 1:] - d2[:, :1] * d1[:, 1:]
        det = np.where(det == 0, 1e-30, det)
        du, dv = (e1 * d2[:, 1:] - e2 * d1[:, 1:]) / det, (e2 * d1[:, :1] - e1 * d2[:, :1]) / det
        tangent = np.where(given, own[:, :3], du)
        tangent = normalize(tangent - n * dot(n, tangent)[:, None])
        side = np.where(given[:, 0], np.sign(own[:, 3]), np.where(dot(np.cross(n, tangent), -dv) < 0, -1, 1))
        bitangent = np.cross(n, tangent) * side[:, None]
        v = 2 * m.normal_texture.at(uvs)[:, :3] - 1
        bent = v[:, :1] * m.normal_scale * tangent + v[:, 1:2] * m.normal_scale * bitangent + v[:, 2:] * n
        self.normal[at] = turn * normalize(bent)

    def select(self, at):
        out = object.__new__(Surface)
        out.scene = self.scene
        for name in ("triangle", "position", "weights", "back", "facet", "normal", "toward", "base", "emission", "opacity", "metallic",
                     "roughness", "lit"):
            setattr(out, name, getattr(self, name)[at])
        return out

    def prepare(self):
        self.alpha = self.roughness**2
        self.polished = self.alpha <= 1e-4
        self.f0 = 0.04 * (1 - self.metallic[:, None]) + self.base[:, :3] * self.metallic[:, None]
        self.nv = np.maximum(np.abs(dot(self.normal, self.toward)), 1e-7)
        self.up = self.toward + self.normal * (self.nv - dot(self.normal, self.toward))[:, None]  # a view from behind is mirrored
        self.diffuse = self.base[:, :3] * (1 - self.metallic[:, None])
        lobe = layer()
        self.through = lobe.transmittance(self.roughness, self.nv) / lobe.mean(self.roughness)
        # how often the highlight is followed
        self.choice = np.where(self.diffuse.max(axis=1) > 0, 0.35 + 0.4 * self.metallic, 1)

    def brdf(self, l):
        """Returns the BRDF times the cosine, without polished highlights, and the pdf of sample()."""
        nl = dot(self.normal, l)
        ok = nl > 0
        nl = np.maximum(nl, 1e-9)
        h = normalize(self.up + l)
        nh, vh = np.clip(dot(self.normal, h), 0, 1), np.clip(dot(self.up, h), 0, 1)
        alpha = np.maximum(self.alpha, 1e-4)
        d = np.where(self.polished, 0, ggx(alpha, nh))
        specular = schlick(self.f0, vh[:, None]) * (d * visibility(alpha, nl, self.nv))[:, None]
        base = self.diffuse * (self.through * layer().transmittance(self.roughness, nl) / np.pi)[:, None]
        smith = 2 * self.nv / (self.nv + np.sqrt(alpha**2 + (1 - alpha**2) * self.nv**2))
        pdf = self.choice * d * smith / (4 * self.nv) + (1 - self.choice) * nl / np.pi
        return np.where(ok[:, None], (specular + base) * nl[:, None], 0), pdf

    def sample(self, rng):
        """Returns directions and what to multiply paths with."""
        n = len(self.nv)
        u = rng.random((3, n))
        t, b = basis(self.normal)
        r, phi = np.sqrt(u[0]), 2 * np.pi * u[1]
        diffuse = (r * np.cos(phi))[:, None] * t + (r * np.sin(phi))[:, None] * b + np.sqrt(1 - u[0])[:, None] * self.normal
        # E. Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018
        a = np.maximum(self.alpha, 1e-4)
        local = np.stack([dot(self.up, t) * a, dot(self.up, b) * a, self.nv], 1)
        vh = normalize(local)
        flat = vh[:, 0]**2 + vh[:, 1]**2
        t1 = np.where(flat[:, None] > 1e-20, np.stack([-vh[:, 1], vh[:, 0], 0 * flat], 1) / np.sqrt(np.maximum(flat, 1e-20))[:, None],
                      [[1.0, 0, 0]])
        t2 = np.cross(vh, t1)
        x, y, s = r * np.cos(phi), r * np.sin(phi), 0.5 * (1 + vh[:, 2])
        y = (1 - s) * np.sqrt(np.maximum(0, 1 - x**2)) + s * y
        h = x[:, None] * t1 + y[:, None] * t2 + np.sqrt(np.maximum(0, 1 - x**2 - y**2))[:, None] * vh
        h = normalize(np.stack([a * h[:, 0], a * h[:, 1], np.maximum(h[:, 2], 1e-12)], 1))
        h = np.where(self.polished[:, None], self.normal, h[:, :1] * t + h[:, 1:2] * b + h[:, 2:] * self.normal)
        mirrored = 2 * dot(self.up, h)[:, None] * h - self.up
        shine = u[2] < self.choice
        l = normalize(np.where(shine[:, None], mirrored, diffuse))
        value, pdf = self.brdf(l)
        weight = value / np.maximum(pdf, 1e-300)[:, None]
        exact = schlick(self.f0, self.nv[:, None]) / self.choice[:, None]  # a polished highlight
        weight = np.where((shine & self.polished)[:, None], exact, weight)
        weight[(dot(l, self.facet) <= 0) | (dot(l, self.normal) <= 0)] = 0
        return l, weight


class Tracer:

    def __init__(self, scene, rt):
        self.scene, self.caster = scene, rt.Raycaster()
        self.caster.add_triangles(scene.points.reshape(-1, 3), np.arange(3 * len(scene.points)).reshape(-1, 3))

    def hits(self, origin, direction):
        rays = np.concatenate([origin, direction], axis=1).astype(np.float32)
        found = self.caster.cast_rays(rays)
        return found["primitive_ids"].astype(int), np.isfinite(found["t_hit"])

    def shadow(self, origin, to, distance):
        """Returns the share of light that passes what lies between. Back faces cast shadows, too."""
        through, start = np.ones(len(origin)), origin.copy()
        alive = np.arange(len(origin))
        for _ in range(PASSES):
            triangle, met = self.hits(start[alive], to[alive])
            alive, triangle = alive[met], triangle[met]
            if not len(alive):
                break
            at = Surface(self.scene, triangle, to[alive], start[alive])
            before = dot(at.position - origin[alive], to[alive]) < distance[alive]
            through[alive[before]] *= 1 - at.alpha_alone[before]
            start[alive] = at.position + STEP * to[alive]
            alive = alive[before & (through[alive] > 0)]
        return through

    def lamps(self, s):
        """Returns the light of the lamps that the places reflect."""
        out = np.zeros((len(s.nv), 3))
        for light in self.scene.lights:
            to, distance, arrives = light.reach(s.position)
            value, _ = s.brdf(to)
            value = value * arrives
            at = np.flatnonzero(value.max(axis=1) > 0)
            if not len(at):
                continue
            start = s.position[at] + STEP * s.facet[at]
            away = dot(s.facet[at], to[at]) <= 0
            if away.any():  # J. Hanika, "Hacking the Shadow Terminator": from the smooth surface
                w, turn = s.weights[at][away], np.where(s.back[at][away], -1.0, 1.0)[:, None, None]
                p, corner = s.position[at][away], self.scene.points[s.triangle[at][away]]
                n = turn * self.scene.normals[s.triangle[at][away]]
                below = np.minimum(0, np.einsum("ijk,ijk->ij", p[:, None] - corner, n))
                start[away] = p - np.einsum("ij,ij,ijk->ik", w, below, n) + STEP * s.facet[at][away]
            out[at] += value[at] * self.shadow(start, to[at], distance[at])[:, None]
        return out

    def radiance(self, origin, direction, rng, depth=25):
        n = len(origin)
        out, carried, alive = np.zeros((n, 3)), np.ones((n, 3)), np.arange(n)
        origin, direction = origin.copy(), direction.copy()
        bounces, passes = np.zeros(n, int), np.zeros(n, int)
        while len(alive):
            triangle, met = self.hits(origin[alive], direction[alive])
            alive, triangle = alive[met], triangle[met]
            if not len(alive):
                break
            s = Surface(self.scene, triangle, direction[alive], origin[alive])
            passing = rng.random(len(alive)) >= s.opacity
            gone = alive[passing]
            origin[gone] = s.position[passing] + STEP * direction[gone]
            passes[gone] += 1
            gone = gone[passes[gone] < PASSES]
            s, stopped = s.select(~passing), alive[~passing]
            out[stopped] += carried[stopped] * s.emission
            keep = s.lit & (bounces[stopped] < depth)
            s, stopped = s.select(keep), stopped[keep]
            if len(stopped):
                s.prepare()
                out[stopped] += carried[stopped] * self.lamps(s)
                l, weight = s.sample(rng)
                carried[stopped] *= weight
                bounces[stopped] += 1
                most = carried[stopped].max(axis=1)
                lives = np.where(bounces[stopped] > 3, np.minimum(1, most * 1.5), most > 0)
                chosen = rng.random(len(stopped)) < lives
                carried[stopped] /= np.maximum(lives, 1e-300)[:, None]
                origin[stopped] = s.position + STEP * s.facet
                direction[stopped] = l
                stopped = stopped[chosen]
            alive = np.concatenate([gone, stopped])
        return out

    def camera_rays(self, size, rng, spp):
        (camera, matrix), (width, height) = self.scene.camera, size
        y, x = np.mgrid[0:height, 0:width].astype(float)
        x, y = (np.repeat(v.ravel(), spp) for v in (x, y))
        x, y = 2 * (x + rng.random(len(x))) / width - 1, 1 - 2 * (y + rng.random(len(y))) / height
        if camera["type"] == "orthographic":
            size = camera["orthographic"]
            origin = np.stack([x * size["xmag"], y * size["ymag"], 0 * x], 1) @ matrix[:3, :3].T + matrix[:3, 3]
            return origin, np.tile(normalize(-matrix[:3, 2]), (len(x), 1))
        size = camera["perspective"]
        tangent = np.tan(size["yfov"] / 2)
        direction = np.stack([x * tangent * size["aspectRatio"], y * tangent, 0 * x - 1], 1)
        return np.tile(matrix[:3, 3], (len(x), 1)), normalize(direction @ matrix[:3, :3].T)

    def picture(self, size, spp, seed):
        rng = np.random.default_rng(seed)
        origin, direction = self.camera_rays(size, rng, spp)
        return self.radiance(origin, direction, rng).reshape(size[1], size[0], spp, 3).mean(axis=2)
