"""Splines over quad layouts: patches by a recurrence of our own, arcs, nearest places, meshes, matrices, files, refusals."""

import json
import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import BSpline
from scipy.sparse import csr_array

import ricci

AXES = np.array([1.6, 1.2, 1.0])


@pytest.fixture(scope="module")
def flat() -> ricci.Seamless:
    ball = ricci.make("sphere", n=8)
    return ricci.seamless(ricci.Mesh(ball.V * AXES, ball.F))


@pytest.fixture(scope="module")
def spline(flat: ricci.Seamless) -> ricci.QuadSpline:
    return ricci.quad_spline(flat, most_spans=2)


def test_figures_are_of_a_closed_surface(flat: ricci.Seamless, spline: ricci.QuadSpline) -> None:
    s = spline.summary
    assert s.n_patches + s.n_nodes == s.n_arcs + 2
    assert (s.degree, s.n_folded_patches, len(spline.folds)) == (5, 0, 0)
    assert s.rms <= s.max < 5e-3
    assert s.tolerance == max(1e-3, 4 * s.noise)
    assert s.converged == (max(s.max, s.vertex_max) <= s.tolerance)
    assert s.normal_jump < 1e-6
    same = ricci.quad_spline(flat, ricci.quad_layout(flat), most_spans=2, threads=1)
    assert same.summary == s
    assert np.array_equal(same.poles(0), spline.poles(0))
    assert repr(spline) == f"<ricci.QuadSpline: {s.n_patches} patches, {s.n_control_points} control points>"


def test_patches_are_their_poles_and_knots(spline: ricci.QuadSpline) -> None:
    at = np.random.default_rng(3).uniform(size=(20, 2))
    for p in range(spline.summary.n_patches):
        patch = spline.patch(p)
        poles = spline.poles(p)
        assert poles.shape == (*patch.n_poles, 3)
        assert patch.periodic == (False, False)
        bases = []
        for k, along in enumerate("uv"):
            knots, counts = spline.knots(p, along)
            assert len(knots) == patch.n_knots[k]
            bases.append(BSpline.design_matrix(at[:, k], np.repeat(knots, counts), patch.degrees[k]).toarray())
        assert np.allclose(np.einsum("ki,kj,ijx->kx", *bases, poles), spline.evaluate(p, at), atol=1e-12)


def test_patches_meet_along_arcs(spline: ricci.QuadSpline) -> None:
    seen = np.zeros(spline.summary.n_arcs, int)
    for p in range(spline.summary.n_patches):
        patch, poles, controls = spline.patch(p), spline.poles(p), spline.controls(p)
        sides = (poles[:, 0], poles[-1], poles[::-1, -1], poles[0, ::-1])
        for k, side in enumerate(sides):
            arc = spline.arc(patch.arcs[k])
            seen[patch.arcs[k]] += 1
            run = side[::-1] if patch.reversed[k] else side
            assert np.array_equal(run, spline.arc_poles(patch.arcs[k]))
            assert arc.patches[int(patch.reversed[k])] == p
            assert arc.patches[1 - int(patch.reversed[k])] == patch.neighbours[k]
            beyond = spline.controls(patch.neighbours[k])
            back = (beyond[:, 0], beyond[-1], beyond[::-1, -1], beyond[0, ::-1])[patch.neighbour_sides[k]]
            assert np.array_equal((controls[:, 0], controls[-1], controls[::-1, -1], controls[0, ::-1])[k], back[::-1])
    assert (seen == 2).all()


def test_derivatives_and_curvatures(spline: ricci.QuadSpline) -> None:
    at, step = np.array([[0.3, 0.6]]), 1e-5
    jet = spline.evaluate(0, at, "third")[0]
    assert jet.shape == (10, 3)
    for k, along in ((6, [step, 0]), (9, [0, step])):
        less, more = (spline.evaluate(0, at + sign * np.array(along), "second")[0] for sign in (-1, 1))
        before = 3 if k == 6 else 5
        assert np.allclose((more - less)[before] / (2 * step), jet[k], rtol=1e-4, atol=1e-4)
    shape = spline.evaluate([0], at, "shape")[0]
    x = jet[0]
    outwards = x / AXES**2 / np.linalg.norm(x / AXES**2)
    assert shape[:3] @ outwards > 0.999
    assert 0 > shape[3] >= shape[4]


def test_nearest_places(spline: ricci.QuadSpline) -> None:
    at = np.random.default_rng(5).uniform(0.1, 0.9, size=(spline.summary.n_patches, 2))
    patches = np.arange(len(at))
    points = spline.evaluate(patches, at) + 0.1 * spline.evaluate(patches, at, "shape")[:, :3]
    found = spline.closest(points)
    assert np.array_equal(found.patches, patches)
    assert np.allclose(found.parameters, at, atol=1e-7)
    assert np.allclose(found.distances, 0.1, atol=1e-10)
    assert np.allclose(np.linalg.norm(points - found.points, axis=1), found.distances, atol=1e-12)


def test_meshes_are_closed(flat: ricci.Seamless, spline: ricci.QuadSpline) -> None:
    s = spline.summary
    mesh = spline.tessellate(parts=5)
    assert (mesh.n_faces, mesh.n_vertices) == (50 * s.n_patches, 25 * s.n_patches + 2)
    assert mesh.summary.n_boundary_loops == 0
    assert np.array_equal(spline.patch_of_faces(mesh), np.repeat(np.arange(s.n_patches), 50))
    fine = spline.tessellate(tolerance=1e-3)
    corners = fine.V[fine.F]
    volume = np.linalg.det(corners).sum() / 6
    assert volume == pytest.approx(4 / 3 * np.pi * AXES.prod(), rel=5e-3)
    assert spline.tessellate().n_faces < fine.n_faces
    for sizes in ({"parts": 0}, {"tolerance": 0}, {"parts": 2, "tolerance": 0.1}, {"tolerance": -1.0}):
        with pytest.raises(ricci.ArgumentError):
            spline.tessellate(**sizes)


def test_matrices(spline: ricci.QuadSpline) -> None:
    s = spline.summary
    starts, columns, values = spline.extraction
    matrix = csr_array((values, columns, starts), shape=(s.n_control_points, s.n_free))
    assert matrix.nnz == s.n_entries
    assert np.allclose(matrix.sum(axis=1), 1, atol=1e-9)
    points = np.empty((s.n_control_points, 3))
    for p in range(s.n_patches):
        points[spline.controls(p)] = spline.poles(p)
    free = np.linalg.lstsq(matrix.toarray(), points, rcond=None)[0]
    assert np.allclose(matrix @ free, points, atol=1e-9)
    of_u, of_v = spline.bezier(0, "u"), spline.bezier(0, "v")
    poles = spline.poles(0)[:6, :6]
    net = np.einsum("ak,bl,klx->abx", of_u[0], of_v[0], poles)
    assert np.allclose(net[0, 0], spline.evaluate(0, [[0, 0]])[0], atol=1e-12)
    assert np.allclose(net[5, 5], spline.evaluate(0, [[1 / len(of_u), 1 / len(of_v)]])[0], atol=1e-12)


def test_poisson_s_equation_has_the_known_answer() -> None:
    main = runpy.run_path(str(Path(__file__).parents[2] / "examples" / "python" / "poisson.py"))["main"]
    coarse, fine = main("sphere", 12, 2)
    assert fine < coarse / 4
    assert fine < 4e-3
    coarse, fine = main("genus2", 4, 2)
    assert fine < coarse / 4
    assert fine < 1e-2


def test_step_files(spline: ricci.QuadSpline, tmp_path) -> None:
    spline.write_step(tmp_path / "a.step", name="part", unit="metre")
    text = (tmp_path / "a.step").read_text()
    assert text.count("ADVANCED_FACE(") == spline.summary.n_patches
    assert "'part'" in text
    with pytest.raises(ricci.FileError, match=r"known are \.step, \.stp"):
        spline.write_step(tmp_path / "a.obj")


CUBE = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]


def test_control_meshes(tmp_path: Path) -> None:
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)], float)
    smooth = ricci.fit_control_mesh(corners, CUBE, tolerance=0.01)
    assert smooth.summary.converged
    assert smooth.summary.n_patches == 6
    tessellated = smooth.tessellate(24)
    a, b, c = (np.asarray(tessellated.V)[np.asarray(tessellated.F)[:, k]] for k in range(3))
    inside = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert smooth.summary.volume == pytest.approx(inside, rel=2e-3)
    smooth.write_json(tmp_path / "cube.json")
    written = json.loads((tmp_path / "cube.json").read_text())
    assert len(written["control_points"]) == smooth.summary.n_control_points
    sheet = ricci.fit_control_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    assert np.isnan(sheet.summary.volume)
    with pytest.raises(ricci.SplineError, match="same direction"):
        ricci.fit_control_mesh(corners, [*CUBE, CUBE[0]])
    with pytest.raises(ricci.ArgumentError, match="n x 4"):
        ricci.fit_control_mesh(corners, [[0, 1, 2]])


def test_what_cannot_be_is_refused(flat: ricci.Seamless, spline: ricci.QuadSpline) -> None:
    other = ricci.seamless(ricci.make("ellipsoid", n=4, a=1.6, b=1.2, c=1))
    with pytest.raises(ricci.ArgumentError, match="another seamless metric"):
        ricci.quad_spline(flat, ricci.quad_layout(other))
    with pytest.raises(ricci.ArgumentError, match="bending"):
        ricci.quad_spline(flat, bending=1.0)
    for call in (spline.patch, spline.poles, spline.controls, spline.arc, spline.arc_poles):
        with pytest.raises(ricci.SplineError):
            call(10_000)
    with pytest.raises(ricci.SplineError):
        spline.evaluate(0, [[0.5, 1.5]])
    with pytest.raises(ricci.ArgumentError, match="none of"):
        spline.knots(0, "w")
    with pytest.raises(ricci.ArgumentError, match="point"):
        spline.closest([[0, np.nan, 0]])
    with pytest.raises(ricci.LayoutError, match="positions"):
        ricci.quad_spline(ricci.seamless(ricci.make("bolza", n=2)))
