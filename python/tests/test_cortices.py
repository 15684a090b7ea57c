"""Cortical hemispheres: sphere, inflated view, medial wall, flat map."""

import numpy as np
import pytest

import ricci


def folded(n=10):
    ball = ricci.make("ellipsoid", n=n, a=1, b=1.6, c=1.2)
    fold = 1 + 0.08 * np.sin(9 * ball.V[:, :1]) * np.cos(8 * ball.V[:, 1:2])
    return fold * ball.V, ball.F


def area(V, F):
    return np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1).sum() / 2


def test_the_maps_of_a_hemisphere():
    V, F = folded()
    maps = ricci.brain(V, F, hemisphere="right", wall=0.1)
    assert maps.sphere_map.converged
    assert maps.flat_map.converged
    np.testing.assert_allclose(np.linalg.norm(maps.sphere, axis=1), 100, rtol=1e-13)
    assert (np.linalg.det(maps.sphere[F]) > 0).all()
    # The wall of a right hemisphere lies at small x.
    assert V[~maps.cortex, 0].max() < 0
    number = np.cumsum(maps.cortex) - 1
    a, b, c = (maps.flat[number[maps.faces[:, k]]] for k in range(3))
    assert ((b - a)[:, 0] * (c - a)[:, 1] > (b - a)[:, 1] * (c - a)[:, 0]).all()
    assert maps.flat.shape == (len(maps.vertices), 2)
    np.testing.assert_allclose(area(maps.inflated, F), area(V, F), rtol=1e-12)


def test_inflation_smooths_folds_and_its_end_is_round():
    V, F = folded()
    spreads = []
    for time in (0.001, 0.01, 1):
        view = ricci.inflate(V, F, time=time)
        lengths = np.linalg.norm(view - view.mean(axis=0), axis=1)
        spreads.append(lengths.std() / lengths.mean())
    assert spreads[0] > spreads[1] > spreads[2]
    assert spreads[2] < 0.02


def test_a_given_cortex_is_cleaned_and_what_is_no_hemisphere_is_refused():
    V, F = folded(6)
    marked = V[:, 0] < 0.6
    kept = ricci.flat_part(V, F, marked=marked)
    assert not (kept & ~marked).any()
    maps = ricci.brain(V, F, cortex=marked)
    assert (maps.cortex == kept).all()
    with pytest.raises(ricci.ArgumentError, match="three vertices"):
        ricci.flat_part(V, F, marked=np.zeros(len(V)))
    with pytest.raises(ricci.ArgumentError, match="hemisphere"):
        ricci.medial_wall(V, F, view=V, hemisphere="both")
    with pytest.raises(ricci.ArgumentError, match="share"):
        ricci.medial_wall(V, F, view=V, share=2)
    with pytest.raises(ricci.ArgumentError, match="closed"):
        ricci.inflate(ricci.make("disk", n=3))
    with pytest.raises(ricci.ArgumentError, match="time"):
        ricci.inflate(V, F, time=0)
