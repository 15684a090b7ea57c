#!/usr/bin/env python3
"""Recompute from the files of `ricci flow` what they claim, with plain formulas and numpy only.

usage: outside.py RICCI_BINARY CORPUS_FOLDER
"""
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

RICCI, CORPUS = sys.argv[1], sys.argv[2]
PI = np.longdouble("3.14159265358979323846264")
passed = failed = 0


def check(name, holds, detail=""):
    global passed, failed
    passed, failed = passed + bool(holds), failed + (not holds)
    if not holds:
        print(f"FAILED {name}: {detail}")


def angles(lengths, low, space):
    """Angles opposite the lengths, whose doubles lose `low`."""
    r = []
    for k in range(3):
        (a, b, c), (x, y, z) = np.roll(lengths, -k, 1).T, np.roll(low, -k, 1).T
        large, small = np.maximum(b, c), np.minimum(b, c)
        # In this order differences of lengths are exact.
        r.append((np.where(a > large, small - (a - large), large + (small - a)) + (y + z - x)) / 2)
    f = {"e2": lambda x: x, "h2": np.sinh, "s2": np.sin}[space]
    top, r = f(r[0] + r[1] + r[2]), [f(x) for x in r]
    half = lambda k: 2 * np.arctan2(np.sqrt(r[(k + 1) % 3] * r[(k + 2) % 3]), np.sqrt(top * r[k]))
    return np.stack([half(0), half(1), half(2)], 1)


def check_metric(name, path, error):
    metric = json.load(open(path))
    faces, lengths = np.array(metric["faces"]), np.array(metric["lengths"], np.longdouble)
    k = np.where(np.array(metric["boundary"], bool), PI, 2 * PI)
    low = np.array(metric["lengths_lo"], np.longdouble) if "lengths_lo" in metric else np.zeros_like(lengths)
    np.subtract.at(k, faces.ravel(), angles(lengths, low, metric["space"]).ravel())
    worst = float(np.abs(k - np.array(metric["target"])).max())
    check(name + " curvature", worst <= 1e-10, f"{worst} (the report says {error})")
    check(name + " triangles", (angles(lengths, low, metric["space"]) > 0).all(), "broken")
    length = {}
    for face, row in zip(faces, lengths):
        for i in range(3):
            key = tuple(sorted((face[(i + 1) % 3], face[(i + 2) % 3])))
            length.setdefault(key, set()).add(float(row[i]))
    if "face_edges" not in metric:
        check(name + " edges", all(len(v) == 1 for v in length.values()), "two lengths for one edge")


def read_obj(path):
    v, vt, f, ft = [], [], [], []
    for line in open(path):
        word, *rest = line.split() or [""]
        if word == "v":
            v.append([float(x) for x in rest])
        elif word == "vt":
            vt.append([float(x) for x in rest])
        elif word == "f":
            corners = [q.split("/") for q in rest]
            f.append([int(q[0]) - 1 for q in corners])
            ft.append([int(q[1]) - 1 for q in corners] if len(corners[0]) > 1 else None)
    return np.array(v), np.array(vt), np.array(f), ft


def on_edges(points, v0, f0):
    """The largest distance of a point from the nearest of the input's edges, over 300 points at most."""
    points = points[:: 1 + len(points) // 300]
    a, b = v0[f0].reshape(-1, 3), v0[np.roll(f0, -1, 1)].reshape(-1, 3)
    along = b - a
    worst = 0.0
    for p in points:
        t = np.clip(((p - a) * along).sum(1) / (along * along).sum(1), 0, 1)
        worst = max(worst, np.sqrt(((p - a - t[:, None] * along) ** 2).sum(1).min()))
    return worst


def solid_area(v, f):
    return np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1).sum() / 2


def check_uv(name, path, source, metric):
    v, vt, f, ft = read_obj(path)
    v0, _, f0, _ = read_obj(source)
    size = np.abs(v0).max()
    check(name + " positions", np.abs(v[: len(v0)] - v0).max() <= 1e-6 * size, "moved")
    t = vt[np.array(ft)]
    e = [t[:, (k + 2) % 3] - t[:, (k + 1) % 3] for k in range(3)]
    area = (e[2][:, 0] * e[0][:, 1] - e[2][:, 1] * e[0][:, 0]) / 2
    longest = np.max([(x * x).sum(1) for x in e], axis=0)
    if len(v) > len(v0) or f.shape != f0.shape or (f != f0).any():
        # The common refinement: pieces of the input's faces.
        off = on_edges(v[len(v0) :], v0, f0)
        check(name + " crossings", off <= 1e-9 * size, f"{off} off the input's edges")
        check(name + " orientation", (area >= -1e-12 * longest).all(), f"{(area < -1e-12 * longest).sum()} flipped")
        there, before = solid_area(v, f), solid_area(v0, f0)
        check(name + " area", abs(there - before) <= 1e-9 * before, f"{there} of {before}")
        return
    check(name + " orientation", (area > 0).all(), f"{(area <= 0).sum()} flipped")
    # The layout is the metric up to one scale.
    lengths = np.array(json.load(open(metric))["lengths"])
    there = np.stack([np.hypot(*x.T) for x in e], 1)
    scale = there.max() / lengths.max()
    # An edge is a difference of two points in doubles.
    off = np.abs(there - scale * lengths) - 1e-6 * scale * lengths - 4e-16 * np.abs(vt).max()
    check(name + " isometry", (off <= 0).all(), f"{off.max()}")


def run(name, mesh, *options):
    with tempfile.TemporaryDirectory() as out:
        path = lambda file: os.path.join(out, file)
        files = ["--metric", path("m.json"), "--report", path("r.json")]
        plane = "h2" not in options
        if plane:
            files += ["--uv", path("uv.obj")]
        code = subprocess.run([RICCI, "flow", mesh, *options, *files, "--quiet"]).returncode
        report = json.load(open(path("r.json")))
        result, checks = report["result"], report["checks"]
        check(name + " exit", (code == 0) == all(c["holds"] for c in checks.values()), f"exit {code}, {checks}")
        check(name + " truth", result["converged"] or code == 1, f"exit {code}, {result}")
        if code == 0:
            check_metric(name, path("m.json"), result["max_curvature_error"])
            if plane:
                check_uv(name, path("uv.obj"), mesh, path("m.json"))
        return code


with tempfile.TemporaryDirectory() as folder:
    shapes = {
        "torus": [["--scheme", s] for s in ("yamabe", "inversive", "thurston", "tangential")],
        "sphere": [[]],
        "disk": [[], ["--scheme", "thurston"]],
        "annulus": [[]],
        "genus": [["--space", "e2", "--target", "single:0"], ["--space", "h2"]],
    }
    for shape, variants in shapes.items():
        mesh = os.path.join(folder, shape + ".obj")
        check(shape + " make", subprocess.run([RICCI, "make", shape, "-o", mesh, "--quiet"]).returncode == 0)
        for options in variants:
            code = run(f"{shape} {' '.join(options)}", mesh, *options)
            check(f"{shape} {options} converges", code == 0, f"exit {code}")

names = "bunny_libigl camel_b cow_cgal face_1180 genus3 kitten_10k knot1 mushroom pipe spot_low".split()
good = os.path.join(CORPUS, "good")
if os.path.isdir(good):
    for name in names:
        for scheme in ("yamabe", "inversive"):
            code = run(f"{name} {scheme} flips", os.path.join(good, name + ".obj"), "--space", "e2", "--scheme", scheme)
            check(f"{name} {scheme} flips converges", code == 0, f"exit {code}")
        for scheme in ("yamabe", "tangential"):
            run(f"{name} {scheme}", os.path.join(good, name + ".obj"), "--space", "e2", "--scheme", scheme, "--flips", "never")
            genus3 = name == "genus3"
            if genus3:
                run(f"{name} {scheme} h2", os.path.join(good, name + ".obj"), "--space", "h2", "--scheme", scheme)
else:
    print(f"mesh corpus absent ({good}): only generated surfaces were checked")
print(f"{passed} passed, {failed} failed")
sys.exit(failed > 0)
