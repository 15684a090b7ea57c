#!/usr/bin/env python3
"""Run `ricci flow` on every mesh of the corpus and write the tables: with flips for three targets, without for the default one.

usage: docs/results/flow.py [CORPUS [NAME…]] > docs/results/flow.md     (after: cargo build --release -p ricci-apps)

Two flows run at a time, on one thread each.
"""
import concurrent.futures
import math
import os
import random
import statistics
import sys
import tempfile

from page import CHECK, WHY, Run, corpus, file_of, genus, index, launch, loops, main, named, plain, read_obj, sides, table, write_rows

SCHEMES = ["yamabe", "inversive"]
RIGID = ["yamabe", "inversive", "thurston", "tangential"]
TARGETS = {
    "default": "Default space and target: four cones of π on closed genus 0, flat tori, H² with curvature 0 for closed genus ≥ 2, "
               "curvature on the boundary in proportion to its length on open surfaces.",
    "cones": "E², eight random cones on vertices that are flat otherwise, seeded by the mesh's name: on closed surfaces they carry 2πχ, each "
             "an eighth of it with up to ±π/2 added; on open ones, inside, they add up to 0 and the boundary carries 2πχ in proportion to "
             "its length.",
    "straight": "E², open surfaces: eight random cones carry all of 2πχ and the boundary is straight.",
    "single": "E², genus 1 to 3: all of 2πχ at vertex 0.",
}
TOLERANCE = 1e-10
SECONDS = 900

meshes = sorted((m for m in index(corpus) if not named or m["name"] in named), key=lambda m: (loops(m) > 0, genus(m), int(m["V"])))


def euler(mesh):
    return int(mesh["V"]) - int(mesh["E"]) + int(mesh["F"])


def boundary(mesh):
    """The boundary's length at each of its vertices: half of the two edges there."""
    points, faces = read_obj(file_of(mesh))
    known, length = sides(faces), {}
    for a, b in known:
        if (b, a) not in known:
            for v in (a, b):
                length[v] = length.get(v, 0.0) + math.dist(points[a], points[b]) / 2
    return length


def random_cones(mesh, target):
    """Vertices with their curvature; all others are flat. Drawn anew until all of it is admissible."""
    draw, edge = random.Random(mesh["name"]), boundary(mesh)
    total, n = 2 * math.pi * euler(mesh), int(mesh["V"])
    carried = target == "cones" and edge
    inside = [v for v in range(n) if v not in edge] if carried else range(n)
    while True:
        at = draw.sample(inside, 8)
        k = [draw.uniform(-math.pi / 2, math.pi / 2) for _ in at]
        miss = ((0 if carried else total) - sum(k)) / 8
        curvature = {v: x + miss for v, x in zip(at, k)}
        if all(x < (math.pi if v in edge else 2 * math.pi) for v, x in curvature.items()):
            break
    if carried:
        whole, most = sum(edge.values()), max(edge.values())
        equal = total * most / whole >= math.pi
        curvature |= {v: total * (1 / len(edge) if equal else x / whole) for v, x in edge.items()}
    return curvature


def options(run, mesh, target):
    if target in ("cones", "straight"):
        path = write_rows(run.path("cones.csv"), "vertex,curvature", random_cones(mesh, target).items())
        return ["--space", "e2", "--target", f"cones:{path}"]
    return ["--space", "e2", "--target", "single:0"] if target == "single" else []


def flow(mesh, scheme, target, flips="auto"):
    """The report's result, with what the outside program says of the files."""
    with tempfile.TemporaryDirectory() as folder:
        run, path = Run(folder), file_of(mesh)
        metric, uv = run.fresh("m.json", "uv.obj")
        line = ["flow", path, "--scheme", scheme, "--flips", flips, "--threads", "1", *options(run, mesh, target)]
        flat = target != "default" or loops(mesh) > 0 or genus(mesh) < 2
        files = flips == "auto"
        line += ["--metric", metric, *(["--uv", uv] if flat else [])] if files else []
        code, found, said = launch(folder, *line, seconds=SECONDS)
        if code is None:
            return {"done": False, "stop_reason": f"{SECONDS} seconds"}
        if found is None or "converged" not in found["result"]:
            return {"done": False, "stop_reason": said}
        result = {**found["result"], "seconds": found["seconds"], "code": code}
        result["failed"] = [name for name, check in found["checks"].items() if not check["holds"]]
        result["done"] = result["converged"] and result["max_curvature_error"] <= TOLERANCE and result["broken_triangles"] == 0
        if files and CHECK:
            result["metric"] = CHECK.metric(metric)
            result["uv"] = CHECK.uv(uv, path) if os.path.exists(uv) else None
        return result


def on_input(mesh):
    """The layout of the default flow on the input's own faces: how many the program says fold, and the outside verdict."""
    with tempfile.TemporaryDirectory() as folder:
        path, uv = file_of(mesh), os.path.join(folder, "uv.obj")
        code, report, _ = launch(folder, "flow", path, "--uv", uv, "--on", "input", "--threads", "1", seconds=SECONDS)
        written = report is not None and os.path.exists(uv)
        found = CHECK.corners(uv, path) if CHECK and written else {}
        return {"written": written, "folded": report["result"]["flipped_input_faces"] if written else None, **found}


def work(mesh):
    print(mesh["name"], file=sys.stderr)
    targets = ["default", "cones"] + ["straight"] * (loops(mesh) > 0) + ["single"] * (1 <= genus(mesh) <= 3)
    flown = {(target, scheme): flow(mesh, scheme, target) for target in targets for scheme in SCHEMES}
    return flown, {scheme: flow(mesh, scheme, "default", "never") for scheme in RIGID}, on_input(mesh)


def kind(mesh):
    if loops(mesh):
        return "open"
    return "closed, genus " + ("≥ 2" if genus(mesh) >= 2 else mesh["genus"])


def middle(values):
    return plain(statistics.median_low(values), "d") if values else "–"


def why(x):
    text = x["stop_reason"].replace("_", " ")
    text += f" ({x['broken_triangles']})" if text == "broken triangles" else ""
    text += f" ({len(x['obstruction']['vertices'])})" if text == "infeasible" and x.get("obstruction") else ""
    return text if len(text) < 60 else text[:57] + "…"


def summary(flown):
    for target in TARGETS:
        for scheme in SCHEMES:
            r = [x[target, scheme] for _, x in flown if (target, scheme) in x]
            done = [x for x in r if x["done"]]
            laid = [x for x in done if x.get("flipped_triangles") is not None]
            metric = [x["metric"] for x in done if x.get("metric")]
            uv = [x["uv"] for x in done if x.get("uv")]
            steps = [x["iterations"] for x in done]
            yield (target, scheme, f"{len(done)} of {len(r)}", f"{middle(steps)}, {max(steps, default='–')}",
                   middle([x["flips"] for x in done]), plain(max((x["max_curvature_error"] for x in done), default=None), ".0e"),
                   f"{sum(x['flipped_triangles'] == 0 for x in laid)} of {len(laid)}", sum(x["degenerate_pieces"] for x in laid),
                   f"{sum(x['max_curvature_error'] <= TOLERANCE and x['broken_triangles'] == 0 for x in metric)} of {len(metric)}",
                   f"{sum(x['flipped'] == 0 and x['first_vertices_kept'] for x in uv)} of {len(uv)}")


def classes(flown):
    for name in ["closed, genus 0", "closed, genus 1", "closed, genus ≥ 2", "open"]:
        row = [name, sum(kind(m) == name for m, _ in flown)]
        for target in TARGETS:
            for scheme in SCHEMES:
                r = [x[target, scheme] for m, x in flown if kind(m) == name and (target, scheme) in x]
                r = [x for x in r if x["done"]]
                steps = [x["iterations"] for x in r]
                row.append(f"{middle(steps)}, {max(steps)}, {middle([x['flips'] for x in r])}" if r else "–")
        yield row


def missing(flown):
    for target in TARGETS:
        for m, x in flown:
            for scheme in SCHEMES:
                r = x.get((target, scheme))
                if r and not r["done"]:
                    yield m["name"], target, scheme, why(r), r.get("iterations", "–"), plain(r.get("max_curvature_error"), ".0e")


def details(flown, target):
    for m, x in flown:
        for scheme in SCHEMES:
            r = x.get((target, scheme))
            if r is None:
                continue
            if "seconds" not in r:
                yield m["name"], m["V"], m["genus"], m["boundary_loops"], scheme, why(r), *["–"] * 11
                continue
            metric, uv, get = r.get("metric"), r.get("uv"), r.get
            fails = ", ".join(r["failed"]).replace("_", " ")
            yield (m["name"], m["V"], m["genus"], m["boundary_loops"], scheme,
                   ("yes" if r["done"] else why(r)) + (f" ! {fails}" if fails else ""), r["iterations"], r["flips"],
                   f"{r['seconds']['total']:.2f}", f"{r['max_curvature_error']:.0e}", plain(get("qc_mean"), ".3f"),
                   plain(get("qc_max"), ".3g"), plain(get("flipped_triangles"), "d"), plain(get("degenerate_pieces"), "d"),
                   plain(get("crossings"), "d"), plain(metric and metric["max_curvature_error"], ".0e"),
                   "–" if not uv else f"{uv['flipped']}, {uv['degenerate']}")


def rigid_cell(x):
    if not x["done"]:
        return why(x)
    return f"{x['iterations']}" + (f" ! {x['flipped_triangles']} flipped" if x["flipped_triangles"] else "")


def content(_):
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        results = list(pool.map(work, meshes))
    flown = [(m, x) for m, (x, _, _) in zip(meshes, results)]
    rigid = [(m, x) for m, (_, x, _) in zip(meshes, results)]
    given = [(m, x) for m, (_, _, x) in zip(meshes, results)]
    whole = sum(int(m["F"]) for m, _ in given)
    folded = sum(x["folded"] or 0 for _, x in given)
    same = sum(bool(x.get("same_faces")) for _, x in given)
    head = ["mesh", "V", "genus", "loops", "scheme", "reached", "steps", "flips", "seconds", "error", "qc mean", "qc max", "flipped",
            "degenerate", "crossings", "outside error", "outside flipped, degenerate"]
    return [
        "# Flow on the mesh corpus",
        f"Made by `docs/results/flow.py`: `ricci flow` on each of the {len(meshes)} meshes. Reached: converged, max |K − K̄| ≤ 1e-10, no "
        "broken triangle. Flips: those of the flow and the isometric ones before it, on the double of an open surface. Seconds: the whole "
        "command on one thread, files included.",
        "\n".join(f"- *{name}*: {text}" for name, text in TARGETS.items()),
        "## With flips",
        f"No outside verdict: {WHY}." if WHY else
        "The last two columns are the verdict of a program that shares nothing with this project (`check.py metric`, `check.py uv`), on the "
        "files written: how many metrics have max |K − K̄| ≤ 1e-10 and no broken triangle, recomputed from faces and lengths in long "
        "doubles (which slivers of 1e-9 and thinner exhaust); how many layouts have no flipped triangle and keep the input's vertices.",
        table(["target", "scheme", "reached", "steps: median, most", "median flips", "largest error", "layouts without flipped triangles",
               "degenerate pieces", "outside: metrics", "outside: layouts"], summary(flown)),
        "Per class: steps (median, most), median flips.",
        table(["class", "meshes"] + [f"{target} {scheme}" for target in TARGETS for scheme in SCHEMES], classes(flown)),
        "Not reached: u is beyond ±5e5 (diverged), rounding holds the error above 1e-10 (rounding floor: the report "
        "states it; stalled), or Newton's method takes more than 500 steps.",
        table(["mesh", "target", "scheme", "why", "steps", "error"], missing(flown)),
        "## Every flow",
        "Error: max |K − K̄| of the flow. qc: quasi-conformal dilatation of the layout, area-weighted mean and maximum. Flipped and "
        "degenerate: pieces of the layout. Crossings: vertices of the common subdivision that are none of the input's. Outside: error of the "
        "metric file; flipped and degenerate pieces of the layout file. A dash where there is no layout (H²) or no refinement (no flip). `!`: a "
        "check of the report that does not hold.",
        *(block for target in TARGETS for block in (f"### {target}", table(head, details(flown, target)))),
        "## Without flips",
        "`--flips never`, default target: steps where reached, otherwise why not: the energy is least with that many broken triangles; or "
        "infeasible, and how many vertices prove it. `!`: reached, but triangles of the layout are flipped.",
        table(["", *RIGID], [["reached", *(f"{sum(x[s]['done'] for _, x in rigid)} of {len(rigid)}" for s in RIGID)]]),
        table(["mesh", *RIGID], [[m["name"], *(rigid_cell(x[s]) for s in RIGID)] for m, x in rigid]),
        "## On the input's own faces",
        "`--on input`, default target: the layout made linear on each face of the input. Folded: faces of the input that turn over then "
        "(the exact map, on the refinement, turns none over), as the report says and as `check.py corners` counts.",
        f"{sum(x['written'] for _, x in given)} of {len(given)} meshes written; {same} with the input's own faces, and so with seams on its "
        f"edges, by the outside program. {folded} of {whole} faces folded: {100 * folded / whole:.2f} %.",
        table(["mesh", "faces", "folded", "share", "outside: folded"],
              [(m["name"], m["F"], x["folded"], f"{100 * (x['folded'] or 0) / int(m['F']):.2f} %", x.get("flipped", "–")) for m, x in given]),
    ]


main(content)
