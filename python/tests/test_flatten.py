"""Flat maps of least stretch."""

import numpy as np
import pytest

import ricci


def bent(n, place):
    x, y = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n)))
    a = (n * np.arange(n - 1)[:, None] + np.arange(n - 1)).ravel()
    faces = np.concatenate([np.stack([a, a + 1, a + n + 1], 1), np.stack([a, a + n + 1, a + n], 1)])
    return place(x, y), faces


def test_what_unrolls_keeps_its_lengths():
    V, F = bent(12, lambda x, y: np.stack([np.sin(2 * x), y, np.cos(2 * x)], 1))
    for energy in ("isometric", "arap"):
        flat = ricci.flatten(V, F, energy=energy)
        assert flat.converged
        assert flat.after.max_length_error < 1e-12
        sides = [np.linalg.norm(P[F[:, 0]] - P[F[:, 1]], axis=1) for P in (V, flat.points)]
        np.testing.assert_allclose(*sides, rtol=1e-12)


def test_the_energy_is_that_of_the_points_and_nothing_is_turned_over():
    V, F = bent(15, lambda x, y: np.stack([x, y, np.sin(3 * x) * np.cos(2 * y)], 1))
    flat = ricci.flatten(V, F)
    p, q = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    length = np.linalg.norm(p, axis=1)
    along = (p * q).sum(1) / length
    across = np.linalg.norm(np.cross(p, q), axis=1) / length
    rest = np.stack([np.stack([length, along], 1), np.stack([0 * length, across], 1)], 1)
    image = np.stack([flat.points[F[:, 1]] - flat.points[F[:, 0]], flat.points[F[:, 2]] - flat.points[F[:, 0]]], 2)
    maps = image @ np.linalg.inv(rest)
    assert (np.linalg.det(maps) > 0).all()
    s = np.linalg.svd(maps, compute_uv=False)
    area = length * across
    np.testing.assert_allclose(((s**2 + s**-2).sum(1) * area).sum() / area.sum(), flat.after.energy, rtol=1e-12)
    np.testing.assert_allclose([s.min(), s.max()], [flat.after.least_stretch, flat.after.most_stretch], rtol=1e-12)
    assert flat.after.energy < flat.before.energy
    assert (np.diff(flat.energies) < 1e-13).all()
    assert flat.energies[-1] == flat.summary.energy


def test_conditions_are_met():
    V, F = bent(11, lambda x, y: np.stack([x, y, 0.3 * np.sin(3 * x) * np.cos(2 * y)], 1))
    free = ricci.flatten(V, F)
    assert free.summary.one_to_one
    pins = {0: [0, 0], 10: [1.1, 0.25]}
    sides = [list(range(11)), list(range(10, 121, 11))]
    flat = ricci.flatten(V, F, pins=pins, straight=sides, injective=True)
    assert flat.converged
    assert flat.summary.one_to_one
    assert flat.summary.misfit < 1e-12
    for vertex, place in pins.items():
        assert (flat.points[vertex] == place).all()
    for side in sides:
        along = flat.points[side] - flat.points[side[0]]
        off = along[:, 0] * along[-1, 1] - along[:, 1] * along[-1, 0]
        assert np.abs(off).max() < 1e-11
    assert flat.after.energy > free.after.energy
    weights = np.where(np.arange(len(F)) < len(F) / 2, 50.0, 1.0)
    heavy = ricci.flatten(V, F, weights=weights)
    assert heavy.after.energy > free.after.energy
    distance = ricci.flatten(V, F, energy="distance", rings=3)
    assert distance.converged
    assert distance.after.mean_length_error < free.after.mean_length_error
    with pytest.raises(ricci.ArgumentError, match="number of weights"):
        ricci.flatten(V, F, weights=[1, 2])
    with pytest.raises(ricci.ArgumentError, match="straight piece"):
        ricci.flatten(V, F, straight=[[1, 2]])


def test_a_map_to_the_sphere_turns_nothing_over():
    ball = ricci.make("ellipsoid", n=8, a=1, b=1.5, c=2)
    found = ricci.flatten_sphere(ball)
    assert found.converged
    assert found.summary.one_to_one
    np.testing.assert_allclose(np.linalg.norm(found.points, axis=1), 1, rtol=1e-14)
    corners = found.points[ball.F]
    assert (np.linalg.det(corners) > 0).all()
    assert found.after.energy < found.before.energy
    areas = ricci.flatten_sphere(ball, energy="area")
    assert areas.after.mean_area_error < found.after.mean_area_error
    with pytest.raises(ricci.ArgumentError, match="Euler characteristic 1"):
        ricci.flatten_sphere(ricci.make("disk", n=3))


def test_options_and_what_is_refused():
    disk = ricci.make("disk", n=6)
    bowl = np.column_stack([disk.V[:, :2], 0.5 * (disk.V[:, :2] ** 2).sum(1)])
    lengths, areas = (ricci.flatten(bowl, disk.F, energy=energy).after for energy in ("isometric", "area"))
    assert areas.mean_area_error < lengths.mean_area_error
    angles = ricci.flatten(bowl, disk.F, conformal=0.8).after
    assert angles.mean_dilatation < lengths.mean_dilatation
    with pytest.warns(ricci.ConvergenceWarning, match="max_iterations"):
        assert not ricci.flatten(bowl, disk.F, max_iterations=1, tolerance=1e-12).converged
    with pytest.raises(ricci.LayoutError, match="genus 0 and 0 boundary loops"):
        ricci.flatten(ricci.make("sphere", n=3))
    with pytest.raises(ricci.ArgumentError, match="conformal"):
        ricci.flatten(disk, conformal=2)
    with pytest.raises(ricci.ArgumentError, match="tolerance"):
        ricci.flatten(disk, tolerance=0)
