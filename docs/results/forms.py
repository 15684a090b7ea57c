#!/usr/bin/env python3
"""Harmonic and holomorphic 1-forms of every closed mesh of genus 1 and more, and of known surfaces on finer meshes, as tables.

usage: docs/results/forms.py [CORPUS [NAME…]] > docs/results/forms.md     (after: cargo build --release -p ricci-apps)
"""
import json
import math

from page import (CHECK, complex_text, divided, fallen, file_of, genus, judged, loops, main, meshes, named, read_obj, seconds, small, table, verdict,
                  write_obj)

# Values in a file above which the outside program, which holds them all at 16 bytes each, is not asked.
JUDGED = 12_000_000
# Times that the edges of a mesh are halved to compare moduli, and vertices up to which they are halved once more.
HALVED, SMALL = 2, 2_000
BRANCH_POINTS = ["-1.6,0.1", "-0.7,-0.3", "-0.1,0.6", "0.5,-0.5", "1.1,0.4", "1.5,-0.2"]


HEAD = ["mesh", "V", "genus", "flips", "d*ω", "least eigenvalue", "‖Π−Πᵀ‖/‖Π‖", "‖J²+1‖", "zeros", "largest index", "modulus",
        "outside: rank, dω, d*ω", "loops, matrix s", "factor s", "solves s", "all s"]


def corpus_row(run, mesh):
    path, out = file_of(mesh), run.path("F.json")
    is_judged = 2 * genus(mesh) * int(mesh["E"]) <= JUDGED
    report = run.report(mesh["name"], "forms", path, *(["--forms", out] if is_judged else []))
    if report is None:
        return None
    r, s, seen = report["result"], report["seconds"], "–"
    if is_judged and CHECK:
        said = judged("forms", out)
        holds = said["rank"] == 2 * said["genus"] and not said["faces_of_positive_index"] and said["coclosedness"] <= 1e-10
        run.insist(holds, f"{mesh['name']}, outside: {said}")
        seen = f"{said['rank']}, {small(said['closedness'])}, {small(said['coclosedness'])}"
    zeros = {sum(z["multiplicity"] for z in of) for of in r["zeros"]}
    return [
        mesh["name"], mesh["V"], mesh["genus"], r["flips"], small(r["coclosedness"]), small(r["riemann_min_eigenvalue"]),
        small(r["riemann_symmetry"]), small(r["star_residual"]), ", ".join(map(str, zeros)), r["largest_index"],
        complex_text(r["modulus"], 5) if "modulus" in r else "", seen,
        f"{s['build'] + s['assemble'] + s['analyse']:.2f}", f"{s['factor']:.2f}", f"{s['solve']:.2f}", seconds(report),
    ]


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
    move = lambda x, y, z: (x + 0.4 * math.sin(y + 0.7 * z + 0.3), y + 0.3 * math.sin(0.8 * x - 0.2) * z, z + 0.25 * math.sin(x + 1.3 * y))
    places, faces = read_obj(path)
    return write_obj(path, [move(*p) for p in places], faces)


def rates(run):
    residuals = lambda r: [r["star_residual"], r["riemann_symmetry"]]
    off = lambda r, exact: residuals(r) + [spectral(matrix(r["period_matrix"]), exact)]
    exact = 1j * math.sqrt(2 * 2 - 0.8 * 0.8) / 0.8
    made = lambda n: run.make("m.obj", "torus", "--big", "2", "--small", "0.8", "-n", str(2 * n), "-m", str(n))
    rows = run.refined("torus of revolution", ((made(n), None) for n in (16, 32, 64, 128)),
                       lambda r, _: residuals(r) + [abs(complex(*r["modulus"]) - exact)], "forms")
    crooked = ((bent(run.make("m.obj", "genus", "--ratio", "2", "-n", str(n))), None) for n in (2, 4, 8, 16, 32))
    rows += [r + [""] for r in run.refined("genus 2 without symmetry", crooked, lambda r, _: residuals(r), "forms")]

    def curve(n, grading):
        report = run.path("made.json")
        at = [word for point in BRANCH_POINTS for word in ("--at", point)]
        path = run.make("m.json", "hyperelliptic", *at, "-n", str(n), "--grading", str(grading), "--report", report)
        return path, matrix(json.load(open(report))["result"]["period_matrix"])

    for grading in (1, 2, 3):
        rows += run.refined(f"hyperelliptic, grading {grading}", (curve(n, grading) for n in (8, 16, 32, 64)), off, "forms")
    curve_of_bolza = [[complex(-2, 2 * math.sqrt(2)) / 3, complex(-1, math.sqrt(2)) / 3],
                      [complex(-1, math.sqrt(2)) / 3, complex(-2, 2 * math.sqrt(2)) / 3]]
    bolza = ((run.make("m.json", "bolza", "--level", str(n)), curve_of_bolza) for n in (2, 3, 4, 5, 6))
    rows += run.refined("Bolza", bolza, off, "forms")
    return table(["surface", "V", "‖J²+1‖", "‖Π−Πᵀ‖/‖Π‖", "modulus or energies off by"], rows)


def star_of_bolza(run):
    """By how much the two eigenvalues of the discrete star of the Bolza surface exceed 1, from the forms in the file."""
    import numpy as np
    rows = []
    for level in range(1, 7):
        out = run.path("F.json")
        report = run.needed("Bolza", "forms", run.make("m.json", "bolza", "--level", str(level)), "--forms", out)
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
        rows.append([report["input"]["vertices"], flips, f"{first:.4e}", f"{second:.4e}", tiny(second - first), tiny(asymmetry)])
    return table(["V", "flips", "first", "second", "difference", "‖Π−Πᵀ‖/‖Π‖"], rows)


def apart(tau, other):
    """Distance of two reduced moduli, also across the sides of the fundamental domain."""
    same = [other, other + 1, other - 1, -1 / other, -1 / other + 1, -1 / other - 1]
    return min(abs(tau - z) for z in same)


def modulus_row(run, mesh):
    """The modulus of a torus from its form and from the flow, on the mesh and with its edges halved once and more often."""
    path, before, cells = file_of(mesh), None, []
    for level in range(HALVED + 1 + (int(mesh["V"]) <= SMALL)):
        if level:
            path = divided(path, run.path(f"level{level}.obj"))
        (form, why), (flow, also) = run.try_report("forms", path), run.try_report("uniformize", path)
        if form is None or flow is None:
            run.bad.append(f"{mesh['name']}, level {level}: {why} {also}")
            break
        taus = [r["result"]["modulus"] for r in (form, flow)]
        now = [apart(*(complex(*tau) for tau in taus))]
        cells += [complex_text(tau, 6) for tau in taus] if level == 0 else []
        cells += fallen(now, before)
        run.insist(level <= 1 or now[0] < before[0], f"{mesh['name']}, level {level}: the difference of moduli grows")
        before = now
    return [mesh["name"], mesh["V"], *cells] + [""] * (6 - len(cells))


def content(run):
    rows = run.rows(meshes(lambda m: loops(m) == 0 and genus(m) > 0), corpus_row)
    tori = run.rows(meshes(lambda m: loops(m) == 0 and genus(m) == 1), modulus_row)
    page = [
        "# Harmonic and holomorphic 1-forms",
        """Every closed mesh of the corpus of genus 1 and more, made by `docs/results/forms.py`: `ricci forms MESH` with default options, on the
intrinsic Delaunay triangulation. Times are those of one run on a shared machine and say little.""",
        verdict(run.bad),
        """*d\\*ω*: largest of any form at any vertex, over the form's largest value; dω is 0 without rounding. *zeros*: of each holomorphic form of the
basis, with multiplicity: 2g − 2. *largest index* of a real form of the basis at a vertex or a face: never positive where
values are above the form's rounding, which they are not far out on horns. *outside*: check.py on
the file, where that is not too large for it.""",
        table(HEAD, rows),
        "## The modulus of a torus, twice",
        """By `ricci forms` and by `ricci uniformize`; then on the same polyhedron with every triangle cut into four, once and more often. Each
difference with the factor by which it has fallen: 4 for rate 2; where angles at the polyhedron's own vertices are above 2π the forms are
not smooth, which leaves a lower rate. On pinion, a gear with sharp teeth and few vertices, the first difference is small by chance.""",
        table(["mesh", "V", "τ by its form", "τ by the flow", "difference", "edges halved", "twice", "three times"], tori),
    ]
    if named:
        return page
    page += [
        "## Rates",
        "Each error with the factor by which it has fallen since the row before, where the edges are halved.",
        """*genus 2 without symmetry*: `ricci make genus --ratio 2`, moved by a smooth map of space. *hyperelliptic*: a curve over six branch points without
symmetry; at distance r from one, edges are r^(1 − 1/grading) times as long as elsewhere. Against forms that grow as r^(−1/2) linear
elements have rate 1 without grading, rate 2 but for a logarithm with grading 2 (the chart √z evenly meshed), rate 2 beyond: there the factor comes
up to 4 from below. The vertices of the sphere below that are nearest to the branch points are moved onto them, on every mesh by other amounts: hence
the unsteady asymmetry without grading. *energies*: the 16 least |m + Πn|² of integer classes, which no change of the basis changes, against those of
the curve's own period matrix.""",
        rates(run),
    ]
    if CHECK is None:
        return page
    return page + [
        "## Why the Bolza surface's matrix is nearly symmetric",
        """Its mesh is kept by the rotation of order 8, and so is the discrete star J: on the two planes that the rotation has in the cohomology it has
eigenvalues ±i(1 + first) and ±i(1 + second), computed here from the forms in the file. Π = Πᵀ where both are the same; so its asymmetry
measures their difference alone, at most 2 % of the errors, which fall by 4. On the subdivided mesh without a flip the asymmetry is larger and
falls steadily: 1.5e-2, 2.8e-3, 6.7e-4, 1.7e-4, 4.2e-5, 1.0e-5 (÷5.3, 4.1, 4.0, 4.0, 4.0; `tests/library/harmonic/known.rs` has three of these). The flips to the Delaunay
triangulation take most of the difference away, all of it on the coarsest mesh, and not the same share on every level: hence no steady rate
there. On the surface without symmetry, above, the asymmetry falls by 4.""",
        star_of_bolza(run),
    ]


main(content)
