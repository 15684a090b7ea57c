#!/usr/bin/env python3
"""Run `ricci flow --flips never` with default targets on every mesh of the corpus, for four schemes, and write the table.

usage: docs/results/flow.py [CORPUS] > docs/results/flow.md     (after: cargo build --release -p ricci-apps)
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
corpus = sys.argv[1] if len(sys.argv) > 1 else os.path.join(root, "..", "shared", "meshes", "good")
ricci = os.path.join(root, "target", "release", "ricci")
schemes = ["yamabe", "inversive", "thurston", "tangential"]
meshes = list(csv.DictReader(open(os.path.join(corpus, "INDEX.csv"))))
meshes.sort(key=lambda m: (int(m["boundary_loops"]) > 0, int(m["genus"]), int(m["V"])))


def run(mesh, scheme):
    with tempfile.TemporaryDirectory() as out:
        report = os.path.join(out, "r.json")
        code = subprocess.run([ricci, "flow", os.path.join(corpus, mesh["file"]), "--scheme", scheme, "--flips", "never",
                               "--report", report, "--quiet"], stderr=subprocess.PIPE, text=True)
        if not os.path.exists(report):
            return {"why": code.stderr.strip(), "code": code.returncode, "done": False}
        result = json.load(open(report))
        r = result["result"]
        done = r["max_curvature_error"] <= 1e-10 and r["broken_triangles"] == 0 and r["converged"]
        return {"done": done, "code": code.returncode, "why": r["stop_reason"], **r, "seconds": result["seconds"]["total"]}


rows = [(m, {s: run(m, s) for s in schemes}) for m in meshes]
print("# Flow without flips on the mesh corpus\n")
print("Made by `docs/results/flow.py`: `ricci flow MESH --scheme S --flips never`, default space and target, for each of the "
      f"{len(rows)} meshes. Reached: max |K − K̄| ≤ 1e-10, no broken triangle.\n")
print("| scheme | reached | broken triangles | infeasible | stalled | other | median steps | flipped in a layout |")
print("|---|---|---|---|---|---|---|---|")
for s in schemes:
    r = [x[s] for _, x in rows]
    count = lambda *why: sum(1 for x in r if not x["done"] and x["why"] in why)
    steps = sorted(x["iterations"] for x in r if x["done"])
    named = count("broken_triangles"), count("infeasible"), count("stalled")
    other = sum(1 for x in r if not x["done"]) - sum(named)
    flipped = sum(1 for x in r if x["done"] and (x.get("flipped_triangles") or 0) > 0)
    print(f"| {s} | {sum(x['done'] for x in r)} of {len(r)} | {named[0]} | {named[1]} | {named[2]} | {other} | "
          f"{steps[len(steps) // 2] if steps else '–'} | {flipped} |")
print("\nPer mesh: steps and max |K − K̄| where reached, otherwise why not: the energy is least with that many broken triangles; or "
      "infeasible, and how many vertices prove it (every metric of the scheme on this triangulation has more total curvature "
      "there than the target asks for); or stalled. `!`: reached, but that many triangles of the layout are flipped, because "
      "lengths range over more decades than doubles resolve (exit code 1). `qc`: area-weighted mean quasi-conformal dilatation "
      "of the yamabe layout (E²), a dash where there is none.\n")
print("| mesh | V | genus | loops | " + " | ".join(schemes) + " | qc | seconds (yamabe) |")
print("|---|---|---|---|" + "---|" * (len(schemes) + 2))


def cell(x):
    if x["done"]:
        flipped = f" ! {x['flipped_triangles']} flipped" if x["flipped_triangles"] else ""
        return f"{x['iterations']}, {x['max_curvature_error']:.0e}{flipped}"
    why = x["why"].replace("_", " ")
    if x["why"] == "broken_triangles":
        why += f" ({x['broken_triangles']})"
    if x["why"] == "infeasible":
        why += f" ({len(x['obstruction']['vertices'])})"
    return why if len(why) < 60 else why[:57] + "…"


for m, x in rows:
    qc = x["yamabe"].get("qc_mean")
    print(f"| {m['name']} | {m['V']} | {m['genus']} | {m['boundary_loops']} | " + " | ".join(cell(x[s]) for s in schemes)
          + f" | {'–' if qc is None else f'{qc:.3f}'} | {x['yamabe'].get('seconds', 0):.2f} |")
