#!/usr/bin/env python3
"""Give every open mesh of the corpus with χ < 0 a geodesic boundary, and write the table.

usage: docs/results/boundaries.py [CORPUS [NAME…]] > docs/results/boundaries.md     (after: cargo build --release -p ricci-apps)

RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository);
where it or numpy is absent, the page says so.
"""
import os
import tempfile

from page import file_of, failures, judge, judged, meshes, run, small, table, verdict


def euler(mesh):
    return 2 - 2 * int(mesh["genus"]) - int(mesh["boundary_loops"])


rows = meshes(lambda m: int(m["boundary_loops"]) > 0 and euler(m) < 0,
              lambda m: (int(m["genus"]), int(m["boundary_loops"]), int(m["V"])))


def row(folder, mesh):
    path = file_of(mesh)
    uv, deck = (os.path.join(folder, name) for name in ("uv.obj", "deck.json"))
    r, why = run(folder, "uniformize", path, "--uv", uv, "--generators", deck)
    name = [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"]]
    if r is None:
        return name + [why], [f"{mesh['name']}: {why}"]
    result, checks = r["result"], r["checks"]
    seen = [judged("uv", uv, path, "h2"), judged("deck", deck)]
    outside = "–" if None in seen else f"{seen[0]['flipped']}, {small(seen[1]['relative'])}"
    lengths, domain = result["boundary_lengths"], result["domain"]
    cells = name + [
        str(result["iterations"]), str(result["flips"]), small(checks["boundary_straightness"]["value"]),
        small(checks["boundary_turning"]["value"]), small(checks["area"]["value"]), f"{min(lengths):.3f}–{max(lengths):.3f}",
        small(result["relation_residual"]) if result["relation_residual"] < 1 else "none", f"{result['radius']:.1f}",
        str(domain["sides"]) if domain else "none", f"{result['qc_mean']:.3f}", outside, f"{r['seconds']['total']:.2f}",
    ]
    return cells, failures(mesh["name"], r)


def main():
    head = ["mesh", "V", "genus", "loops", "steps", "flips", "straight to", "turning", "area off −2πχ", "boundary lengths", "relation", "radius",
            "Dirichlet sides", "mean dilatation", "outside: flipped, relation", "s"]
    with tempfile.TemporaryDirectory() as folder:
        done = [row(folder, mesh) for mesh in rows]
    bad = [why for _, failed in done for why in failed]
    print("# Geodesic boundaries\n")
    print(f"Every open mesh of the corpus with χ < 0 ({len(rows)}), made by `docs/results/boundaries.py`: `ricci uniformize MESH` with default options. "
          "Times are those of one run on a shared machine and say little.\n")
    print(verdict(bad) + "\n")
    print("*straight to*: largest distance of a vertex of the boundary from the geodesic through two lifts of one of its vertices. *turning*: largest "
          "difference of the angles at a vertex of the boundary from π, radians. *relation*: of the canonical generators, relative to the largest "
          f"matrix on the way. *outside*: what an independent program finds in the files ({os.path.basename(judge)}).\n")
    print(table(head, [cells for cells, _ in done]))


main()
