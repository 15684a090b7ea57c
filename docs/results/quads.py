#!/usr/bin/env python3
"""Quad meshes of two sizes of every mesh, those along sharp edges, and the coarsest layouts, as tables.

usage: docs/results/quads.py [CORPUS [NAME…]] > docs/results/quads.md     (after: cargo build --release -p ricci-apps)
"""
import math

from page import CAD, build, failures, file_of, genus, judged, loops, main, meshes, read_obj, seconds, small, table, verdict

# About so many quads, and the sizes of the tables.
SIZES = (1000, 10_000)
# The angle of sharp edges, degrees.
SHARP = "40"
# Most seconds of a run.
LONGEST = 300

HEAD = ["mesh", "V", "genus", "loops", "quads", "irregular, cones", "angles off 90°: mean, most", "edges: deviation over mean", "distance: rms, most",
        "outside: pure, χ, valences", "s", "s of seamless"]


def row(run, mesh, *options):
    name = f"{mesh['name']}, {' '.join(options)}"
    [path] = run.fresh("quads.obj")
    report, why = run.try_report("quads", file_of(mesh), "-o", path, *options, seconds=LONGEST)
    if report is None:
        run.bad.append(f"{name}: {why}")
        return [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"], str(why).strip()[:120]] + ["–"] * (len(HEAD) - 5)
    run.bad += failures(name, report)
    r = report["result"]
    size = diagonal(file_of(mesh))
    said, seen = judged("quads", path), "–"
    if said:
        pure = said["corners"] == [4] and said["edges_used_twice"] == 0 and said["repeated_corner"] == 0
        same = said["euler"] == 2 - 2 * genus(mesh) - loops(mesh)
        run.insist(pure and same and said["valences_add_up"], f"{name}, outside: {said}")
        seen = f"{'yes' if pure else 'no'}, {said['euler']}, {'yes' if said['valences_add_up'] else 'no'}"
    sharp = [word for pair in zip(options, options[1:]) for word in pair if pair[0] == "--features"]
    flat = run.report(f"{name}, seamless", "seamless", file_of(mesh), "--uv", run.path("seamless.obj"), *sharp, seconds=LONGEST)
    return [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"], r["quads"], f"{r['irregular']}, {r['cones']}",
            f"{math.degrees(r['angle_mean']):.1f}, {math.degrees(r['angle_max']):.0f}", f"{r['edge_deviation']:.2f}",
            f"{small(r['distance_rms'] / size)}, {small(r['distance_max'] / size)}", seen, seconds(report), seconds(flat) if flat else "–"]


def diagonal(path):
    places, _ = read_obj(path)
    return math.dist([min(x) for x in zip(*places)], [max(x) for x in zip(*places)])


LAYOUT_HEAD = ["mesh", "V", "genus", "loops", "cones", "patches", "least", "over the least", "s"]


def layout(run, mesh, *options):
    name = f"{mesh['name']}, layout"
    report, why = run.try_report("layout", file_of(mesh), "-o", run.path("layout.json"), *options, seconds=LONGEST)
    if report is None:
        run.bad.append(f"{name}: {why}")
        return [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"], str(why).strip()[:120]] + ["–"] * (len(LAYOUT_HEAD) - 5)
    run.bad += failures(name, report)
    r = report["result"]
    least = least_patches(mesh, r["cones"]) if loops(mesh) == 0 else None
    over = f"{r['patches'] / least:.1f}" if least else "–"
    return [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"], r["cones"], r["patches"], least or "–", over, seconds(report)]


def least_patches(mesh, cones):
    """Patches of a closed layout whose nodes are these cones alone: V - E + F = χ with E = 2 F."""
    return max(cones - (2 - 2 * genus(mesh)), 1)


def summed(rows):
    """How many meshes have quads, and how soon."""
    done = [dict(zip(HEAD, cells)) for cells in rows if cells[-2] != "–"]
    times = sorted(float(cells["s"]) / max(float(cells["s of seamless"]), 0.02) for cells in done if cells["s of seamless"] != "–")
    told = f"Quad meshes: {len(done)} of {len(rows)}"
    if times:
        told += f"; at most three times as long as `seamless` for {sum(t <= 3 for t in times)} of {len(times)}, in the median {times[len(times) // 2]:.1f} times"
    return told + "."


def content(run):
    every = meshes()
    blocks = []
    for size in SIZES:
        rows = [run.keep([mesh["name"], size], lambda: row(run, mesh, "--faces", str(size))) for mesh in every]
        blocks.append(f"## About {size} quads\n\n{summed(rows)}\n\n" + table(HEAD, rows))
    rows = [run.keep([mesh["name"], "sharp"], lambda: row(run, mesh, "--faces", str(SIZES[-1]), "--features", SHARP)) for mesh in every if mesh["name"] in CAD]
    blocks.append(f"## About {SIZES[-1]} quads, sharp edges of {SHARP}° kept\n\n{summed(rows)}\n\n" + table(HEAD, rows))
    rows = [run.keep([mesh["name"], "layout"], lambda: layout(run, mesh)) for mesh in every]
    found = [cells for cells in rows if cells[-1] != "–"]
    few = [cells for cells in found if cells[-2] != "–" and float(cells[-2]) <= 3]
    closed = [cells for cells in found if cells[-2] != "–"]
    blocks.append(f"## Coarsest layouts\n\nLayouts: {len(found)} of {len(rows)}; of the closed surfaces {len(few)} of {len(closed)} have at most three times the patches of a layout "
                  "whose only nodes are the cones (*least*: cones − χ).\n\n" + table(LAYOUT_HEAD, rows))
    head = f"""# Quad meshes and layouts of scanned surfaces

Made by `docs/results/quads.py` with {build}: `ricci quads MESH` and `ricci layout MESH`, every mesh of one component. *irregular, cones*: vertices without four quads, and
cones of the seamless metric. *distance*: of the mesh's vertices from the quads and of the quads' middles from the mesh, over the diagonal. *outside*: `check.py quads` on the written file: quads alone, each edge used once
on either side; Euler characteristic; Σ (4 − valence) = 4 χ. *s of seamless*: `ricci seamless MESH --uv` of the same mesh."""
    return [head, verdict(run.bad), *blocks]


main(content)
