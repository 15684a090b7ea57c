#!/usr/bin/env python3
"""Flatten every open mesh of the corpus of genus 0 by the default target and by the former one, flatten surfaces that unroll, and write the tables.

usage: docs/results/defaults.py [CORPUS [NAME…]] > docs/results/defaults.md     (after: cargo build --release -p ricci-apps)
"""
import math

from page import build, file_of, genus, loops, main, meshes, plain, seconds, small, table, verdict, write_obj

HEAD = ["mesh", "F", "loops", "default: dilatation max, mean", "area ratio", "seams", "s",
        "`boundary`: dilatation max, mean", "area ratio", "seams", "s"]
ISOMETRIC = 1e-12


def figures(report):
    result = report["result"]
    if "seams" not in result:
        return [f"none: {result['stop_reason']}", "–", "–", seconds(report)]
    return [f"{plain(result['qc_max'], '.3g')}, {plain(result['qc_mean'], '.3f')}",
            f"{small(result['area_ratio_min'])}–{small(result['area_ratio_max'])}", len(result["seams"]), seconds(report)]


def row(run, mesh):
    new = run.report(mesh["name"], "flow", file_of(mesh))
    old = run.try_report("flow", file_of(mesh), "--target", "boundary")
    name = [mesh["name"], mesh["F"], mesh["boundary_loops"]]
    if new is None:
        return name + [run.bad[-1].removeprefix(f"{mesh['name']}: ")]
    result = new["result"]
    run.insist(result["converged"], f"{mesh['name']}: {result['stop_reason']}")
    run.insist(result.get("seams") == [], f"{mesh['name']}: not one piece without seams")
    return name + figures(new) + (figures(old[0]) if old[0] else [old[1]])


def grid(n, m, hole, place):
    """A grid of n × m squares without those that `hole` names, at the points of `place`."""
    faces = []
    for j in range(m):
        for i in range(n):
            if not hole(i, j):
                a, b = j * (n + 1) + i, (j + 1) * (n + 1) + i
                faces += [[a, a + 1, b + 1], [a, b + 1, b]]
    used = sorted({v for f in faces for v in f})
    number = {v: k for k, v in enumerate(used)}
    places = [place(v % (n + 1), v // (n + 1)) for v in used]
    return places, [[number[v] for v in f] for f in faces]


def rolled(radius, step):
    return lambda i, j: [radius(i * step) * math.cos(i * step), radius(i * step) * math.sin(i * step), 0.1 * j]


def two_holes(i, j):
    return 4 <= i < 10 and 4 <= j < 16 or 20 <= i < 30 and 8 <= j < 12


def rows_of_holes(i, j):
    return i % 6 in (2, 3) and j % 6 in (2, 3, 4) and 6 <= i < 120 and j < 12


def no_hole(i, j):
    return False


UNROLLED = [
    ("plate with two holes", 40, 20, two_holes, lambda i, j: [0.1 * i, 0.1 * j + 0.003 * i, 0.0]),
    ("tilted plate with two holes", 40, 20, two_holes, lambda i, j: [0.036 * i - 0.08 * j, 0.048 * i + 0.06 * j, 0.08 * i]),
    ("cone sector", 40, 20, no_hole,
     lambda i, j: [0.6 * (1 + 0.05 * j) * math.cos(0.08 * i), 0.6 * (1 + 0.05 * j) * math.sin(0.08 * i), 0.8 * (1 + 0.05 * j)]),
    ("cylinder cut open", 60, 20, no_hole, rolled(lambda angle: 1.0, 0.1)),
    ("cylinder cut open, two holes", 60, 20, two_holes, rolled(lambda angle: 1.0, 0.1)),
    ("scroll", 200, 20, no_hole, rolled(lambda angle: 1 + 0.05 * angle, 0.1)),
    ("scroll with 38 holes", 126, 16, rows_of_holes, rolled(lambda angle: 1 + 0.05 * angle, 0.15)),
]


def stretch(uv):
    """Largest |length in the layout over length in space − 1| over the edges, after the scale that makes the areas equal."""
    corners, coordinates, textures = [], [], []
    for word in (line.split() for line in open(uv)):
        if word and word[0] == "v":
            corners.append([float(x) for x in word[1:4]])
        elif word and word[0] == "vt":
            coordinates.append([float(x) for x in word[1:3]])
        elif word and word[0] == "f":
            textures.append([[int(x) - 1 for x in corner.split("/")[:2]] for corner in word[1:]])
    ratios = []
    for face in textures:
        for (v, t), (w, s) in zip(face, face[1:] + face[:1]):
            ratios.append(math.dist(coordinates[t], coordinates[s]) / math.dist(corners[v], corners[w]))
    middle = sorted(ratios)[len(ratios) // 2]
    return max(abs(ratio / middle - 1) for ratio in ratios)


def unrolled(run, one):
    name, n, m, hole, place = one
    places, faces = grid(n, m, hole, place)
    path, (uv,) = write_obj(run.path("developable.obj"), places, faces), run.fresh("uv.obj")
    report = run.report(name, "flow", path, "--uv", uv)
    if report is None:
        return [name, len(faces), run.bad[-1]]
    result, off = report["result"], stretch(uv)
    run.insist(off < ISOMETRIC, f"{name}: lengths change by {off:.1e}, limit {ISOMETRIC:.0e}")
    return [name, len(faces), report["input"]["boundary_loops"], result["iterations"], small(off), len(result["seams"]), seconds(report)]


def content(run):
    chosen = meshes(lambda m: genus(m) == 0 and loops(m) > 0, lambda m: int(m["F"]))
    rows, flat = run.rows(chosen, row), run.rows(UNROLLED, unrolled)
    return [
        "# Defaults on open surfaces",
        f"Every open mesh of the corpus of genus 0 ({len(chosen)}) and surfaces that unroll, made by `docs/results/defaults.py`. By default the longest loop keeps its "
        "lengths and the holes are filled while the flow runs (`--target outer`); the former default, `--target boundary`, bends all loops in proportion to their "
        f"length. Times are those of one run of {build} on a shared machine and say little. Folded faces of files with `--on input` are in [input.md](input.md).",
        verdict(run.bad),
        table(HEAD, rows),
        "## Surfaces that unroll",
        "*off*: largest |length in the layout over length in space − 1| over all edges, read from the file of `--uv`.",
        table(["surface", "F", "loops", "steps", "off", "seams", "s"], flat),
    ]


main(content)
