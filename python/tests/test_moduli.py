"""Period matrices with bounds: known moduli, and the width that is asked for."""

import math

import numpy as np
import pytest

import ricci


def test_a_flat_torus_is_known_to_rounding():
    bounds = ricci.period_bounds(ricci.forms(ricci.make("flat_torus", a=0.25, b=1.5, n=5)))
    assert bounds.summary.gap < 1e-10
    assert bounds.summary.reached
    assert bounds.summary.n_added == 0
    assert abs(bounds.summary.modulus - (0.25 + 1.5j)) <= bounds.summary.modulus_radius + 1e-14


def test_narrower_bounds_lie_within_wider_ones():
    forms = ricci.forms(ricci.make("genus", genus=2, n=4))
    as_they_are = ricci.period_bounds(forms, width=math.inf, degree="linear")
    assert as_they_are.summary.n_systems == 1
    assert as_they_are.summary.gap > 1e-3
    wide = ricci.period_bounds(forms)
    narrow = ricci.period_bounds(forms, width=1e-5)
    assert narrow.summary.reached
    assert narrow.summary.gap <= 1e-5 < wide.summary.gap <= 1e-3
    for bounds in (as_they_are, wide):
        assert (np.abs(bounds.matrix - narrow.matrix) <= bounds.radius + narrow.radius).all()
    assert (np.linalg.eigvalsh(narrow.matrix.imag) > 0).all()
    assert (narrow.matrix == narrow.matrix.T).all()


def test_what_has_no_period_matrix_is_refused():
    with pytest.raises(ricci.LayoutError, match="closed"):
        ricci.period_bounds(ricci.forms(ricci.make("annulus")))
    with pytest.raises(ricci.ArgumentError, match="width"):
        ricci.period_bounds(ricci.forms(ricci.make("torus", n=8)), width=0)


def test_cancelling_ends_the_search():
    forms = ricci.forms(ricci.make("genus", genus=2, n=4))
    control = ricci.Control()
    control.cancel()
    with pytest.raises(ricci.Cancelled):
        ricci.period_bounds(forms, control)


def test_the_bolza_surface_has_its_shortest_geodesics():
    bolza = ricci.uniformize(ricci.make("bolza", n=1))
    found = ricci.deck(bolza, kind="geodesics", radius=6.2, limit=1_000_000)
    exact = [2 * math.acosh(m + n * math.sqrt(2)) for m, n in ((1, 1), (3, 2), (5, 3), (5, 4))]
    assert np.allclose(np.unique(np.round(found.lengths, 8)), np.round(exact, 8))
    assert (found.lengths < 3.1).sum() == (found.powers == 2).sum() == 12
    faces, weights = found.geodesic(0)
    assert len(faces) == len(weights) > 2
    assert np.allclose(weights.sum(1), 1)
    with pytest.raises(ricci.ArgumentError, match="GEODESICS"):
        _ = ricci.deck(bolza).powers


def test_lengths_of_fenchel_nielsen_coordinates_are_those_of_their_curves():
    curved = ricci.uniformize(ricci.make("genus", genus=3, n=4))
    coordinates = ricci.fenchel_nielsen(curved)
    words = [[1], [3], [5], [1, 2, -1, -2], [3, 4, -3, -4], [5, 6, -5, -6]]
    assert np.allclose(coordinates[:, 0], ricci.deck(curved, kind="words", words=words).lengths)
    with pytest.raises(ricci.LayoutError):
        ricci.fenchel_nielsen(ricci.uniformize(ricci.make("torus", n=8)))


def test_lengths_and_twists_lead_to_a_surface_and_back():
    points = [2 + 0.4j, 3 - 1j, 2.5 + 0.7j]
    surface = ricci.make("fenchel_nielsen", genus=1, points=[2 + 0.4j, 3 - 1j, 1.5, 0.7], n=1)
    assert (surface.genus, surface.summary.n_boundary_loops) == (1, 2)
    loops = ricci.make_loops(1, [2 + 0.4j, 3 - 1j, 1.5, 0.7], 1)
    found = ricci.fenchel_nielsen(ricci.uniformize(surface), loops)
    assert np.abs(found - [[2, 0.4], [3, -1]]).max() < 1e-10
    closed = ricci.uniformize(ricci.make("fenchel_nielsen", genus=2, points=points))
    assert np.abs(ricci.fenchel_nielsen(closed, ricci.make_loops(2, points)) - [[2, 0.4], [3, -1], [2.5, 0.7]]).max() < 1e-10
    with pytest.raises(ricci.LayoutError, match="canonical basis"):
        ricci.fenchel_nielsen(closed, [ricci.make_loops(2, points)[k] for k in (1, 2, 0, 3)])
    with pytest.raises(ricci.ArgumentError, match="twist"):
        ricci.make("fenchel_nielsen", points=[2, 2, 2 + 100j])


def test_named_curves_have_the_lengths_of_canonical_ones():
    two = ricci.uniformize(ricci.make("genus", genus=2, n=4))
    canonical = ricci.fenchel_nielsen(two)
    found = ricci.pants(ricci.deck(two, kind="words", words=[[1], [3], [1, 2, -1, -2]]))
    assert np.abs(found[:, 0] - canonical[:, 0]).max() < 1e-10
    turns = (found[:, 1] - canonical[:, 1]) / (0.5 * canonical[:, 0])
    assert np.abs(turns - turns.round()).max() < 1e-8
    with pytest.raises(ricci.LayoutError, match="a1 and b1 cross"):
        ricci.pants(ricci.deck(two, kind="words", words=[[1], [2], [3]]))


def test_moduli_lie_between_their_bounds():
    ring = ricci.modulus_bounds(ricci.make("annulus", a=0.4, b=1.0, n=24), width=1e-5)
    assert ring.low < ring.high < ring.low * (1 + 2.1e-5)
    assert abs(ring.low - math.log(2.5) / (2 * math.pi)) < 2e-3
    V = [[x, y, 0] for y in (0, 1) for x in (0, 1, 2)]
    F = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]
    box = ricci.modulus_bounds(ricci.Mesh(V, F), [0, 2, 5, 3])
    assert box.low <= 0.5 <= box.high < box.low + 1e-12
    with pytest.raises(ricci.ArgumentError, match="corner"):
        ricci.modulus_bounds(ricci.Mesh(V, F))


def test_flat_tori_have_the_distance_of_their_moduli():
    square, long = ricci.make("flat_torus", n=6, m=6), ricci.make("flat_torus", b=3.0, n=5, m=5)
    found = ricci.dilatation_bracket(ricci.match(square, long))
    assert found.lower_by == "periods"
    assert found.n_left_out == 0 or found.left_out_area < 1e-6
    assert abs(found.lower - 3) < 1e-8
    assert abs(found.upper - 3) < 1e-6
    with pytest.raises(ricci.ArgumentError, match="four"):
        ricci.dilatation_bracket(ricci.match(square, long), [[0, 0]])


def test_distances_of_a_family_of_tori_are_those_of_the_modular_surface():
    moduli = [1j, 0.2 + 1.1j, -0.3 + 1.4j, 0.5 + 2j]
    found = ricci.moduli_distances([ricci.make("flat_torus", a=t.real, b=t.imag, n=4, m=4) for t in moduli])
    assert (found.lower == found.lower.T).all()
    assert (found.upper - found.lower).max() < 1e-8
    # All four are reduced, and nearer to each other than to any other image but across the line Re = 1/2.
    z, w = moduli[1], moduli[3]
    near = min(np.arcsinh(abs(z - v) / (2 * np.sqrt(z.imag * v.imag))) for v in (w, w - 1))
    assert abs(found.lower[1, 3] - near) < 1e-8
    points = ricci.classical_scaling(0.5 * (found.lower + found.upper))
    assert points.shape == (4, 2)
    with pytest.raises(ricci.ArgumentError, match="topologies"):
        ricci.moduli_distances([ricci.make("flat_torus"), ricci.make("annulus")])


def test_the_job_moduli_has_what_is_known_of_each_mesh():
    torus = ricci.Job("moduli")(ricci.make("flat_torus", a=0.2, b=1.3, n=4, m=4)).result
    assert torus["gap"] < 1e-10
    assert abs(torus["modulus"] - (0.2 + 1.3j)) < 1e-9
    two = ricci.Job("moduli", {"width": 1e-2})(ricci.make("genus", genus=2, n=3)).result
    assert two["periods"].shape == (2, 2)
    assert two["pants"].shape == (3, 2)
    assert (two["radius"] > 0).all()
    ring = ricci.Job("moduli")(ricci.make("annulus", a=0.4, b=1.0)).result
    assert ring["low"] < ring["high"]
    with pytest.raises(ricci.ArgumentError):
        ricci.Job("moduli", {"depth": 3})
