#!/usr/bin/env python3
"""Bring every open mesh of the corpus, and spheres with random holes, to circle domains, and write the tables.

usage: docs/results/circles.py [CORPUS [NAME…]] > docs/results/circles.md     (after: cargo build --release -p ricci-apps)

RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository);
where it or numpy is absent, the page says so.
"""
import json
import math
import os
import random
import subprocess
import tempfile

from page import CHECK, WHY, corpus, judged, make, meshes, named, ricci, small, table

HOLES = [3, 10, 20, 40, 70, 100]
SEED = 1

MESHES = meshes(lambda m: int(m["boundary_loops"]) > 0)


def row(folder, path, bad, name):
    """The figures of one circle domain, or None; what does not hold goes into `bad`."""
    report, uv, metric = (os.path.join(folder, file) for file in ("report.json", "uv.obj", "metric.json"))
    for old in (report, uv, metric):
        if os.path.exists(old):
            os.remove(old)
    command = [ricci, "circles", path, "--quiet", "--report", report, "--uv", uv, "--metric", metric]
    done = subprocess.run(command, capture_output=True, text=True)
    found = json.load(open(report)) if os.path.exists(report) else None
    if found is None or "circles" not in found["result"]:
        bad.append(f"{name}: refused: {done.stderr.strip()}")
        return None
    r, checks = found["result"], found["checks"]
    fails = [check for check, c in checks.items() if not c["holds"]]
    if fails:
        bad.append(f"{name}: {', '.join(fails)}")
    verdicts = "–"
    if CHECK is not None:
        round_, faces = judged("circles", uv), judged("uv", uv, path, r["space"])
        k = judged("metric", metric)["max_curvature_error"]
        verdicts = f"{small(round_['worst_deviation'])}, {small(round_['worst_overlap'])}, {faces['flipped']}, {small(k)}"
        if (round_["worst_deviation"] or 0) > 1e-9 or round_["worst_overlap"] > 0 or faces["flipped"] or not faces["first_vertices_kept"]:
            bad.append(f"{name}: outside: {round_} {faces}")
    modulus = r.get("modulus")
    if isinstance(modulus, list):
        modulus = "{:.4f} + {:.4f} i".format(*modulus)
    elif modulus is not None:
        modulus = f"{modulus:.6f}"
    return found, [
        str(r["iterations"]), str(r["flips"]), small(checks["max_curvature_error"]["value"]), small(checks["roundness"]["value"]),
        str(int(checks["overlapping_circles"]["value"])), str(r["flipped_triangles"]), str(r["degenerate_pieces"]),
        str(r["halved_edges"]), str(r["crossed_edges"]), modulus or "–", f"{r['qc_mean']:.3f}", verdicts, f"{found['seconds']['total']:.2f}",
    ]


FIGURES = ["steps", "flips", "max \\|K\\|", "deviation", "overlaps", "flipped", "without area", "added before", "added by flips", "modulus",
           "mean dilatation", "outside: deviation, overlap, flipped, \\|K\\|", "s"]


def of_corpus(folder):
    rows, bad = [], []
    for mesh in MESHES:
        found = row(folder, os.path.join(corpus, mesh["file"]), bad, mesh["name"])
        if found:
            rows.append([mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"]] + found[1])
    return rows, bad


def sphere_with_holes(sphere, path, n, seed):
    """The faces of a sphere's file without n disks at random places, of random sizes, that lie apart."""
    lines = [line.split() for line in open(sphere)]
    points = [tuple(map(float, l[1:4])) for l in lines if l and l[0] == "v"]
    faces = [tuple(int(x.split("/")[0]) - 1 for x in l[1:4]) for l in lines if l and l[0] == "f"]
    rng, disks = random.Random(seed), []
    largest = 0.6 / math.sqrt(n)
    while len(disks) < n:
        center, radius = rng.choice(points), largest * rng.uniform(0.5, 1.0)
        if all(math.dist(center, c) > radius + r + 0.4 * largest for c, r in disks):
            disks.append((center, radius))
    inside = [any(math.dist(p, c) < r for c, r in disks) for p in points]
    kept = [f for f in faces if not all(inside[v] for v in f)]
    number = {v: k + 1 for k, v in enumerate(sorted({v for f in kept for v in f}))}
    with open(path, "w") as out:
        out.writelines("v {!r} {!r} {!r}\n".format(*points[v]) for v in number)
        out.writelines("f {} {} {}\n".format(*(number[v] for v in f)) for f in kept)


def of_spheres(folder):
    rows, bad = [], []
    sphere, path = make(folder, "sphere.obj", "sphere", "-n", "60"), os.path.join(folder, "holes.obj")
    for n in HOLES:
        sphere_with_holes(sphere, path, n, SEED)
        found = row(folder, path, bad, f"{n} holes")
        if found:
            counts = found[0]["input"]
            if counts["boundary_loops"] != n:
                bad.append(f"{n} holes: the surface has {counts['boundary_loops']}")
            rows.append([str(n), str(counts["vertices"])] + found[1])
    return rows, bad


def page():
    with tempfile.TemporaryDirectory() as folder:
        corpus_rows, bad = of_corpus(folder)
        sphere_rows, more = ([], []) if named else of_spheres(folder)
    bad += more
    print("# Circle domains\n")
    print(f"Every open mesh of the corpus ({len(corpus_rows)} of {len(MESHES)}), made by `docs/results/circles.py`: `ricci circles MESH` with default options. "
          "Times are those of one run on a shared machine.\n")
    print("All checks of every report hold." if not bad else "What does not hold:\n\n" + "\n".join(f"- {line}" for line in bad))
    print("\n*deviation*: of a loop from its circle, a share of the radius. *without area*: pieces of the layout whose area is below rounding. "
          "*added before*: vertices put on loops before the flow, because a loop has fewer than 12 edges, lies opposite an obtuse angle, or has a circle that "
          "overlaps another. *added by flips*: where edges of loops are flipped. *modulus*: of an annulus its height over its circumference, of a torus τ.\n")
    print("*outside*: what an independent program finds in the files (check.py); *overlap* is negative where circles lie apart."
          if CHECK else f"No independent program has judged the files: {WHY}.")
    print("\n## The corpus\n")
    print(table(["mesh", "V", "genus", "loops"] + FIGURES, corpus_rows))
    if sphere_rows:
        print(f"\n## Spheres with random holes\n\nIcospheres of 36002 vertices without disks at random places, of random sizes (seed {SEED}).\n")
        print(table(["holes", "V"] + FIGURES, sphere_rows))


page()
