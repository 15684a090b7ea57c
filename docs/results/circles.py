#!/usr/bin/env python3
"""Bring every open mesh of the corpus, and spheres with random holes, to circle domains, and write the tables.

usage: docs/results/circles.py [CORPUS [NAME…]] > docs/results/circles.md     (after: cargo build --release -p ricci-apps)
"""
import math
import random

from page import build, CHECK, complex_text, file_of, judged, loops, main, meshes, named, read_obj, seconds, small, table, verdict, verdict_of_outside, write_obj

HOLES = [3, 10, 20, 40, 70, 100]
SEED = 1
FIGURES = ["steps", "flips", "max \\|K\\|", "deviation", "overlaps", "flipped", "without area", "added before", "added by flips", "modulus",
           "mean dilatation", "outside: deviation, overlap, flipped, \\|K\\|", "s"]


def domain(run, path, name):
    """The counts of a surface and the figures of its circle domain, or None."""
    uv, metric = run.fresh("uv.obj", "metric.json")
    report, why = run.try_report("circles", path, "--uv", uv, "--metric", metric)
    if report is None:
        run.bad.append(f"{name}: refused: {why}")
        return None
    r, checks = report["result"], report["checks"]
    fails = [check for check, c in checks.items() if not c["holds"]]
    run.insist(not fails, f"{name}: {', '.join(fails)}")
    seen = "–"
    if CHECK is not None:
        round_, faces, k = judged("circles", uv), judged("uv", uv, path, r["space"]), judged("metric", metric)["max_curvature_error"]
        seen = f"{small(round_['worst_deviation'])}, {small(round_['worst_overlap'])}, {faces['flipped']}, {small(k)}"
        holds = (round_["worst_deviation"] or 0) <= 1e-9 and round_["worst_overlap"] <= 0 and not faces["flipped"] and faces["first_vertices_kept"]
        run.insist(holds, f"{name}: outside: {round_} {faces}")
    modulus = r.get("modulus")
    modulus = "–" if modulus is None else complex_text(modulus, 4) if isinstance(modulus, list) else f"{modulus:.6f}"
    return report["input"], [
        r["iterations"], r["flips"], small(checks["max_curvature_error"]["value"]), small(checks["roundness"]["value"]),
        int(checks["overlapping_circles"]["value"]), r["flipped_triangles"], r["degenerate_pieces"], r["halved_edges"], r["crossed_edges"], modulus,
        f"{r['qc_mean']:.3f}", seen, seconds(report),
    ]


def of_mesh(run, mesh):
    found = domain(run, file_of(mesh), mesh["name"])
    return found and [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"]] + found[1]


def sphere_with_holes(sphere, path, n):
    """The faces of a sphere's file without n disks at random places, of random sizes, that lie apart."""
    points, faces = read_obj(sphere)
    rng, disks = random.Random(SEED), []
    largest = 0.6 / math.sqrt(n)
    while len(disks) < n:
        center, radius = rng.choice(points), largest * rng.uniform(0.5, 1.0)
        if all(math.dist(center, c) > radius + r + 0.4 * largest for c, r in disks):
            disks.append((center, radius))
    inside = [any(math.dist(p, c) < r for c, r in disks) for p in points]
    kept = [f for f in faces if not all(inside[v] for v in f)]
    number = {v: k for k, v in enumerate(sorted({v for f in kept for v in f}))}
    return write_obj(path, [points[v] for v in number], [[number[v] for v in f] for f in kept])


def of_sphere(run, n):
    sphere = run.make("sphere.obj", "sphere", "-n", "60")
    found = domain(run, sphere_with_holes(sphere, run.path("holes.obj"), n), f"{n} holes")
    if found:
        run.insist(found[0]["boundary_loops"] == n, f"{n} holes: the surface has {found[0]['boundary_loops']}")
        return [n, found[0]["vertices"]] + found[1]


def content(run):
    chosen = meshes(lambda m: loops(m) > 0)
    rows = run.rows(chosen, of_mesh)
    spheres = [] if named else run.rows(HOLES, of_sphere)
    return [
        "# Circle domains",
        f"Every open mesh of the corpus ({len(rows)} of {len(chosen)}), made by `docs/results/circles.py`: `ricci circles MESH` with default options. "
        f"Times are those of one run of {build} on a shared machine.",
        verdict(run.bad),
        "*deviation*: of a loop from its circle, a share of the radius. *without area*: pieces of the layout whose area is below rounding. "
        "*added before*: vertices put on loops before the flow, because a loop has fewer than 12 edges, lies opposite an obtuse angle, or has a circle that "
        "overlaps another. *added by flips*: where edges of loops are flipped. *modulus*: of an annulus its height over its circumference, of a torus τ.",
        verdict_of_outside("*outside*: what an independent program finds in the files (check.py); *overlap* is negative where circles lie apart."),
        "## The corpus",
        table(["mesh", "V", "genus", "loops"] + FIGURES, rows),
        spheres and "## Spheres with random holes",
        spheres and f"Icospheres of 36002 vertices without disks at random places, of random sizes (seed {SEED}).",
        spheres and table(["holes", "V"] + FIGURES, spheres),
    ]


main(content)
