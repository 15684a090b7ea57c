#!/usr/bin/env python3
"""Recompute from the files of `ricci flow`, `uniformize` and `cover` what they claim, with plain formulas and numpy only.

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
        # The common subdivision: pieces of the input's faces.
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


def check_origins(name, path, uv, source):
    """--xref: every vertex of the layout's mesh lies where its row says, every face in its face, and the faces fill theirs."""
    (v, _, f, _), (v0, _, f0, _) = read_obj(uv), read_obj(source)
    faces, vertices = open(path).read().split("output_vertex,source_face,b0,b1,b2\n")
    rows = np.array([[float(x) for x in line.split(",")] for line in vertices.splitlines()])
    whole = np.array([[int(x) for x in line.split(",")] for line in faces.splitlines()[1:]])
    check(name + " rows", (whole[:, 0] == np.arange(len(f))).all() and (rows[:, 0] == np.arange(len(v))).all(), "not in order")
    there = (rows[:, 2:, None] * v0[f0[rows[:, 1].astype(int)]]).sum(1)
    off = np.abs(there - v).max() / np.abs(v0).max()
    check(name + " places", off <= 1e-6, f"{off}")
    area = lambda v, f: np.linalg.norm(np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]]), axis=1)
    filled = np.zeros(len(f0))
    np.add.at(filled, whole[:, 1], area(v, f))
    short = np.abs(filled - area(v0, f0)).max() / area(v0, f0).max()
    check(name + " pieces", short <= 1e-6, f"{short}")


def klein(z):
    return 2 * z / (1 + (z * z).sum(1, keepdims=True))


def check_disk(name, path, source):
    """A layout in the Poincaré disk: orientation of the Klein images, what every layout keeps, and that seams are glued."""
    v, vt, f, ft = read_obj(path)
    v0, _, f0, _ = read_obj(source)
    size = np.abs(v0).max()
    check(name + " positions", np.abs(v[: len(v0)] - v0).max() <= 1e-6 * size, "moved")
    if len(v) > len(v0):
        off = on_edges(v[len(v0) :], v0, f0)
        check(name + " crossings", off <= 1e-9 * size, f"{off} off the input's edges")
    there, before = solid_area(v, f), solid_area(v0, f0)
    check(name + " area", abs(there - before) <= 1e-9 * before, f"{there} of {before}")
    check(name + " inside", ((vt * vt).sum(1) < 1).all(), "outside the disk")
    t = klein(vt)[np.array(ft)]
    a, b = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    area = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    longest = np.max([((t[:, k] - t[:, k - 1]) ** 2).sum(1) for k in range(3)], axis=0)
    # What coordinates of size 1 have been rounded to.
    rounded = 1e-12 * longest + 4e-16 * np.sqrt(longest)
    check(name + " orientation", (area >= -rounded).all(), f"{(area < -rounded).sum()} flipped")
    # An edge has the same hyperbolic length in both of its faces.
    ft, z = np.array(ft), vt[:, 0] + 1j * vt[:, 1]
    lengths = {}
    for face, corners in zip(f, ft):
        for k in range(3):
            p, q = z[corners[k]], z[corners[(k + 1) % 3]]
            key = tuple(sorted((face[k], face[(k + 1) % 3])))
            # Far out a coordinate resolves this much.
            blur = 1e-15 / min(1 - abs(p) ** 2, 1 - abs(q) ** 2)
            lengths.setdefault(key, []).append((2 * np.arctanh(abs((p - q) / (1 - p.conjugate() * q))), blur))
    pairs = [two for two in lengths.values() if len(two) == 2]
    off = max(abs(a - b) / (1e-8 + 8 * max(x, y)) for (a, x), (b, y) in pairs)
    check(name + " seams", off <= 1, f"{off}")


def check_boundary(name, path, report, generators):
    """Geodesic boundary loops: in the Klein disk their points lie on straight lines between the seams, and the traces have their lengths."""
    _, vt, f, ft = read_obj(path)
    half = {(a[k], a[(k + 1) % 3]): (b[k], b[(k + 1) % 3]) for a, b in zip(f.tolist(), np.array(ft).tolist()) for k in range(3)}
    after = {a: (b, w) for (a, b), w in half.items() if (b, a) not in half}
    points, worst, loops = klein(vt), 0.0, 0
    while after:
        loops, a, run = loops + 1, next(iter(after)), []
        while a in after:
            a, w = after.pop(a)
            if run and run[-1] != w[0]:
                run = []
            run += [w[0], w[1]]
            p, q = points[run[0]], points[w[1]]
            if len(run) > 2:
                d = q - p
                off = np.abs(d[0] * (points[run] - p)[:, 1] - d[1] * (points[run] - p)[:, 0]) / np.hypot(*d)
                worst = max(worst, off.max())
    told = report["result"]["boundary_lengths"]
    check(name + " loops", loops == len(told), f"{loops}, {told}")
    check(name + " straight boundary", worst <= 1e-9, f"{worst}")
    group = json.load(open(generators))["generators"]
    for around in report["result"]["boundary"]:
        m = np.array([[complex(*z) for z in row] for row in group[around["generator"]]])
        length = 2 * np.arccosh(abs(np.trace(m)) / 2)
        check(name + " length of " + around["generator"], abs(length - around["length"]) <= 1e-6 * length, f"{length}, {around}")


def check_deck(name, path, genus, loops=0):
    group = json.load(open(path))
    matrices = {k: np.array([[complex(*z) for z in row] for row in m]) for k, m in group["generators"].items()}
    expected = [x for i in range(1, genus + 1) for x in (f"a{i}", f"b{i}", f"a{i}^-1", f"b{i}^-1")]
    expected += [f"c{j}" for j in range(1, loops + 1)]
    check(name + " word", group["word"] == expected, group["word"])
    product, largest = np.eye(2, dtype=complex), 1.0
    for letter in group["word"]:
        m = matrices[letter.removesuffix("^-1")]
        product = product @ (np.linalg.inv(m) if letter.endswith("^-1") else m)
        largest = max(largest, np.linalg.norm(product) ** 2)
    off = min(np.linalg.norm(product - s * np.eye(2)) for s in (1, -1)) / largest
    check(name + " relation", off <= 1e-8, f"{off}")
    for k, m in matrices.items():
        if genus == 1 and loops == 0:
            check(f"{name} {k} translation", abs(m[0, 0] - 1) <= 1e-10 and m[1, 0] == 0, m)
        else:
            size = abs(m).max() ** 2
            unit = max(abs(m[1, 1] - m[0, 0].conjugate()), abs(m[1, 0] - m[0, 1].conjugate()), abs(np.linalg.det(m) - 1))
            check(f"{name} {k} isometry of the disk", unit <= 1e-13 * max(size, 1), f"{unit}")
            check(f"{name} {k} hyperbolic", abs(np.trace(m)) > 2, np.trace(m))


def check_sphere(name, path, source, u_range):
    v, _, f, _ = read_obj(path)
    v0, _, f0, _ = read_obj(source)
    check(name + " vertices", len(v) == len(v0) and len(f) == len(f0), f"{len(v)} of {len(v0)}")
    check(name + " radius", np.abs((v * v).sum(1) - 1).max() <= 1e-14, "off the sphere")
    n = np.cross(v[f[:, 1]] - v[f[:, 0]], v[f[:, 2]] - v[f[:, 0]])
    far = {}
    for i, face in enumerate(f):
        for k in range(3):
            far.setdefault(tuple(sorted((face[k], face[(k + 1) % 3]))), []).append((i, face[(k + 2) % 3]))
    check(name + " closed", all(len(x) == 2 for x in far.values()), "an edge without two faces")
    if u_range < 30:
        over = max(n[i] @ (v[z] - v[f[i, 0]]) / np.linalg.norm(n[i]) for (i, _), (_, z) in far.values())
        check(name + " convex", over <= 1e-12, f"{over}")
    area = np.linalg.norm(np.cross(v0[f0[:, 1]] - v0[f0[:, 0]], v0[f0[:, 2]] - v0[f0[:, 0]]), axis=1) / 6
    weight = np.zeros(len(v0))
    np.add.at(weight, f0.ravel(), np.repeat(area, 3))
    centre = np.linalg.norm(weight @ v) / weight.sum()
    check(name + " centre", centre <= 1e-9, f"{centre}")


def check_copies(name, path, generators):
    """Every copy is the first one, moved by the matrix of its name."""
    group = json.load(open(generators))["generators"]
    matrices = {k: np.array([[complex(*z) for z in row] for row in m]) for k, m in group.items()}
    copies = {}
    for line in open(path):
        word, *rest = line.split()
        if word == "o":
            copies[rest[0]] = current = []
        elif word == "v":
            current.append(complex(float(rest[0]), float(rest[1])))
    first = np.array(copies["1"])
    worst = 0.0
    for letters, points in copies.items():
        m = np.eye(2, dtype=complex)
        for letter in letters.split(".") if letters != "1" else []:
            g = matrices[letter.removesuffix("^-1")]
            m = m @ (np.linalg.inv(g) if letter.endswith("^-1") else g)
        moved = (m[0, 0] * first + m[0, 1]) / (m[1, 0] * first + m[1, 1])
        worst = max(worst, (np.abs(moved - points) / np.maximum(1, np.abs(moved))).max())
    check(name + " copies", worst <= 1e-8, f"{worst}")


def uniformize(name, mesh, genus, loops=0):
    with tempfile.TemporaryDirectory() as out:
        path = lambda file: os.path.join(out, file)
        files = ["--metric", path("m.json"), "--report", path("r.json"), "--generators", path("c.json")]
        round_ = genus == 0 and loops == 0
        files += ["--sphere", path("s.obj")] if round_ else ["--uv", path("uv.obj"), "--cover", path("all.obj")]
        command = "uniformize" if round_ else "cover"
        depth = [] if round_ else ["--depth", "1"]
        code = subprocess.run([RICCI, command, mesh, *depth, *files, "--quiet"]).returncode
        report = json.load(open(path("r.json")))
        check(name + " uniformizes", code == 0, f"exit {code}, {report['checks']}")
        check_metric(name, path("m.json"), report["result"]["max_curvature_error"])
        if round_:
            check_sphere(name, path("s.obj"), mesh, report["result"]["u_range"])
            return
        check_deck(name, path("c.json"), genus, loops)
        check_copies(name, path("all.obj"), path("c.json"))
        if genus == 1 and loops == 0:
            check_uv(name, path("uv.obj"), mesh, path("m.json"))
        else:
            check_disk(name, path("uv.obj"), mesh)
            if loops:
                check_boundary(name, path("uv.obj"), report, path("c.json"))
            # The area by l'Huilier's formula, without angles.
            metric = json.load(open(path("m.json")))
            a, b, c = np.array(metric["lengths"], np.longdouble).T
            s = (a + b + c) / 2
            root = np.sqrt(np.tanh(s / 2) * np.tanh((s - a) / 2) * np.tanh((s - b) / 2) * np.tanh((s - c) / 2))
            area = float((4 * np.arctan(root)).sum())
            exact = 2 * np.pi * (2 * genus - 2 + loops)
            # The file of a surface with boundary has its double, if the flow has gone there.
            area /= 2 if "mirror" in metric else 1
            check(name + " area of the metric", abs(area - exact) <= 1e-9 * exact, f"{area} of {exact}")


def run(name, mesh, *options):
    with tempfile.TemporaryDirectory() as out:
        path = lambda file: os.path.join(out, file)
        files = ["--metric", path("m.json"), "--report", path("r.json")]
        plane = "h2" not in options
        files += ["--uv", path("uv.obj"), "--xref", path("x.csv")]
        code = subprocess.run([RICCI, "flow", mesh, *options, *files, "--quiet"]).returncode
        report = json.load(open(path("r.json")))
        result, checks = report["result"], report["checks"]
        check(name + " exit", (code == 0) == all(c["holds"] for c in checks.values()), f"exit {code}, {checks}")
        check(name + " truth", result["converged"] or code == 1, f"exit {code}, {result}")
        if code == 0:
            check_metric(name, path("m.json"), result["max_curvature_error"])
            check_origins(name + " way back", path("x.csv"), path("uv.obj"), mesh)
            if plane:
                check_uv(name, path("uv.obj"), mesh, path("m.json"))
            else:
                check_disk(name, path("uv.obj"), mesh)
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

    for shape, genus in (("sphere", 0), ("ellipsoid", 0), ("torus", 1), ("knot", 1), ("genus", 2)):
        mesh = os.path.join(folder, shape + ".obj")
        check(shape + " make", subprocess.run([RICCI, "make", shape, "-o", mesh, "--quiet"]).returncode == 0)
        uniformize(shape + " uniformized", mesh, genus)
    mesh = os.path.join(folder, "three.obj")
    check("genus 3 make", subprocess.run([RICCI, "make", "genus", "--genus", "3", "-n", "5", "-o", mesh, "--quiet"]).returncode == 0)
    uniformize("genus 3 uniformized", mesh, 3)
    for shape, genus, loops in (("sphere", 0, 4), ("torus", 1, 1), ("genus", 2, 2)):
        mesh = os.path.join(folder, shape + "_holes.obj")
        made = subprocess.run([RICCI, "make", shape, "--holes", str(loops), "-o", mesh, "--quiet"])
        check(shape + " with holes make", made.returncode == 0)
        uniformize(f"{shape} with {loops} holes uniformized", mesh, genus, loops)

names = "bunny_libigl camel_b cow_cgal face_1180 genus3 kitten_10k knot1 mushroom pipe spot_low".split()
good = os.path.join(CORPUS, "good")
if os.path.isdir(good):
    for name, genus in (("spot_low", 0), ("hand_cgal", 0), ("bob", 1), ("eight_315", 2), ("pretzel", 3), ("bamboo_pen", 8)):
        uniformize(name + " uniformized", os.path.join(good, name + ".obj"), genus)
    for name, genus, loops in (("eight_open", 0, 4), ("punctured_torus", 1, 1), ("eight_hole", 2, 1)):
        uniformize(name + " uniformized", os.path.join(good, name + ".obj"), genus, loops)
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
