"""The models of tools/compare_gltf.py, small and with few samples, beside their reference: a path
tracer of its own with the BRDF of glTF 2.0. And that such a comparison notices what is wrong."""

import json
import pathlib
import sys

import numpy as np
import pytest

pytest.importorskip("PIL")
pytest.importorskip("xvrml")
sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tools"))
import compare_gltf  # noqa: E402
from gltf import models, reference, scene  # noqa: E402
from xvrml import rt  # noqa: E402

SIZE, REPEATS = (20, 15), 4


def compare(path):
    return compare_gltf.compare(path, SIZE, spp=16, reference_spp=8, repeats=REPEATS)


def differs(line):
    """Bounds for few repetitions, whose standard errors are themselves uncertain."""
    return abs(line["mean"]) > line["interval"] * 1.7 + 0.01 or line["share"] > 0.1


@pytest.mark.parametrize("name", models.MODELS)
def test_models_agree_with_the_reference(name, tmp_path):
    line = compare(models.write(name, tmp_path))
    assert not differs(line), {key: value for key, value in line.items() if np.isscalar(value)}


def test_changes_are_noticed(tmp_path):
    path = models.write("base-textures", tmp_path)
    document = json.loads(path.read_text())
    for material in document["materials"]:
        r, g, b, a = material["pbrMetallicRoughness"]["baseColorFactor"]
        material["pbrMetallicRoughness"]["baseColorFactor"] = [0.7 * r, g, b, a]
    other = path.with_name("other.gltf")
    other.write_text(json.dumps(document))
    ours = np.stack(list(compare_gltf.draw_with_package(other, SIZE, 16, range(REPEATS))))
    tracer = reference.Tracer(scene.Scene(path), rt)
    truth = np.stack([tracer.picture(SIZE, 8, seed) for seed in range(REPEATS)])
    assert differs(compare_gltf.numbers(ours, truth))


def test_the_reference_keeps_energy():
    """Under light of 1 from everywhere a white dielectric reflects no more than 1, and nearly all."""
    rng = np.random.default_rng(0)
    for roughness in (0.1, 0.5, 1):
        for cosine in (0.2, 0.7, 1):
            s = object.__new__(reference.Surface)
            n = 20000
            s.normal = s.facet = np.tile([0.0, 0, 1], (n, 1))
            s.toward = np.tile([np.sqrt(1 - cosine**2), 0, cosine], (n, 1))
            s.base, s.metallic, s.roughness = np.ones((n, 4)), np.zeros(n), np.full(n, float(roughness))
            s.prepare()
            albedo = s.sample(rng)[1].mean()
            assert 0.97 < albedo < 1.01, (roughness, cosine, albedo)
