"""Seams that are open by a rounding, T-junctions, faces without area: what `info` says and `repair` mends."""

import json

import pytest


@pytest.mark.row("cyl_seam_eps.obj")
def test_a_seam_open_by_a_rounding_is_named_with_the_weld_that_closes_it(ricci, case):
    told = ricci("info", case("cyl_seam_eps.obj"))
    assert told.code == 0
    (hint,) = told.report["result"]["hints"]
    assert hint["code"] == "open_seam"
    assert 2.4e-16 < hint["weld"] < 2.6e-16
    assert "--weld 2.5e-16" in told.out
    assert told.out.index("hint:") < told.out.index("no defects")
    assert [rim["edges"] for rim in told.report["result"]["loops"]] == [82]
    asked = ricci("uniformize", case("cyl_seam_eps.obj"))
    assert asked.code == 3
    assert "--weld 2.5e-16" in asked.err
    mended = ricci("repair", case("cyl_seam_eps.obj"), "-o", "r.obj", "--weld", repr(hint["weld"]))
    assert (mended.code, mended.report["result"]["boundary_loops"], mended.report["result"]["euler"]) == (0, 2, 0)
    assert ricci("uniformize", "r.obj").code == 0


@pytest.mark.row("tjunction.obj")
def test_t_junctions_are_named_with_edge_and_vertex(ricci, case):
    told = ricci("info", case("tjunction.obj"))
    hint = next(hint for hint in told.report["result"]["hints"] if hint["code"] == "t_junctions")
    assert hint["vertices"] == list(range(211, 231, 2))
    assert "vertex 211 on edge 232–231" in told.out
    mended = ricci("repair", case("tjunction.obj"), "-o", "r.obj", "--t-junctions", "--map", "map.json")
    result = mended.report["result"]
    assert (mended.code, result["joined_t_junctions"], result["components"], result["boundary_loops"]) == (0, 10, 1, 1)
    assert result["euler"] == 1
    assert result["hints"] == []


@pytest.mark.row("collinear_caps.obj")
def test_faces_without_area_are_mended_with_the_map_back(ricci, case, tmp_path):
    file = case("collinear_caps.obj")
    told = ricci("info", file)
    assert {kind["code"] for kind in told.report["result"]["defect_counts"]} == {"zero_area_face"}
    assert "ricci repair --degenerate" in told.out
    area = told.report["result"]["quality"]["area"]
    mended = ricci("repair", file, "-o", "r.obj", "--degenerate", "--map", "map.json")
    result = mended.report["result"]
    assert mended.code == 0
    assert result["flipped_edges"] + result["opened_faces"] + result["collapsed_edges"] > 0
    again = ricci("info", "r.obj")
    assert again.report["result"]["admissible"]
    # The faces that count as without area have 1.2e-10 of it together.
    assert abs(again.report["result"]["quality"]["area"] / area - 1) < 1e-9
    assert (again.report["input"]["euler"], again.report["input"]["boundary_loops"]) == (1, 1)
    origin = json.loads((tmp_path / "map.json").read_text())
    assert len(origin["face_origin"]) == again.report["input"]["faces"]
    assert None not in origin["face_origin"] + origin["vertex_origin"]
    assert ricci("flow", "r.obj").code == 0


def torn_plate(n, gap):
    """A square of two halves whose seam is open by `gap`, as OBJ."""
    lines = []
    for side in range(2):
        for i in range(n + 1):
            for j in range(n + 1):
                lines.append(f"v {(side + i / n) + (gap if side else 0)!r} {j / n!r} 0")
    for side in range(2):
        for i in range(n):
            for j in range(n):
                a = side * (n + 1) ** 2 + i * (n + 1) + j + 1
                lines += [f"f {a} {a + n + 1} {a + n + 2}", f"f {a} {a + n + 2} {a + 1}"]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("gap", [2e-16, 1e-12, 1e-9, 2e-7])
def test_the_advice_to_take_one_component_comes_after_the_weld(ricci, tmp_path, gap):
    (tmp_path / "torn.obj").write_text(torn_plate(8, gap))
    refused = ricci("flow", "torn.obj")
    assert refused.code == 3
    assert refused.err.index("--weld") < refused.err.index("--component")
    taken = ricci("repair", "torn.obj", "-o", "half.obj", "--component", "0", "--no-weld")
    if gap > 1e-15:
        assert "may be torn pieces of one" in taken.out
    weld = ricci("info", "torn.obj").report["result"]["hints"][0]["weld"]
    whole = ricci("repair", "torn.obj", "-o", "whole.obj", "--weld", repr(weld))
    assert (whole.code, whole.report["result"]["components"]) == (0, 1)


def test_a_cortical_surface_with_vertices_that_are_not_finite_is_made_whole(ricci, tmp_path):
    assert ricci("make", "sphere", "-n", "8", "-o", "ball.obj").code == 0
    lines = (tmp_path / "ball.obj").read_text().splitlines()
    vertices = [k for k, line in enumerate(lines) if line.startswith("v ")]
    for v in (40, 200, 201):
        lines[vertices[v]] = "v nan nan nan"
    (tmp_path / "holed.obj").write_text("\n".join(lines) + "\n")
    refused = ricci("repair", "holed.obj", "-o", "out.obj")
    assert refused.code == 3
    assert "--drop-nonfinite" in refused.err
    open_ = ricci("repair", "holed.obj", "-o", "open.obj", "--drop-nonfinite")
    assert (open_.code, open_.report["result"]["boundary_loops"]) == (0, 3)
    loops = ricci("info", "open.obj").report["result"]["loops"]
    assert len(loops) == 3
    whole = ricci("repair", "holed.obj", "-o", "whole.obj", "--drop-nonfinite", "--fill-holes", "all", "--map", "map.json")
    result = whole.report["result"]
    assert (whole.code, result["euler"], result["boundary_loops"], len(result["filled_holes"])) == (0, 2, 0, 3)
    origin = json.loads((tmp_path / "map.json").read_text())
    first, end = result["filled_holes"][0]["faces"]
    assert all(face is None for face in origin["face_origin"][first:end])
    assert ricci("uniformize", "whole.obj").code == 0
    named = ricci("repair", "open.obj", "-o", "one.obj", "--fill-hole", str(loops[1]["vertex"]))
    assert named.report["result"]["boundary_loops"] == 2
    assert [hole["vertex"] for hole in named.report["result"]["filled_holes"]] == [loops[1]["vertex"]]
