"""Files of GIFTI beside nibabel: both read the same numbers, metadata and transforms from the same files."""

import numpy as np
import pytest

import ricci

MATRIX = np.array([[0.5, -2, 0.25, 4.5], [0, 1, 0, -18], [0, 0, 1, 2], [0, 0, 0, 1]])
NOTES = ricci.GiftiNotes(
    {"AnatomicalStructurePrimary": "CortexLeft", "a & b": "<]]>"},
    [ricci.GiftiTransform("NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_MNI_152", MATRIX)],
)


@pytest.fixture
def ball():
    return ricci.make("sphere", n=2)


@pytest.mark.parametrize("ending", ["", ".gz"])
def test_what_is_written_is_read_again(ball, tmp_path, ending):
    at = lambda name: tmp_path / (name + ending)  # noqa: E731
    ricci.write_gifti_surface(at("lh.surf.gii"), ball, notes=NOTES)
    np.testing.assert_array_equal(ricci.read(at("lh.surf.gii")).V, ball.V.astype(np.float32))
    found = ricci.read_gifti_notes(at("lh.surf.gii"))
    assert dict(found.metadata) == NOTES.metadata
    assert [way[:2] for way in found.transforms] == [("NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_MNI_152")]
    np.testing.assert_array_equal(found.transforms[0].matrix, MATRIX)
    # What was read is written as it is.
    ricci.write_gifti_values(at("lh.shape.gii"), {"sulc": [0.5, np.nan], "": [2, 3]}, notes=found)
    sulc, other = ricci.read_gifti_columns(at("lh.shape.gii")).columns
    assert (sulc.intent, sulc.name, other.name) == ("SHAPE", "sulc", "")
    assert sulc.values[0] == 0.5
    assert np.isnan(sulc.values[1])
    assert other.values.tolist() == [2, 3]
    assert ricci.read_gifti_notes(at("lh.shape.gii")) == ricci.GiftiNotes(found.metadata, ())
    table = [ricci.GiftiLabel(0, "???", (0, 0, 0, 0)), ricci.GiftiLabel(-7, "cuneus", (1, 0.25, 0.5, 1))]
    ricci.write_gifti_labels(at("lh.label.gii"), np.array([-7, 0]), table)
    labels = ricci.read_gifti_columns(at("lh.label.gii"))
    assert labels.table == table
    assert labels.columns[0].values.tolist() == [-7, 0]


def test_nibabel_reads_the_metadata_and_the_transforms(ball, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    ricci.write_gifti_surface(tmp_path / "lh.surf.gii", ball.V, ball.F, notes=NOTES)
    image = nibabel.load(tmp_path / "lh.surf.gii")
    assert dict(image.meta) == NOTES.metadata
    assert dict(image.darrays[0].meta) == NOTES.metadata
    way = image.darrays[0].coordsys
    np.testing.assert_array_equal(way.xform, MATRIX)
    codes = nibabel.nifti1.xform_codes
    assert (way.dataspace, way.xformspace) == (codes.code["NIFTI_XFORM_SCANNER_ANAT"], codes.code["NIFTI_XFORM_MNI_152"])
    np.testing.assert_array_equal(image.agg_data("triangle"), ball.F)
    ricci.write_gifti_values(tmp_path / "lh.shape.gii", {"a": [1, 2.5], "b": [3, 4]}, notes=NOTES)
    image = nibabel.load(tmp_path / "lh.shape.gii")
    assert [dict(array.meta)["Name"] for array in image.darrays] == ["a", "b"]
    assert image.darrays[0].data.tolist() == [1, 2.5]
    ricci.write_gifti_labels(tmp_path / "lh.label.gii", [7, 0], [(0, "???", (0, 0, 0, 0)), (7, "cuneus", (1, 0.25, 0.5, 1))])
    image = nibabel.load(tmp_path / "lh.label.gii")
    assert image.labeltable.get_labels_as_dict() == {0: "???", 7: "cuneus"}
    assert image.labeltable.labels[1].rgba == (1, 0.25, 0.5, 1)
    assert image.agg_data().tolist() == [7, 0]


def test_what_nibabel_writes_is_read(ball, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    from nibabel.gifti import GiftiCoordSystem, GiftiDataArray, GiftiImage, GiftiLabel, GiftiLabelTable, GiftiMetaData

    way = GiftiCoordSystem("NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_TALAIRACH", MATRIX)
    points = GiftiDataArray(ball.V.astype(np.float32), "NIFTI_INTENT_POINTSET", coordsys=way, meta={"GeometricType": "Spherical"})
    triangles = GiftiDataArray(ball.F, "NIFTI_INTENT_TRIANGLE", datatype="NIFTI_TYPE_INT32")
    nibabel.save(GiftiImage(darrays=[points, triangles], meta=GiftiMetaData({"Date": "today"})), tmp_path / "rh.surf.gii")
    found = ricci.read_gifti_notes(tmp_path / "rh.surf.gii")
    assert found.metadata == (("Date", "today"), ("GeometricType", "Spherical"))
    # It gives the triangles a transform too, which says nothing.
    assert [found.transforms[0].source, found.transforms[0].target] == ["NIFTI_XFORM_SCANNER_ANAT", "NIFTI_XFORM_TALAIRACH"]
    assert len(found.transforms) == 1
    np.testing.assert_array_equal(found.transforms[0].matrix, MATRIX)
    table = GiftiLabelTable()
    table.labels.append(GiftiLabel(3, 0.5, 0.25, 1, 1))
    table.labels[0].label = "motor"
    arrays = [
        GiftiDataArray(np.float32([1, 2]), "NIFTI_INTENT_TIME_SERIES", meta={"Name": "first"}),
        GiftiDataArray(np.int32([3, 3]), "NIFTI_INTENT_LABEL"),
    ]
    nibabel.save(GiftiImage(darrays=arrays, labeltable=table), tmp_path / "rh.func.gii")
    columns, labels = ricci.read_gifti_columns(tmp_path / "rh.func.gii")
    assert [(c.intent, c.name, c.values.tolist()) for c in columns] == [("TIME_SERIES", "first", [1, 2]), ("LABEL", "", [3, 3])]
    assert labels == [(3, "motor", (0.5, 0.25, 1, 1))]


def test_what_is_wrong_is_refused_and_leaves_no_file(ball, tmp_path):
    path = tmp_path / "x.gii"
    nan = ricci.GiftiNotes(transforms=[ricci.GiftiTransform("a", "b", np.full((4, 4), np.nan))])
    for call, words in [
        (lambda: ricci.write_gifti_surface(path, ball, notes=nan), "matrix: entry 0 is NaN"),
        (lambda: ricci.write_gifti_surface(path, ball, notes=NOTES._replace(transforms=[("a", "b", np.eye(3))])), "n x 4"),
        (lambda: ricci.write_gifti_surface(path, ball, notes={"a": "b"}), "GiftiNotes, not dict"),
        (lambda: ricci.write_gifti_surface(path, ball, notes=ricci.GiftiNotes({"a": 3})), "a text is needed, not int"),
        (lambda: ricci.write_gifti_surface(path, ball, notes=ricci.GiftiNotes({"a": "\x01"})), "XML"),
        (lambda: ricci.write_gifti_values(path, {"a": [1, 2], "b": [3]}), r"b has shape \(1,\)"),
        (lambda: ricci.write_gifti_values(path, {"a\nb": [1, 2]}), "2 lines for 1"),
        (lambda: ricci.write_gifti_values(path, {"a\0": [1, 2]}), "zero"),
        (lambda: ricci.write_gifti_values(path, {"a": [1e39]}), "single precision"),
        (lambda: ricci.write_gifti_values(path, [1, 2]), "a dict"),
        (lambda: ricci.write_gifti_labels(path, [5], [(3, "a", (0, 0, 0, 1))]), "5"),
        (lambda: ricci.write_gifti_labels(path, [5], [(5, "a", "red")]), "colour"),
        (lambda: ricci.write_gifti_labels(path, [0.5], [(3, "a", (0, 0, 0, 1))]), "integers"),
    ]:
        with pytest.raises(ricci.ArgumentError, match=words):
            call()
    assert not path.exists()
    path.write_text("<GIFTI><DataArray>")
    with pytest.raises(ricci.ParseError, match=r"x\.gii"):
        ricci.read_gifti_notes(path)
    with pytest.raises(ricci.FileError, match=r"no\.gii"):
        ricci.read_gifti_columns(tmp_path / "no.gii")
