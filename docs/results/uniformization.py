#!/usr/bin/env python3
"""Uniformize every closed mesh of the corpus and generated surfaces at four resolutions, and write the tables.

usage: docs/results/uniformization.py [CORPUS [NAME…]] > docs/results/uniformization.md     (after: cargo build --release -p ricci-apps)
"""
import json
import math
import os

from page import CHECK, WHY, complex_text, file_of, genus, judge, judged, loops, main, meshes, rate, read_obj, seconds, small, table, verdict

GENERA = {2: [2, 4, 8, 16], 3: [2, 4, 8, 16], 4: [2, 4, 8, 16], 5: [2, 4, 8, 16]}
GEODESICS = 2

closed = meshes(lambda m: loops(m) == 0)


def sphere(run, mesh):
    path, (out,) = file_of(mesh), run.fresh("sphere.obj")
    report = run.report(mesh["name"], "uniformize", path, "--sphere", out)
    if report is None:
        return None
    r, seen = report["result"], judged("sphere", out, path)
    return [
        mesh["name"], mesh["V"], r["iterations"], r["flips"], small(r["max_curvature_error"]), f"{r['u_range']:.1f}",
        small(r["delaunay_violation"]), small(r["link_turning"]), small(r["nonconvexity"]), small(r["centring"]), small(r["smallest_edge"]),
        "–" if seen is None else f"{small(seen['worst_nonconvexity'])}, {small(seen['centre_of_mass'])}", seconds(report),
    ]


def quotient(run, mesh):
    path, (uv, deck, metric), is_flat = file_of(mesh), run.fresh("uv.obj", "deck.json", "metric.json"), genus(mesh) == 1
    report = run.report(mesh["name"], "uniformize", path, "--uv", uv, "--generators", deck, "--metric", metric)
    if report is None:
        return None
    r, checks, seen = report["result"], report["checks"], "–"
    if CHECK is not None:
        k, relation = judged("metric", metric)["max_curvature_error"], judged("deck", deck)["relative"]
        seen = f"{small(k)}, {small(relation)}, {judged('uv', uv, path, *([] if is_flat else ['h2']))['flipped']}"
    of_space = [complex_text(r["modulus"], 6), small(checks["turning"]["value"])] if is_flat else [
        small(checks["area"]["value"]), f"{min(r['translation_lengths']):.2f}–{max(r['translation_lengths']):.2f}"]
    return [
        mesh["name"], mesh["V"], *([] if is_flat else [mesh["genus"]]), r["iterations"], r["flips"], small(r["max_curvature_error"]),
        small(r["angle_defect"]), *of_space, small(r["relation_residual"]), small(r["disagreement"]), f"{r['radius']:.1f}", r["domain"]["sides"],
        f"{r['qc_mean']:.3f}", seen, seconds(report),
    ]


SPHERES = ["mesh", "V", "steps", "flips", "max \\|K\\|", "range of u", "Delaunay violation", "least turning", "nonconvexity", "centring",
           "shortest edge", "outside: nonconvexity, centre", "s"]
QUOTIENT = ["relation", "disagreement", "radius", "Dirichlet sides", "mean dilatation", "outside: \\|K\\|, relative relation, flipped", "s"]
FLAT = ["mesh", "V", "steps", "flips", "max \\|K\\|", "the same, double-double", "modulus", "rotation"] + QUOTIENT
HYPERBOLIC = ["mesh", "V", "genus", "steps", "flips", "max \\|K\\|", "the same, double-double", "area off", "translation lengths"] + QUOTIENT


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


def family(run, number, layers):
    """Shortest geodesics of the same smooth surface on ever finer meshes, with its numbers of vertices."""
    vertices, values = [], []
    for n in layers:
        mesh, deck = run.make("made.obj", "genus", "--genus", str(number), "-n", str(n)), run.path("deck.json")
        report = run.needed(f"genus {number}, {n} layers", "uniformize", mesh, "--generators", deck)
        simple = []
        for x in lengths_of(deck, 3):
            # Neither another one's length nor a geodesic run through several times.
            if all(abs(x / y - round(x / y)) > 1e-3 for y in simple):
                simple.append(x)
        values.append(simple[:GEODESICS])
        vertices.append(report["input"]["vertices"])
    return vertices, values


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


def spheroid(run, n, a=1.0, c=1.6):
    """The number of vertices of a spheroid, and the largest error of the distances between some of them on the unit sphere."""
    mesh, out = run.make("made.obj", "ellipsoid", "--axes", str(a), str(a), str(c), "-n", str(n)), run.path("sphere.obj")
    run.needed(f"spheroid {n}", "uniformize", mesh, "--sphere", out)
    given, found = read_obj(mesh)[0], read_obj(out)[0]

    def exact(p):
        z = conformal_height(math.asin(max(-1.0, min(1.0, p[2] / c))), a, c) if abs(p[2]) < c else math.copysign(1, p[2])
        r, s = math.hypot(p[0], p[1]), math.sqrt(max(0.0, 1 - z * z))
        return [p[0] / r * s, p[1] / r * s, z] if r > 0 else [0.0, 0.0, z]

    some = range(0, len(given), max(1, len(given) // 60))
    wanted = {i: exact(given[i]) for i in some}
    return len(given), max(abs(math.dist(wanted[i], wanted[j]) - math.dist(found[i], found[j])) for i in some for j in some)


def convergence(run):
    rows, errors = [], []
    for n in (4, 8, 16, 32):
        vertices, worst = spheroid(run, n)
        errors.append(worst)
        rows.append([0, n, vertices, "distances on the sphere", small(worst), rate(errors)])
    exact = 1.2 / math.sqrt(2.0**2 - 1.2**2)
    exact = max(exact, 1 / exact)
    errors = []
    for n in (16, 32, 64, 128):
        mesh = run.make("made.obj", "torus", "--big", "2", "--small", "1.2", "-n", str(n), "-m", str(n))
        report = run.needed(f"torus {n}", "uniformize", mesh)
        tau = report["result"]["modulus"]
        errors.append(math.hypot(tau[0], tau[1] - exact))
        shown = f"Im τ = {tau[1]:.8f} (exact {exact:.8f})"
        rows.append([1, n, report["input"]["vertices"], shown, small(errors[-1]), rate(errors)])
    for number, layers in GENERA.items():
        vertices, values = family(run, number, layers)
        for i, (n, v) in enumerate(zip(layers, values)):
            change = "" if i == 0 else small(max(abs(a - b) for a, b in zip(v, values[i - 1])))
            fall = "" if i < 2 else ", ".join(f"{rates([w[k] for w in values[:i + 1]])[-1]:.2f}" for k in range(GEODESICS))
            rows.append([number, n, vertices[i], ", ".join(f"{x:.6f}" for x in v), change, fall])
    return table(["genus", "resolution", "V", "modulus / shortest geodesics", "error / change", "rate"], rows)


def content(run):
    ball = run.rows((m for m in closed if genus(m) == 0), sphere)
    flat = run.rows((m for m in closed if genus(m) == 1), quotient)
    hyperbolic = run.rows((m for m in closed if genus(m) > 1), quotient)
    return [
        "# Uniformization",
        f"Every closed mesh of the corpus ({len(closed)}), made by `docs/results/uniformization.py`: `ricci uniformize MESH` with default options. "
        "Times are those of one run on a shared machine and say little.",
        verdict(run.bad),
        f"*outside*: what an independent program finds in the files ({os.path.basename(judge)})." if WHY is None else f"No outside program: {WHY}.",
        "## Genus 0: the unit sphere",
        "*Delaunay violation* (radians) and *least turning* are those of the plane, *nonconvexity* the largest signed distance of a vertex over the "
        "plane of a neighbouring face (negative: strictly convex), *centring* |Σ w x|/Σ w. Where the range of u comes near 30 positions have no more "
        "digits to tell.",
        table(SPHERES, ball),
        "## Genus 1: flat tori",
        "*the same, double-double*: |K| by products of rotations in double-double precision. *rotation*: the largest of a generator, radians. "
        "*disagreement*: largest distance between the two images of a vertex along the cut, brought together by the side pairings.",
        table(FLAT, flat),
        "## Genus 2 and more: hyperbolic surfaces",
        "*area off*: |area − 4π(g − 1)|, area without angle sums. *relation*: ‖R − I‖/max‖P‖² in double-double precision; a Dirichlet domain has at "
        "most 12g − 6 sides.",
        table(HYPERBOLIC, hyperbolic),
        "## The same surface on finer meshes",
        "A spheroid (1 : 1 : 1.6), whose conformal map is an integral; a torus of revolution (R = 2, r = 1.2), whose modulus is known; smooth surfaces of `ricci make genus`: lengths of the shortest closed geodesics of "
        "the hyperbolic metric (traces of the deck group), by words of up to three letters. *rate*: log₂ of the quotient of successive errors (genus 0 and 1) or "
        "changes.",
        convergence(run),
    ]


main(content)
