#!/usr/bin/env python3
"""Give every open mesh of the corpus with χ < 0 a geodesic boundary, and write the table.

usage: docs/results/boundaries.py [CORPUS [NAME…]] > docs/results/boundaries.md     (after: cargo build --release -p ricci-apps)

RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository);
where it or numpy is absent, the page says so.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
corpus = sys.argv[1] if len(sys.argv) > 1 else os.path.join(root, "..", "shared", "meshes", "good")
judge = os.environ.get("RICCI_CHECK", os.path.join(root, "..", "shared", "tools", "check.py"))
ricci = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(root, "target")), "release", "ricci")


def euler(mesh):
    return 2 - 2 * int(mesh["genus"]) - int(mesh["boundary_loops"])


rows = [m for m in csv.DictReader(open(os.path.join(corpus, "INDEX.csv"))) if int(m["components"]) == 1 and int(m["boundary_loops"]) > 0]
rows = [m for m in rows if euler(m) < 0 and (not sys.argv[2:] or m["name"] in sys.argv[2:])]
rows.sort(key=lambda m: (int(m["genus"]), int(m["boundary_loops"]), int(m["V"])))


def small(x):
    return "0" if x == 0 else f"{x:.1e}" if abs(x) < 1e-2 or abs(x) >= 1e4 else f"{x:.3g}"


def outside(*arguments):
    """What the outside program says of a file; None where it does not run."""
    done = subprocess.run([sys.executable, judge, *arguments], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else None


def row(folder, mesh):
    path = os.path.join(corpus, mesh["file"])
    uv, deck, report = (os.path.join(folder, name) for name in ("uv.obj", "deck.json", "report.json"))
    arguments = ["uniformize", path, "--uv", uv, "--generators", deck, "--report", report, "--quiet"]
    done = subprocess.run([ricci, *arguments], capture_output=True, text=True)
    name = [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"]]
    if not os.path.exists(report):
        return name + [done.stderr.strip()], mesh["name"] + ": " + done.stderr.strip()
    r = json.load(open(report))
    os.remove(report)
    result, checks = r["result"], r["checks"]
    failed = [k for k, c in checks.items() if not c["holds"]]
    seen = [outside("uv", uv, path, "h2"), outside("deck", deck)]
    verdict = "–" if None in seen else f"{seen[0]['flipped']}, {small(seen[1]['relative'])}"
    lengths, domain = result["boundary_lengths"], result["domain"]
    cells = name + [
        str(result["iterations"]), str(result["flips"]), small(checks["boundary_straightness"]["value"]),
        small(checks["boundary_turning"]["value"]), small(checks["area"]["value"]), f"{min(lengths):.3f}–{max(lengths):.3f}",
        small(result["relation_residual"]) if result["relation_residual"] < 1 else "none", f"{result['radius']:.1f}",
        str(domain["sides"]) if domain else "none", f"{result['qc_mean']:.3f}", verdict, f"{r['seconds']['total']:.2f}",
    ]
    return cells, mesh["name"] + ": " + ", ".join(failed) if failed else None


def main():
    head = ["mesh", "V", "genus", "loops", "steps", "flips", "straight to", "turning", "area off −2πχ", "boundary lengths", "relation", "radius",
            "Dirichlet sides", "mean dilatation", "outside: flipped, relation", "s"]
    with tempfile.TemporaryDirectory() as folder:
        done = [row(folder, mesh) for mesh in rows]
    bad = [why for _, why in done if why]
    print("# Geodesic boundaries\n")
    print(f"Every open mesh of the corpus with χ < 0 ({len(rows)}), made by `docs/results/boundaries.py`: `ricci uniformize MESH` with default options. "
          "Times are those of one run on a shared machine and say little.\n")
    print("All checks of every report hold.\n" if not bad else "Not everything holds:\n\n" + "\n".join(f"- {line}" for line in bad) + "\n")
    print("*straight to*: largest distance of a vertex of the boundary from the geodesic through two lifts of one of its vertices. *turning*: largest "
          "difference of the angles at a vertex of the boundary from π, radians. *relation*: of the canonical generators, relative to the largest "
          f"matrix on the way. *outside*: what an independent program finds in the files ({os.path.basename(judge)}).\n")
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for cells, _ in done:
        print("| " + " | ".join(cells) + " |")


main()
