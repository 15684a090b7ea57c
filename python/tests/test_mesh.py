"""Meshes, triangle lists and files: arrays go in and come out as they are, and what is wrong is named."""

import pickle

import numpy as np
import pytest

import ricci

FORMATS = ["obj", "off", "ply", "glb"]
SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)


def test_arrays_come_back_as_they_were(torus):
    mesh = ricci.Mesh(torus.V, torus.F)
    assert np.array_equal(mesh.V, torus.V)
    assert np.array_equal(mesh.F, torus.F)
    ends = mesh.V[mesh.edges]
    assert np.array_equal(mesh.lengths, torus.lengths)
    np.testing.assert_allclose(mesh.lengths, np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), rtol=1e-15)
    assert mesh.euler == mesh.n_vertices - len(mesh.edges) + mesh.n_faces == 0
    assert mesh.genus == 1
    assert mesh.boundary == []


@pytest.mark.parametrize("dtype", [np.int32, np.uint32, np.int64, np.uint8, list])
def test_faces_of_any_integers_are_taken(dtype):
    faces = [[0, 1, 2], [0, 2, 3]]
    mesh = ricci.Mesh(SQUARE, faces if dtype is list else np.array(faces, dtype))
    assert mesh.F.tolist() == faces


def test_positions_are_read_where_they_lie():
    """Every other row of a wider array: the library is given the stride, and nothing is copied before it reads."""
    from ricci._arrays import points

    wide = np.zeros((8, 5))
    wide[::2, 1:4] = SQUARE
    view = points(wide[::2, 1:4])
    assert np.shares_memory(view, wide)
    assert np.array_equal(ricci.Mesh(wide[::2, 1:4], [[0, 1, 2], [0, 2, 3]]).V, SQUARE)
    assert np.array_equal(ricci.Mesh(np.asfortranarray(SQUARE), [[0, 1, 2], [0, 2, 3]]).V, SQUARE)


def test_index_arrays_of_32_bits_are_not_copied():
    from ricci._arrays import indices

    for dtype in (np.int32, np.uint32):
        faces = np.array([[0, 1, 2]], dtype)
        assert np.shares_memory(indices(faces), faces)


def test_arrays_handed_out_are_kept_and_read_only(torus):
    assert torus.V is torus.V
    with pytest.raises(ValueError, match="read-only"):
        torus.V[0, 0] = 1


def test_boundary_loops_have_the_surface_on_their_left(pants):
    directed = {tuple(edge) for face in pants.F.tolist() for edge in ((face[0], face[1]), (face[1], face[2]), (face[2], face[0]))}
    assert len(pants.boundary) == 3
    for loop in pants.boundary:
        assert all((int(a), int(b)) in directed for a, b in zip(loop, np.roll(loop, -1), strict=True))


def test_edges_of_faces_lie_opposite_their_corners(genus2):
    for k in range(3):
        edge = np.abs(genus2.face_edges[:, k]) - 1
        ends = np.sort(genus2.edges[edge], axis=1)
        assert np.array_equal(ends, np.sort(genus2.F[:, [(k + 1) % 3, (k + 2) % 3]], axis=1))


@pytest.mark.parametrize("ending", FORMATS)
def test_files_read_back(tmp_path, torus, ending):
    path = tmp_path / f"mesh.{ending}"
    torus.write(path)
    again = ricci.read(path)
    assert np.array_equal(again.F, torus.F)
    np.testing.assert_allclose(again.V, torus.V, atol=1e-6 if ending == "glb" else 0)


def test_attributes_are_written_and_read(tmp_path, torus):
    uv = np.random.default_rng(1).random((torus.n_faces, 3, 2))
    normals = torus.V / np.linalg.norm(torus.V, axis=1, keepdims=True)
    torus.write(tmp_path / "a.obj", uv=uv, normals=normals)
    again = ricci.read(str(tmp_path / "a.obj"))
    assert np.array_equal(again.uv, uv)
    assert np.array_equal(again.normals, normals)
    assert again.colors is None
    assert again.corner_normals is None
    with pytest.raises(ricci.ArgumentError, match=r"uv has shape \(3, 2\)"):
        torus.write(tmp_path / "b.obj", uv=np.zeros((3, 2)))
    assert not (tmp_path / "b.obj").exists()


def test_gluings_are_intrinsic_surfaces(torus):
    glued = ricci.Mesh.from_gluing(torus.F, torus.face_edges, torus.lengths)
    assert not glued.summary.has_positions
    assert np.array_equal(glued.lengths, torus.lengths)
    with pytest.raises(ricci.ArgumentError):
        _ = glued.V
    scaled = torus.with_lengths(2 * torus.lengths)
    assert np.array_equal(scaled.lengths, 2 * torus.lengths)
    with pytest.raises(ricci.MetricError) as wrong:
        torus.with_lengths(np.where(np.arange(len(torus.lengths)) == 7, -1.0, torus.lengths))
    assert (wrong.value.element, wrong.value.index, wrong.value.amount) == ("edge", 7, -1.0)


def test_what_is_no_mesh_is_refused_by_name(tmp_path):
    with pytest.raises(ricci.ArgumentError, match="entry 2 of F is -3") as wrong:
        ricci.Mesh(SQUARE, np.array([[0, 1, -3]]))
    assert (wrong.value.element, wrong.value.index) == ("entry", 2)
    with pytest.raises(ricci.ArgumentError, match="n x 3 is needed"):
        ricci.Mesh(SQUARE[:, :2], [[0, 1, 2]])
    with pytest.raises(ricci.ArgumentError, match="integers"):
        ricci.Mesh(SQUARE, [[0.0, 1.0, 2.0]])
    with pytest.raises(ricci.MeshError, match="vertex 3 belongs to no face"):
        ricci.Mesh(SQUARE, [[0, 1, 2]])
    with pytest.raises(OSError, match="no-such"):
        ricci.read(tmp_path / "no-such.obj")
    (tmp_path / "cut.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 zero\n")
    with pytest.raises(ricci.ParseError) as wrong:
        ricci.read(tmp_path / "cut.off")
    assert (wrong.value.element, wrong.value.index, wrong.value.status) == ("line", 4, ricci.Status.PARSE)
    with pytest.raises(ricci.FileError) as wrong:
        ricci.read(tmp_path / "mesh.xyz")
    assert wrong.value.status is ricci.Status.UNKNOWN_FORMAT


def test_exceptions_travel_between_processes():
    wrong = ricci.TargetError("vertex 3: too large", ricci.Status.TARGET_AT_VERTEX, (1, 3), 0.5)
    again = pickle.loads(pickle.dumps(wrong))
    assert type(again) is ricci.TargetError
    assert (str(again), again.status, again.element, again.index, again.amount) == (str(wrong), 400, "vertex", 3, 0.5)


def test_defects_are_listed_as_views_and_repaired():
    soup = ricci.Soup(np.vstack([SQUARE, [[9, 9, 9]]]), [[0, 1, 2], [0, 1, 2], [0, 2, 3], [1, 1, 2]])
    found = {defect.code for defect in soup.defects}
    assert {"duplicate_face", "degenerate_face", "isolated_vertex"} <= found
    duplicate = next(defect for defect in soup.defects if defect.code == "duplicate_face")
    assert duplicate.faces.tolist() == [0, 1]
    assert not duplicate.faces.flags.owndata
    assert not duplicate.faces.flags.writeable
    repaired = soup.repair()
    assert repaired.summary.n_defects == 0
    assert repaired.summary.duplicate_faces == repaired.summary.degenerate_faces == repaired.summary.isolated_vertices == 1
    vertices, faces = repaired.origins
    assert vertices.tolist() == [0, 1, 2, 3]
    assert faces.tolist() == [0, 2]
    assert repaired.mesh().n_faces == 2
    with pytest.raises(ricci.MeshError):
        soup.mesh()
    with pytest.raises(ricci.ArgumentError, match="no option 'welding' of repair; there are component"):
        soup.repair(welding=1.0)


def test_holes_are_filled_and_seams_are_named():
    plate = np.array([[i, j, 0] for i in range(5) for j in range(5)], float)
    squares = [5 * i + j for i in range(4) for j in range(4) if (i, j) != (1, 1)]
    faces = [face for k in squares for face in ([k, k + 5, k + 6], [k, k + 6, k + 1])]
    soup = ricci.Soup(plate, faces)
    whole = soup.repair(fill_holes=8)
    assert (whole.summary.filled_holes, whole.summary.n_boundary_loops, whole.summary.euler) == (1, 1, 1)
    assert soup.repair(holes=[6]).summary.n_faces == whole.summary.n_faces
    assert set(whole.origins[1][len(faces) :].tolist()) == {-1}
    assert soup.repair(fill_holes="all").summary.euler == 2
    torn = ricci.Soup(np.vstack([plate, plate + 1e-12]), [*faces[:16], *[[a + 25, b + 25, c + 25] for a, b, c in faces[16:]]])
    (hint,) = torn.hints
    assert hint.code == "open_seam"
    assert "Soup.repair(weld=" in hint.remedy


def test_the_lists_of_a_triangle_list_are_those_of_its_file(tmp_path):
    roof = np.array([[0, 0, 0], [4, 0, 0], [4, 1, 1], [0, 1, 1], [4, 2, 0], [0, 2, 0], [9, 0, 0], [10, 0, 0], [9, 1, 0]], float)
    faces = [[6, 7, 8], [0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]]
    lines = [f"v {x} {y} {z}" for x, y, z in roof] + ["usemtl slate", "f 7 8 9", "g roof"]
    (tmp_path / "roof.obj").write_text("\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces[1:]]) + "\n")
    soup = ricci.Soup.read(tmp_path / "roof.obj")
    alone, outline = soup.loops
    assert (alone.vertices.tolist(), len(outline.vertices)) == ([6, 7, 8], 6)
    np.testing.assert_allclose([alone.length, outline.length], [2 + np.sqrt(2), 8 + 4 * np.sqrt(2)])
    edges, angles = soup.sharp_edges(np.radians(60))
    assert edges.tolist() == [[2, 3]]
    np.testing.assert_allclose(angles, np.pi / 2)
    assert {2, 3} <= set(soup.corners(np.radians(60)).tolist())
    assert soup.sharp_edges(np.radians(120))[0].shape == (0, 2)
    numbers, names = soup.names("material")
    assert [names[k] for k in numbers] == ["slate"] * 5
    numbers, names = soup.names("group")
    assert [names[k] for k in numbers] == ["", "roof", "roof", "roof", "roof"]
    large, small = soup.components()
    assert (large.origins[0].tolist(), small.origins[1].tolist()) == ([0, 1, 2, 3, 4, 5], [0])
    with pytest.raises(ricci.ArgumentError, match="angle"):
        soup.corners(0.0)
    with pytest.raises(ricci.ArgumentError, match="none of object, group"):
        soup.names("colour")


def test_further_numbers_of_a_file_can_be_read(tmp_path):
    header = "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(f"property float {k}\n" for k in ("x", "y", "z", "quality"))
    header += "element face 1\nproperty list uchar int vertex_indices\nproperty int part\nend_header\n"
    (tmp_path / "measured.ply").write_text(header + "0 0 0 0.5\n1 0 0 nan\n0 1 0 2\n3 0 1 2 7\n")
    soup = ricci.Soup.read(tmp_path / "measured.ply")
    np.testing.assert_array_equal(soup.vertex_numbers["quality"], [0.5, np.nan, 2])
    assert (list(soup.vertex_numbers), soup.face_numbers["part"].tolist()) == (["quality"], [7])


def test_holes_of_a_repair_are_listed():
    plate = np.array([[i, j, 0] for i in range(5) for j in range(5)], float)
    squares = [5 * i + j for i in range(4) for j in range(4) if (i, j) != (1, 1)]
    soup = ricci.Soup(plate, [face for k in squares for face in ([k, k + 5, k + 6], [k, k + 6, k + 1])])
    (hole,) = soup.repair(fill_holes=8).holes
    assert (hole.filled, hole.reason, hole.n_edges, hole.vertex) == (True, "", 4, 6)
    np.testing.assert_allclose([hole.length, hole.area], [4, 1])
    assert hole.faces == range(30, 32)
    assert soup.repair().holes == []


def test_views_outlive_their_soup():
    def faces():
        soup = ricci.Soup(SQUARE, [[0, 1, 2]] * 50 + [[0, 2, 3]])
        return [defect.faces for defect in soup.defects if defect.code == "duplicate_face"]

    kept = faces()
    for _ in range(50):
        ricci.Soup(SQUARE, [[0, 1, 2]] * 50)
    assert [part.tolist()[0] for part in kept] == [0] * len(kept)


def test_edges_that_welding_refuses_are_told(tmp_path):
    fins = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0, 1, 0]], float)
    corners = [0, 1, 2, 0, 1, 3, 0, 1, 4]
    soup = ricci.Soup(fins[corners], np.arange(9).reshape(3, 3))
    soup.write(tmp_path / "fins.obj")
    edges, faces = ricci.Soup.read(tmp_path / "fins.obj").repair().refused
    assert edges.shape == (1, 2)
    assert [part.tolist() for part in faces] == [[0, 1, 2]]


def test_changes_do_what_they_say(torus):
    assert len(ricci.change(torus, "punch", count=2).boundary) == 2
    noisy = ricci.change(torus, "noise", amount=0.1, seed=3)
    assert 0 < np.abs(noisy.V - torus.V).max() < 0.2
    turned = ricci.change(torus, "invert", centre=[0, 0, 5], amount=2)
    np.testing.assert_allclose(np.linalg.norm(turned.V - [0, 0, 5], axis=1) * np.linalg.norm(torus.V - [0, 0, 5], axis=1), 4, rtol=1e-12)
    with pytest.raises(ricci.ArgumentError, match="torus"):
        ricci.make("tors")


def test_the_quality_of_triangles():
    faces = [[0, 1, 2], [0, 2, 3]]
    quality = ricci.Mesh(SQUARE, faces).quality
    np.testing.assert_allclose([quality.area, quality.min_angle, quality.edge_ratio], [1, np.pi / 4, np.sqrt(2)])
    assert (quality.obtuse_fraction, quality.non_delaunay_fraction) == (0, 0)
    assert ricci.Soup(SQUARE, faces).quality == quality
    torn = ricci.Soup(SQUARE, [*faces, [0, 1, 9]]).quality
    assert torn.area == pytest.approx(1)
    assert np.isnan(torn.non_delaunay_fraction)


def test_refined_lists_lie_where_their_places_say():
    sphere = ricci.make("sphere", n=3)
    soup = ricci.Soup(sphere.V, sphere.F)
    for finer in (soup.refine(levels=1), soup.refine(longest_edge=0.2)):
        faces, at, weights = finer.places
        assert len(faces) == finer.summary.n_faces
        np.testing.assert_allclose((weights[:, :, None] * soup.V[soup.F[at]]).sum(1), finer.V, atol=1e-14)
        assert finer.quality.area == pytest.approx(soup.quality.area, rel=1e-12)
        assert finer.summary.euler == 2
    with pytest.raises(ricci.ArgumentError, match="was not refined"):
        _ = soup.places


def test_metrics_are_refined_to_an_angle():
    thin = ricci.make("ellipsoid", n=3, a=1, b=0.1, c=6)
    finer, course = thin.refine_angle()
    assert course.least_angle >= np.deg2rad(25) > course.given_angle
    assert course.n_below == 0
    assert finer.quality.min_angle == pytest.approx(course.least_angle)
    assert finer.quality.area == pytest.approx(thin.quality.area, rel=1e-9)
    faces, weights = finer.places
    at = (weights[:, :, None] * thin.V[thin.F[faces]]).sum(1)
    np.testing.assert_array_equal(at[: len(thin.V)], thin.V)
    ends = finer.edges
    straight = np.linalg.norm(at[ends[:, 0]] - at[ends[:, 1]], axis=1)
    assert (straight <= finer.lengths * (1 + 1e-9)).all()
    with pytest.raises(ricci.ArgumentError, match="was not refined"):
        _ = thin.places
    with pytest.raises(ricci.ArgumentError, match="30"):
        thin.refine_angle(1.0)
