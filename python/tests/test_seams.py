"""Seamless metrics: exact seams, cones, refusals."""

import numpy as np
import pytest

import ricci


@pytest.fixture(scope="module")
def surface() -> ricci.Mesh:
    """A surface of genus 2."""
    return ricci.make("genus", genus=2, n=5)


def test_a_surface_becomes_seamless(surface: ricci.Mesh) -> None:
    made = ricci.seamless(surface, cones=8)
    assert made.converged
    assert made.summary.error < 1e-10
    assert (4 - made.cones[:, 1].astype(int)).sum() == -8
    assert made.turning.shape == (4,)
    again = ricci.seamless(surface, cones={int(v): int(k) for v, k in made.cones}, quarter_turns=made.turning)
    assert np.array_equal(again.turning, made.turning)
    assert np.array_equal(again.metric.lengths, made.metric.lengths)


def test_its_seams_are_exact(surface: ricci.Mesh) -> None:
    layout = ricci.seamless(surface).map()
    faces, corners, points = layout.mesh.F, layout.corners("refinement"), layout.points()
    sides = {}
    for f, c in zip(faces, corners, strict=True):
        for k in range(3):
            sides[int(f[k]), int(f[(k + 1) % 3])] = points[c[(k + 1) % 3]] - points[c[k]]
    turned = 0
    for (a, b), [x, y] in sides.items():
        other = -sides[b, a]
        assert any(np.array_equal(other, w) for w in ([x, y], [-y, x], [-x, -y], [y, -x]))
        turned += not np.array_equal(other, [x, y])
    assert turned > 0


def test_the_map_of_least_stretch_keeps_the_seams(surface: ricci.Mesh) -> None:
    flat = ricci.flatten_seamless(ricci.seamless(surface))
    assert flat.converged
    assert flat.summary.start == "seamless"
    assert 4 < flat.after.energy < flat.before.energy
    assert flat.energies.size == flat.summary.n_energies
    figures = flat.layout.summary
    assert figures.n_flipped == 0
    assert figures.consistency < 1e-12
    assert 4.01 < figures.symmetric_dirichlet == pytest.approx(flat.after.energy, rel=0.1)
    with pytest.raises(ricci.ArgumentError, match="number of weights"):
        ricci.flatten_seamless(ricci.seamless(surface), weights=[1.0])


def test_what_cannot_be_is_refused(surface: ricci.Mesh) -> None:
    with pytest.raises(ricci.TargetError, match="this surface has -8"):
        ricci.seamless(surface, cones={0: 5})
    with pytest.raises(ricci.ArgumentError, match="whole numbers"):
        ricci.seamless(surface, quarter_turns=[0.5, 0, 0, 0])
    with pytest.raises(ricci.ArgumentError, match="field"):
        ricci.seamless(surface, cones="few")
    with pytest.raises(ricci.ArgumentError, match="boundary"):
        ricci.seamless(ricci.make("disk", n=4), cones=4)
    with pytest.raises(ricci.ArgumentError, match="no edge"):
        ricci.seamless(surface, features=[[0, 10**6]])


def test_boundaries_become_straight() -> None:
    made = ricci.seamless(ricci.make("disk", n=5), isometric_steps=2)
    assert made.converged
    assert made.summary.length_change <= made.summary.conformal_change
    assert made.summary.n_left_out == 0
    assert made.map().summary.symmetric_dirichlet >= 4.0
    layout = made.map()
    faces, corners, points = layout.mesh.F, layout.corners("refinement"), layout.points()
    sides = {}
    for f, c in zip(faces, corners, strict=True):
        for k in range(3):
            sides[int(f[k]), int(f[(k + 1) % 3])] = points[c[(k + 1) % 3]] - points[c[k]]
    outer = [side for (a, b), side in sides.items() if (b, a) not in sides]
    assert len(outer) == made.features.shape[0] == 30
    assert all(0.0 in side for side in outer)


def test_the_field_is_a_unit_vector_in_each_face(surface: ricci.Mesh) -> None:
    field = ricci.cross_field(surface, curvature=1.0, strokes={0: [1.0, 0.0, 0.0]})
    assert field.shape == surface.F.shape
    assert np.allclose(np.linalg.norm(field, axis=1), 1.0)
