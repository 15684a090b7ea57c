"""Uniformization, groups and covers: moduli, relations, polygons and areas that are known beforehand."""

from functools import reduce

import numpy as np
import pytest

import ricci
from ricci import models


@pytest.fixture(scope="module")
def octagon(genus2):
    return ricci.uniformize(genus2)


@pytest.mark.parametrize("tau", [0.2 + 1.3j, 0.5 + 0.9j, 3j])
def test_the_modulus_of_a_flat_torus_comes_back(tau):
    found = ricci.uniformize(ricci.make("flat_torus", a=tau.real, b=tau.imag, n=6, m=5))
    assert found.converged
    assert found.summary.modulus == pytest.approx(tau, abs=1e-12)


def test_the_modulus_of_a_torus_of_revolution():
    """R : r = 2 : 1 has tau = i / sqrt(4 - 1), reduced i sqrt(3); a mesh has it up to its size squared."""
    errors = [abs(ricci.uniformize(ricci.make("torus", a=2, b=1, n=n, m=n)).summary.modulus - 1j * np.sqrt(3)) for n in (20, 40)]
    assert errors[1] < 0.3 * errors[0] < 0.02


def test_a_sphere_flows_in_its_own_space():
    found = ricci.uniformize(ricci.make("ellipsoid", n=4, a=1, b=1.2, c=0.9), flow={"method": "gradient"})
    assert found.converged
    assert found.metric.report.converged
    assert found.summary.n_tried == 0
    np.testing.assert_allclose(np.linalg.norm(found.sphere_points(), axis=1), 1, atol=1e-12)
    with pytest.raises(ricci.LayoutError, match="plane"):
        found.sphere_points("poincare")


def test_a_sphere_lies_on_the_unit_sphere():
    found = ricci.uniformize(ricci.make("ellipsoid", n=6, a=2, b=1, c=1), flow={"tolerance": 1e-11})
    points = found.sphere_points()
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(models.to_sphere(found.sphere_points("poincare")), points, atol=1e-9)
    polyhedron = found.sphere_mesh()
    normals = np.cross(
        polyhedron.V[polyhedron.F[:, 1]] - polyhedron.V[polyhedron.F[:, 0]],
        polyhedron.V[polyhedron.F[:, 2]] - polyhedron.V[polyhedron.F[:, 0]],
    )
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    heights = np.einsum("fx,fx->f", normals, polyhedron.V[polyhedron.F[:, 0]])
    assert (normals @ polyhedron.V.T - heights[:, None]).max() < 1e-9
    with pytest.raises(ricci.LayoutError):
        found.layout()
    with pytest.raises(ricci.LayoutError):
        ricci.deck(found)


def test_generators_satisfy_the_relation(octagon):
    a1, b1, a2, b2 = ricci.deck(octagon).matrices
    product = reduce(np.matmul, [a1, b1, np.linalg.inv(a1), np.linalg.inv(b1), a2, b2, np.linalg.inv(a2), np.linalg.inv(b2)])
    np.testing.assert_allclose(product, np.eye(3), atol=1e-6)
    form = np.diag([1, 1, -1])
    np.testing.assert_allclose(a1.T @ form @ a1, form, atol=1e-8 * np.abs(a1).max() ** 2)


def test_words_are_composed_and_matrices_agree(octagon):
    one, two, both = (ricci.deck(octagon, kind="words", words=[word]) for word in ([1], [2], [1, 2]))
    np.testing.assert_allclose(one.matrices[0] @ two.matrices[0], both.matrices[0], rtol=1e-9)
    assert both.words[0].tolist() == [1, 2]
    np.testing.assert_allclose(2 * np.cosh(both.lengths / 2), both.traces, rtol=1e-9)
    points = np.array([[0.0, 0.0, 1.0]])
    np.testing.assert_allclose(both.apply(0, points)[0], both.matrices[0] @ points[0], rtol=1e-9)
    z = models.from_hyperboloid(points) @ [1, 1j]
    (a, b), (c, d) = both.mobius[0]
    moved = models.from_hyperboloid(both.apply(0, points)) @ [1, 1j]
    np.testing.assert_allclose((a * z + b) / (c * z + d), moved, atol=1e-9)


def test_the_dirichlet_domain_has_the_area_of_the_surface(octagon):
    found = ricci.dirichlet(octagon)
    assert found.summary.area == pytest.approx(4 * np.pi, abs=1e-9)
    assert np.array_equal(found.partners[found.partners], np.arange(found.summary.n_sides))
    corners = models.from_hyperboloid(found.corners, "klein")
    turns = np.cross(
        np.pad(np.roll(corners, -1, 0) - corners, ((0, 0), (0, 1))), np.pad(np.roll(corners, -2, 0) - corners, ((0, 0), (0, 1)))
    )
    assert turns[:, 2].min() > 0
    sides = ricci.deck(octagon, kind="dirichlet_sides", dirichlet=found)
    assert len(sides) == found.summary.n_sides
    with pytest.raises(ricci.ArgumentError, match=r"\(3,\) is needed"):
        ricci.dirichlet(octagon, [0, 0])


def test_copies_cover_a_disk_of_the_universal_cover(octagon):
    cover = ricci.cover(octagon, depth=1)
    assert len(cover) == 9
    assert cover.deck.words[0].tolist() == []
    assert max(np.hypot(*cover.points(k).T).max() for k in range(9)) < 1
    apart = [models.to_hyperboloid(cover.points(k, "klein"), "klein") for k in range(9)]
    np.testing.assert_allclose(apart[3], cover.points(3, "ambient"), rtol=1e-6)
    near = ricci.cover(octagon, radius=3.0)
    assert 1 <= len(near) < 40
    with pytest.raises(ricci.RicciError):
        ricci.cover(octagon, depth=6, limit=10)


def test_neighbours_lie_across_every_side(octagon):
    """Without a depth the cover is one copy and those that share a side of the layout with it."""
    cover = ricci.cover(octagon)
    across = {tuple(word) for word in ricci.deck(octagon, kind="sides").words}
    assert len(across) == octagon.summary.n_sides
    assert {tuple(word) for word in cover.deck.words} == across | {()}
    assert cover.deck.words[0].tolist() == []
    with pytest.raises(ricci.ArgumentError, match="name one of them"):
        ricci.cover(octagon, depth=1, radius=2.0)


def test_the_canonical_polygon_closes(octagon):
    corners, angles = octagon.polygon
    assert corners.shape == (8, 3)
    assert angles.sum() == pytest.approx(2 * np.pi, abs=1e-9)
    loop = octagon.homotopy.loops[0]
    end = ricci.deck(octagon).apply(0, octagon.summary.base_lift @ np.eye(3)[None])
    np.testing.assert_allclose(octagon.lift(loop)[-1], end[0], rtol=1e-9)


def test_loops_of_vertices_are_lifted(octagon, genus2):
    """A loop around a vertex closes; one that is named by the basis ends where its word carries its start."""
    loop = ricci.homotopy(genus2).loops[0]
    ends = genus2.edges[np.abs(loop) - 1]
    around = np.where(loop > 0, ends[:, 0], ends[:, 1])
    layout = octagon.layout("refinement")
    points, word = octagon.lift_loop(around, layout)
    assert len(points) > len(around)
    assert len(word) > 0
    image = ricci.deck(octagon, kind="words", words=[word]).apply(0, points[:1])
    np.testing.assert_allclose(image[0], points[-1], rtol=1e-8)
    face = genus2.F[0]
    points, word = octagon.lift_loop([*face, face[0]])
    assert word.tolist() == []
    np.testing.assert_allclose(points[0], points[-1], atol=1e-9)
    with pytest.raises(ricci.ArgumentError, match="an edge of the surface"):
        octagon.lift_loop([0, genus2.n_vertices - 1])


def test_loops_cross_as_the_names_say(genus2):
    basis = ricci.homotopy(genus2)
    expected = np.kron(np.eye(2, dtype=int), [[0, 1], [-1, 0]])
    assert np.array_equal(basis.intersections, expected)
    assert basis.text(basis.path_word(basis.loops[2])) == "a2"
    assert basis.parse("a1 b1 a1^-1").tolist() == [1, 2, -1]
    assert basis.reduce([1, 2, -1, -2, 3, 4, -3, -4]).tolist() == []
    assert basis.homology([1, 1, -2]).tolist() == [2, -1, 0, 0]
    assert basis.text([]) == "1"
    lift = basis.lift(basis.summary.base, basis.loops[1])
    assert lift[0].tolist() == []
    assert lift[-1].tolist() == [2]
    assert basis.path_word(np.concatenate([basis.loops[0], -basis.loops[0][::-1]])).tolist() == []
    far = (basis.summary.base + 100) % genus2.n_vertices
    path = basis.tree_path(far)
    assert genus2.edges[abs(path[-1]) - 1][1 if path[-1] > 0 else 0] == far
    with pytest.raises(ricci.ArgumentError):
        basis.path_word([1, 1])


def test_words_of_a_surface_with_boundary(pants):
    """c1 c2 c3 = 1, so that the last counts as minus the others."""
    basis = ricci.homotopy(pants)
    assert basis.summary.n_generators == 3
    assert basis.reduce([1, 2, 3]).tolist() == []
    assert basis.homology([1, 2, 2]).tolist() == [1, 2]
    assert basis.homology([3]).tolist() == [-1, -1]


def test_a_domain_pairs_its_sides(genus2):
    domain = ricci.homotopy(genus2).domain()
    partners = domain.partners
    assert np.array_equal(partners[partners], np.arange(len(partners)))
    for k, side in enumerate(domain.sides):
        assert np.array_equal(domain.sides[partners[k]], -side[::-1])
        assert np.array_equal(domain.elements[partners[k]], -domain.elements[k][::-1])
    vertices, words = domain.corners
    assert len(vertices) == len(words) == domain.summary.n_sides


def test_straight_sides_and_geodesic_loops(disk, pants):
    square = ricci.uniformize(disk, boundary="straight", corners=4)
    start, lengths = square.sides
    assert start.shape == lengths.shape == (4, 2)
    assert square.summary.extremal_distance == pytest.approx(1, abs=0.01)
    given = ricci.uniformize(disk, boundary="straight", corners=start[:, 1], corner_angles=[np.pi / 2] * 4)
    np.testing.assert_allclose(np.sort(given.sides[1][:, 0]), np.sort(lengths[:, 0]), rtol=1e-6)
    assert len(ricci.uniformize(disk, boundary="straight", corners=5).sides[0]) == 5
    hyperbolic = ricci.uniformize(pants)
    assert hyperbolic.summary.space == "h2"
    assert hyperbolic.summary.area == pytest.approx(2 * np.pi, abs=1e-9)
    assert hyperbolic.summary.straightness < 1e-6
    with pytest.raises(ricci.LayoutError):
        ricci.uniformize(disk)
    with pytest.raises(ricci.TargetError):
        ricci.uniformize(disk, boundary="straight", corners=start[:, 1], corner_angles=[1.0] * 4)


def test_pants_have_the_lengths_that_were_asked_for():
    found = ricci.uniformize(ricci.make("pants", a=1.0, b=2.0, c=1.5, n=3))
    np.testing.assert_allclose(np.sort(found.sides[1][:, 0]), [1.0, 1.5, 2.0], rtol=1e-9)


def test_models_are_inverse_to_each_other():
    z = np.random.default_rng(2).normal(size=(50, 2))
    ambient = np.column_stack([z, np.sqrt(1 + (z**2).sum(1))])
    for model in ("poincare", "klein", "half_plane", "ambient"):
        np.testing.assert_allclose(models.to_hyperboloid(models.from_hyperboloid(ambient, model), model), ambient, rtol=1e-9, atol=1e-9)
    unit = ambient / np.linalg.norm(ambient, axis=1, keepdims=True) * [1, 1, -1]
    np.testing.assert_allclose(models.to_sphere(models.to_plane(unit)), unit, atol=1e-12)
    assert models.to_sphere([[np.inf, np.inf]]).tolist() == [[0, 0, -1]]
    assert np.isinf(models.to_plane([[0, 0, -1]])).all()
    with pytest.raises(ricci.ArgumentError):
        models.to_plane(z)
