#!/usr/bin/env python3
"""Uniformize every closed mesh of the corpus and generated surfaces at four resolutions, and write the tables.

usage: docs/results/uniformization.py [CORPUS [NAME…]] > docs/results/uniformization.md     (after: cargo build --release -p ricci-apps)

RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository);
where it or numpy is absent, the page says so.
"""
import json
import math
import os
import tempfile

from page import CHECK, WHY, failures, file_of, judge, judged, make, meshes, run, small, table, verdict

GENERA = {2: [2, 4, 8, 16], 3: [2, 4, 8, 16], 4: [2, 4, 8, 16], 5: [2, 4, 8, 16]}
GEODESICS = 2

closed = meshes(lambda m: int(m["boundary_loops"]) == 0)


def seconds(report):
    return f"{report['seconds']['total']:.2f}"


def spheres(folder):
    rows, bad = [], []
    for mesh in (m for m in closed if int(m["genus"]) == 0):
        path, out = file_of(mesh), os.path.join(folder, "sphere.obj")
        report, why = run(folder, "uniformize", path, "--sphere", out)
        if report is None:
            bad.append(f"{mesh['name']}: {why}")
            continue
        r = report["result"]
        seen = judged("sphere", out, path)
        bad += failures(mesh["name"], report)
        rows.append([
            mesh["name"], mesh["V"], str(r["iterations"]), str(r["flips"]), small(r["max_curvature_error"]), f"{r['u_range']:.1f}",
            small(r["delaunay_violation"]), small(r["link_turning"]), small(r["nonconvexity"]), small(r["centring"]), small(r["smallest_edge"]),
            "–" if seen is None else f"{small(seen['worst_nonconvexity'])}, {small(seen['centre_of_mass'])}", seconds(report),
        ])
    head = ["mesh", "V", "steps", "flips", "max \\|K\\|", "range of u", "Delaunay violation", "least turning", "nonconvexity", "centring",
            "shortest edge", "outside: nonconvexity, centre", "s"]
    return table(head, rows), bad


def quotients(folder, genus_one):
    rows, bad = [], []
    for mesh in (m for m in closed if (int(m["genus"]) == 1) == genus_one and int(m["genus"]) > 0):
        path = file_of(mesh)
        uv, deck, metric = (os.path.join(folder, name) for name in ("uv.obj", "deck.json", "metric.json"))
        report, why = run(folder, "uniformize", path, "--uv", uv, "--generators", deck, "--metric", metric)
        if report is None:
            bad.append(f"{mesh['name']}: {why}")
            continue
        r, checks = report["result"], report["checks"]
        bad += failures(mesh["name"], report)
        verdicts = "–"
        if CHECK is not None:
            k = judged("metric", metric)["max_curvature_error"]
            relation = judged("deck", deck)["relative"]
            flips = judged("uv", uv, path) if genus_one else judged("uv", uv, path, "h2")
            verdicts = f"{small(k)}, {small(relation)}, {flips['flipped']}"
        row = [mesh["name"], mesh["V"]]
        row += [] if genus_one else [mesh["genus"]]
        row += [str(r["iterations"]), str(r["flips"]), small(r["max_curvature_error"]), small(r["angle_defect"])]
        if genus_one:
            row += ["{:.6f} + {:.6f} i".format(*r["modulus"]), small(checks["turning"]["value"])]
        else:
            row += [small(checks["area"]["value"]), f"{min(r['translation_lengths']):.2f}–{max(r['translation_lengths']):.2f}"]
        row += [small(r["relation_residual"]), small(r["disagreement"]), f"{r['radius']:.1f}", str(r["domain"]["sides"]), f"{r['qc_mean']:.3f}",
                verdicts, seconds(report)]
        rows.append(row)
    head = ["mesh", "V"] + ([] if genus_one else ["genus"]) + ["steps", "flips", "max \\|K\\|", "the same, double-double"]
    head += ["modulus", "rotation"] if genus_one else ["area off", "translation lengths"]
    head += ["relation", "disagreement", "radius", "Dirichlet sides", "mean dilatation", "outside: \\|K\\|, relative relation, flipped", "s"]
    return table(head, rows), bad


def lengths_of(deck, depth):
    """The shortest closed geodesics that words of some letters have, as lengths; each once."""
    import numpy as np
    group = json.load(open(deck))
    letters = []
    for matrix in group["generators"].values():
        g = np.array([[complex(*z) for z in row] for row in matrix])
        letters += [g, np.linalg.inv(g)]
    level, half = [np.eye(2)], set()
    for _ in range(depth):
        level = [a @ g for a in level for g in letters]
        half.update(round(abs((a[0, 0] + a[1, 1]).real) / 2, 9) for a in level)
    return sorted(2 * math.acosh(h) for h in half if h > 1 + 1e-6)


def family(folder, genus, layers):
    """Shortest geodesics of the same smooth surface on ever finer meshes."""
    rows, values = [], []
    for n in layers:
        mesh, deck = make(folder, "made.obj", "genus", "--genus", str(genus), "-n", str(n)), os.path.join(folder, "deck.json")
        report, why = run(folder, "uniformize", mesh, "--generators", deck)
        if report is None:
            raise SystemExit(f"genus {genus}, {n} layers: {why}")
        shortest = lengths_of(deck, 3)
        simple = []
        for x in shortest:
            # Neither another one's length nor a geodesic run through several times.
            if all(abs(x / y - round(x / y)) > 1e-3 for y in simple):
                simple.append(x)
        values.append(simple[:GEODESICS])
        rows.append([n, report["input"]["vertices"], report["result"]["relation_residual"]])
    return rows, values


def rates(series):
    """log₂ of the quotients of successive differences, for steps that halve."""
    steps = [abs(b - a) for a, b in zip(series, series[1:])]
    return [math.log2(a / b) if b > 0 else math.inf for a, b in zip(steps, steps[1:])]


def conformal_height(t, a, c):
    """Height on the unit sphere of the point (a cos t, 0, c sin t) of a spheroid under the conformal map that keeps parallels and the equator:
    tanh of ψ = ∫ √(a² sin² + c² cos²)/(a cos) dt, by Simpson's rule."""
    n = 400
    f = lambda x: math.hypot(a * math.sin(x), c * math.cos(x)) / (a * math.cos(x))
    h = t / n
    total = f(0) + f(t) + sum((4 if k % 2 else 2) * f(k * h) for k in range(1, n))
    return math.tanh(total * h / 3)


def spheroid(folder, n, a=1.0, c=1.6):
    """Largest error of the distances between vertices of a spheroid on the unit sphere, over some pairs."""
    mesh = make(folder, "made.obj", "ellipsoid", "--axes", str(a), str(a), str(c), "-n", str(n))
    out = os.path.join(folder, "sphere.obj")
    report, why = run(folder, "uniformize", mesh, "--sphere", out)
    if report is None:
        raise SystemExit(f"spheroid {n}: {why}")
    read = lambda path: [[float(x) for x in line.split()[1:4]] for line in open(path) if line.startswith("v ")]
    given, found = read(mesh), read(out)

    def exact(p):
        z = conformal_height(math.asin(max(-1.0, min(1.0, p[2] / c))), a, c) if abs(p[2]) < c else math.copysign(1, p[2])
        r, s = math.hypot(p[0], p[1]), math.sqrt(max(0.0, 1 - z * z))
        return [p[0] / r * s, p[1] / r * s, z] if r > 0 else [0.0, 0.0, z]

    some = range(0, len(given), max(1, len(given) // 60))
    wanted = {i: exact(given[i]) for i in some}
    worst = max(abs(math.dist(wanted[i], wanted[j]) - math.dist(found[i], found[j])) for i in some for j in some)
    return report["input"]["vertices"], worst


def convergence(folder):
    rows, errors = [], []
    for n in (4, 8, 16, 32):
        vertices, worst = spheroid(folder, n)
        errors.append(worst)
        rate = "" if len(errors) < 2 else f"{math.log2(errors[-2] / errors[-1]):.2f}"
        rows.append(["0", str(n), str(vertices), "distances on the sphere", small(worst), rate])
    exact = 1.2 / math.sqrt(2.0**2 - 1.2**2)
    exact = max(exact, 1 / exact)
    errors = []
    for n in (16, 32, 64, 128):
        mesh = make(folder, "made.obj", "torus", "--big", "2", "--small", "1.2", "-n", str(n), "-m", str(n))
        report, why = run(folder, "uniformize", mesh)
        if report is None:
            raise SystemExit(f"torus {n}: {why}")
        tau = report["result"]["modulus"]
        errors.append(math.hypot(tau[0], tau[1] - exact))
        rate = "" if len(errors) < 2 else f"{math.log2(errors[-2] / errors[-1]):.2f}"
        rows.append(["1", str(n), str(report["input"]["vertices"]), f"Im τ = {tau[1]:.8f} (exact {exact:.8f})", small(errors[-1]), rate])
    for genus, layers in GENERA.items():
        runs, values = family(folder, genus, layers)
        for (n, vertices, _), v, i in zip(runs, values, range(len(runs))):
            change = "" if i == 0 else small(max(abs(a - b) for a, b in zip(v, values[i - 1])))
            rate = ""
            if i >= 2:
                rate = ", ".join(f"{rates([w[k] for w in values[:i + 1]])[-1]:.2f}" for k in range(GEODESICS))
            rows.append([str(genus), str(n), str(vertices), ", ".join(f"{x:.6f}" for x in v), change, rate])
    return table(["genus", "resolution", "V", "modulus / shortest geodesics", "error / change", "rate"], rows)


def main():
    with tempfile.TemporaryDirectory() as folder:
        ball, bad = spheres(folder)
        flat, more = quotients(folder, True)
        hyperbolic, most = quotients(folder, False)
        bad += more + most
        refined = convergence(folder)
    print("# Uniformization")
    print()
    print(f"Every closed mesh of the corpus ({len(closed)}), made by `docs/results/uniformization.py`: `ricci uniformize MESH` with default options. "
          "Times are those of one run on a shared machine and say little.")
    print()
    print(verdict(bad))
    print()
    print(f"*outside*: what an independent program finds in the files ({os.path.basename(judge)})." if WHY is None else f"No outside program: {WHY}.")
    print()
    print("## Genus 0: the unit sphere\n")
    print("*Delaunay violation* (radians) and *least turning* are those of the plane, *nonconvexity* the largest signed distance of a vertex over the "
          "plane of a neighbouring face (negative: strictly convex), *centring* |Σ w x|/Σ w. Where the range of u comes near 30 positions have no more "
          "digits to tell.\n")
    print(ball)
    print("\n## Genus 1: flat tori\n")
    print("*the same, double-double*: |K| by products of rotations in double-double precision. *rotation*: the largest of a generator, radians. "
          "*disagreement*: largest distance between the two images of a vertex along the cut, brought together by the side pairings.\n")
    print(flat)
    print("\n## Genus 2 and more: hyperbolic surfaces\n")
    print("*area off*: |area − 4π(g − 1)|, area without angle sums. *relation*: ‖R − I‖/max‖P‖² in double-double precision; a Dirichlet domain has at "
          "most 12g − 6 sides.\n")
    print(hyperbolic)
    print("\n## The same surface on finer meshes\n")
    print("A spheroid (1 : 1 : 1.6), whose conformal map is an integral; a torus of revolution (R = 2, r = 1.2), whose modulus is known; smooth surfaces of `ricci make genus`: lengths of the shortest closed geodesics of "
          "the hyperbolic metric (traces of the deck group), by words of up to three letters. *rate*: log₂ of the quotient of successive errors (genus 0 and 1) or "
          "changes.\n")
    print(refined)


main()
