"""Layouts, charts and maps: laid out triangles have the metric's lengths, charts do not overlap, values are carried."""

import numpy as np
import pytest

import ricci


@pytest.fixture(scope="module")
def flat(genus2):
    return ricci.flow(genus2, target="single:0")


@pytest.fixture(scope="module")
def laid(flat):
    return ricci.layout(flat)


def signed_areas(uv):
    a, b, c = uv[:, 0], uv[:, 1], uv[:, 2]
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def test_triangles_are_counterclockwise_and_have_the_area_of_the_surface(laid, genus2):
    s = laid.summary
    assert s.n_flipped == 0
    areas = signed_areas(laid.uv("refinement"))
    assert areas.min() > 0
    sides = genus2.V[genus2.F]
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1).sum()
    assert areas.sum() == pytest.approx(area, rel=1e-10)
    assert laid.flipped("refinement").size == 0
    assert laid.flipped("input").size == s.n_flipped_input


def test_the_figures_of_the_summary_say_for_which_faces_they_are(laid):
    s = laid.summary
    for on, mean, largest in (("refinement", s.qc_mean, s.qc_max), ("input", s.qc_mean_input, s.qc_max_input)):
        qc, ratio = laid.distortion(on)
        assert qc.max() == largest
        assert 1 <= mean <= largest
        assert ratio.min() > 0
    assert (s.area_ratio_min_input, s.area_ratio_max_input) == (ratio.min(), ratio.max())
    assert s.n_degenerate_input == 0
    assert 0 <= s.overlap < 1


def test_a_repaired_input_has_no_folded_face(laid, genus2):
    repaired = laid.repaired_input()
    s, mesh = repaired.summary, repaired.mesh
    assert s.n_flipped == 0
    assert signed_areas(repaired.uv()).min() > 0
    assert (s.n_split_edges == 0) == (laid.summary.n_flipped_input == 0)
    assert np.array_equal(mesh.V[: len(genus2.V)], genus2.V)
    assert len(mesh.V) == s.n_vertices >= len(genus2.V) + s.n_split_edges
    placed = np.einsum("fck,fkx->fcx", repaired.barycentric, genus2.V[genus2.F[repaired.faces]])
    np.testing.assert_allclose(placed, mesh.V[mesh.F], atol=1e-12)


def test_without_flips_edges_have_the_metrics_lengths(torus):
    flat = ricci.flow(torus, target="uniform", flips="never")
    uv = ricci.layout(flat, scale="as_solved").uv()
    for k in range(3):
        side = np.linalg.norm(uv[:, (k + 1) % 3] - uv[:, (k + 2) % 3], axis=1)
        np.testing.assert_allclose(side, flat.lengths[np.abs(torus.face_edges[:, k]) - 1], rtol=1e-9)


def test_corners_index_points(laid):
    for on in ("input", "refinement"):
        uv, points = laid.uv(on), laid.points()
        if on == "refinement":
            assert np.array_equal(uv, points[laid.corners(on)])
    assert laid.points("ambient").shape == (laid.summary.n_points, 3)


def test_seams_are_isometries_that_carry_one_side_to_the_other(laid):
    mesh, edges = laid.mesh, laid.seam_edges("refinement")
    uv = {}
    for face, row in zip(mesh.face_edges, laid.uv("refinement"), strict=True):
        for k in range(3):
            uv[int(face[k])] = row[(k + 1) % 3], row[(k + 2) % 3]
    assert len(edges) == len(laid.seams) > 0
    for seam, path in zip(laid.seams, edges, strict=True):
        (a, b), (c, d) = seam.mobius
        assert abs(a) == pytest.approx(1)
        assert (c, d) == (0, 1)
        for edge in path.tolist():
            left = np.array([complex(*p) for p in uv[edge]])
            right = np.array([complex(*p) for p in uv[-edge]])[::-1]
            np.testing.assert_allclose(a * left + b, right, atol=1e-10)


def test_distortion_of_a_conformal_map_is_small(laid):
    qc, ratio = laid.distortion("refinement")
    assert qc.min() >= 1
    assert laid.summary.qc_mean < 1.2
    assert ratio.min() > 0


def test_layouts_are_written_as_obj(tmp_path, laid, genus2):
    laid.write(tmp_path / "uv.obj")
    again = ricci.read(tmp_path / "uv.obj")
    assert np.array_equal(again.F, genus2.F)
    assert np.array_equal(again.uv, laid.uv())
    laid.write(tmp_path / "fine.obj", "refinement")
    assert ricci.read(tmp_path / "fine.obj").n_faces == laid.summary.n_faces


@pytest.mark.parametrize("ending", ["ply", "glb"])
def test_layouts_are_written_in_the_format_of_the_ending(tmp_path, laid, genus2, ending):
    """Each format has the coordinates of every corner; glTF has a vertex once for each pair, in 24 bits."""
    for writes in (laid, ricci.charts(laid)):
        path = tmp_path / f"uv.{ending}"
        writes.write(path)
        assert not path.read_bytes().startswith(b"v ")
        again = ricci.Soup.read(path)
        uv = laid.uv() if writes is laid else writes.points[writes.corners]
        assert again.summary.n_uv == len(uv)
        np.testing.assert_allclose(again.uv, uv, atol=1e-6 * np.abs(uv).max() if ending == "glb" else 0)


def test_what_a_format_has_no_place_for_is_refused(tmp_path, laid, disk):
    with pytest.raises(ricci.FileError, match=r"known are .obj, .off, .ply, .glb"):
        laid.write(tmp_path / "uv.stl")
    for name in ("uv.mz3", "lh.pial"):
        with pytest.raises(ricci.ArgumentError, match=r"no texture coordinates: write .obj, .off"):
            laid.write(tmp_path / name)
    with pytest.raises(ricci.FileError, match="unknown format"):
        ricci.charts(laid).write(tmp_path / "charts")
    for name in ("uv.off", "uv.vtk", "uv.vtp"):
        with pytest.raises(ricci.ArgumentError, match="has seams"):
            laid.write(tmp_path / name)
    with pytest.raises(ricci.ArgumentError, match=r"in .obj files only"):
        laid.write(tmp_path / "uv.ply", "refinement", homogeneous=True)
    assert list(tmp_path.iterdir()) == []
    whole = ricci.layout(ricci.flow(disk))
    whole.write(tmp_path / "uv.off")
    assert np.array_equal(ricci.read(tmp_path / "uv.off").uv, whole.uv())


def test_a_curved_metric_is_laid_out_where_its_cones_are_named_alone(genus2):
    curved = ricci.metric(genus2)
    with pytest.raises(ricci.LayoutError, match=r"curved at \d+ vertices inside.*ricci.flow\(mesh.*cones=") as told:
        ricci.layout(curved)
    at = told.value.index
    assert told.value.element == "vertex"
    assert abs(curved.curvature[at]) == np.abs(curved.curvature).max()
    everywhere = ricci.layout(curved, cones=np.arange(genus2.n_vertices))
    assert everywhere.summary.n_flipped == 0
    corners = [[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    cube = ricci.Mesh(corners, [face for a, b, c, d in sides for face in ([a, b, c], [a, c, d])])
    assert ricci.layout(ricci.metric(cube), cones=range(8)).summary.n_flipped == 0


def test_flat_metrics_need_no_flow(disk):
    assert ricci.layout(ricci.metric(disk)).summary.n_flipped == 0
    assert ricci.layout(ricci.metric(ricci.make("flat_torus"))).summary.n_flipped == 0


def test_a_metric_that_has_not_converged_is_told_of(genus2):
    with pytest.warns(ricci.ConvergenceWarning, match="the flow stopped \\(iteration_limit\\) after 1 steps") as flowed:
        early = ricci.flow(genus2, target="auto:6", max_iterations=1)
    assert flowed[0].filename == __file__
    with pytest.warns(ricci.ConvergenceWarning, match="has not converged.*its seams do not fit") as laid:
        ricci.layout(early)
    assert laid[0].filename == __file__


def test_labels_stay_labels_on_the_refinement(flat, genus2):
    way = ricci.Map(flat)
    labels = np.arange(genus2.n_vertices, dtype=np.int16) % 7
    carried = way.carry(labels)
    assert carried.dtype == np.int16
    assert np.array_equal(carried[: genus2.n_vertices], labels)
    shares = np.stack([way.carry((labels == label).astype(float)) for label in range(7)])
    np.testing.assert_allclose(np.take_along_axis(shares, carried[None].astype(int), 0)[0], shares.max(0), atol=1e-12)
    assert set(np.unique(way.carry(genus2.F % 5, at="corners"))) <= set(range(5))
    assert way.carry(labels > 3).dtype == bool
    with pytest.raises(ricci.ArgumentTypeError, match="have no mean"):
        way.carry(labels, mode="linear")
    with pytest.raises(ricci.ArgumentError, match=r"a mode of Matching\.carry"):
        way.carry(labels.astype(float), mode="conservative")
    metric_side = way.carry(np.arange(flat.summary.n_mesh_vertices), on="metric")
    assert np.array_equal(metric_side[: genus2.n_vertices], np.arange(genus2.n_vertices))
    with pytest.raises(ricci.ArgumentError, match="rows of labels"):
        way.carry(labels[:-1])


def test_charts_fill_the_unit_square_and_are_moved_copies(laid, tmp_path):
    atlas = ricci.charts(laid, margin=0.01)
    points = atlas.points[atlas.corners]
    assert points.min() >= 0
    assert points.max() <= 1
    angle, x, y = atlas.motions[atlas.charts].T
    z = laid.uv("refinement") @ [1, 1j]
    moved = np.exp(1j * angle)[:, None] * (atlas.summary.scale * z) + (x + 1j * y)[:, None]
    np.testing.assert_allclose(points @ [1, 1j], moved, atol=1e-12)
    assert signed_areas(points).sum() == pytest.approx(atlas.summary.efficiency, rel=1e-9)
    atlas.write(tmp_path / "charts.obj")
    assert ricci.read(tmp_path / "charts.obj").uv is not None
    with pytest.raises(ricci.ArgumentError):
        ricci.charts(laid, margin=2)


def test_values_are_carried_over_the_refinement(flat, genus2):
    way = ricci.Map(flat)
    fine = way.mesh
    np.testing.assert_allclose(way.carry(genus2.V), fine.V, atol=1e-12)
    assert np.array_equal(way.carry(genus2.V[:, 0])[: genus2.n_vertices], genus2.V[:, 0])
    corners = way.carry(genus2.V[genus2.F], at="corners")
    np.testing.assert_allclose(corners, fine.V[fine.F], atol=1e-12)
    spots = np.einsum("fcw,fwx->fcx", way.barycentric(), genus2.V[genus2.F[way.faces()]])
    np.testing.assert_allclose(spots, fine.V[fine.F], atol=1e-12)
    edges, fractions = way.crossings()
    ends = genus2.V[genus2.edges[edges]]
    np.testing.assert_allclose(
        ends[:, 0] * (1 - fractions)[:, None] + ends[:, 1] * fractions[:, None], fine.V[genus2.n_vertices :], atol=1e-12
    )
    assert way.weights.min() > 0
    assert way.faces("refinement").max() + 1 == way.summary.n_pieces
    with pytest.raises(ricci.ArgumentError):
        way.carry(np.zeros(3))
    with pytest.raises(ricci.ArgumentError, match="finite"):
        way.carry(np.full(genus2.n_vertices, np.nan))


def test_a_cut_goes_through_chosen_cones(torus):
    flat = ricci.flow(torus, target="uniform")
    # A root away from the shortest paths between the cones has one place.
    plain, cut = ricci.layout(flat, cones=[]), ricci.layout(flat, cones=[0, 300], root=410)
    assert len(cut.seams) > len(plain.seams)
    assert np.allclose(cut.points()[cut.corners()[torus.F == 410]], 0)


def test_circles_of_faces_are_orthogonal_to_those_of_their_corners():
    flat = ricci.flow(ricci.make("disk", n=5), scheme="tangential", flips="never")
    layout = ricci.layout(flat)
    points, faces = layout.circle_pattern(), layout.circle_pattern("faces")
    corners = points[layout.corners("metric")]
    distances = ((corners[:, :, :2] - faces[:, None, :2]) ** 2).sum(2)
    np.testing.assert_allclose(distances, corners[:, :, 2] + faces[:, None, 2], atol=1e-9)


def test_a_bent_strip_is_cut_along_one_line_and_folded_along_another(tmp_path):
    x, y = np.meshgrid(np.arange(8.0), np.arange(3.0), indexing="ij")
    points = np.stack([np.minimum(x, 3), y, np.maximum(x - 3, 0)], axis=-1).reshape(-1, 3)
    corner = (3 * np.arange(7)[:, None] + np.arange(2)).ravel()
    faces = np.concatenate([[corner, corner + 3, corner + 4], [corner, corner + 4, corner + 1]], axis=1).T
    flat = ricci.layout(ricci.metric(ricci.Mesh(points, faces.astype(np.uint32))), scale="as_solved")
    boundary, fold = flat.lines()
    assert (boundary.layer, boundary.closed, boundary.seam) == ("boundary", True, None)
    assert (fold.layer, fold.closed) == ("folds", False)
    uv = flat.points()
    around = uv[boundary.points]
    assert np.linalg.norm(around - np.roll(around, 1, axis=0), axis=1).sum() == pytest.approx(18, abs=1e-9)
    assert np.linalg.norm(np.diff(uv[fold.points], axis=0), axis=1).sum() == pytest.approx(2, abs=1e-9)
    assert len(flat.lines(fold_angle=1.6)) == 1
    flat.write_flat(tmp_path / "strip.obj")
    again = ricci.read(tmp_path / "strip.obj")
    assert again.n_faces == 28
    assert np.array_equal(again.V[:, 2], np.zeros(again.n_vertices))
    for name in ["strip.dxf", "strip.svg"]:
        flat.write_flat(tmp_path / name, unit="inch")
        assert "FOLDS" in (tmp_path / name).read_text()
    with pytest.raises(ricci.ArgumentError):
        flat.lines(fold_angle=-1)
