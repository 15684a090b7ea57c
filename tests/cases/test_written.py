"""Checks look at the file that is written: folded faces with --on input and their repair, maps that fold, layouts that overlap."""

import json

import pytest


def folded(obj):
    """The number of faces of a file that do not run counterclockwise in its texture coordinates."""
    return len(obj.turned())


def tell(run, path, read_obj):
    """The check of the run is that of the file: the number of folded faces, which is returned, and the exit code."""
    n = folded(read_obj(path))
    check = run.report["checks"]["flipped_triangles"]
    assert (check["value"], check["holds"]) == (n, n == 0)
    assert run.report["result"]["flipped_triangles"] == n
    assert run.code == (1 if n else 0), run.text
    assert ("FAILED: flipped_triangles" in run.text) == (n > 0), run.text
    return n


def on_surface(before, after):
    """Vertices of a repaired file: the first are those of the input, the others lie on its edges."""
    assert after.v[: len(before.v)] == before.v
    edges = {tuple(sorted(pair)) for f in before.f for pair in zip(f, f[1:] + f[:1])}
    ends = [(before.v[a], before.v[b]) for a, b in edges]
    for p in after.v[len(before.v) :]:
        assert min(distance(p, a, b) for a, b in ends) < 1e-9, p


def distance(p, a, b):
    """The distance of a point from a segment in space."""
    along = [y - x for x, y in zip(a, b)]
    off = [y - x for x, y in zip(a, p)]
    square = sum(x * x for x in along)
    t = min(1, max(0, sum(x * y for x, y in zip(along, off)) / square))
    return sum((x - t * y) ** 2 for x, y in zip(off, along)) ** 0.5


@pytest.mark.row("min_on_input.obj")
def test_the_check_is_of_the_file_and_a_repair_leaves_no_fold(ricci, case, read_obj, tmp_path):
    mesh, uv = case("min_on_input.obj"), tmp_path / "u.obj"
    line = ("flow", mesh, "--pin", "boundary", "--uv", uv, "--on", "input")
    run = ricci(*line)
    assert tell(run, uv, read_obj) == 1
    assert run.report["result"]["flipped_input_faces"] == 1
    assert "0 triangles flipped" not in run.text and "all hold" not in run.text
    assert "--repair" in run.report["checks"]["flipped_triangles"]["remedy"]
    turned = read_obj(uv).turned()
    assert run.report["checks"]["flipped_triangles"]["where"] == f"face {turned[0]}"

    xref = tmp_path / "x.csv"
    run = ricci(*line, "--repair", "--xref", xref)
    assert tell(run, uv, read_obj) == 0
    before, after = read_obj(mesh), read_obj(uv)
    result = run.report["result"]
    assert (result["flipped_input_faces"], result["split_edges"]) == (1, 1)
    assert result["added_vertices"] == len(after.v) - len(before.v) == 1
    on_surface(before, after)
    faces, vertices = xref.read_text().split("output_vertex,source_face,b0,b1,b2\n")
    assert len(faces.splitlines()) - 1 == len(after.f) == len(before.f) + 2
    for row in vertices.splitlines():
        v, f, *b = row.split(",")
        corners = [before.v[c] for c in before.f[int(f)]]
        for k in range(3):
            assert abs(sum(float(w) * c[k] for w, c in zip(b, corners)) - after.v[int(v)][k]) < 1e-12


@pytest.mark.row("bowtie_patch.obj")
def test_the_largest_part_of_a_repaired_patch_is_written_without_folds(ricci, case, read_obj, tmp_path):
    ricci("repair", case("bowtie_patch.obj"), "-o", "r.obj", "--component", "0", report=False)
    uv = tmp_path / "u.obj"
    for more in ([], ["--target", "boundary"]):
        run = ricci("flow", "r.obj", "--uv", uv, "--on", "input", *more)
        n = tell(run, uv, read_obj)
        assert run.report["result"]["flipped_input_faces"] == n
    assert n == 2
    run = ricci("flow", "r.obj", "--target", "boundary", "--uv", uv, "--on", "input", "--repair")
    assert tell(run, uv, read_obj) == 0
    on_surface(read_obj(tmp_path / "r.obj"), read_obj(uv))


@pytest.mark.row("ramp_540deg.obj")
def test_a_layout_that_covers_itself_says_so_and_names_charts(ricci, case):
    mesh = case("ramp_540deg.obj")
    run = ricci("flow", mesh, "--pin", "boundary", "--uv", "u.obj")
    # One and a half turns: a third of the area lies on other parts.
    assert abs(run.report["result"]["overlap"] - 1 / 3) < 0.01
    assert "overlap" in run.text and "--charts" in run.text
    run = ricci("flow", mesh, "--pin", "boundary", "--uv", "u.obj", "--charts")
    assert "overlap" not in run.report["result"] and "overlap  " not in run.text
    assert run.report["checks"]["overlapping_in_charts"]["holds"]


@pytest.mark.row("fixed71.obj")
def test_a_map_with_given_places_that_folds_fails_by_name(ricci, case, read_obj, tmp_path):
    uv = tmp_path / "u.obj"
    run = ricci("harmonic", case("fixed71.obj"), "--to", f"file:{case('fixed71.csv')}", "--uv", uv)
    # 576 of the 1152 triangles of the domain, which are 804 pieces of the file.
    assert tell(run, uv, read_obj) == 804
    assert run.report["result"]["flipped_domain_triangles"] == 576
    assert "804 triangles flipped (pieces of 576 of the 1152 triangles mapped)" in run.text
    assert "flipped_triangles = 8.040e2, limit 0.000e0 (faces " in run.text
    assert "--to disk" in run.text and "(804 in all)" in run.text


def test_the_export_of_a_folded_spline_fails_by_name(ricci, tmp_path):
    ricci("make", "torus", "-n", "24", "-o", "t.obj", report=False)
    assert ricci("spline", "fit", "t.obj", "-o", "s.json").code == 0
    sound = ricci("spline", "export", "s.json", "-o", "s.step", "--tolerance", "1e-3")
    assert sound.code == 0 and sound.report["checks"]["folded_patches"]["holds"], sound.text
    # A control point on the other side of the axis draws the surface through itself.
    spline = json.loads((tmp_path / "s.json").read_text())
    x, y, z = spline["control_points"][0]
    spline["control_points"][0] = [-x, -y, z]
    (tmp_path / "bent.json").write_text(json.dumps(spline))
    refused = ricci("spline", "export", "bent.json", "-o", "bent.step", "--tolerance", "1e-3")
    assert refused.code == 3 and "turns back on itself" in refused.text and not (tmp_path / "bent.step").exists()
    few = ricci("spline", "export", "s.json", "-o", "few.step", "--tolerance", "1e-3", "--control-points", "100")
    assert few.code == 2 and "larger tolerance" in few.text and not (tmp_path / "few.step").exists()
    bent = ricci("spline", "export", "bent.json", "-o", "bent.step", "--tolerance", "1e-3", "--allow-folds")
    assert bent.code == 1 and "folded_patches" in bent.text and "all hold" not in bent.text
    assert "patch" in bent.report["checks"]["folded_patches"]["where"]


def test_a_repair_needs_the_inputs_faces(ricci):
    ricci("make", "torus", "-o", "t.obj", report=False)
    refused = ricci("flow", "t.obj", "--uv", "u.obj", "--repair")
    assert refused.code == 2 and "--on input" in refused.text
