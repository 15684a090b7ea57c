#!/usr/bin/env python3
"""Give every open mesh of the corpus with χ < 0 a geodesic boundary, and write the table.

usage: docs/results/boundaries.py [CORPUS [NAME…]] > docs/results/boundaries.md     (after: cargo build --release -p ricci-apps)
"""
import os

from page import euler, file_of, genus, judge, judged, loops, main, meshes, seconds, small, table, verdict

HEAD = ["mesh", "V", "genus", "loops", "steps", "flips", "straight to", "turning", "area off −2πχ", "boundary lengths", "relation", "radius",
        "Dirichlet sides", "mean dilatation", "outside: flipped, relation", "s"]


def row(run, mesh):
    path, (uv, deck) = file_of(mesh), run.fresh("uv.obj", "deck.json")
    name = [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"]]
    report = run.report(mesh["name"], "uniformize", path, "--uv", uv, "--generators", deck)
    if report is None:
        return name + [run.bad[-1].removeprefix(f"{mesh['name']}: ")]
    result, checks = report["result"], report["checks"]
    seen = [judged("uv", uv, path, "h2"), judged("deck", deck)]
    lengths, domain = result["boundary_lengths"], result["domain"]
    return name + [
        result["iterations"], result["flips"], small(checks["boundary_straightness"]["value"]), small(checks["boundary_turning"]["value"]),
        small(checks["area"]["value"]), f"{min(lengths):.3f}–{max(lengths):.3f}",
        small(result["relation_residual"]) if result["relation_residual"] < 1 else "none", f"{result['radius']:.1f}",
        domain["sides"] if domain else "none", f"{result['qc_mean']:.3f}",
        "–" if None in seen else f"{seen[0]['flipped']}, {small(seen[1]['relative'])}", seconds(report),
    ]


def content(run):
    chosen = meshes(lambda m: loops(m) > 0 and euler(m) < 0, lambda m: (genus(m), loops(m), int(m["V"])))
    rows = run.rows(chosen, row)
    return [
        "# Geodesic boundaries",
        f"Every open mesh of the corpus with χ < 0 ({len(chosen)}), made by `docs/results/boundaries.py`: `ricci uniformize MESH` with default options. "
        "Times are those of one run on a shared machine and say little.",
        verdict(run.bad),
        "*straight to*: largest distance of a vertex of the boundary from the geodesic through two lifts of one of its vertices. *turning*: largest "
        "difference of the angles at a vertex of the boundary from π, radians. *relation*: of the canonical generators, relative to the largest "
        f"matrix on the way. *outside*: what an independent program finds in the files ({os.path.basename(judge)}).",
        table(HEAD, rows),
    ]


main(content)
