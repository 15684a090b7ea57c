#!/usr/bin/env python3
"""Flat maps of every open mesh of genus 0 beside SLIM of libigl from the same start, as a table.

usage: docs/results/flatten.py [CORPUS [NAME…]] > docs/results/flatten.md
(after: cargo build --release -p ricci-apps, in a Python with: pip install numpy libigl)

Energies, lengths and turned triangles of both are those that this file finds in the written numbers: no code of either program is asked.
"""
import importlib.metadata
import math
import time
from fractions import Fraction

import igl
import numpy as np
from page import file_of, genus, loops, main, meshes, small, table, verdict

# SLIM goes on until ten of its steps lower the energy by less than this share, or for so many seconds.
SETTLED = 1e-6
LONGEST = 120
# By how much our energy may exceed that of SLIM.
MORE = 1.001


def texture(path):
    """Positions, faces and the texture coordinates of the vertices of an OBJ file whose corners have those of their vertices."""
    V, T, F, at = [], [], [], {}
    for word in (line.split() for line in open(path)):
        if word and word[0] == "v":
            V.append([float(x) for x in word[1:4]])
        elif word and word[0] == "vt":
            T.append([float(x) for x in word[1:3]])
        elif word and word[0] == "f":
            corners = [[int(x) - 1 for x in corner.split("/")[:2]] for corner in word[1:4]]
            F.append([v for v, _ in corners])
            at.update(corners)
    return np.array(V), np.array(F), np.array([T[at[v]] for v in range(len(V))])


def turned(F, uv):
    """The number of triangles that are not counterclockwise: in floating point where that is sure, else by fractions."""
    p, q = uv[F[:, 1]] - uv[F[:, 0]], uv[F[:, 2]] - uv[F[:, 0]]
    there, back = p[:, 0] * q[:, 1], p[:, 1] * q[:, 0]
    scale = np.abs(uv[F]).max(axis=(1, 2)) * (np.abs(p) + np.abs(q)).max(axis=1)
    sure = np.abs(there - back) > 1e-14 * scale
    count = int((sure & (there < back)).sum())
    for a, b, c in uv[F[~sure]]:
        a, b, c = ([Fraction(float(x)) for x in point] for point in (a, b, c))
        count += (b[0] - a[0]) * (c[1] - a[1]) <= (b[1] - a[1]) * (c[0] - a[0])
    return count


def energy(V, F, uv):
    """The mean of s² + t² + 1/s² + 1/t² over the area; infinite if a triangle is turned over."""
    p, q = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    length = np.linalg.norm(p, axis=1)
    along, area = (p * q).sum(1) / length, np.linalg.norm(np.cross(p, q), axis=1)
    u, v = uv[F[:, 1]] - uv[F[:, 0]], uv[F[:, 2]] - uv[F[:, 0]]
    # Columns of the map: the image of the unit vector along p, and of that across.
    first = u / length[:, None]
    second = (v - along[:, None] * first) / (area / length)[:, None]
    det = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    square = (first**2).sum(1) + (second**2).sum(1)
    with np.errstate(divide="ignore"):
        density = np.where(det > 0, square * (1 + 1 / det**2), math.inf)
    return float((area * density).sum() / area.sum())


def length_errors(V, F, uv):
    """Mean and largest |length in the plane / length - 1| of the edges."""
    ends = np.unique(np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1), axis=0)
    ratio = np.linalg.norm(uv[ends[:, 0]] - uv[ends[:, 1]], axis=1) / np.linalg.norm(V[ends[:, 0]] - V[ends[:, 1]], axis=1)
    errors = np.abs(ratio - 1)
    return errors.mean(), errors.max()


def slim(V, F, uv):
    """The map of SLIM from a start: the map, the seconds, and whether it settled."""
    area = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1).sum() / 2
    scale = 1 / math.sqrt(area)
    V, uv = np.asfortranarray(V * scale), np.asfortranarray(uv * scale)
    begun = time.perf_counter()
    data = igl.slim_precompute(V, np.asfortranarray(F.astype(np.int32)), uv, igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
                               np.zeros(0, np.int32), np.zeros((0, 2), order="F"), 0.0)
    taken, last = time.perf_counter() - begun, energy(V, F, uv)
    while taken < LONGEST:
        begun = time.perf_counter()
        found = igl.slim_solve(data, 10)
        taken += time.perf_counter() - begun
        now = energy(V, F, found)
        if not now < math.inf or now > last * (1 - SETTLED):
            return found / scale, taken, now < math.inf
        last = now
    return found / scale, taken, False


HEAD = ["mesh", "V", "loops", "start", "energy before", "after", "steps (by the Hessian)", "decrement", "lengths: mean %", "most %", "overlap", "turned",
        "s", "SLIM: energy", "turned", "s", "ours over SLIM's"]


def row(run, mesh):
    name, path = mesh["name"], file_of(mesh)
    out, start = run.fresh("flat.obj", "start.obj")
    report = run.report(name, "flatten", path, "--uv", out)
    begin, why = run.try_report("flatten", path, "--uv", start, "--max-iterations", "0")
    if report is None or begin is None:
        run.insist(begin is not None, f"{name}: {why}")
        return None
    r = report["result"]
    V, F, uv = texture(out)
    ours, bad = energy(V, F, uv), turned(F, uv)
    run.insist(bad == 0, f"{name}: {bad} triangles turned over in the file")
    run.insist(abs(ours - r["after"]["energy"]) < 1e-6 * ours, f"{name}: energy {r['after']['energy']}, by the file {ours}")
    mean, most = length_errors(V, F, uv)
    taken = report["seconds"]["layout"] + report["seconds"]["solve"]
    cells = [name, len(V), loops(mesh), r["start"], f"{r['before']['energy']:.6g}", f"{ours:.6f}", f"{r['iterations']} ({r['unclamped_steps']})",
             small(r["newton_decrement"]), f"{100 * mean:.2f}", f"{100 * most:.1f}", small(r["overlap"]), bad, f"{taken:.2f}"]
    V, F, uv = texture(start)
    found, seconds, settled = slim(V, F, uv)
    theirs, flipped = energy(V, F, found), turned(F, found)
    run.insist(ours <= MORE * theirs, f"{name}: energy {ours:.6f}, SLIM's {theirs:.6f}")
    run.insist(taken < seconds, f"{name}: {taken:.2f} s, SLIM {seconds:.2f} s")
    return cells + [f"{theirs:.6f}", flipped, f"{seconds:.2f}" + ("" if settled else " (stopped)"), f"{ours / theirs:.6f}"]


def content(run):
    rows = run.rows(meshes(lambda m: genus(m) == 0 and loops(m) > 0), lambda run, m: run.keep(["flatten", m["name"]], lambda: row(run, m)))
    return [
        "# Flat maps of least stretch",
        "Made by `docs/results/flatten.py`: `ricci flatten` with default options on every open mesh of genus 0 of the corpus, beside SLIM of libigl "
        f"{importlib.metadata.version('libigl')} (PyPI) from the same start, until ten of its steps lower the energy by less than {SETTLED:g} of itself, "
        f"at most {LONGEST} s. Seconds are those of the start and the descent for ours, of the descent alone for SLIM, on a shared machine with two cores.",
        verdict(run.bad),
        "*energy*: mean of s² + t² + 1/s² + 1/t² over the area, at least 4, found in the written files by numpy. *start*: the conformal layout, or an "
        "embedding by Tutte's theorem where that turns a triangle of the mesh over. *lengths*: |length in the plane / length − 1| of the edges. "
        "*overlap*: share of the map that lies on other parts of it, which nothing forbids here. *turned*: triangles that are not counterclockwise, by "
        "fractions where floating point is not sure.",
        table(HEAD, rows),
    ]


if __name__ == "__main__":
    main(content)
