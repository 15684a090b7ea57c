"""Atlases: transitions carry shared vertices, holonomy satisfies the relation, points lie in charts consistently."""

import numpy as np
import pytest

import ricci


def mobius(matrix, points):
    z = points @ [1, 1j]
    (a, b), (c, d) = matrix
    moved = (a * z + b) / (c * z + d)
    return np.column_stack([moved.real, moved.imag])


def projective(matrix, points):
    moved = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    return moved[:, :2] / moved[:, 2:]


@pytest.mark.parametrize(("kind", "act"), [("hyperbolic", mobius), ("projective", projective), ("affine", projective)])
def test_transitions_carry_shared_vertices(genus2, kind, act):
    found = ricci.structure(genus2, kind=kind)
    charts, matrices = found.transitions
    assert len(charts) == found.summary.n_transitions > 0
    for k in range(0, len(charts), 97):
        first, second = (found.coordinates(int(chart)) for chart in charts[k])
        pairs = found.shared[k]
        np.testing.assert_allclose(act(matrices[k], first[pairs[:, 0]]), second[pairs[:, 1]], atol=1e-7 * max(1, np.abs(second).max()))
    assert found.summary.cocycle_residual < 1e-6


def test_charts_are_made_of_the_faces_of_the_triangulation(genus2):
    found = ricci.structure(genus2, kind="hyperbolic", charts="patches")
    assert found.folded.size == found.excluded.size == 0
    for chart in range(0, found.summary.n_charts, 5):
        faces, corners, vertices = found.chart_faces[chart], found.chart_corners[chart], found.chart_vertices[chart]
        assert np.array_equal(vertices[corners], found.F[faces])
    with pytest.raises(ricci.ArgumentError):
        found.coordinates(found.summary.n_charts)


def test_holonomy_satisfies_the_relation(genus2):
    a1, b1, a2, b2 = ricci.structure(genus2, kind="hyperbolic").holonomy
    inverse = np.linalg.inv
    product = a1 @ b1 @ inverse(a1) @ inverse(b1) @ a2 @ b2 @ inverse(a2) @ inverse(b2)
    product /= np.sqrt(np.linalg.det(product).astype(complex))
    np.testing.assert_allclose(product * np.sign(product[0, 0].real), np.eye(2), atol=1e-6)


def test_places_of_a_point_agree(genus2):
    found = ricci.structure(genus2, kind="affine")
    face = int(found.chart_faces[0][0])
    places = found.places(face, [0.2, 0.3, 0.5])
    assert len(places) >= 2
    start = [[places[0].x, places[0].y]]
    for place in places[1:]:
        np.testing.assert_allclose(found.carry(places[0], place, start), [[place.x, place.y]], atol=1e-9)
    with pytest.raises(ricci.ArgumentError):
        found.places(face, [-1.0, 1.0, 1.0])


def test_affine_structures_have_one_singular_vertex_or_zeros(genus2):
    flow = ricci.structure(genus2, kind="affine", singular=7)
    assert flow.singular.tolist() == [7]
    form = ricci.structure(genus2, kind="affine", source="form")
    assert form.zeros[:, 1].sum() == 2
    rotation = form.transitions[1][:, :2, :2]
    np.testing.assert_allclose(rotation / rotation[:, :1, :1], np.broadcast_to(np.eye(2), rotation.shape), atol=1e-8)


def test_integer_structures_have_whole_coordinates_and_transitions(torus, genus2):
    for mesh in (torus, genus2):
        found = ricci.structure(mesh, kind="integer", n_quads=300)
        assert found.summary.kind == "integer"
        charts = [found.coordinates(k) for k in range(found.summary.n_charts)]
        assert all(np.array_equal(xy, np.round(xy)) for xy in charts)
        assert np.array_equal(found.transitions[1], np.round(found.transitions[1]))
        assert found.summary.transition_residual == 0.0
        assert found.summary.n_faces % 2 == 0
    with pytest.raises(ricci.ArgumentError):
        ricci.structure(torus, kind="affine", n_quads=300)


def test_every_structure_of_a_surface(torus, genus2):
    assert set(ricci.structures(torus)) == {"conformal", "affine"}
    assert "spherical" in ricci.structures(ricci.make("sphere", n=3))
    assert set(ricci.structures(genus2)) == {"conformal", "affine", "hyperbolic", "projective"}
    for kind, found in (ricci.structures(ricci.make("sphere", n=3)) | ricci.structures(genus2)).items():
        assert found.summary.kind == kind
    with pytest.raises(ricci.ArgumentError, match="'zeros' is none of conformal, spherical"):
        ricci.structure(torus, kind="zeros")
    with pytest.raises(ricci.ArgumentError):
        ricci.structure(torus, kind="hyperbolic")
