#!/usr/bin/env python3
"""Harmonic and holomorphic 1-forms of every closed mesh of genus 1 and more, and of known surfaces on finer meshes, as tables.

usage: docs/results/forms.py [CORPUS [NAME…]] > docs/results/forms.md     (after: cargo build --release -p ricci-apps)

RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository).
"""
import json
import math
import os
import tempfile

from page import CHECK, failures, fallen, file_of, judged, make, meshes, named, run, small, table, verdict

# Values in a file above which the outside program, which holds them all at 16 bytes each, is not asked.
JUDGED = 12_000_000
# Times that the edges of a mesh are halved to compare moduli, and vertices up to which they are halved once more.
HALVED, SMALL = 2, 2_000
BRANCH_POINTS = ["-1.6,0.1", "-0.7,-0.3", "-0.1,0.6", "0.5,-0.5", "1.1,0.4", "1.5,-0.2"]


def corpus_table(folder):
    chosen = meshes(lambda m: int(m["boundary_loops"]) == 0 and int(m["genus"]) > 0)
    rows, bad = [], []
    for mesh in chosen:
        path, out = file_of(mesh), os.path.join(folder, "F.json")
        values = 2 * int(mesh["genus"]) * int(mesh["E"])
        report, code = run(folder, "forms", path, *(["--forms", out] if values <= JUDGED else []))
        if report is None or "closedness" not in report["result"]:
            bad.append(f"{mesh['name']}: {code if report is None else report['result']}")
            continue
        r, s = report["result"], report["seconds"]
        bad += failures(mesh["name"], report)
        seen = "–"
        if values <= JUDGED and CHECK:
            said = judged("forms", out)
            if said["rank"] != 2 * said["genus"] or said["faces_of_positive_index"] or said["coclosedness"] > 1e-10:
                bad.append(f"{mesh['name']}, outside: {said}")
            seen = f"{said['rank']}, {small(said['closedness'])}, {small(said['coclosedness'])}"
        zeros = {sum(z["multiplicity"] for z in of) for of in r["zeros"]}
        modulus = "{:.5f} + {:.5f} i".format(*r["modulus"]) if "modulus" in r else ""
        rows.append([
            mesh["name"], mesh["V"], mesh["genus"], str(r["flips"]), small(r["coclosedness"]), small(r["riemann_min_eigenvalue"]),
            small(r["riemann_symmetry"]), small(r["star_residual"]), ", ".join(map(str, zeros)), str(r["largest_index"]), modulus, seen,
            f"{s['build'] + s['assemble'] + s['analyse']:.2f}", f"{s['factor']:.2f}", f"{s['solve']:.2f}", f"{s['total']:.2f}",
        ])
    head = ["mesh", "V", "genus", "flips", "d*ω", "least eigenvalue", "‖Π−Πᵀ‖/‖Π‖", "‖J²+1‖", "zeros", "largest index", "modulus",
            "outside: rank, dω, d*ω", "loops, matrix s", "factor s", "solves s", "all s"]
    return table(head, rows), bad


def matrix(rows):
    return [[complex(*z) for z in row] for row in rows]


def energies(tau):
    """The 16 least energies |m + τn|² in the metric (Im τ)⁻¹ of integer classes of a surface of genus 2: the same for every canonical basis."""
    x, y = ([[part(z) for z in row] for row in tau] for part in (lambda z: z.real, lambda z: z.imag))
    x, y = ([[0.5 * (a[i][j] + a[j][i]) for j in (0, 1)] for i in (0, 1)] for a in (x, y))
    det = y[0][0] * y[1][1] - y[0][1] ** 2
    inverse = [[y[1][1] / det, -y[0][1] / det], [-y[0][1] / det, y[0][0] / det]]
    square = lambda a, v: sum(v[i] * a[i][j] * v[j] for i in (0, 1) for j in (0, 1))
    few, found = range(-3, 4), []
    for n in ((c, d) for c in few for d in few):
        for m in ((a, b) for a in few for b in few):
            real = [m[i] + x[i][0] * n[0] + x[i][1] * n[1] for i in (0, 1)]
            found.append(square(inverse, real) + square(y, n))
    return sorted(found)[:16]


def spectral(found, exact):
    return max(abs(a - b) for a, b in zip(energies(found), energies(exact)))


def bent(path):
    """Move the vertices of an OBJ file by a smooth map of space without symmetry."""
    lines = open(path).readlines()
    with open(path, "w") as out:
        for line in lines:
            if line.startswith("v "):
                x, y, z = map(float, line.split()[1:4])
                x, y, z = x + 0.4 * math.sin(y + 0.7 * z + 0.3), y + 0.3 * math.sin(0.8 * x - 0.2) * z, z + 0.25 * math.sin(x + 1.3 * y)
                line = f"v {x!r} {y!r} {z!r}\n"
            out.write(line)


def rows_of(folder, name, surfaces, errors):
    """A row per surface on ever finer meshes: each error with the factor by which it has fallen."""
    rows, before = [], None
    for path, known in surfaces:
        report, why = run(folder, "forms", path)
        if report is None:
            raise SystemExit(f"{name}: {why}")
        now = errors(report["result"], known)
        rows.append([name, str(report["input"]["vertices"]), *fallen(now, before)])
        before = now
    return rows


def rates(folder):
    residuals = lambda r: [r["star_residual"], r["riemann_symmetry"]]
    exact = 1j * math.sqrt(2 * 2 - 0.8 * 0.8) / 0.8
    made = lambda n: make(folder, "m.obj", "torus", "--big", "2", "--small", "0.8", "-n", str(2 * n), "-m", str(n))
    rows = rows_of(folder, "torus of revolution", ((made(n), None) for n in (16, 32, 64, 128)),
                   lambda r, _: residuals(r) + [abs(complex(*r["modulus"]) - exact)])

    def without_symmetry(n):
        path = make(folder, "m.obj", "genus", "--ratio", "2", "-n", str(n))
        bent(path)
        return path, None

    rows += [r + [""] for r in rows_of(folder, "genus 2 without symmetry", map(without_symmetry, (2, 4, 8, 16, 32)), lambda r, _: residuals(r))]

    def curve(n, grading):
        report = os.path.join(folder, "made.json")
        at = [word for point in BRANCH_POINTS for word in ("--at", point)]
        path = make(folder, "m.json", "hyperelliptic", *at, "-n", str(n), "--grading", str(grading), "--report", report)
        return path, matrix(json.load(open(report))["result"]["period_matrix"])

    for grading in (1, 2, 3):
        off = lambda r, exact: residuals(r) + [spectral(matrix(r["period_matrix"]), exact)]
        rows += rows_of(folder, f"hyperelliptic, grading {grading}", (curve(n, grading) for n in (8, 16, 32, 64)), off)
    curve_of_bolza = [[complex(-2, 2 * math.sqrt(2)) / 3, complex(-1, math.sqrt(2)) / 3],
                      [complex(-1, math.sqrt(2)) / 3, complex(-2, 2 * math.sqrt(2)) / 3]]
    off = lambda r, exact: residuals(r) + [spectral(matrix(r["period_matrix"]), exact)]
    rows += rows_of(folder, "Bolza", ((make(folder, "m.json", "bolza", "--level", str(n)), curve_of_bolza) for n in (2, 3, 4, 5, 6)), off)
    return table(["surface", "V", "‖J²+1‖", "‖Π−Πᵀ‖/‖Π‖", "modulus or energies off by"], rows)


def star_of_bolza(folder):
    """By how much the two eigenvalues of the discrete star of the Bolza surface exceed 1, from the forms in the file."""
    import numpy as np
    rows = []
    for level in range(1, 7):
        out = os.path.join(folder, "F.json")
        report, _ = run(folder, "forms", make(folder, "m.json", "bolza", "--level", str(level)), "--forms", out)
        file = json.load(open(out))
        weights = np.zeros(len(file["edges"]))
        for lengths, edges in zip(file["lengths"], file["face_edges"]):
            a = 2 * np.sinh(np.array(lengths) / 2)
            for k in range(3):
                cos = (a[k - 1] ** 2 + a[k - 2] ** 2 - a[k] ** 2) / (2 * a[k - 1] * a[k - 2])
                weights[abs(edges[k]) - 1] += 0.5 * cos / math.sqrt(1 - cos * cos)
        omega = np.array(file["harmonic"])
        star = omega @ (weights[:, None] * omega.T) @ np.kron(np.eye(2), [[0, 1], [-1, 0]])
        first, second = sorted(x.imag - 1 for x in np.linalg.eigvals(star) if x.imag > 0)
        flips, asymmetry = report["result"]["flips"], report["result"]["riemann_symmetry"]
        tiny = lambda x: "0" if abs(x) < 1e-12 else small(x)
        rows.append([str(report["input"]["vertices"]), str(flips), f"{first:.4e}", f"{second:.4e}", tiny(second - first), tiny(asymmetry)])
    return table(["V", "flips", "first", "second", "difference", "‖Π−Πᵀ‖/‖Π‖"], rows)


def subdivided(path, out):
    """Write an OBJ file's surface with every triangle cut into four at the midpoints of its sides."""
    points, faces = [], []
    for word in (line.split() for line in open(path)):
        if word and word[0] == "v":
            points.append([float(x) for x in word[1:4]])
        elif word and word[0] == "f":
            faces.append([int(x.split("/")[0]) - 1 for x in word[1:4]])
    middle = {}

    def between(a, b):
        key = (min(a, b), max(a, b))
        if key not in middle:
            middle[key] = len(points)
            points.append([0.5 * (x + y) for x, y in zip(points[a], points[b])])
        return middle[key]

    with open(out, "w") as file:
        parts = []
        for a, b, c in faces:
            p, q, r = between(a, b), between(b, c), between(c, a)
            parts += [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
        file.writelines("v {!r} {!r} {!r}\n".format(*p) for p in points)
        file.writelines("f {} {} {}\n".format(*(v + 1 for v in f)) for f in parts)
    return out


def apart(tau, other):
    """Distance of two reduced moduli, also across the sides of the fundamental domain."""
    same = [other, other + 1, other - 1, -1 / other, -1 / other + 1, -1 / other - 1]
    return min(abs(tau - z) for z in same)


def moduli(folder):
    """The modulus of every torus from the flow and from its form, on the mesh and with its edges halved once and twice."""
    rows, bad = [], []
    for mesh in meshes(lambda m: int(m["boundary_loops"]) == 0 and int(m["genus"]) == 1):
        path, before, cells = file_of(mesh), None, []
        for level in range(HALVED + 1 + (int(mesh["V"]) <= SMALL)):
            if level:
                path = subdivided(path, os.path.join(folder, f"level{level}.obj"))
            (form, why), (flow, also) = run(folder, "forms", path), run(folder, "uniformize", path)
            if form is None or flow is None:
                bad.append(f"{mesh['name']}, level {level}: {why} {also}")
                break
            taus = [complex(*r["result"]["modulus"]) for r in (form, flow)]
            now = [apart(*taus)]
            cells += [f"{t.real:.6f} + {t.imag:.6f} i" for t in taus] if level == 0 else []
            cells += fallen(now, before)
            if level > 1 and now[0] >= before[0]:
                bad.append(f"{mesh['name']}, level {level}: the difference of moduli grows")
            before = now
        rows.append([mesh["name"], mesh["V"], *cells] + [""] * (6 - len(cells)))
    return table(["mesh", "V", "τ by its form", "τ by the flow", "difference", "edges halved", "twice", "three times"], rows), bad


def main():
    with tempfile.TemporaryDirectory() as folder:
        text, bad = corpus_table(folder)
        tori, more = moduli(folder)
        rest = None if named else (rates(folder), star_of_bolza(folder) if CHECK else None)
    print("# Harmonic and holomorphic 1-forms\n")
    print("Every closed mesh of the corpus of genus 1 and more, made by `docs/results/forms.py`: `ricci forms MESH` with default options, on the")
    print("intrinsic Delaunay triangulation. Times are those of one run on a shared machine and say little.\n")
    print(verdict(bad + more) + "\n")
    print("*d\\*ω*: largest of any form at any vertex, over the form's largest value; dω is 0 without rounding. *zeros*: of each holomorphic form of the")
    print("basis, with multiplicity: 2g − 2. *largest index* of a real form of the basis at a vertex or a face: never positive where")
    print("values are above the form's rounding, which they are not far out on horns. *outside*: check.py on")
    print("the file, where that is not too large for it.\n")
    print(text)
    print("\n## The modulus of a torus, twice\n")
    print("By `ricci forms` and by `ricci uniformize`; then on the same polyhedron with every triangle cut into four, once and more often. Each")
    print("difference with the factor by which it has fallen: 4 for rate 2; where angles at the polyhedron's own vertices are above 2π the forms are")
    print("not smooth, which leaves a lower rate. On pinion, a gear with sharp teeth and few vertices, the first difference is small by chance.\n")
    print(tori)
    if rest is None:
        return
    print("\n## Rates\n\nEach error with the factor by which it has fallen since the row before, where the edges are halved.\n")
    print("*genus 2 without symmetry*: `ricci make genus --ratio 2`, moved by a smooth map of space. *hyperelliptic*: a curve over six branch points without")
    print("symmetry; at distance r from one, edges are r^(1 − 1/grading) times as long as elsewhere. Against forms that grow as r^(−1/2) linear")
    print("elements have rate 1 without grading, rate 2 but for a logarithm with grading 2 (the chart √z evenly meshed), rate 2 beyond: there the factor comes")
    print("up to 4 from below. The vertices of the sphere below that are nearest to the branch points are moved onto them, on every mesh by other amounts: hence")
    print("the unsteady asymmetry without grading. *energies*: the 16 least |m + Πn|² of integer classes, which no change of the basis changes, against those of")
    print("the curve's own period matrix.\n")
    print(rest[0])
    if rest[1] is None:
        return
    print("\n## Why the Bolza surface's matrix is nearly symmetric\n")
    print("Its mesh is kept by the rotation of order 8, and so is the discrete star J: on the two planes that the rotation has in the cohomology it has")
    print("eigenvalues ±i(1 + first) and ±i(1 + second), computed here from the forms in the file. Π = Πᵀ where both are the same; so its asymmetry")
    print("measures their difference alone, at most 2 % of the errors, which fall by 4. On the subdivided mesh without a flip the asymmetry is larger and")
    print("falls steadily: 1.5e-2, 2.8e-3, 6.7e-4, 1.7e-4, 4.2e-5, 1.0e-5 (÷5.3, 4.1, 4.0, 4.0, 4.0; `tests/harmonic/known.rs` has three of these). The flips to the Delaunay")
    print("triangulation take most of the difference away, all of it on the coarsest mesh, and not the same share on every level: hence no steady rate")
    print("there. On the surface without symmetry, above, the asymmetry falls by 4.\n")
    print(rest[1])


main()
