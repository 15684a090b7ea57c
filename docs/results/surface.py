#!/usr/bin/env python3
"""Surfaces of few patches of every closed mesh of middle size, as a table.

usage: docs/results/surface.py [CORPUS [NAME…]] > docs/results/surface.md     (after: cargo build --release -p ricci-apps)

With RICCI_CAD=PYTHON, a Python with cadquery-ocp, OpenCASCADE works on each file as well (cad_operations.py).
"""
import json
import os
import resource
import subprocess
from pathlib import Path

from page import build, file_of, loops, main, meshes, plain, small, table, verdict

# Vertices of the meshes.
LEAST, MOST = 300, 13_000
# Most seconds of a run.
LONGEST = 150

HEAD = ["mesh", "V", "genus", "cones", "faces", "spans", "distance: most, rms", "noise", "folded", "normals of neighbours, °", "volume off by", "MB", "s of the processor", "OpenCASCADE",
        "holds"]
# Seconds after which OpenCASCADE is ended.
PATIENCE = 120


def worked_on(path):
    """What OpenCASCADE's operations come to: those that give no valid solid."""
    python = os.environ.get("RICCI_CAD")
    if not python:
        return "–"
    try:
        done = subprocess.run([python, str(Path(__file__).with_name("cad_operations.py")), path], capture_output=True, text=True, timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        return f"longer than {PATIENCE} s"
    if done.returncode != 0:
        return (done.stderr.strip().splitlines() or ["ended"])[-1][:60]
    found = json.loads(done.stdout.splitlines()[-1])
    failed = [] if found["valid"] else ["the solid itself"]
    failed += [name for name, what in found.items() if isinstance(what, dict) and not what["valid"]]
    return "all valid" if not failed else "not valid: " + ", ".join(failed)


def row(run, mesh):
    name = mesh["name"]
    [path] = run.fresh("part.step")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    report, why = run.try_report("surface", file_of(mesh), "-o", path, seconds=LONGEST)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = plain(after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, ".0f")
    if report is None:
        run.bad.append(f"{name}: {why}")
        return [name, mesh["V"], mesh["genus"], str(why).strip()[:120]] + ["–"] * (len(HEAD) - 5) + ["no"]
    r = report["result"]
    failed = [check for check, c in report["checks"].items() if not c["holds"]]
    told = ", ".join(f"{check} = {small(report['checks'][check]['value'])}" for check in failed)
    run.bad += [f"{name}: {told}"] if failed else []
    return [name, mesh["V"], mesh["genus"], r["cones"], r["faces"], r["spans"], f"{small(r['max'])}, {small(r['rms'])}", small(r["noise"]),
            len(r["folded_patches"]), small(r["normal_jump"]), small(r["volume_error"]), plain(r["bytes"] / 1e6, ".2f"), took, worked_on(path), "no" if failed else "yes"]


def content(run):
    chosen = meshes(lambda mesh: loops(mesh) == 0 and LEAST <= int(mesh["V"]) <= MOST)
    rows = [run.keep([mesh["name"], "surface"], lambda: row(run, mesh)) for mesh in chosen]
    held = [cells for cells in rows if cells[-1] == "yes"]
    few = [cells for cells in held if cells[4] <= 60]
    head = f"""# Surfaces of few patches

Made by `docs/results/surface.py` with {build}: `ricci surface MESH -o PART.step`, every closed mesh of one component from {LEAST} to {MOST} vertices, without sharp edges kept: also those that
have some, which no smooth surface meets. *distance*: between spline and mesh either way, over the diagonal; *noise*: of the mesh, over the diagonal. *volume off by*: the spline's over the mesh's, less 1. *OpenCASCADE*: two offsets by 1 % of the diagonal one after
the other, a box cut off, a fillet along that cut, a bore through the solid: those that end in no valid solid. All checks hold for {len(held)} of {len(rows)}, with at most 60 faces for {len(few)}; all of OpenCASCADE's operations
for {sum(cells[-2] == "all valid" for cells in rows)}."""
    return [head, verdict(run.bad), table(HEAD, rows)]


main(content)
