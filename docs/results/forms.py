#!/usr/bin/env python3
"""Harmonic and holomorphic 1-forms of every closed mesh of genus 1 and more, and of known surfaces on finer meshes, as tables.

usage: docs/results/forms.py [CORPUS [NAME…]] > docs/results/forms.md     (after: cargo build --release -p ricci-apps)

RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository).
"""
import csv
import json
import math
import os
import subprocess
import sys
import tempfile

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
corpus = sys.argv[1] if len(sys.argv) > 1 else os.path.join(root, "..", "shared", "meshes", "good")
ricci = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release", "ricci")
judge = os.environ.get("RICCI_CHECK", os.path.join(root, "..", "shared", "tools", "check.py"))
# Values in a file above which the outside program, which holds them all at 16 bytes each, is not asked.
JUDGED = 12_000_000


def run(folder, *arguments):
    report = os.path.join(folder, "report.json")
    if os.path.exists(report):
        os.remove(report)
    done = subprocess.run([ricci, *arguments, "--quiet", "--report", report], capture_output=True, text=True)
    return (json.load(open(report)), done.returncode) if os.path.exists(report) else (None, done.stderr.strip())


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def small(x):
    return "0" if x == 0 else f"{x:.1e}" if abs(x) < 1e-2 or abs(x) >= 1e4 else f"{x:.3g}"


def corpus_table(folder):
    meshes = list(csv.DictReader(open(os.path.join(corpus, "INDEX.csv"))))
    chosen = [m for m in meshes if int(m["boundary_loops"]) == 0 and int(m["genus"]) > 0 and int(m["components"]) == 1]
    chosen = [m for m in chosen if not sys.argv[2:] or m["name"] in sys.argv[2:]]
    rows, bad = [], []
    for mesh in sorted(chosen, key=lambda m: (int(m["genus"]), int(m["V"]))):
        path, out = os.path.join(corpus, mesh["file"]), os.path.join(folder, "F.json")
        values = 2 * int(mesh["genus"]) * int(mesh["E"])
        report, code = run(folder, "forms", path, *(["--forms", out] if values <= JUDGED else []))
        if report is None or "closedness" not in report["result"]:
            bad.append(f"{mesh['name']}: {code if report is None else report['result']}")
            continue
        r, s = report["result"], report["seconds"]
        bad += [f"{mesh['name']}: {k}" for k, c in report["checks"].items() if not c["holds"]]
        seen = "–"
        if values <= JUDGED and os.path.exists(judge):
            said = json.loads(subprocess.run([sys.executable, judge, "forms", out], capture_output=True, text=True).stdout)
            if said["rank"] != 2 * said["genus"] or said["faces_of_positive_index"] or said["coclosedness"] > 1e-10:
                bad.append(f"{mesh['name']}, outside: {said}")
            seen = f"{said['rank']}, {small(said['closedness'])}, {small(said['coclosedness'])}"
        zeros = {sum(z["multiplicity"] for z in of) for of in r["zeros"]}
        modulus = "{:.5f} + {:.5f} i".format(*r["modulus"]) if "modulus" in r else ""
        rows.append([
            mesh["name"], mesh["V"], mesh["genus"], str(r["flips"]), small(r["coclosedness"]), small(r["riemann_min_eigenvalue"]),
            small(r["riemann_symmetry"]), small(r["star_residual"]), ", ".join(map(str, zeros)), str(r["largest_index"]), modulus, seen,
            f"{s['build'] + s['assemble'] + s['analyse']:.2f}", f"{s['factor']:.2f}", f"{s['solve']:.2f}", f"{s['total']:.2f}",
        ])
    head = ["mesh", "V", "genus", "flips", "d*ω", "least eigenvalue", "‖Π−Πᵀ‖/‖Π‖", "‖J²+1‖", "zeros", "largest index", "modulus",
            "outside: rank, dω, d*ω", "loops, matrix s", "factor s", "solves s", "all s"]
    return table(head, rows), bad


def family(folder, name, sizes, make, exact=None):
    """The same surface on finer meshes; each error with the factor by which it has fallen."""
    rows, before = [], None
    for n in sizes:
        path = os.path.join(folder, "m.json" if exact is None else "m.obj")
        subprocess.run([ricci, "make", *make(n), "-o", path, "--quiet"], check=True, capture_output=True)
        report, code = run(folder, "forms", path)
        if report is None:
            rows.append([name, str(n), str(code)])
            continue
        r = report["result"]
        errors = [r["star_residual"], r["riemann_symmetry"]]
        errors += [abs(complex(*r["modulus"]) - exact)] if exact is not None else []
        fallen = ["" if before is None or e < 1e-12 else f" (÷{b / e:.2f})" for e, b in zip(errors, before or errors)]
        cells = [("0" if e < 1e-12 else small(e)) + f for e, f in zip(errors, fallen)]
        rows.append([name, str(report["input"]["vertices"]), *cells, *([] if exact is not None else [""])])
        before = errors
    return rows


def main():
    with tempfile.TemporaryDirectory() as folder:
        text, bad = corpus_table(folder)
        rows = []
        if not sys.argv[2:]:
            exact = 1j * math.sqrt(2 * 2 - 0.8 * 0.8) / 0.8
            torus = lambda n: ["torus", "--big", "2", "--small", "0.8", "-n", str(2 * n), "-m", str(n)]
            rows += family(folder, "torus of revolution", [16, 32, 64, 128], torus, exact)
            rows += family(folder, "Bolza", [2, 3, 4, 5, 6], lambda n: ["bolza", "--level", str(n)])
    print("# Harmonic and holomorphic 1-forms\n")
    print("Every closed mesh of the corpus of genus 1 and more, made by `docs/results/forms.py`: `ricci forms MESH` with default options, on the")
    print("intrinsic Delaunay triangulation. Times are those of one run on a shared machine and say little.\n")
    print("All checks of every report hold.\n" if not bad else "What fails:\n" + "\n".join(f"- {line}" for line in bad) + "\n")
    print("*d\\*ω*: largest of any form at any vertex, over the form's largest value; dω is 0 without rounding. *zeros*: of each holomorphic form of the")
    print("basis, with multiplicity: 2g − 2. *largest index* of a real form of the basis at a vertex or a face: never positive where")
    print("values are above the form's rounding, which they are not far out on horns. *outside*: check.py on")
    print("the file, where that is not too large for it.\n")
    print(text)
    if rows:
        print("\n## Rates\n\nEach error with the factor by which it has fallen since the row before, where the edges are halved.\n")
        print(table(["surface", "V", "‖J²+1‖", "‖Π−Πᵀ‖/‖Π‖", "modulus off by"], rows))


main()
