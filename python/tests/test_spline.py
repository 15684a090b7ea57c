"""Splines: polynomials are reproduced, derivatives are those of finite differences, files and patches say all of it."""

import json

import numpy as np
import pytest

import ricci

SQUARE = np.array([[0, 0], [2, 0], [2, 1], [0, 1]], float)


@pytest.fixture(scope="module")
def plane():
    return ricci.Spline.plane(ricci.spline_domain([SQUARE], 0.3), degree=3)


@pytest.fixture(scope="module")
def hill(plane):
    """The graph of x^2 - 2 x y + y / 2."""
    coefficients = np.zeros((10, 3))
    coefficients[1, 0] = coefficients[2, 1] = 1
    coefficients[[3, 4, 2], 2] = 1, -2, 0.5
    return plane.with_polynomial(coefficients)


def height(x, y):
    return x * x - 2 * x * y + y / 2


PLACES = np.random.default_rng(4).uniform([0.05, 0.05], [1.95, 0.95], (200, 2))


def test_a_domain_fills_its_polygons():
    hole = [[0.5, 0.3], [0.5, 0.7], [1.0, 0.5]]
    domain = ricci.spline_domain([SQUARE, hole], 0.2)
    a, b, c = (domain.V[domain.F[:, k], :2] for k in range(3))
    area = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    assert area.min() > 0
    assert area.sum() == pytest.approx(2 - 0.1, abs=1e-12)
    assert len(domain.boundary) == 2
    with pytest.raises(ricci.SplineError):
        ricci.spline_domain([SQUARE[[0, 2, 1, 3]]], 0.2)


def test_a_polynomial_is_reproduced_with_its_derivatives(hill):
    x, y = PLACES.T
    found = hill.evaluate(PLACES, what="second")
    expected = {0: height(x, y), 1: 2 * x - 2 * y, 2: -2 * x + 0.5, 3: 2 + 0 * x, 4: -2 + 0 * x, 5: 0 * x}
    for row, values in expected.items():
        np.testing.assert_allclose(found[:, row, 2], values, atol=1e-9)
    assert np.array_equal(hill.evaluate(PLACES), found[:, 0])
    assert np.array_equal(hill.evaluate(PLACES, what="first"), found[:, :3])


def test_curvatures_are_those_of_the_graph(hill):
    x, y = PLACES.T
    p, q = 2 * x - 2 * y, -2 * x + 0.5
    found = hill.evaluate(PLACES, what="shape")
    gauss = (2 * 0 - 4) / (1 + p * p + q * q) ** 2
    np.testing.assert_allclose(found[:, 3] * found[:, 4], gauss, rtol=1e-8)
    np.testing.assert_allclose(found[:, :3], np.column_stack([-p, -q, 1 + 0 * p]) / np.sqrt(1 + p * p + q * q)[:, None], atol=1e-9)


def test_a_fit_finds_the_polynomial_again(plane, hill):
    points = np.column_stack([PLACES, height(*PLACES.T)])
    fitted = plane.fit(points, fairness=1e-14)
    assert fitted.summary.fit_max < 1e-6
    np.testing.assert_allclose(fitted.evaluate(PLACES)[:, 2], points[:, 2], atol=1e-6)
    elsewhere = plane.fit(points + [5, 0, 0], places=PLACES)
    np.testing.assert_allclose(elsewhere.evaluate(PLACES), points + [5, 0, 0], atol=1e-4)


def test_parts_of_a_spline_fit_together(hill):
    s = hill.summary
    assert hill.knots.shape == (s.n_patches, 3, 4, 2)
    assert hill.controls.max() + 1 == s.n_control_points == len(hill.control_points)
    np.testing.assert_allclose(hill.control_points[:, :2], hill.abscissas, atol=1e-12)
    assert hill.holes.shape == (0, 2)
    patches = hill.locate([[1, 0.5], [9, 9]])
    assert patches[0] >= 0
    assert patches[1] == -1
    corner = hill.knots[patches[0], 0, 0]
    np.testing.assert_allclose(hill.blossom(int(patches[0]), [corner] * 3)[2], height(*corner), atol=1e-9)
    moved = hill.with_points(hill.control_points + [0, 0, 1])
    np.testing.assert_allclose(moved.evaluate(PLACES), hill.evaluate(PLACES) + [0, 0, 1], atol=1e-12)


def test_files_and_texts_keep_every_bit(tmp_path, hill):
    hill.write(tmp_path / "hill.json")
    for again in (ricci.Spline.read(tmp_path / "hill.json"), ricci.Spline.parse(hill.text())):
        assert np.array_equal(again.evaluate(PLACES), hill.evaluate(PLACES))
    with pytest.raises(ricci.ParseError):
        ricci.Spline.parse(hill.text()[:-20])


def test_places_outside_are_named(hill):
    with pytest.raises(ricci.SplineError) as wrong:
        hill.evaluate([[1, 0.5], [7, 7]])
    assert wrong.value.index == 1
    with pytest.raises(ricci.ArgumentError):
        hill.evaluate(PLACES, patches=[0])
    with pytest.raises(ricci.ArgumentError):
        ricci.Spline.plane(ricci.spline_domain([SQUARE], 0.3), degree=6)
    with pytest.raises(ricci.ArgumentError, match="knots have shape"):
        ricci.Spline.plane(ricci.spline_domain([SQUARE], 0.3), knots=np.zeros((2, 2)))


@pytest.fixture(scope="module")
def ring():
    return ricci.spline(ricci.make("torus", a=2, b=0.8, n=40, m=20), rounds=2)


def test_a_whole_torus_is_fitted(ring):
    s = ring.summary
    assert (s.degree, s.n_holes) == (3, 0)
    assert s.n_control_points <= 300
    centres = ring.knots[:, :, 0].mean(1)
    points = ring.evaluate(centres, patches=np.arange(s.n_patches))
    off = np.abs(np.hypot(np.hypot(points[:, 0], points[:, 1]) - 2, points[:, 2]) - 0.8)
    assert off.max() < 0.05
    patches, parameters, nearest, distance = ring.closest(points * 1.1)
    control = ricci.Control()
    control.set_threads(1)
    backwards = ring.closest(points[::-1] * 1.1, control)
    assert all(np.array_equal(found[::-1], again) for found, again in zip((patches, parameters, nearest, distance), backwards, strict=True))
    with pytest.raises(ricci.ArgumentTypeError, match="threads"):
        control.set_threads(-1)
    np.testing.assert_allclose(np.linalg.norm(nearest - points * 1.1, axis=1), distance, atol=1e-12)
    np.testing.assert_allclose(ring.evaluate(parameters, patches), nearest, atol=1e-9)


def test_a_tessellation_is_the_surface_again(ring):
    mesh = ring.tessellate(3)
    assert mesh.n_faces == 9 * ring.summary.n_patches
    assert (mesh.genus, mesh.boundary) == (1, [])
    assert mesh.normals is not None
    assert mesh.uv is not None


def test_patches_for_cad(tmp_path, ring):
    patches = ricci.bicubic(ring, tolerance=1e-3)
    s = patches.summary
    assert s.n_patches == 3 * ring.summary.n_patches
    assert s.closed
    assert s.n_open_sides == 0
    assert s.distance <= 1e-3
    patches.write(tmp_path / "ring.step", name="ring", unit="metre")
    step = (tmp_path / "ring.step").read_text()
    assert step.startswith("ISO-10303-21")
    assert "'ring'" in step
    assert step == patches.text("step", name="ring", unit="metre")
    assert json.loads(patches.text("json"))["format"].startswith("ricci-patches")
    with pytest.raises(ricci.FileError):
        patches.write(tmp_path / "ring.iges")


def test_surfaces_of_other_topology(genus2):
    hole = ricci.spline(ricci.flow(genus2, target="single:0"), degree=2, rounds=1, corrections=-1)
    assert hole.holes[:, 0].tolist() == [3]
    disk = ricci.spline(ricci.make("disk", n=14), degree=2, rounds=1)
    assert disk.summary.n_holes == 0
    with pytest.raises(ricci.ArgumentError, match="number of singular vertices"):
        ricci.flat_metric(ricci.make("sphere", n=4))


def test_a_fit_says_whether_it_holds():
    ball = ricci.make("sphere", n=12)
    fitted = ricci.spline(ball)
    assert fitted.summary.converged
    assert fitted.summary.n_folded_patches == 0
    assert fitted.summary.fit_max < 0.01 * 2 * 3**0.5
    rough = ricci.Spline.of_mesh(ball, tolerance=1e-9, control_points=200, rounds=1)
    assert not rough.summary.converged
    assert rough.summary.fit_max > 1e-9


def test_singular_vertices_are_chosen_counted_or_named():
    ball = ricci.make("sphere", n=8)
    four = ricci.flat_metric(ball, singular=4)
    fitted = ricci.spline(four, degree=2, rounds=1)
    assert fitted.summary.n_holes == 4
    assert fitted.holes[:, 0].sum() == pytest.approx(4 - 2, abs=1e-6)
    named = ricci.Spline.of_surface(ricci.flat_metric(ball, singular=[0, 100, 200, 300]), degree=2, rounds=1)
    assert named.summary.n_holes == 4
    with pytest.raises(ricci.RicciError):
        ricci.flat_metric(ball, singular=[0, 0, 1])
    with pytest.raises(ricci.ArgumentError):
        ricci.flat_metric(ball, singular="all")
