"""Surfaces of FreeSurfer beside nibabel, and of VTK beside pyvista: both read the same numbers from the same files."""

import numpy as np
import pytest

import ricci


@pytest.fixture
def mesh():
    return ricci.make("ellipsoid", n=6, a=1.5, b=1.25, c=1)


def same(V, F, positions, faces):
    np.testing.assert_array_equal(V, positions)
    np.testing.assert_array_equal(F, faces)


def test_nibabel_reads_what_is_written(mesh, tmp_path):
    freesurfer = pytest.importorskip("nibabel.freesurfer")
    path = str(tmp_path / "lh.pial")
    mesh.write(path)
    V, F = freesurfer.read_geometry(path)
    same(V, F, mesh.V.astype(np.float32), mesh.F)
    again = ricci.read(path)
    same(again.V, again.F, V, F)


def test_what_nibabel_writes_is_read(mesh, tmp_path):
    freesurfer = pytest.importorskip("nibabel.freesurfer")
    path = str(tmp_path / "rh.sphere.reg")
    geometry = {
        "head": [2, 0, 20],
        "valid": "1  # volume info valid",
        "filename": "x.mgz",
        "volume": [256, 256, 256],
        "voxelsize": [1.0, 1.0, 1.0],
        "xras": [-1.0, 0.0, 0.0],
        "yras": [0.0, 0.0, -1.0],
        "zras": [0.0, 1.0, 0.0],
        "cras": [0.0, 0.0, 0.0],
    }
    freesurfer.write_geometry(path, mesh.V, mesh.F, volume_info=geometry)
    found = ricci.read(path)
    same(found.V, found.F, mesh.V.astype(np.float32), mesh.F)


@pytest.mark.parametrize("name", ["m.vtk", "m.vtp"])
def test_pyvista_reads_the_same_vtk(mesh, tmp_path, name):
    path = str(tmp_path / name)
    mesh.write(path)
    again = ricci.read(path)
    same(again.V, again.F, mesh.V, mesh.F)
    pyvista = pytest.importorskip("pyvista")
    found = pyvista.read(path)
    same(found.points, found.faces.reshape(-1, 4)[:, 1:], mesh.V, mesh.F)
    for binary in (False, True):
        other = str(tmp_path / f"{binary}{name}")
        found.save(other, binary=binary)
        again = ricci.read(other)
        np.testing.assert_allclose(again.V, mesh.V, rtol=1e-5, atol=1e-9)
        np.testing.assert_array_equal(again.F, mesh.F)


def test_nibabel_reads_the_data_that_is_written_and_the_other_way_round(tmp_path):
    freesurfer = pytest.importorskip("nibabel.freesurfer")
    at = lambda name: str(tmp_path / name)  # noqa: E731
    values = np.float32([0.5, -1.25, 1e20, 3])
    ricci.write_values(at("lh.sulc"), values, n_faces=2)
    np.testing.assert_array_equal(freesurfer.read_morph_data(at("lh.sulc")), values)
    freesurfer.write_morph_data(at("rh.sulc"), values)
    np.testing.assert_array_equal(ricci.read_values(at("rh.sulc")), values)
    ricci.write_label(at("lh.label"), [5, 2, 9], values=[0.5, 1, 0.25])
    vertices, scalars = freesurfer.read_label(at("lh.label"), read_scalars=True)
    np.testing.assert_array_equal(vertices, [5, 2, 9])
    np.testing.assert_array_equal(scalars, [0.5, 1, 0.25])
    regions, colors, names = np.array([1, 0, 0, 1]), {"bank": (25, 100, 40, 0), "cuneus": (220, 20, 100, 0)}, ["bank", "cuneus"]
    ricci.write_annotation(at("lh.annot"), regions, colors)
    found, table, words = freesurfer.read_annot(at("lh.annot"))
    np.testing.assert_array_equal(found, regions)
    np.testing.assert_array_equal(table[:, :4], [*colors.values()])
    assert [word.decode() for word in words] == names
    freesurfer.write_annot(at("rh.annot"), found, table[:, :4], words, fill_ctab=True)
    again = ricci.read_annotation(at("rh.annot"))
    np.testing.assert_array_equal(again.regions, regions)
    assert again.names == names


def test_data_are_read_again_packed_or_not(tmp_path):
    for ending in ("", ".gz"):
        at = lambda name, ending=ending: str(tmp_path / (name + ending))  # noqa: E731
        ricci.write_patch(at("lh.flat"), [7, 3], [[1, 2, 0], [3, 4, 0]], is_border=[False, True])
        patch = ricci.read_patch(at("lh.flat"))
        assert patch.vertices.tolist() == [7, 3]
        assert patch.positions.tolist() == [[1, 2, 0], [3, 4, 0]]
        assert patch.is_border.tolist() == [False, True]
        ricci.write_annotation(at("lh.annot"), [0, -1], {"a": (1, 2, 3, 0)})
        assert ricci.read_annotation(at("lh.annot")).regions.tolist() == [0, -1]
        ricci.write_label(at("lh.label"), [-1, 4], comment="mine")
        assert ricci.read_label(at("lh.label")).vertices.tolist() == [-1, 4]
        ball = ricci.make("sphere", n=2)
        ball.write(at("ball.surf.gii"))
        np.testing.assert_array_equal(ricci.read(at("ball.surf.gii")).V, ball.V.astype(np.float32))
    with pytest.raises(ricci.RicciError, match="sulc"):
        ricci.read_values(tmp_path / "no.sulc")
    with pytest.raises(ricci.ArgumentError, match="positions"):
        ricci.write_label(tmp_path / "x", [1, 2], positions=[[0, 0, 0]])


def test_nibabel_reads_surfaces_in_gifti(mesh, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    path = str(tmp_path / "lh.surf.gii")
    mesh.write(path)
    image = nibabel.load(path)
    same(*(image.agg_data(kind) for kind in ("pointset", "triangle")), mesh.V.astype(np.float32), mesh.F)
