"""Harmonic maps, 1-forms and circle domains, against scipy's sparse algebra and known moduli."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve

import ricci


def laplacian(V, F):
    """The cotangent Laplacian, as textbooks have it."""
    n, rows, columns, entries = len(V), [], [], []
    for k in range(3):
        i, j, o = F[:, (k + 1) % 3], F[:, (k + 2) % 3], F[:, k]
        a, b = V[i] - V[o], V[j] - V[o]
        weight = 0.5 * (a * b).sum(1) / np.linalg.norm(np.cross(a, b), axis=1)
        rows += [i, j]
        columns += [j, i]
        entries += [-weight, -weight]
    matrix = sparse.csr_matrix((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), (n, n))
    return matrix - sparse.diags(np.asarray(matrix.sum(1)).ravel())


def test_given_values_are_continued_as_scipy_does(disk):
    """On a Delaunay mesh of the plane the library's triangulation is the mesh, so both solve one system."""
    rim = disk.boundary[0].astype(int)
    values = np.column_stack([np.cos(2 * np.angle(disk.V[rim] @ [1, 1j, 0])), disk.V[rim, 1]])
    found = ricci.harmonic(disk, b=rim, bc=values)
    inside = np.setdiff1d(np.arange(disk.n_vertices), rim)
    matrix = laplacian(disk.V, disk.F.astype(int)).tocsc()
    ours = spsolve(matrix[inside][:, inside], -matrix[inside][:, rim] @ values)
    np.testing.assert_allclose(found[inside, :2], ours, atol=1e-9)
    np.testing.assert_allclose(found[rim, :2], values, atol=1e-14)
    assert np.all(found[:, 2] == 0)


def test_maps_to_disk_polygon_rectangle_and_sphere(disk):
    np.testing.assert_allclose(np.linalg.norm(ricci.harmonic(disk)[disk.boundary[0]], axis=1), 1, atol=1e-12)
    pentagon = ricci.harmonic(disk, target="polygon", n=5)
    assert np.linalg.norm(pentagon, axis=1).max() == pytest.approx(1)
    corners = disk.boundary[0][:: len(disk.boundary[0]) // 4][:4]
    rectangle = ricci.harmonic(disk, target="rectangle", b=corners)
    assert np.ptp(rectangle[:, 1]) == pytest.approx(1)
    assert np.ptp(rectangle[:, 0]) == pytest.approx(1, abs=0.02)
    ball = ricci.harmonic(ricci.make("ellipsoid", n=5, a=1.3, b=1, c=1), target="sphere")
    np.testing.assert_allclose(np.linalg.norm(ball, axis=1), 1, atol=1e-12)
    with pytest.raises(ricci.LayoutError):
        ricci.harmonic(ricci.make("sphere", n=3))
    with pytest.raises(ricci.ArgumentError, match=r"bc has shape \(2, 1\) for 3 vertices"):
        ricci.harmonic(disk, b=[0, 1, 2], bc=[1.0, 2.0])


def test_forms_are_closed_coclosed_and_dual_to_loops(genus2):
    forms = ricci.forms(genus2)
    mesh, values = forms.mesh, forms.values
    assert len(forms) == 4
    signs, edges = np.sign(mesh.face_edges), np.abs(mesh.face_edges) - 1
    around = (values[:, edges] * signs).sum(-1)
    assert np.abs(around).max() < 1e-10
    assert forms.summary.coclosedness < 1e-8


def test_the_period_matrix_is_symmetric_and_positive(genus2):
    """Symmetric up to the size of the triangles: the conjugate of a discrete form is that of a mesh."""
    periods = ricci.forms(genus2).periods
    np.testing.assert_allclose(periods, periods.T, atol=5e-3)
    assert np.linalg.eigvalsh(periods.imag).min() > 0


def test_zeros_add_up_to_minus_the_euler_characteristic(genus2):
    forms = ricci.forms(genus2)
    zeros = forms.zeros([1.0, 0.3, -0.2, 0.5])
    assert zeros[:, 1].sum() == 2
    form = forms.holomorphic([1.0, 0.3, -0.2, 0.5])
    np.testing.assert_allclose(form.real, [1.0, 0.3, -0.2, 0.5] @ forms.values, atol=1e-12)
    # As coordinates it lays nearly all triangles out counterclockwise, and their area is that of the form.
    mesh = forms.mesh
    sides = form[np.abs(mesh.face_edges) - 1] * np.sign(mesh.face_edges)
    areas = 0.5 * (sides[:, 0].conj() * sides[:, 1]).imag
    assert (areas > 0).mean() > 0.95
    assert areas.sum() > 0.95 * np.abs(areas).sum()
    with pytest.raises(ricci.ArgumentError):
        forms.zeros([1.0])


def test_the_modulus_of_a_torus_by_forms_is_that_by_the_flow(torus):
    assert ricci.forms(torus).summary.modulus == pytest.approx(ricci.uniformize(torus).summary.modulus, rel=0.01)


def test_hyperelliptic_surfaces_have_their_periods():
    points = [0.0, 1.0, 2.0, 3.0, 4.0]
    exact = ricci.hyperelliptic_periods(points)
    np.testing.assert_allclose(exact, exact.T, atol=1e-12)
    assert np.linalg.eigvalsh(exact.imag).min() > 0
    assert ricci.make("hyperelliptic", points=points, n=10).genus == 2


def test_forms_of_a_surface_with_boundary(pants):
    for classes in ("absolute", "relative"):
        assert len(ricci.forms(pants, classes=classes)) == 2
    with pytest.raises(ricci.LayoutError):
        _ = ricci.forms(pants).periods


def test_loops_become_circles(pants):
    found = ricci.circles(pants)
    assert found.converged
    layout = found.layout()
    points = layout.points()
    mesh, corners = layout.mesh, layout.corners("refinement")
    place = np.empty((mesh.n_vertices, 2))
    place[mesh.F] = points[corners]
    for x, y, radius, deviation in found.circles:
        loop = min(mesh.boundary, key=lambda loop: np.abs(np.hypot(*(place[loop] - [x, y]).T) - radius).max())
        np.testing.assert_allclose(np.hypot(*(place[loop] - [x, y]).T), radius, atol=1e-8)
        assert deviation < 1e-9
    outer = found.circles[found.summary.outer]
    np.testing.assert_allclose(outer[:3], [0, 0, 1], atol=1e-12)
    assert found.mesh.n_vertices >= pants.n_vertices


def test_circle_domains_by_choice(pants):
    found = ricci.circles(pants, outer=2, three=pants.boundary[2][[0, 6, 12]])
    assert found.summary.outer == 2
    with pytest.raises(ricci.ArgumentError, match="3 are needed"):
        ricci.circles(pants, three=[1, 2])
    with pytest.raises(ricci.ArgumentError):
        ricci.circles(ricci.make("sphere", n=3))


def test_an_annulus_lies_in_a_strip():
    """Log coordinates: the outer loop is y = 0, the inner one y = 2 pi times the modulus."""
    found = ricci.circles(ricci.make("annulus", a=1, b=2, n=12, m=60), frame="strip")
    assert found.converged
    assert found.summary.frame == "strip"
    height = 2 * np.pi * found.summary.modulus.imag
    assert sorted(found.log_radii) == pytest.approx([-height, 0])
    points = found.layout().points()
    assert points[:, 1].min() == pytest.approx(0, abs=1e-12)
    assert points[:, 1].max() == pytest.approx(height)


def test_an_annulus_has_its_modulus():
    """Radii 1 and 2: height over circumference is ln 2 / 2 pi."""
    found = ricci.circles(ricci.make("annulus", a=1, b=2, n=12, m=60))
    assert found.summary.modulus.imag == pytest.approx(np.log(2) / (2 * np.pi), rel=2e-3)


def test_the_modulus_of_a_rectangle_and_the_energies_of_the_heat_flow(disk):
    grid = np.stack(np.meshgrid(np.linspace(0, 2, 9), np.linspace(0, 1, 5), [0.0]), -1).reshape(-1, 3)
    cells = [9 * j + i for j in range(4) for i in range(8)]
    faces = np.array([[a, a + 1, a + 10] for a in cells] + [[a, a + 10, a + 9] for a in cells])
    found = ricci.harmonic_map(grid, faces, target="rectangle", b=[0, 8, 44, 36])
    assert found.summary.modulus == pytest.approx(2, rel=1e-12)
    assert found.summary.modulus_low <= found.summary.modulus * (1 + 1e-12) <= found.summary.modulus_high * (1 + 2e-12)
    np.testing.assert_allclose(found.points, grid, atol=1e-12)
    flow = ricci.harmonic_map(disk, method="heat")
    assert flow.summary.converged
    assert len(flow.energies) == flow.summary.n_energies > 10
    assert np.diff(flow.energies).max() < 1e-13
    np.testing.assert_allclose(flow.points, ricci.harmonic(disk), atol=1e-9)
    with pytest.raises(ricci.ArgumentError, match="linear solves"):
        ricci.harmonic_map(disk, target="rectangle", method="heat")
