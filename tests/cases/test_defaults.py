"""Defaults that a user would choose on open surfaces: one piece without seams, isometric where the surface unrolls; a flow per component."""

import math

import pytest
from conftest import area

# Largest relative change of an edge of a surface that unrolls.
ISOMETRIC = 1e-12


def stretch(obj):
    """Largest |length in the layout over length in space − 1| over the edges of a file, after the scale that makes their areas equal."""
    in_space = in_plane = 0.0
    for face, texture in zip(obj.f, obj.ft):
        p, q = [obj.v[v] for v in face], [obj.vt[t] for t in texture]
        u, w = ([b - a for a, b in zip(p[0], p[k])] for k in (1, 2))
        in_space += math.hypot(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
        in_plane += area(q)
    scale, worst = math.sqrt(in_space / in_plane), 0.0
    for face, texture in zip(obj.f, obj.ft):
        for k in range(3):
            a, b = (obj.v[face[i]] for i in (k, (k + 1) % 3))
            c, d = (obj.vt[texture[i]] for i in (k, (k + 1) % 3))
            worst = max(worst, abs(scale * math.dist(c, d) / math.dist(a, b) - 1))
    return worst


def boxes(obj, groups):
    """The bounding boxes of the layouts of groups of faces."""
    found = []
    for faces in groups:
        points = [obj.vt[t] for f in faces for t in obj.ft[f]]
        xs, ys = zip(*points)
        found.append((min(xs), min(ys), max(xs), max(ys)))
    return found


@pytest.mark.row("flat_panel.obj")
def test_a_flat_panel_with_holes_is_one_piece_with_its_lengths(ricci, case, read_obj, tmp_path):
    assert ricci("repair", case("flat_panel.obj"), "-o", "r.obj").code == 0
    run = ricci("flow", "r.obj", "--uv", "u.obj")
    assert run.code == 0, run.text
    result = run.report["result"]
    assert result["target"] == "outer" and result["seams"] == [] and result["flipped_triangles"] == 0
    assert result["qc_max"] - 1 < 1e-7, result["qc_max"]
    assert abs(result["area_ratio_min"] - 1) < ISOMETRIC and abs(result["area_ratio_max"] - 1) < ISOMETRIC
    obj = read_obj(tmp_path / "u.obj")
    assert len(obj.vt) == len(obj.v), "a seam would double vertices"
    assert stretch(obj) < ISOMETRIC


def test_the_former_default_is_the_target_boundary(ricci, case):
    assert ricci("repair", case("flat_panel.obj"), "-o", "r.obj").code == 0
    result = ricci("flow", "r.obj", "--target", "boundary").report["result"]
    assert result["target"] == "boundary" and result["qc_max"] > 2 and len(result["seams"]) > 0


@pytest.mark.row("three_disks.obj")
def test_every_component_is_flattened(ricci, case, read_obj, tmp_path):
    path = case("three_disks.obj")
    refused = ricci("flow", path)
    assert refused.code == 3 and "--components all" in refused.text
    for on in ("refined", "input"):
        run = ricci("flow", path, "--components", "all", "--uv", "u.obj", "--on", on)
        assert run.code == 0, run.text
        rows = run.report["result"]["components"]
        assert [row["faces"] for row in rows] == [722] * 3
        assert all(row["converged"] and row["seams"] == [] and row["flipped_triangles"] == 0 for row in rows)
        given, obj = read_obj(path), read_obj(tmp_path / "u.obj")
        assert obj.v[: len(given.v)] == given.v
        if on == "input":
            assert obj.f == given.f and not obj.turned()
            firsts = [row["first_face"] for row in rows]
            # The faces of a component are those whose vertices hang together with its first face.
            root = list(range(len(given.v)))

            def find(v):
                while root[v] != v:
                    v = root[v]
                return v

            for a, b, c in given.f:
                root[find(a)] = root[find(b)] = find(c)
            groups = [[f for f, face in enumerate(given.f) if find(face[0]) == find(given.f[first][0])] for first in firsts]
            found = boxes(obj, groups)
            for i, a in enumerate(found):
                for b in found[:i]:
                    assert a[2] < b[0] or b[2] < a[0] or a[3] < b[1] or b[3] < a[1], "two layouts overlap"


def test_options_of_one_surface_are_refused_for_components(ricci, case):
    path = case("three_disks.obj")
    for option in (["--target", "single:0"], ["--charts", "--uv", "u.obj"], ["--metric", "m.json"], ["--outer", "0"]):
        run = ricci("flow", path, "--components", "all", *option)
        assert run.code == 2 and "--components" in run.text, run.text


def scroll(path, bumps):
    """A segment of a scroll with 37 holes: a sheet rolled to a spiral, with `bumps` of this height in units of a square of its grid."""
    n, m = 116, 16
    corners = [(2 + 6 * k, 2 + 6 * row) for row in range(2) for k in range(19)][1:]
    holes = {(x + d, y + e) for x, y in corners for d in range(2) for e in range(3)}
    lines, faces = [], []
    for j in range(m + 1):
        for i in range(n + 1):
            angle = 0.15 * i
            radius = 5 + 0.2 * angle + bumps * math.sin(0.9 * i) * math.sin(1.1 * j)
            lines.append(f"v {radius * math.cos(angle)!r} {radius * math.sin(angle)!r} {0.75 * j!r}")
    for j in range(m):
        for i in range(n):
            if (i, j) not in holes:
                a, b = j * (n + 1) + i + 1, (j + 1) * (n + 1) + i + 1
                faces += [f"f {a} {a + 1} {b + 1}", f"f {a} {b + 1} {b}"]
    path.write_text("\n".join(lines + faces) + "\n")
    return path


@pytest.mark.parametrize("bumps", [0.0, 0.3])
def test_a_scroll_segment_with_37_holes_has_sensible_areas(ricci, read_obj, tmp_path, bumps):
    raw = scroll(tmp_path / "raw.obj", bumps)
    assert ricci("repair", raw, "-o", "scroll.obj").code == 0
    run = ricci("flow", "scroll.obj", "--uv", "u.obj")
    assert run.code == 0, run.text
    result = run.report["result"]
    assert run.report["input"]["boundary_loops"] == 38 and result["seams"] == []
    assert result["area_ratio_min"] > 0.05 and result["area_ratio_max"] < 20
    if bumps == 0:
        assert stretch(read_obj(tmp_path / "u.obj")) < ISOMETRIC
    former = ricci("flow", "scroll.obj", "--target", "boundary").report["result"]
    assert former["area_ratio_max"] / former["area_ratio_min"] > 100 * result["area_ratio_max"] / result["area_ratio_min"]
