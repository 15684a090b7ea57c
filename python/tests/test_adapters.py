"""Meshes of trimesh, meshio, PyVista and nibabel go in and come out; each is skipped, by name, where it is not installed."""

import numpy as np
import pytest

import ricci

V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], float)
F = np.array([[0, 1, 2], [0, 2, 3]])


@pytest.fixture(scope="module")
def sheet():
    return ricci.Mesh(V, F)


def test_trimesh(sheet):
    trimesh = pytest.importorskip("trimesh")
    given = trimesh.Trimesh(V, F, process=False)
    assert np.array_equal(ricci.as_mesh(given).F, F)
    assert ricci.flow(given).converged
    back = ricci.to_trimesh(sheet, factor=np.arange(4.0))
    assert np.array_equal(back.vertices, V)
    assert np.array_equal(back.faces, F)
    assert np.array_equal(back.vertex_attributes["factor"], np.arange(4.0))


def test_meshio(sheet, tmp_path):
    meshio = pytest.importorskip("meshio")
    ricci.to_meshio(sheet, factor=np.arange(4.0)).write(tmp_path / "sheet.vtk")
    given = meshio.read(tmp_path / "sheet.vtk")
    again = ricci.as_mesh(given)
    assert np.array_equal(again.V, V)
    assert np.array_equal(again.F, F)
    assert np.array_equal(given.point_data["factor"], np.arange(4.0))
    flat = ricci.as_mesh(meshio.Mesh(V[:, :2], [("line", [[0, 1]]), ("triangle", F)]))
    assert np.array_equal(flat.V, V * [1, 1, 0])
    with pytest.raises(ricci.ArgumentError, match="triangles are needed, not quad"):
        ricci.as_mesh(meshio.Mesh(V, [("quad", [[0, 1, 2, 3]])]))


def test_pyvista(sheet):
    pyvista = pytest.importorskip("pyvista")
    back = ricci.to_pyvista(sheet, factor=np.arange(4.0))
    assert np.array_equal(back.point_data["factor"], np.arange(4.0))
    again = ricci.as_mesh(back)
    assert np.array_equal(again.V, V)
    assert np.array_equal(again.F, F)
    ball = pyvista.Sphere(theta_resolution=12, phi_resolution=10)
    assert ricci.uniformize(ball).summary.space == "s2"
    with pytest.raises(ricci.ArgumentError, match="triangulate"):
        ricci.as_mesh(pyvista.Plane(i_resolution=2, j_resolution=2))


def test_nibabel(sheet, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    nibabel.save(ricci.to_gifti(sheet, factor=np.arange(4.0)), tmp_path / "sheet.surf.gii")
    given = nibabel.load(tmp_path / "sheet.surf.gii")
    for again in (ricci.as_mesh(given), ricci.read(tmp_path / "sheet.surf.gii")):
        np.testing.assert_allclose(again.V, V, atol=1e-7)
        assert np.array_equal(again.F, F)
    assert np.array_equal(given.darrays[2].data, np.arange(4.0, dtype=np.float32))
    nibabel.freesurfer.write_geometry(tmp_path / "lh.sheet", V, F)
    assert np.array_equal(ricci.as_mesh(nibabel.freesurfer.read_geometry(tmp_path / "lh.sheet")).F, F)


def test_arrays_pairs_files_and_meshes(sheet, tmp_path):
    sheet.write(tmp_path / "sheet.obj")
    for given in ((V, F), str(tmp_path / "sheet.obj"), tmp_path / "sheet.obj", sheet):
        assert np.array_equal(ricci.as_mesh(given).V, V)
    assert ricci.as_mesh(sheet) is sheet
    with pytest.raises(ricci.ArgumentError, match="not dict"):
        ricci.as_mesh({"V": V})
