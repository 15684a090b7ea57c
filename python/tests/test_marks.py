"""Landmarks: where curvature is extreme, far apart where it is not, and the same on surfaces of the same shape."""

import numpy as np
import pytest

import ricci

TURN = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]])


def bumpy(points):
    """The unit sphere with bumps of different heights, a function of the place alone."""
    places = np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.5, 1], [-0.7, -0.6, -0.5], [0.5, 0.6, -0.9]])
    places /= np.linalg.norm(places, axis=1, keepdims=True)
    heights = np.array([0.9, 0.55, 0.42, 0.32, 0.24])
    unit = points / np.linalg.norm(points, axis=1, keepdims=True)
    return unit * (1 + np.exp(-((1 - unit @ places.T) / 0.06)) @ heights)[:, None], places


def test_tips_of_bumps_are_the_landmarks():
    sphere = ricci.make("sphere", n=24)
    points, places = bumpy(sphere.V)
    found = ricci.landmarks(ricci.Mesh(points, sphere.F), 5)
    unit = points[found] / np.linalg.norm(points[found], axis=1, keepdims=True)
    nearest = (unit @ places.T).argmax(1)
    assert sorted(nearest.tolist()) == [0, 1, 2, 3, 4]
    assert (np.einsum("ij,ij->i", unit, places[nearest]) > 0.995).all()


def test_surfaces_of_one_shape_have_landmarks_that_correspond():
    """Two meshes of one shape, of which one is turned, larger, renumbered and rough."""
    first, second = ricci.make("sphere", n=20), ricci.make("sphere", n=25)
    a = ricci.Mesh(bumpy(first.V)[0], first.F)
    rng = np.random.default_rng(5)
    order = rng.permutation(second.n_vertices)
    turned = 3 * bumpy(second.V @ TURN.T)[0] @ TURN
    positions = np.empty_like(turned)
    positions[order] = turned + 1e-3 * rng.normal(size=turned.shape)
    b = ricci.Mesh(positions, order[second.F])
    marks = np.column_stack([ricci.landmarks(a, 5), ricci.landmarks(b, 5)])
    np.testing.assert_allclose(a.V[marks[:, 0]], b.V[marks[:, 1]] @ TURN.T / 3, atol=0.12)
    found = ricci.match(a, b, landmarks=marks)
    assert found.summary.n_flipped == 0
    assert np.median(np.linalg.norm(found.carry(b.V) @ TURN.T / 3 - a.V, axis=1)) < 0.05


def test_landmarks_do_not_depend_on_numbers_and_size():
    sphere = ricci.make("sphere", n=12)
    mesh = ricci.Mesh(bumpy(sphere.V)[0], sphere.F)
    order = np.random.default_rng(1).permutation(mesh.n_vertices)
    positions = np.empty_like(mesh.V)
    positions[order] = 1000 * mesh.V
    assert np.array_equal(ricci.landmarks(ricci.Mesh(positions, order[mesh.F]), 5), order[ricci.landmarks(mesh, 5)])


@pytest.mark.parametrize("n", [2, 4, 12])
def test_where_curvature_is_constant_they_are_far_apart(n):
    sphere = ricci.make("sphere", n=16)
    found = ricci.landmarks(sphere, n)
    assert len(set(found.tolist())) == n
    angles = np.arccos(np.clip(sphere.V[found] @ sphere.V[found].T, -1, 1))[np.triu_indices(n, 1)]
    # No n points are farther apart than those with this area each (Fejes Toth), here by a factor of 2 at most; along edges.
    assert angles.min() > 0.5 * np.sqrt(8 * np.pi / (np.sqrt(3) * n)) * 0.9


def test_farthest_points_begin_at_the_most_distinct_extreme():
    mesh = ricci.make("ellipsoid", a=4, b=1, c=1, n=12)
    found = ricci.landmarks(mesh, 3, by="distance")
    assert sorted(np.round(mesh.V[found[:2], 0]).tolist()) == [-4, 4]
    assert abs(mesh.V[found[2], 0]) < 0.5


def test_every_number_is_had(disk, pants):
    for mesh in (disk, pants, ricci.make("torus", n=16)):
        for n in (1, 7, mesh.n_vertices):
            assert len(set(ricci.landmarks(mesh, n).tolist())) == n


def test_what_has_no_landmarks_is_refused(disk):
    for n, kind in ((0, ricci.ArgumentError), (10**6, ricci.ArgumentError), (2.5, ricci.ArgumentTypeError)):
        with pytest.raises(kind, match="n is"):
            ricci.landmarks(disk, n)
    with pytest.raises(ricci.ArgumentError, match="with positions"):
        ricci.landmarks(ricci.make("bolza", n=1), 2)
    with pytest.raises(ricci.ArgumentError, match="curvature or distance"):
        ricci.landmarks(disk, 2, by="chance")
