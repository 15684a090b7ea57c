"""Maps and refinements: `match` with landmarks on boundary loops, `harmonic`, `cover --lift`, `refine`."""

import csv
import json
import math

import pytest


def grid(path, a, b, n, place=lambda x, y: (x, y, 0.0)):
    """An OBJ file of a rectangle a x b cut from the plane, n steps per unit; returns its four corners."""
    m, k = round(a * n), round(b * n)
    rows = [f"v {x!r} {y!r} {z!r}\n" for j in range(k + 1) for i in range(m + 1) for x, y, z in [place(a * i / m, b * j / k)]]

    def at(i, j):
        return j * (m + 1) + i + 1

    for j in range(k):
        for i in range(m):
            rows.append(f"f {at(i, j)} {at(i + 1, j)} {at(i + 1, j + 1)}\n")
            rows.append(f"f {at(i, j)} {at(i + 1, j + 1)} {at(i, j + 1)}\n")
    path.write_text("".join(rows))
    return [0, m, (m + 1) * (k + 1) - 1, k * (m + 1)]


@pytest.mark.row("small_a.obj")
def test_landmarks_on_loops_pair_the_loops(ricci, case):
    done = ricci("match", case("small_a.obj"), case("small_b.obj"), "--landmarks", case("small_lm.csv"), "--map", "m.csv")
    assert done.code == 0, done.text
    result = done.report["result"]
    assert result["flipped_triangles"] == 0 and result["landmark_error"] < 1e-9
    assert result["qc_mean"] == pytest.approx(1.05, abs=0.005)
    # The same loops, named.
    named = ricci("match", case("small_a.obj"), case("small_b.obj"), "--landmarks", case("small_lm.csv"), "--loops", "0,1")
    assert named.report["result"]["qc_mean"] == result["qc_mean"]
    # Loops that the landmarks contradict: the message says where to say so.
    wrong = ricci("match", case("small_a.obj"), case("small_b.obj"), "--landmarks", case("small_lm.csv"), "--loops", "1,0")
    assert wrong.code == 3 and "--loops" in wrong.err


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (1.0, 3.0)])
def test_a_rectangle_has_its_own_modulus(ricci, tmp_path, a, b):
    corners = grid(tmp_path / "r.obj", a, b, 4)
    done = ricci("harmonic", "r.obj", "--to", "rectangle", "--corners", ",".join(map(str, corners)))
    assert done.code == 0, done.text
    assert done.report["result"]["modulus"] == pytest.approx(a / b, rel=1e-12)
    assert "modulus" in done.out


def test_the_modulus_of_a_quarter_annulus_converges_between_its_bounds(ricci, tmp_path):
    """Radii 1 and 2: the logarithm maps it to ln 2 by π/2."""
    exact = math.log(2.0) / (math.pi / 2)
    errors = []
    for n in [4, 8, 16]:
        corners = grid(
            tmp_path / "r.obj", 1.0, 1.0, n,
            lambda x, y: ((1 + x) * math.cos(y * math.pi / 2), (1 + x) * math.sin(y * math.pi / 2), 0.0),
        )
        result = ricci("harmonic", "r.obj", "--to", "rectangle", "--corners", ",".join(map(str, corners))).report["result"]
        low, high = result["modulus_bounds"]
        assert low <= result["modulus"] <= high
        errors.append(abs(result["modulus"] - exact))
    assert errors[0] > 3 * errors[1] > 9 * errors[2], errors
    assert errors[2] < 1e-3


def test_the_heat_flow_falls_to_the_harmonic_map(ricci, tmp_path):
    assert ricci("make", "disk", "-n", "8", "--height", "0.4", "-o", "d.obj", report=False).code == 0
    solved = ricci("harmonic", "d.obj", "--uv", "solved.obj")
    heat = ricci("harmonic", "d.obj", "--method", "heat", "--trace", "t.csv", "--uv", "heat.obj")
    assert heat.code == 0, heat.text
    rows = list(csv.DictReader((tmp_path / "t.csv").open()))
    energies = [float(row["energy"]) for row in rows]
    assert len(energies) > 20 and [int(row["step"]) for row in rows] == list(range(len(rows)))
    assert all(after < before or after - before < 1e-14 * energies[0] for before, after in zip(energies, energies[1:]))
    assert energies[-1] == pytest.approx(solved.report["result"]["energy"], rel=1e-12)

    def places(name):
        lines = (tmp_path / name).read_text().splitlines()
        return [tuple(map(float, line.split()[1:3])) for line in lines if line.startswith("vt ")]

    pairs = zip(places("solved.obj"), places("heat.obj"))
    assert max(math.dist(p, q) for p, q in pairs) < 1e-8
    refused = ricci("harmonic", "d.obj", "--trace", "t.csv")
    assert refused.code == 2 and "--method heat" in refused.err


def test_the_heat_flow_to_the_sphere_is_the_papers(ricci, tmp_path):
    assert ricci("make", "ellipsoid", "-n", "4", "-o", "e.obj", report=False).code == 0
    heat = ricci("harmonic", "e.obj", "--method", "heat", "--trace", "t.csv", "--max-iterations", "20000")
    energies = [float(row["energy"]) for row in csv.DictReader((tmp_path / "t.csv").open())]
    assert all(after < before for before, after in zip(energies, energies[1:]))
    solved = ricci("harmonic", "e.obj").report["result"]["energy"]
    assert heat.code == 0, heat.text
    # Both stop where a step lowers the energy by 1e-10 of it; the explicit steps are short, the ends differ by more.
    assert energies[-1] == pytest.approx(solved, rel=1e-3)


def mobius(matrix, z):
    (a, b), (c, d) = [[complex(*entry) for entry in row] for row in matrix]
    return (a * z + b) / (c * z + d)


@pytest.mark.parametrize("shape", ["torus", "genus"])
def test_loops_lift_to_paths_whose_ends_a_deck_transformation_relates(ricci, tmp_path, shape):
    assert ricci("make", shape, "-o", "s.obj", report=False).code == 0
    # A closed edge path: once around a vertex's faces, which is contractible, and one along the mesh that is not.
    faces = [[int(c.split("/")[0]) - 1 for c in line.split()[1:]] for line in (tmp_path / "s.obj").read_text().splitlines() if line.startswith("f ")]
    nxt = {a: b for f in faces for v, a, b in [(f[0], f[1], f[2]), (f[1], f[2], f[0]), (f[2], f[0], f[1])] if v == 7}
    ring = [next(iter(nxt))]
    while nxt[ring[-1]] != ring[0]:
        ring.append(nxt[ring[-1]])
    (tmp_path / "l.csv").write_text("loop,vertex\n" + "".join(f"ring,{v}\n" for v in ring))
    done = ricci("cover", "s.obj", "--depth", "1", "--word", "a1.b1^-1", "--word", "a1 b1", "--lift", "l.csv", "--lift-out", "o.json", "--picture", "p.png")
    assert done.code == 0, done.text
    assert done.report["checks"]["lift_end"]["value"] <= 1e-9
    lifts = json.loads((tmp_path / "o.json").read_text())["lifts"]
    assert [lift["name"] for lift in lifts] == ["a1.b1^-1", "a1 b1", "ring"]
    assert [lift["word"] for lift in lifts] == [["a1", "b1^-1"], ["a1", "b1"], []]
    for lift in lifts:
        start, end = [complex(*lift["points"][k]) for k in (0, -1)]
        assert abs(mobius(lift["matrix"], start) - end) < 1e-9 * max(1.0, abs(end))
        assert lift["vertices"][0] == lift["vertices"][-1]
    assert abs(complex(*lifts[0]["points"][0]) - complex(*lifts[0]["points"][-1])) > 1e-3
    assert ricci("cover", "s.obj", "--word", "a9").code == 2
    (tmp_path / "l.csv").write_text("far,0\nfar,7\n")
    broken = ricci("cover", "s.obj", "--lift", "l.csv")
    assert broken.code == 3 and "edge" in broken.err


def check_back(ricci_back, given, finer):
    """The way back puts each vertex where it is: positions are combinations of the corners of the source face."""
    rows = list(csv.reader(ricci_back.open()))
    at = rows.index(["output_vertex", "source_face", "b0", "b1", "b2"])
    assert len(rows[1:at]) == len(finer.f)
    for v, f, *weights in rows[at + 1 :]:
        w = [float(x) for x in weights]
        corners = [given.v[c] for c in given.f[int(f)]]
        assert min(w) >= 0.0 and sum(w) == pytest.approx(1.0, abs=1e-15)
        place = [sum(w[c] * corners[c][k] for c in range(3)) for k in range(3)]
        assert math.dist(place, finer.v[int(v)]) < 1e-12


def test_refined_surfaces_stay_where_they_are(ricci, tmp_path, read_obj):
    assert ricci("make", "torus", "-o", "t.obj", report=False).code == 0
    given = read_obj(tmp_path / "t.obj")
    for how, times in [(["--levels", "1"], 4), (["--edge", "0.2"], None)]:
        done = ricci("refine", "t.obj", "-o", "fine.obj", "--xref", "x.csv", *how)
        assert done.code == 0, done.text
        finer = read_obj(tmp_path / "fine.obj")
        assert finer.v[: len(given.v)] == given.v
        assert times is None or len(finer.f) == times * len(given.f)
        check_back(tmp_path / "x.csv", given, finer)
        result = done.report["result"]
        assert result["area"] == pytest.approx(result["area_before"], rel=1e-12)
        assert result["euler"] == 0 and result["vertices"] == len(finer.v)
    sides = [math.dist(finer.v[f[k]], finer.v[f[k - 1]]) for f in finer.f for k in range(3)]
    assert max(sides) <= 0.2
    assert ricci("refine", "t.obj", "-o", "fine.obj").code == 2


def test_a_metric_is_refined_to_its_least_angle(ricci, tmp_path):
    assert ricci("make", "torus", "--big", "3", "--small", "0.2", "-n", "8", "-m", "30", "-o", "t.obj", report=False).code == 0
    done = ricci("refine", "t.obj", "--intrinsic", "--angle", "25", "-o", "m.json")
    assert done.code == 0, done.text
    metric = json.loads((tmp_path / "m.json").read_text())
    least = min(
        math.acos(max(-1.0, min(1.0, (b * b + c * c - a * a) / (2 * b * c))))
        for sides in metric["lengths"]
        for a, b, c in [sides, sides[1:] + sides[:1], sides[2:] + sides[:2]]
    )
    assert least >= math.radians(25) and math.degrees(least) == pytest.approx(done.report["result"]["min_angle_degrees"])
    # The conformal structure is that of the surface: the same modulus, to the accuracy of the coarser mesh.
    moduli = [ricci("uniformize", name).report["result"]["modulus"] for name in ("t.obj", "m.json")]
    assert moduli[0] == pytest.approx(moduli[1], rel=0.05)
    assert ricci("refine", "t.obj", "--intrinsic", "--angle", "40", "-o", "m.json").code == 2
