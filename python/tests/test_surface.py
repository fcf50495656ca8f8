"""Surfaces: the answer and its parts, what the checker says, what is refused."""

import json
import pickle

import numpy as np
import pytest

import taut


def torus(around=40, center=(0.0, 0.0, 0.0)):
    u, v = np.meshgrid(np.arange(around) * (2 * np.pi / around), np.arange(around // 2) * (4 * np.pi / around))
    u, v = u.ravel(), v.ravel() + 0.01 * u.ravel()
    ring = 2 + 0.7 * np.cos(v)
    return np.c_[ring * np.cos(u), ring * np.sin(u), 0.7 * np.sin(v)] + center


@pytest.fixture(scope="module")
def two():
    points = np.r_[torus(), torus(center=(9.0, 0.0, 0.0))]
    return np.random.default_rng(7).permutation(np.r_[points, points[:1]])


def test_parts_and_handles_are_counted(two):
    found = taut.surface(two)
    answer = found.answer
    assert isinstance(answer, taut.Surface) and isinstance(answer.components, tuple)
    assert answer.triangles.dtype == np.uint32 and answer.triangles.shape == (3200, 3)
    assert answer.vertices is None and answer.genus == 2 and answer.boundary_loops == 0
    assert answer.euler_characteristic == 0 and answer.non_manifold_edges == answer.inconsistent_edges == 0
    for part in answer.components:
        assert isinstance(part, taut.SurfaceComponent)
        assert (part.genus, part.triangles, part.boundary_loops, part.orientable) == (1, 1600, 0, True)
    ((copy, first),) = answer.duplicates
    assert copy > first and (two[copy] == two[first]).all()
    assert len(answer.outliers) == len(answer.interior) == len(answer.unreferenced) == 0
    corners = two[answer.triangles]
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(2 * 2 * np.pi**2 * 2 * 0.7**2, rel=0.03)


def test_trimesh_agrees(two):
    trimesh = pytest.importorskip("trimesh")
    found = taut.surface(two)
    mesh = trimesh.Trimesh(two, found.answer.triangles, process=False)
    mesh.remove_unreferenced_vertices()
    assert mesh.is_watertight and mesh.is_winding_consistent and mesh.volume > 0
    assert mesh.euler_number == found.answer.euler_characteristic


def test_verdicts_and_certificates(two):
    found = taut.surface(two)
    verdict = found.check(two)
    assert isinstance(verdict, taut.SurfaceVerdict)
    assert verdict.certified and verdict.doubt is None and verdict.genus == 2
    assert verdict.closed and verdict.manifold and verdict.oriented and verdict.embedded
    assert verdict.delaunay and verdict.outward and verdict.displacement == 0.0
    assert isinstance(found.certificate, taut.SurfaceCertificate)
    assert found.certificate.method == "tree" and len(found.certificate.apexes) == len(found.answer.triangles)
    again = taut.Solution.from_json(found.to_json())
    assert again == found and pickle.loads(pickle.dumps(found)) == found
    assert taut.verify(found.to_json(), two).certified
    lie = json.loads(found.to_json())
    lie["answer"]["triangles"][5].reverse()
    with pytest.raises(taut.Violation):
        taut.verify(json.dumps(lie), two)
    with pytest.raises(taut.Violation, match="hash"):
        found.check(two + 1.0)


def test_single_precision_threads_and_order(two):
    narrow = two.astype(np.float32)
    wide = taut.surface(narrow.astype(np.float64))
    assert (taut.surface(narrow).answer.triangles == wide.answer.triangles).all()
    assert taut.surface(two, threads=1) == taut.surface(two, threads=3)


@pytest.mark.parametrize("method", ["thesis", "alpha", "hull"])
def test_other_methods_pass_the_checker(two, method):
    found = taut.surface(two, method=method)
    assert found.certificate.method == method
    assert found.check(two).delaunay
    few = taut.surface(two, method=method, alpha=0.2)
    assert len(few.answer.triangles) <= len(found.answer.triangles)
    few.check(two)


def test_open_sheets_and_noise():
    x, y = np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-1, 1, 21))
    x, y = x.ravel(), y.ravel() + 1e-3 * x.ravel() ** 2
    sheet = np.c_[x, y, 0.3 * (x * x - y * y)]
    found = taut.surface(sheet, open=True)
    assert found.answer.boundary_loops == 1 and found.answer.genus == 0
    assert not found.check(sheet).closed
    rng = np.random.default_rng(3)
    ball = rng.normal(size=(3000, 3))
    ball *= (1 + 0.01 * rng.normal(size=(3000, 1))) / np.linalg.norm(ball, axis=1, keepdims=True)
    smooth = taut.surface(ball, denoise=True)
    assert smooth.answer.vertices.shape == (3000, 3)
    off = np.abs(np.linalg.norm(smooth.answer.vertices, axis=1) - 1).mean()
    assert off < 0.6 * np.abs(np.linalg.norm(ball, axis=1) - 1).mean()
    assert smooth.check(ball).displacement > 0
    kept = taut.surface(ball, denoise=True, original=True)
    assert kept.answer.vertices is None
    kept.check(ball)


def test_bad_input_is_refused(two):
    with pytest.raises(ValueError, match="row|point"):
        taut.surface([[0, 0, 0], [1, 0, np.nan], [0, 1, 0], [0, 0, 1]])
    with pytest.raises(ValueError, match="2 coordinates"):
        taut.surface([[0, 0], [1, 0], [0, 1]])
    with pytest.raises(ValueError, match="plane"):
        taut.surface([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    with pytest.raises(ValueError, match="method"):
        taut.surface(two, method="poisson")
    with pytest.raises(ValueError, match="priority"):
        taut.surface(two, method="thesis", priority="nearest")
    with pytest.raises(ValueError, match="epsilon"):
        taut.surface(two, method="thesis", epsilon=1.0)
    with pytest.raises(ValueError, match="neighbors"):
        taut.surface(two, denoise=True, neighbors=3)
    with pytest.raises(ValueError, match="iterations.*from 0 to 100"):
        taut.surface(two, denoise=True, iterations=-3)


@pytest.mark.parametrize(
    "options",
    [
        {"alpha": 0.1},
        {"neighbors": 30},
        {"original": True},
        {"open": True, "method": "hull"},
        {"epsilon": 1e-3, "method": "alpha"},
        {"sliver_angle": 0.2, "method": "hull"},
        {"priority": "circumradius"},
        {"restarts": True},
    ],
)
def test_options_of_others_are_not_passed_over(two, options):
    name = next(iter(options))
    with pytest.raises(ValueError, match=f"option `{name}` is of"):
        taut.surface(two, **options)
