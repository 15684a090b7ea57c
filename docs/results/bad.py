#!/usr/bin/env python3
"""Diagnose, repair and flow every broken or odd file of the corpus, and write the table.

usage: python3 docs/results/bad.py [CORPUS] > docs/results/bad.md     (after: cargo build --release -p ricci-apps)
"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
corpus = sys.argv[1] if len(sys.argv) > 1 else os.path.join(root, "..", "shared", "meshes", "bad")
ricci = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release", "ricci")
MORE = 1000
LARGE = 1000
files = list(csv.DictReader(open(os.path.join(corpus, "INDEX.csv"))))


def finite(value):
    if isinstance(value, dict):
        return all(map(finite, value.values()))
    if isinstance(value, list):
        return all(map(finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def run(out, *line):
    """Exit code, report, and peak memory where there is a report; a panic or an exit code of no meaning ends the script."""
    report = os.path.join(out, "r.json")
    if os.path.exists(report):
        os.remove(report)
    done = subprocess.run([ricci, *line, "--report", report, "--quiet"], stderr=subprocess.PIPE, text=True)
    assert done.returncode in (0, 1, 3) and "panick" not in done.stderr, (line, done)
    found = json.load(open(report)) if os.path.exists(report) else None
    assert found is None or finite(found), line
    return done.returncode, found, done.stderr.strip()


def failing(name, clean, result):
    """What the report of a flow says that did not reach its target, and what more steps give."""
    _, more, _ = run(os.path.dirname(clean), "flow", clean, "--max-iterations", str(MORE))
    again, worst = more["result"], result["worst_vertices"][0]
    floor = f", rounding floor {again['rounding_floor']:.0e}" if again["rounding_floor"] else ""
    shape = more["input"]
    return (name, f"{shape['vertices']}, {shape['genus']}, {shape['boundary_loops']}", result["stop_reason"], str(result["flips"]),
            f"{result['max_curvature_error']:.1e} at vertex {worst['vertex']}",
            f"{again['area_ratio_min']:.0e} … {again['area_ratio_max']:.0e}" if again["area_ratio_min"] else "–",
            f"{again['stop_reason']} after {again['iterations']}: {again['max_curvature_error']:.0e}{floor}")


def kinds(result):
    return ", ".join(f"{d['code']} {d['count']}" for d in result["defect_counts"]) or "none"


rows, fails, flows, share, flow_bytes = [], [], 0, 0.0, 0.0
with tempfile.TemporaryDirectory() as out:
    for file in files:
        path = os.path.join(corpus, file["file"])
        limit = (64 << 20) + 20 * os.path.getsize(path)
        codes = []
        code, report, error = run(out, "info", path)
        codes.append(code)
        if report is None:
            rows.append((file["file"], error.split(": ", 2)[-1][:90], "–", "–", "3"))
            continue
        share = max(share, report["peak_bytes"] / limit)
        found, left, flow = kinds(report["result"]), "–", "–"
        clean = os.path.join(out, "clean.ply")
        code, report, error = run(out, "repair", path, "-o", clean, "--cut-edges", *(["--component", "0"] if report["input"]["faces"] else []))
        codes.append(code)
        if report:
            share = max(share, report["peak_bytes"] / limit)
            left = kinds(report["result"])
        if code == 0:
            code, report, error = run(out, "flow", clean)
            codes.append(code)
            if report["input"]["faces"] >= LARGE:
                flow_bytes = max(flow_bytes, report["peak_bytes"] / report["input"]["faces"])
            if not report["result"]["converged"]:
                fails.append(failing(file["file"], clean, report["result"]))
            flow = f"{report['result']['stop_reason']}, {report['result']['iterations']} steps"
            flows += report["result"]["converged"]
        rows.append((file["file"], found, left, flow, " ".join(map(str, codes))))

print("# Broken and odd files\n")
print(f"Made by `docs/results/bad.py`: `ricci info`, `ricci repair --cut-edges --component 0`, and `ricci flow` of the result where it is "
      f"admissible, on each of the {len(files)} files. Every run ended with exit code 0, 1 or 3, without a panic, with finite numbers in its "
      f"report. `info` and `repair` stayed within 64 MB + 20 × the file (the largest share was {100 * share:.0f} %); a flow with its layout "
      f"took at most {flow_bytes / 1000:.0f} kB per face (of surfaces with {LARGE} faces or more).\n")
print(f"Flows that reached their target, with flips as is the default: {flows} of {sum(r[3] != '–' for r in rows)}.\n")
if fails:
    print("## Flows that did not\n")
    print(f"Error: max |K − K̄|. Area: least and largest ratio of area in the layout to area on the surface, and the end of the flow, with "
          f"`--max-iterations {MORE}` instead of 200.\n")
    print("| file | vertices, genus, loops | why | flips | error | area | more steps |")
    print("|---|---|---|---|---|---|---|")
    for row in fails:
        print("| " + " | ".join(row) + " |")
    print("\\nLengths change there by factors as far apart as the square roots of the ratios: far for Newton's steps from u = 0, "
          "with many flips on the way, and with few digits left where they shrink most.\\n")
print("## All files\n")
print("| file | defects (or why it is refused) | left after repair | flow | exit codes |")
print("|---|---|---|---|---|")
for row in rows:
    print("| " + " | ".join(row) + " |")
