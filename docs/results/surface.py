#!/usr/bin/env python3
"""Surfaces of few patches of every closed mesh of middle size, as a table.

usage: docs/results/surface.py [CORPUS [NAME…]] > docs/results/surface.md     (after: cargo build --release -p ricci-apps)
"""
from page import build, file_of, loops, main, meshes, plain, seconds, small, table, verdict

# Vertices of the meshes.
LEAST, MOST = 1000, 13_000
# Most seconds of a run.
LONGEST = 150

HEAD = ["mesh", "V", "genus", "cones", "faces", "spans", "distance: most, rms", "noise", "folded", "normals of neighbours, °", "MB", "s", "holds"]


def row(run, mesh):
    name = mesh["name"]
    [path] = run.fresh("part.step")
    report, why = run.try_report("surface", file_of(mesh), "-o", path, seconds=LONGEST)
    if report is None:
        run.bad.append(f"{name}: {why}")
        return [name, mesh["V"], mesh["genus"], str(why).strip()[:120]] + ["–"] * (len(HEAD) - 5) + ["no"]
    r = report["result"]
    failed = [check for check, c in report["checks"].items() if not c["holds"]]
    told = ", ".join(f"{check} = {small(report['checks'][check]['value'])}" for check in failed)
    run.bad += [f"{name}: {told}"] if failed else []
    return [name, mesh["V"], mesh["genus"], r["cones"], r["faces"], r["spans"], f"{small(r['max'])}, {small(r['rms'])}", small(r["noise"]),
            len(r["folded_patches"]), small(r["normal_jump"]), plain(r["bytes"] / 1e6, ".2f"), seconds(report), "no" if failed else "yes"]


def content(run):
    chosen = meshes(lambda mesh: loops(mesh) == 0 and LEAST <= int(mesh["V"]) <= MOST)
    rows = [run.keep([mesh["name"], "surface"], lambda: row(run, mesh)) for mesh in chosen]
    held = [cells for cells in rows if cells[-1] == "yes"]
    few = [cells for cells in held if cells[4] <= 60]
    head = f"""# Surfaces of few patches

Made by `docs/results/surface.py` with {build}: `ricci surface MESH -o PART.step`, every closed mesh of one component from {LEAST} to {MOST} vertices, without sharp edges kept: also those that
have some, which no smooth surface meets. *distance*: between spline and mesh either way, over the diagonal; *noise*: of the mesh, over the diagonal. All checks hold for {len(held)} of {len(rows)}, with at most 60 faces for {len(few)}."""
    return [head, verdict(run.bad), table(HEAD, rows)]


main(content)
