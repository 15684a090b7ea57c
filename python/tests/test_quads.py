"""Quad meshes and layouts: counts of our own, places on the surface, sizes, refusals."""

import numpy as np
import pytest

import ricci
from ricci._structs import options
from ricci.quad_meshes import _QUADS


def euler_of(F: np.ndarray, n_vertices: int) -> int:
    """V - E + F, each edge counted once; no two quads have an edge on the same side."""
    sides = np.stack([F, np.roll(F, -1, axis=1)], axis=-1).reshape(-1, 2)
    assert len(np.unique(sides, axis=0)) == len(sides)
    return n_vertices - len(np.unique(np.sort(sides, axis=1), axis=0)) + len(F)


def check_quads(mesh: ricci.Mesh, made: ricci.Quads, euler: int) -> None:
    """The topology of the surface, and vertices on its faces."""
    n = made.summary.n_vertices
    assert made.F.shape == (made.summary.n_quads, 4)
    assert euler_of(made.F, n) == made.summary.euler == euler
    assert np.array_equal(np.unique(made.F), np.arange(n))
    faces, weights = made.places
    corners = mesh.V[mesh.F[faces]]
    assert np.allclose((weights[:, :, None] * corners).sum(axis=1), made.positions, atol=1e-12)
    assert (weights >= 0).all()
    assert np.allclose(weights.sum(axis=1), 1.0)
    assert made.rectangles.max() < made.summary.n_rectangles


def test_a_torus_without_cones_has_regular_quads_alone() -> None:
    mesh = ricci.make("torus", a=2, b=1, n=24, m=12)
    flat = ricci.seamless(mesh, cones={})
    made = ricci.quads(flat, n_quads=400)
    check_quads(mesh, made, 0)
    assert 0.8 * 400 < made.summary.n_quads < 1.2 * 400
    assert (np.bincount(made.F.ravel()) == 4).all()
    assert made.summary.n_irregular == 0
    assert made.creases.shape == (0, 2)
    again = ricci.quads(flat, edge=made.summary.edge, threads=1)
    assert np.array_equal(again.F, made.F)
    assert np.array_equal(again.positions, made.positions)


def test_an_ellipsoid_is_irregular_at_its_cones() -> None:
    ball = ricci.make("sphere", n=6)
    mesh = ricci.Mesh(ball.V * [1.0, 1.3, 1.7], ball.F)
    flat = ricci.seamless(mesh)
    made = ricci.quads(flat, n_quads=500)
    check_quads(mesh, made, 2)
    valences = np.bincount(made.F.ravel())
    assert sorted(valences[valences != 4]) == sorted(flat.cones[:, 1])
    assert (4 - valences).sum() == 8


def test_the_boundary_is_a_crease() -> None:
    mesh = ricci.make("disk", n=5)
    made = ricci.quads(ricci.seamless(mesh), n_quads=200)
    check_quads(mesh, made, 1)
    sides = {(int(a), int(b)) for quad in made.F for a, b in zip(quad, np.roll(quad, -1), strict=True)}
    border = {frozenset(side) for side in sides if side[::-1] not in sides}
    assert {frozenset(map(int, crease)) for crease in made.creases} == border


def test_patches_are_rectangles_of_quads() -> None:
    mesh = ricci.make("genus", genus=2, n=4)
    made = ricci.quad_layout(ricci.seamless(mesh))
    s = made.summary
    assert s.n_nodes - s.n_arcs + s.n_patches == -2
    assert (4 - made.nodes[:, 1]).sum() == -8
    check_quads(mesh, made.quads, -2)
    lengths = made.arcs[:, 2]
    for sides, size in zip(made.sides, made.sizes, strict=True):
        assert [int(lengths[np.abs(side) - 1].sum()) for side in sides] == [*size, *size]
    assert np.array_equal(np.bincount(made.patches), made.sizes.prod(axis=1) * s.n_parts**2)
    for along, [a, b, length, crease] in zip(made.arc_vertices, made.arcs, strict=True):
        assert [along[0], along[-1]] == [made.nodes[a, 0], made.nodes[b, 0]]
        assert len(along) == s.n_parts * length + 1
        assert crease == 0
    finer = ricci.quad_layout(ricci.seamless(mesh), n_quads=4 * s.n_units)
    assert finer.summary.n_units > s.n_units


def test_one_size_is_asked_for() -> None:
    flat = ricci.seamless(ricci.make("torus", a=2, b=1, n=8, m=6))
    with pytest.raises(ricci.ArgumentError, match="one size is needed, not n_quads and coarse"):
        ricci.quads(flat, n_quads=3, coarse=True)
    with pytest.raises(ricci.ArgumentError, match="n_quads is 0"):
        ricci.quads(flat, n_quads=0)
    with pytest.raises(ricci.ArgumentError, match="edge"):
        ricci.quads(flat, edge=-1.0)
    with pytest.raises(ricci.ArgumentError, match="coarse is 3"):
        ricci.quads(flat, coarse=3)
    assert ricci.quads(flat, coarse=True).summary.n_quads < ricci.quads(flat, coarse=False, n_quads=300).summary.n_quads


def test_the_size_that_is_given_arrives() -> None:
    for given, sizing in (({}, 0), ({"n_quads": 7}, 1), ({"edge": 0.5}, 2), ({"coarse": True}, 3), ({"at_most": 9}, 4)):
        struct = options("quads_options", {**given, "threads": 2}, _QUADS)._pointer
        assert (struct.sizing, struct.threads) == (sizing, 2)
        assert (struct.n_quads, struct.edge) == (given.get("n_quads", given.get("at_most", 0)), given.get("edge", 0.0))


def test_quads_without_positions_have_places() -> None:
    made = ricci.quads(ricci.seamless(ricci.make("bolza", n=2)), coarse=True)
    assert np.isnan(made.summary.angle_mean)
    assert made.places.weights.shape == (made.summary.n_vertices, 3)
    with pytest.raises(ricci.ArgumentError, match="positions"):
        made.positions  # noqa: B018


@pytest.mark.filterwarnings("ignore::ricci.ConvergenceWarning")
def test_a_metric_that_is_not_seamless_is_refused() -> None:
    far_off = ricci.seamless(ricci.make("genus", genus=2, n=4), quarter_turns=[9, -9, 9, -9], max_iterations=1)
    for make in (ricci.quads, ricci.quad_layout):
        with pytest.raises(ricci.LayoutError, match="seam"):
            make(far_off)
