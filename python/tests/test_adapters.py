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


@pytest.fixture(scope="module")
def dressed():
    """A disk with normals, colours and texture coordinates; and one whose texture coordinates have seams."""
    disk = ricci.make("disk", n=4)
    rng = np.random.default_rng(5)
    normals, colors = rng.normal(size=(disk.n_vertices, 3)), np.round(255 * rng.random((disk.n_vertices, 4))) / 255
    whole = disk.with_attributes(normals=normals, colors=colors, uv=disk.V[:, :2][disk.F])
    return whole, disk.with_attributes(normals=normals, uv=rng.random((disk.n_faces, 3, 2)), corner_normals=None)


@pytest.mark.parametrize("library", ["trimesh", "meshio", "pyvista"])
def test_attributes_go_along_both_ways(dressed, library):
    pytest.importorskip(library)
    torn = dressed[1]
    send = getattr(ricci, f"to_{library}")
    for mesh in dressed:
        again = ricci.as_mesh(send(mesh, field=np.arange(mesh.n_vertices)))
        assert np.array_equal(again.F, mesh.F)
        for name in ("normals", "colors", "uv"):
            mine, other = getattr(mesh, name), getattr(again, name)
            assert (mine is None) == (other is None), name
            assert mine is None or np.allclose(mine, other, atol=1e-7), name
    assert ricci.as_mesh(send(torn)).summary.n_boundary_loops == 1


def test_texture_coordinates_are_where_the_libraries_look_for_them(dressed):
    trimesh, pyvista = pytest.importorskip("trimesh"), pytest.importorskip("pyvista")
    whole, torn = dressed
    uv = whole.V[:, :2]
    assert np.allclose(ricci.to_trimesh(whole).visual.uv, uv)
    assert np.allclose(ricci.to_pyvista(whole).active_texture_coordinates, uv)
    assert ricci.to_pyvista(torn).cell_data["uv"].shape == (torn.n_faces, 6)
    assert ricci.to_trimesh(torn).face_attributes["uv"].shape == (torn.n_faces, 6)
    painted = whole.with_attributes(colors=whole.colors)
    assert np.array_equal(ricci.to_trimesh(painted).visual.vertex_colors, np.round(255 * whole.colors))
    ball = ricci.as_mesh(pyvista.Sphere(theta_resolution=12, phi_resolution=10))
    assert ball.normals.shape == (ball.n_vertices, 3)
    assert ricci.as_mesh(trimesh.creation.icosphere(subdivisions=1)).uv is None


def test_labels_have_the_intent_and_the_table_of_labels(sheet, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    image = ricci.to_gifti(sheet, aparc=np.array([13, 14, 14, 0]), mask=np.array([True, False, True, True]), depth=np.arange(4.0))
    nibabel.save(image, tmp_path / "sheet.gii")
    again = nibabel.load(tmp_path / "sheet.gii")
    assert [array.intent for array in again.darrays] == [1008, 1009, 1002, 1002, 2005]
    assert again.darrays[2].data.tolist() == [13, 14, 14, 0]
    assert again.darrays[2].data.dtype == np.int32
    assert again.labeltable.get_labels_as_dict() == {13: "13", 14: "14", 0: "0", 1: "1"}
    with pytest.raises(TypeError, match="GIFTI holds numbers"):
        ricci.to_gifti(sheet, names=np.array(["a", "b", "c", "d"]))
    with pytest.warns(UserWarning, match="texture coordinates"):
        ricci.to_gifti(sheet.with_attributes(uv=np.zeros((2, 3, 2))))


def test_other_objects_name_what_makes_a_mesh_of_them(tmp_path):
    pyvista, trimesh, nibabel = (pytest.importorskip(name) for name in ("pyvista", "trimesh", "nibabel"))
    ball = pyvista.Sphere()
    given = [
        (ball.cast_to_unstructured_grid(), r"extract_surface\(\).triangulate\(\)"),
        (pyvista.MultiBlock([ball, ball]), r"combine\(\).extract_surface"),
        (pyvista.ImageData(dimensions=(3, 3, 3)), r"extract_surface\(\)"),
        (trimesh.Scene([trimesh.creation.box()]), r"to_mesh\(\)"),
        (nibabel.gifti.GiftiImage(), "no pointset and triangles"),
    ]
    for other, words in given:
        with pytest.raises(ricci.ArgumentError, match=words):
            ricci.as_mesh(other)


def test_arrays_pairs_files_and_meshes(sheet, tmp_path):
    sheet.write(tmp_path / "sheet.obj")
    for given in ((V, F), str(tmp_path / "sheet.obj"), tmp_path / "sheet.obj", sheet):
        assert np.array_equal(ricci.as_mesh(given).V, V)
    assert ricci.as_mesh(sheet) is sheet
    with pytest.raises(ricci.ArgumentError, match="not dict"):
        ricci.as_mesh({"V": V})


@pytest.fixture(scope="module")
def laid(genus2):
    return ricci.layout(ricci.flow(genus2, target="auto:6"))


@pytest.mark.parametrize("library", ["trimesh", "meshio", "pyvista"])
@pytest.mark.parametrize("kind", ["layout", "charts", "repaired input"])
def test_layouts_are_given_cut_open(laid, genus2, library, kind):
    """Each point of a layout is a vertex with its place in space and its coordinates, and they come back."""
    pytest.importorskip(library)
    given = {"layout": laid, "charts": ricci.charts(laid), "repaired input": laid.repaired_input()}[kind]
    corners = given.corners("refinement") if kind == "layout" else given.corners
    uv = given.points() if kind == "layout" else given.points
    own = given.mesh if kind != "charts" else laid.mesh
    sent = getattr(ricci, f"to_{library}")(given, height=own.V[:, 2])
    again = ricci.as_mesh(sent) if kind != "charts" else None
    data = {"trimesh": "vertex_attributes", "meshio": "point_data", "pyvista": "point_data"}[library]
    origins = np.asarray(getattr(sent, data)["vertex"])
    assert np.array_equal(origins[corners], own.F)
    assert np.array_equal(np.asarray(getattr(sent, data)["height"]), own.V[origins, 2])
    if again is not None:
        assert np.array_equal(again.F, corners)
        assert np.allclose(again.uv, uv[corners], atol=1e-6)
        assert np.allclose(again.V, own.V[origins], atol=1e-6)
        assert again.euler == 1
    with pytest.raises(ricci.ArgumentError, match=r"rows, of the mesh, or \d+, of the points"):
        getattr(ricci, f"to_{library}")(given, height=[1.0])


def test_polyscope_shows_meshes_and_layouts(laid, dressed):
    polyscope = pytest.importorskip("polyscope")
    polyscope.init("openGL_mock")
    shown = ricci.to_polyscope(laid, "layout", height=laid.mesh.V[:, 2], normal=laid.mesh.V)
    assert shown.n_vertices() == laid.summary.n_points
    assert shown.n_faces() == laid.summary.n_faces
    whole, torn = dressed
    assert ricci.to_polyscope(whole, "whole").n_vertices() == whole.n_vertices
    assert ricci.to_polyscope(torn, "torn").n_corners() == 3 * torn.n_faces
    assert polyscope.has_surface_mesh("layout")
    polyscope.remove_all_structures()


def test_gifti_comes_back_with_its_labels_and_anatomy(sheet, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    told = {"AnatomicalStructurePrimary": "CortexRight", "GeometricType": "Inflated"}
    parcels, depth = np.array([13, 14, 14, 0]), np.array([0.5, 1.5, 2.5, 3.5])
    image = ricci.to_gifti(sheet, labels={13: "motor", 0: "unknown"}, anatomy=told, aparc=parcels, depth=depth)
    nibabel.save(image, tmp_path / "sheet.gii")
    found = ricci.from_gifti(tmp_path / "sheet.gii")
    assert np.array_equal(found.mesh.F, sheet.F)
    assert np.allclose(found.mesh.V, sheet.V)
    assert found.labels == {0: "unknown", 13: "motor", 14: "14"}
    assert found.anatomy == told
    assert found.fields["aparc"].dtype == np.int32
    assert found.fields["aparc"].tolist() == parcels.tolist()
    assert found.fields["depth"].tolist() == depth.tolist()
    assert nibabel.load(tmp_path / "sheet.gii").darrays[0].metadata["GeometricType"] == "Inflated"
    alone = nibabel.gifti.GiftiImage(darrays=image.darrays[2:])
    assert ricci.from_gifti(alone).mesh is None
    with pytest.raises(ricci.ArgumentTypeError, match="not Mesh"):
        ricci.from_gifti(sheet)
