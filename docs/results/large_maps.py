#!/usr/bin/env python3
"""Cortices of about 160,000 vertices on the sphere and in the plane, and rolled-up sheets of a million vertices with 37 holes laid flat.

usage: docs/results/large_maps.py [CORPUS] > docs/results/large_maps.md
(after: cargo build --release -p ricci-apps, in a Python with: pip install numpy nibabel nilearn autoflatten libigl)

Seconds are those of the whole command, with reading and writing. Turned triangles are those that this file finds in the written numbers.
"""
import math
import os
import resource
import subprocess

import numpy as np
from autoflatten.flatten.algorithm import count_flipped_triangles
from autoflatten.viz import compute_kring_distortion
from brain import patch, turned
from flatten import energy, length_errors, texture
from flatten import turned as turned_in_plane
from nibabel import freesurfer
from page import file_of, loops, main, meshes, ricci, table, verdict

# Faces of cortices are cut into four until they have at least so many vertices.
VERTICES = 150_000
# The most seconds that a flat map, and the sphere, of a cortex may take, and a whole sheet.
OF_CORTEX, OF_SHEET = 60, 180
# Squares of a sheet along and across, and the holes.
ALONG, ACROSS, HOLES = 2668, 368, 37


def measured(run, name, *arguments):
    """The report of a command with the seconds of the processor that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    report = run.report(name, *arguments)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return report, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def cost(report, processor):
    """Seconds of a whole command, those of the processor, and gigabytes."""
    return [f"{report['seconds']['total']:.0f}", f"{processor:.0f}", f"{report['peak_bytes'] / 1e9:.1f}"]


def in_time(run, name, taken, limit):
    """The seconds as text; more than `limit` are told."""
    run.insist(taken <= limit, f"{name}: {taken:.0f} s, more than {limit}")
    return f"{taken:.0f}"


def fine(run, mesh):
    """A cortex with its faces cut into four until it has enough vertices."""
    levels = math.ceil(math.log(VERTICES / int(mesh["V"]), 4))
    out = run.path(f"{mesh['name']}.pial")
    subprocess.run([ricci, "refine", file_of(mesh), "--levels", str(levels), "-o", out, "--quiet"], check=True, capture_output=True)
    return out


def distance_errors(V, F, vertices, P):
    """The distance errors of a flat map by autoflatten's own function, over pairs that up to 2 and up to 7 edges separate, and the triangles that it finds flipped."""
    order = np.argsort(vertices)
    vertices, P = vertices[order], P[order]
    number = np.full(len(V), -1)
    number[vertices] = np.arange(len(vertices))
    inside = F[(number[F] >= 0).all(axis=1)]
    errors = [compute_kring_distortion(P, V, F, vertices, k=k, verbose=False)[1] for k in (2, 7)]
    return inside, number, P, [f"{error:.2f}" for error in errors], int(count_flipped_triangles(P, number[inside]))


def hemisphere(run, mesh):
    """Sphere and flat map of a closed cortex."""
    name, given, out = mesh["name"], fine(run, mesh), run.path(mesh["name"])
    side = "left" if "left" in name else "right"
    report, processor = measured(run, name, "brain", given, "--hemisphere", side, "-o", out)
    if report is None:
        return None
    at = os.path.join(out, {"left": "lh", "right": "rh"}[side])
    V, F = freesurfer.read_geometry(given)
    S, _ = freesurfer.read_geometry(f"{at}.sphere")
    vertices, P, _ = patch(f"{at}.cortex.patch.flat")
    inside, number, P, errors, flipped = distance_errors(V, F, vertices, P[:, :2])
    found = [turned(S[F]), turned(P[number[inside]])]
    run.insist(found == [0, 0] and flipped == 0, f"{name}: {found} turned triangles, autoflatten {flipped}")
    row = report["result"]["hemispheres"][0]
    ends = [f"{row[kind]['iterations']} | {row[kind]['after']['energy']:.3f}" for kind in ("sphere", "flat")]
    seconds = [in_time(run, f"{name}, {kind}", sum(row[kind]["seconds"]), OF_CORTEX) for kind in ("sphere", "flat")]
    return [name, len(V), ends[0], seconds[0], found[0], ends[1], seconds[1], found[1], *errors, *cost(report, processor)]


def open_cortex(run, mesh):
    """The flat map of a cortex that is open already."""
    name, given = mesh["name"], fine(run, mesh)
    out = run.path("open.patch")
    report, processor = measured(run, name, "flatten", given, "--patch", out)
    if report is None:
        return None
    V, F = freesurfer.read_geometry(given)
    vertices, P, _ = patch(out)
    inside, number, P, errors, flipped = distance_errors(V, F, vertices, P[:, :2])
    found = turned(P[number[inside]])
    run.insist(found == 0 and flipped == 0, f"{name}: {found} turned triangles, autoflatten {flipped}")
    r = report["result"]
    return [name, len(V), "– | –", "–", "–", f"{r['iterations']} | {r['energy']:.3f}", in_time(run, name, report["seconds"]["layout"] + report["seconds"]["solve"], OF_CORTEX), found, *errors,
            *cost(report, processor)]


def sheet(path, bumps):
    """A sheet rolled up to a spiral of twelve turns, with `bumps` of this height in squares of its grid, and holes in two rows."""
    i, j = np.meshgrid(np.arange(ALONG + 1), np.arange(ACROSS + 1))
    step = 12 * 2 * math.pi / ALONG
    angle = step * i
    radius = 60 + 8 * angle + bumps * np.sin(0.9 * i) * np.sin(1.1 * j)
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), 2.0 * j], axis=2).reshape(-1, 3)
    is_open = np.zeros((ACROSS, ALONG), bool)
    for k in range(HOLES):
        row, column = divmod(k, (HOLES + 1) // 2)
        y, x = 100 + 140 * row, 60 + 138 * column
        is_open[y:y + 30, x:x + 20] = True
    y, x = np.nonzero(~is_open)
    a, b = y * (ALONG + 1) + x, (y + 1) * (ALONG + 1) + x
    faces = np.concatenate([np.stack([a, a + 1, b + 1], 1), np.stack([a, b + 1, b], 1)])
    used = np.unique(faces)
    number = np.full(len(places), -1)
    number[used] = np.arange(len(used))
    with open(path, "w") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in places[used].tolist())
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in (number[faces] + 1).tolist())


def sheet_row(run, bumps):
    name, path, out = f"sheet with bumps of {bumps}", run.path("sheet.obj"), run.path("flat.obj")
    sheet(path, bumps)
    report, processor = measured(run, name, "flatten", path, "--uv", out)
    if report is None:
        return None
    V, F, uv = texture(out)
    bad = turned_in_plane(F, uv)
    run.insist(bad == 0, f"{name}: {bad} turned triangles")
    run.insist(report["input"]["boundary_loops"] == HOLES + 1, f"{name}: {report['input']['boundary_loops']} loops")
    mean, most = length_errors(V, F, uv)
    if bumps == 0:
        run.insist(most < 1e-11, f"{name}: lengths are off by {most}")
    in_time(run, name, report["seconds"]["total"], OF_SHEET)
    return [name, len(V), report["input"]["boundary_loops"] - 1, report["result"]["iterations"], f"{energy(V, F, uv):.9f}", f"{mean:.2e}", f"{most:.2e}", bad,
            *cost(report, processor)]


def content(run):
    cortices = [mesh for mesh in meshes(lambda m: m["name"].startswith("cortex_"))]
    one = lambda run, m: run.keep(["large", m["name"]], lambda: (hemisphere if loops(m) == 0 else open_cortex)(run, m))
    yield "# Large surfaces laid flat"
    yield ("Made by `docs/results/large_maps.py` on a machine with two cores: every cortex of the corpus, its faces cut into four until it has at least 150,000 vertices, with `ricci brain` "
           "(sphere and flat map, the medial wall found) or, where it is open already, `ricci flatten`. *error*: the distance error of the flat map by autoflatten's own function (1.0.7; "
           "percent, over pairs of vertices that up to 2 and up to 7 edges separate). *turned*: triangles that are not counterclockwise in the numbers of the files, by fractions where "
           "floating point is not sure; autoflatten counts none either. *s*: the whole command, and the two maps by themselves.")
    head = ["surface", "V", "sphere: steps", "energy", "s", "turned", "plane: steps", "energy", "s", "turned", "error, 2 edges %", "7 edges %", "s", "processor s", "GB"]
    yield table(head, run.rows(cortices, one))
    yield ("Sheets rolled up to a spiral of twelve turns, with 37 holes, by `ricci flatten`. Lengths: mean and largest |length in the plane / length - 1| of the edges, in the file.")
    yield table(["surface", "V", "holes", "steps", "energy", "lengths: mean", "most", "turned", "s", "processor s", "GB"],
                run.rows((0, 0.3), lambda run, bumps: run.keep(["sheet", bumps], lambda: sheet_row(run, bumps))))
    yield verdict(run.bad, "All checks hold.")


if __name__ == "__main__":
    main(content)
