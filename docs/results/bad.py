#!/usr/bin/env python3
"""Diagnose, repair and flow every broken or odd file of the corpus, and write the table.

usage: docs/results/bad.py [CORPUS] > docs/results/bad.md     (after: cargo build --release -p ricci-apps)
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
ricci = os.path.join(root, "target", "release", "ricci")
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


def kinds(result):
    return ", ".join(f"{d['code']} {d['count']}" for d in result["defect_counts"]) or "none"


rows, flows, worst, over = [], 0, 0.0, 0
with tempfile.TemporaryDirectory() as out:
    for file in files:
        path = os.path.join(corpus, file["file"])
        limit = (64 << 20) + 20 * os.path.getsize(path)
        codes, peaks = [], []
        code, report, error = run(out, "info", path)
        codes.append(code)
        if report is None:
            rows.append((file["file"], error.split(": ", 2)[-1][:90], "–", "–", "3"))
            continue
        peaks.append(report["peak_bytes"])
        found, left, flow = kinds(report["result"]), "–", "–"
        clean = os.path.join(out, "clean.ply")
        code, report, error = run(out, "repair", path, "-o", clean, "--cut-edges", *(["--component", "0"] if report["input"]["faces"] else []))
        codes.append(code)
        if report:
            peaks.append(report["peak_bytes"])
            left = kinds(report["result"])
        if code == 0:
            code, report, error = run(out, "flow", clean)
            codes.append(code)
            peaks.append(report["peak_bytes"])
            flow = f"{report['result']['stop_reason']}, {report['result']['iterations']} steps"
            flows += report["result"]["converged"]
        worst = max(worst, max(peaks) / limit)
        over += max(peaks) > limit
        rows.append((file["file"], found, left, flow, " ".join(map(str, codes))))

print("# Broken and odd files\n")
print(f"Made by `docs/results/bad.py`: `ricci info`, `ricci repair --cut-edges --component 0`, and `ricci flow` of the result where it is "
      f"admissible, on each of the {len(files)} files. Every run ended with exit code 0, 1 or 3, without a panic, with finite numbers in its "
      f"report, and within 64 MB + 20 × the file (the largest share was {100 * worst:.0f} %; {over} files above).\n")
print(f"Flows that reached their target without flips: {flows} of {sum(r[3] != '–' for r in rows)}.\n")
print("| file | defects (or why it is refused) | left after repair | flow | exit codes |")
print("|---|---|---|---|---|")
for row in rows:
    print("| " + " | ".join(row) + " |")
