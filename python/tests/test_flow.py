"""Flows against independent facts: Gauss-Bonnet, angles by numpy, conformal lengths by the formula of the class."""

import numpy as np
import pytest

import ricci
from conftest import angle_defects


def test_curvature_is_the_angle_defect_and_adds_up(genus2):
    start = ricci.metric(genus2)
    ours = angle_defects(genus2.V, genus2.F)
    np.testing.assert_allclose(start.curvature, ours, atol=1e-12)
    assert start.curvature.sum() == pytest.approx(2 * np.pi * genus2.euler, abs=1e-10)


def test_a_torus_becomes_flat(torus):
    flat = ricci.flow(torus.V, torus.F, target="uniform")
    assert flat.converged
    mesh = flat.triangulation
    np.testing.assert_allclose(angle_defects(flat.lengths, mesh.F, mesh.face_edges), 0, atol=1e-9)


def test_lengths_are_those_of_the_conformal_class(torus):
    flat = ricci.flow(torus, flips="never", target="uniform")
    u = flat.factor
    np.testing.assert_allclose(flat.lengths, torus.lengths * np.exp(u[torus.edges].sum(1) / 2), rtol=1e-12)


@pytest.mark.parametrize(("space", "sign"), [("h2", 1), ("e2", 0)])
def test_gauss_bonnet_in_each_space(genus2, space, sign):
    target = None if space == "h2" else "single:5"
    flat = ricci.flow(genus2, target=target, space=space)
    s = flat.summary
    assert flat.converged
    assert flat.curvature.sum() - sign * s.area == pytest.approx(2 * np.pi * genus2.euler, abs=1e-9)
    if space == "h2":
        assert s.area == pytest.approx(4 * np.pi, abs=1e-9)


def test_targets_by_rule_by_mapping_and_by_value(genus2):
    start = ricci.metric(genus2)
    cones = {3: -2 * np.pi, 200: -2 * np.pi}
    values = np.zeros(genus2.n_vertices)
    values[list(cones)] = list(cones.values())
    assert np.array_equal(start.fill(cones), values)
    assert np.array_equal(start.fill(values), values)
    by_name, by_value = start.flow(cones), start.flow(values)
    assert np.array_equal(by_name.u, by_value.u)
    assert by_name.report.cones.tolist() == [3, 200]
    assert start.fill("single:7")[7] == pytest.approx(-4 * np.pi)
    assert np.count_nonzero(np.abs(start.fill("auto:4")) > 1e-9) == 4
    open_torus = ricci.metric(ricci.change(ricci.make("torus", n=24, m=12, a=2, b=1), "punch", count=1))
    assert np.array_equal(open_torus.fill(None), open_torus.fill("auto:4"))
    with pytest.raises(ricci.ArgumentError, match="target 'autos:4'"):
        start.fill("autos:4")


def test_schemes_all_reach_a_uniform_torus(torus):
    for scheme in ("yamabe", "inversive", "tangential", "thurston"):
        assert ricci.flow(torus, target="uniform", scheme=scheme).converged, scheme


def test_edges_that_are_fixed_are_not_flipped(genus2):
    def rows(mesh, of=slice(None)):
        return {tuple(sorted(edge)) for edge in mesh.edges[of].tolist()}

    flipped = rows(genus2) - rows(ricci.flow(genus2, target="single:0").triangulation)
    features = [k for k, edge in enumerate(genus2.edges.tolist()) if tuple(sorted(edge)) in flipped][:5]
    assert len(features) == 5
    kept = rows(ricci.flow(genus2, target="single:0", fixed_edges=features).triangulation)
    assert rows(genus2, features) <= kept


def test_a_sphere_in_its_own_space():
    sphere = ricci.make("ellipsoid", n=5, a=1.2, b=1, c=1)
    start = ricci.metric(sphere.with_lengths(0.9 * sphere.lengths / sphere.lengths.max(), "s2"), space="s2")
    assert start.curvature.sum() + start.summary.area == pytest.approx(4 * np.pi, abs=1e-9)


def test_the_gradient_flow_leaves_a_trace(torus):
    found = ricci.flow(torus, target="uniform", method="gradient", tolerance=1e-6)
    assert found.converged
    trace = found.report.trace
    assert trace.shape[1] == 5
    assert trace[-1, 2] <= 1e-6 < trace[0, 2]


def test_newton_converges_quadratically_at_the_end(torus):
    residuals = ricci.flow(torus, target="uniform").report.residuals
    small = residuals[residuals < 1e-2]
    assert len(small) >= 2
    assert small[1] < 100 * small[0] ** 2 + 1e-12


def test_results_do_not_depend_on_threads(genus2):
    one, many = (ricci.flow(genus2, target="single:0", threads=n) for n in (1, 8))
    assert np.array_equal(one.u, many.u)
    assert np.array_equal(one.lengths, many.lengths)


def test_a_solver_goes_from_target_to_target(genus2):
    solver = ricci.Solver(ricci.metric(genus2), tolerance=1e-9)
    first, second = (solver.solve(f"single:{v}") for v in (0, 9))
    assert first.converged
    assert second.converged
    np.testing.assert_allclose(second.factor, ricci.flow(genus2, target="single:9").factor, atol=1e-7)
    pinned = solver.solve("single:0")
    solver.pin([4])
    held = solver.solve("single:0")
    assert held.u[4] == pytest.approx(pinned.u[4], abs=1e-9)
    solver.pin()
    with pytest.raises(ricci.ArgumentError):
        solver.pin([genus2.n_vertices])


def test_inadmissible_targets_name_the_vertex_and_the_amount(genus2):
    with pytest.raises(ricci.TargetError) as wrong:
        ricci.flow(genus2, target={8: 7.0})
    assert (wrong.value.element, wrong.value.index) == ("vertex", 8)
    assert wrong.value.amount == pytest.approx(7 - 2 * np.pi)
    with pytest.raises(ricci.TargetError) as wrong:
        ricci.flow(genus2, target=np.zeros(genus2.n_vertices))
    assert wrong.value.status is ricci.Status.TARGET_TOTAL
    assert wrong.value.amount == pytest.approx(4 * np.pi)
    with pytest.raises(ricci.ArgumentError):
        ricci.flow(genus2, target=np.zeros(3))
    with pytest.raises(ricci.ArgumentError, match="'newtons' is none of gradient, newton"):
        ricci.flow(genus2, method="newtons")


def test_what_stops_early_is_a_result(genus2):
    found = ricci.flow(genus2, target="single:0", max_iterations=1)
    assert not found.converged
    assert found.report.summary.stop_reason == "iteration_limit"
    worst, errors = found.report.worst
    assert np.abs(errors[0]) == pytest.approx(found.report.summary.max_curvature_error)
    assert len(worst) == len(errors) > 0


def test_a_surface_with_boundary_flows_on_its_double(pants):
    flat = ricci.flow(pants)
    assert flat.converged
    assert flat.curvature.sum() == pytest.approx(2 * np.pi * pants.euler, abs=1e-9)
    inside = np.setdiff1d(np.arange(pants.n_vertices), np.concatenate(pants.boundary))
    np.testing.assert_allclose(flat.curvature[inside], 0, atol=1e-9)
    mirror = flat.mirror
    assert np.array_equal(mirror[mirror], np.arange(len(mirror)))
    assert len(flat.triangulation_u) == len(mirror)


def test_nothing_is_reported_where_nothing_flowed(torus):
    start = ricci.metric(torus)
    with pytest.raises(ricci.ArgumentError):
        _ = start.report
    assert np.array_equal(start.types, np.zeros(torus.n_vertices))
    assert len(start.eta) == len(torus.edges)
