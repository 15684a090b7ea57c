#!/usr/bin/env python3
"""Seamless metrics of every mesh with the cones of the smoothest field, of meshes with sharp edges along these, of closed ones with a few placed cones,
and of random signatures, as tables.

usage: docs/results/seamless.py [CORPUS [NAME…]] > docs/results/seamless.md     (after: cargo build --release -p ricci-apps)
"""
import random

from page import build, euler, failures, file_of, genus, judged, loops, main, meshes, seconds, small, table, verdict

# Random signatures to a mesh, and the number of meshes, the smallest of each genus first.
TRIED, RANDOM_MESHES = 50, 4
# Vertices up to which the outside program reads the written map.
JUDGED = 70_000
# The angle of sharp edges, degrees, and the most vertices of meshes with sharp edges.
SHARP, CREASED = "40", 7_000

HEAD = ["mesh", "V", "genus", "cones", "valences", "flow + Newton", "angles off by", "smallest and largest area ratio", "largest dilatation",
        "symmetric Dirichlet", "straight edges, left out", "flipped, degenerate", "outside: seams, not exact, flipped, angles off", "s", "s of flow"]


def valences(cones):
    counts = {}
    for cone in cones:
        counts[cone["valence"]] = counts.get(cone["valence"], 0) + 1
    return ", ".join(f"{n} of {valence}" for valence, n in sorted(counts.items()))


def row(run, mesh, cones, *options):
    [path] = run.fresh("uv.obj")
    name = f"{mesh['name']}, {cones}"
    report, why = run.try_report("seamless", file_of(mesh), "--cones", cones, "--uv", path, *options, seconds=600)
    if report is None or not report["result"]["converged"]:
        off = small(report["result"]["holonomy_error"]) if report else "–"
        return [mesh["name"], mesh["V"], mesh["genus"], "not reached", str(why or "").strip()[:80], "–", off] + ["–"] * (len(HEAD) - 7)
    flow = run.report(f"{mesh['name']}, flow", "flow", file_of(mesh), "--space", "e2", "--uv", run.path("flow.obj"), seconds=600)
    run.bad += failures(name, report)
    r = report["result"]
    seen = "–"
    if int(mesh["V"]) <= JUDGED and r["flipped_triangles"] is not None:
        said = judged("seamless", path)
        if said:
            run.insist(said["seams_not_exact"] == 0 and said["valences_add_up"], f"{name}, outside: {said}")
            seen = f"{said['seam_edges']}, {said['seams_not_exact']}, {said['flipped']}, {small(said['worst_angle_off'])}"
    return [mesh["name"], mesh["V"], mesh["genus"], len(r["cones"]), valences(r["cones"]),
            f"{r['iterations'] - r['newton_iterations']} + {r['newton_iterations']}", small(r["holonomy_error"]),
            f"{small(r['area_ratio_min'])}, {small(r['area_ratio_max'])}", small(r["qc_max"]), small(r["symmetric_dirichlet"][1]),
            f"{r['straight_edges']}, {r['features_left_out']}",
            f"{r['flipped_triangles']}, {r['degenerate_pieces']}", seen, seconds(report), seconds(flow) if flow else "–"]


# Words of the messages by which signatures are refused that no metric has.
IMPOSSIBLE = ("flat torus", "[IKRSS13]", "[MS93]", "[KZ03]")


def signatures(run, mesh):
    """Random cones of valence 3 and 5 at random vertices, and random turning that is at most one quarter turn off the nearest."""
    draw, reached, steps, impossible, tried = random.Random(int(mesh["V"])), 0, [], 0, 0
    while tried < TRIED and impossible < 10 * TRIED:
        rest, cones, taken = 4 * euler(mesh), [], set()
        extra = draw.randrange(0, 4)
        quarters = [1, -1] * extra + [(1 if rest > 0 else -1)] * abs(rest)
        for q in quarters:
            v = draw.randrange(int(mesh["V"]))
            while v in taken:
                v = draw.randrange(int(mesh["V"]))
            taken.add(v)
            cones.append((v, 4 - q))
        table_of_cones = run.path("cones.csv")
        with open(table_of_cones, "w") as out:
            out.write("vertex,valence\n" + "".join(f"{v},{valence}\n" for v, valence in cones))
        report, why = run.try_report("seamless", file_of(mesh), "--cones", table_of_cones, seconds=300)
        if report is not None:
            turning = [t + draw.choice((-1, 0, 0, 0, 1)) for t in report["result"]["holonomy"]]
            report, why = run.try_report("seamless", file_of(mesh), "--cones", table_of_cones, f"--turning={','.join(map(str, turning))}", seconds=300)
        if report is None and any(word in str(why) for word in IMPOSSIBLE):
            impossible += 1
            continue
        tried += 1
        if report is not None and report["result"]["converged"]:
            reached += 1
            steps.append(report["result"]["newton_iterations"])
    steps.sort()
    return [mesh["name"], mesh["V"], mesh["genus"], f"{reached} of {tried}", impossible, steps[len(steps) // 2] if steps else "–", steps[-1] if steps else "–"]


def summed(rows):
    """How many meshes are reached, in how many steps and how soon."""
    reached = [dict(zip(HEAD, cells)) for cells in rows if cells[3] != "not reached"]
    steps = sorted(int(cells["flow + Newton"].split("+")[1]) for cells in reached)
    times = [float(cells["s"]) / max(float(cells["s of flow"]), 0.01) for cells in reached if cells["s of flow"] != "–"]
    told = f"Reached: {len(reached)} of {len(rows)}"
    if steps:
        told += f"; Newton steps {steps[len(steps) // 2]} in the median, {steps[-1]} at most"
    if times:
        told += f"; at most three times as long as `flow` for {sum(t <= 3 for t in times)} of {len(times)}, in the median {sorted(times)[len(times) // 2]:.1f} times"
    return told + "."


def has_sharp_edges(run, mesh):
    report, _ = run.try_report("info", file_of(mesh), "--sharp", SHARP)
    return report is not None and any(len(found) > 20 for found in sharp_edges(report["result"]))


def sharp_edges(figures):
    """Every list of sharp edges inside a report."""
    if isinstance(figures, dict):
        for name, value in figures.items():
            yield from [value] if name == "sharp_edges" and isinstance(value, list) else sharp_edges(value)


def content(run):
    closed = meshes(lambda mesh: loops(mesh) == 0)
    every = meshes()
    head = f"""# Seamless metrics of scanned surfaces

Made by `docs/results/seamless.py` with {build}: `ricci seamless MESH --uv`, every mesh of one component; *not reached*: the refusal, or how far angles are off. *flow + Newton*: steps of the conformal flow
with these cones and least-norm steps after it. *angles off by*: largest deviation, radians, around vertices and along loops that were found anew. *outside*: `check.py seamless`
on the written file: edges of seams, those that are not exactly a rotation by a multiple of 90°, faces that it finds turned over or without area, largest deviation of an
angle, radians. *symmetric Dirichlet*: 4 for an isometry, areas scaled to the same total. *straight edges, left out*: those of boundary and features, and features that are not
straight. *s of flow*: `ricci flow --space e2 --uv` of the same mesh; where other work runs
beside them, seconds compare within a row alone. Cross fields of libigl are not measured beside these: Debian has no package of its headers."""
    blocks = []
    creased = [mesh for mesh in every if int(mesh["V"]) <= CREASED and has_sharp_edges(run, mesh)]
    for title, those, key, cones, options in (
        ("Cones of the smoothest field, boundaries straight", every, "field", "field", ()),
        (f"Sharp edges of {SHARP}° straight", creased, "sharp", "field", ("--features", SHARP)),
        ("Eight placed cones", closed, "auto:8", "auto:8", ()),
    ):
        rows = [run.keep([mesh["name"], key], lambda: row(run, mesh, cones, *options)) for mesh in those]
        blocks.append(f"## {title}\n\n{summed(rows)}\n\n" + table(HEAD, rows))
    chosen = [mesh for mesh in closed if genus(mesh) > 0][:RANDOM_MESHES]
    blocks.append(f"""## Random signatures

Cones of valence 3 and 5 at random vertices, and turning that is the nearest to the conformal metric's but for two loops of five, which turn a quarter more or
less: {TRIED} to a mesh that are not known to be impossible, the first {len(chosen)} of genus 1 and more by genus and size. *refused as impossible*: signatures
drawn beside these that a theorem rules out.

""" + table(["mesh", "V", "genus", "reached", "refused as impossible", "median Newton steps", "most"],
            [run.keep([mesh["name"], "random"], lambda: signatures(run, mesh)) for mesh in chosen]))
    return [head, verdict(run.bad), *blocks]


main(content)
