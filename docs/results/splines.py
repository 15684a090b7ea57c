#!/usr/bin/env python3
"""Splines near meshes of the corpus, what an outside program says of them, and their patches for CAD, as tables.

usage: docs/results/splines.py [CORPUS [NAME…]] > docs/results/splines.md     (after: cargo build --release -p ricci-apps)
"""
import csv
import json
import math
import os
import random
import subprocess

import page

# Meshes of the table: connected, with so many vertices.
SIZES = range(500, 60_001)
# Most vertices of meshes whose splines the outside program evaluates, and that are exported if they hold.
JUDGED, EXPORTED = 2500, 2500
# Most vertices of surfaces that are fitted over a holomorphic 1-form too.
BY_FORM = 2500
# Seconds that a command may take, and the outside program, which evaluates every basis function by itself.
PATIENCE, JUDGING = 300, 60
# Places inside patches where the outside program evaluates the spline, the share of them that lie near a side and how near, and
# places on sides between two patches. There the outside program counts both of two functions that end at the side.
INSIDE, BESIDE, NEAR, ASIDE = 30, 10, 1e-4, 30
RMS, MOST = 1e-3, 1e-2


def jobs(meshes):
    """Each mesh and how it is fitted: `flow`, or `form` too on closed surfaces of genus 2 and more."""
    for mesh in meshes:
        yield mesh, 3, "flow"
        if page.loops(mesh) == 0 and int(mesh["genus"]) > 1 and int(mesh["V"]) <= BY_FORM:
            yield mesh, 3, "form"


def fit(run, mesh, degree, kind):
    """One spline: the figures of its reports, what the outside program says, and what fails."""
    row = {"mesh": mesh["name"], "degree": degree, "kind": kind, "bad": []}
    (spline,) = run.fresh("S.json")
    asked = {"flow": [], "form": ["--atlas", "form"]}[kind]
    report, why = run.try_report("spline", "fit", page.file_of(mesh), "--degree", str(degree), *asked, "-o", spline, seconds=PATIENCE)
    if report is None:
        return row | {"refused": why.splitlines()[0].removeprefix("ricci: ")}
    figures = report["result"]
    names = ["patches", "control_points", "hole_coefficients", "singular_vertices", "rms", "max", "continuity", "rough_sides", "partition_of_unity", "folded_patches", "rounds"]
    row |= {name: figures[name] for name in names} | {"seconds": report["seconds"]["total"]}
    row["bad"] += [f"{name} is {page.small(c['value'])}, over {page.small(c['limit'])}" for name, c in report["checks"].items() if not c["holds"]]
    row["bad"] += [f"rms is {page.small(row['rms'])}, over {page.small(RMS)}"] if row["rms"] > RMS else []
    if kind == "form":
        return row
    row["quarter"] = 4 * (row["control_points"] + row["hole_coefficients"]) <= int(mesh["V"])
    row["angles"] = angles(run, mesh, spline)
    row["outside"] = outside(run, row, spline) if int(mesh["V"]) <= JUDGED else [None, None, None]
    if not row["bad"] and int(mesh["V"]) <= EXPORTED:
        row["export"] = export(run, row, spline, page.loops(mesh) == 0)
    return row


def places(spline):
    """Places in patches, and pairs of places, one in each of two patches, that are the same point of their common side."""
    patches, generator = spline["patches"], random.Random(1)
    corners = [[knots[0] for knots in patch["knots"]] for patch in patches]
    mix = lambda of, weights: [sum(w * c[x] for w, c in zip(weights, of)) / sum(weights) for x in (0, 1)]
    inside, pairs = [], []
    for k in range(INSIDE):
        patch, weights = generator.randrange(len(patches)), [generator.expovariate(1.0) for _ in range(3)]
        weights[k % 3] *= NEAR if k < BESIDE else 1.0
        inside.append((patch, *mix(corners[patch], weights)))
    while len(pairs) < 2 * ASIDE:
        patch = generator.randrange(len(patches))
        own, size = corners[patch], max(abs(corners[patch][0][x] - corners[patch][k][x]) for k in (1, 2) for x in (0, 1))
        near = lambda p: [k for k in range(3) if max(abs(p[x] - own[k][x]) for x in (0, 1)) < 1e-9 * size]
        sides = []
        for other in spline["supports"][patch]:
            moved = [[sum(a * c for a, c in zip(line, [*corner, 1.0])) for line in other["to"]] for corner in corners[other["patch"]]]
            common = [(k, near(p)[0]) for k, p in enumerate(moved) if near(p)]
            if len(common) == 2:
                sides.append((other["patch"], common))
        if not sides:
            continue
        other, common = generator.choice(sides)
        t = generator.random()
        for of, ends in ((patch, [b for _, b in common]), (other, [a for a, _ in common])):
            pairs.append((of, *mix([corners[of][k] for k in ends], [t, 1.0 - t])))
    return inside, pairs


def evaluated(run, spline, rows, *options):
    """The rows of `spline eval --at` at places, and their file."""
    at, out = page.write_rows(run.path("q.csv"), "patch,x,y", rows), run.path("v.csv")
    subprocess.run([page.ricci, "spline", "eval", spline, "--at", at, *options, "-o", out, "--quiet"], check=True, timeout=PATIENCE)
    return list(csv.DictReader(open(out))), out


def outside(run, row, path):
    """Largest difference from the outside program's values, its partition of unity, and the largest difference across sides."""
    spline = json.load(open(path))
    inside, pairs = places(spline)
    pairs, _ = evaluated(run, path, pairs, "--filled")
    _, out = evaluated(run, path, inside)
    pairs = [[float(r[x]) for x in "XYZ"] for r in pairs]
    size = max(max(p[x] for p in spline["control_points"]) - min(p[x] for p in spline["control_points"]) for x in range(3))
    apart = max(abs(a - b) for p, q in zip(pairs[::2], pairs[1::2]) for a, b in zip(p, q)) / size
    row["bad"] += [f"sides differ by {page.small(apart)}"] if apart > 1e-10 else []
    said = page.judged_within(JUDGING, "spline", path, out)
    if said is None:
        return [None, None, apart]
    if max(said["worst_difference"], said["partition_of_unity"]) > 1e-9:
        row["bad"].append(f"outside: {said}")
    return [said["worst_difference"], said["partition_of_unity"], apart]


def normals(points, faces):
    """Normals at the vertices of a mesh, the sums of those of the faces there by area."""
    sums = [[0.0] * 3 for _ in points]
    for face in faces:
        a, b, c = (points[v] for v in face)
        u, w = ([q[x] - a[x] for x in range(3)] for q in (b, c))
        n = [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]]
        for v in face:
            sums[v] = [s + x for s, x in zip(sums[v], n)]
    return sums


def angles(run, mesh, spline):
    """Median and 99th percentile of the angles, in degrees, between normals of the mesh and of the spline where it is nearest, and the share of
    angles above ten degrees."""
    points, faces = page.read_obj(page.file_of(mesh))
    at, out = page.write_rows(run.path("p.csv"), "x,y,z", points), run.path("n.csv")
    subprocess.run([page.ricci, "spline", "eval", spline, "--closest", at, "-o", out, "--quiet"], check=True, timeout=PATIENCE)
    nearest = [(r["patch"], float(r["u"]), float(r["v"])) for r in csv.DictReader(open(out))]
    rows, _ = evaluated(run, spline, nearest, "--filled", "--derivatives")
    found = []
    for r, n in zip(rows, normals(points, faces)):
        if r["NX"] and any(n):
            cosine = sum(float(r[k]) * x for k, x in zip(("NX", "NY", "NZ"), n)) / math.hypot(*n)
            found.append(math.degrees(math.acos(max(-1.0, min(1.0, cosine)))))
    found.sort()
    return [found[len(found) // 2], found[99 * len(found) // 100], sum(x > 10.0 for x in found) / len(found)]


def export(run, row, spline, closed):
    (out,) = run.fresh("S.step")
    report, why = run.try_report("spline", "export", spline, "-o", out, "--tolerance", "1e-3", seconds=PATIENCE)
    if report is None:
        row["bad"].append("export: " + why.splitlines()[0])
        return None
    figures, checks = report["result"], report["checks"]
    row["bad"] += [f"export: {name} is {page.small(c['value'])}, over {page.small(c['limit'])}" for name, c in checks.items() if not c["holds"]]
    row["bad"] += ["export: closed surface, open shell"] if closed != figures["closed"] else []
    names = ["bicubic_patches", "spans_min", "spans_max", "distance", "normal_jump_max", "normal_jump_mean"]
    return {name: figures[name] for name in names} | {"bytes": os.path.getsize(out), "seconds": report["seconds"]["total"]}


def torus_level(p):
    return math.hypot(math.hypot(p[0], p[1]) - 1.0, p[2]) - 0.4


def sphere_level(p):
    return math.hypot(*p) - 1.0


def ellipsoid_level(p):
    return math.hypot(p[0] / 1.6, p[1], p[2] / 0.7) - 1.0


def bumps_height(x, y):
    return 0.2 * math.sin(2.0 * x) * math.cos(1.7 * y + 0.3)


def bumps_level(p):
    return p[2] - bumps_height(p[0], p[1])


def exact_torus(run, n):
    """A torus with vertices at random beside those of a grid."""
    path, generator, rows, faces = run.path("exact.obj"), random.Random(7), [], []
    for j, i in ((j, i) for j in range(n) for i in range(2 * n)):
        u, v = (2.0 * math.pi * (k + 0.6 * (generator.random() - 0.5)) / m for k, m in ((i, 2 * n), (j, n)))
        rows.append(((1.0 + 0.4 * math.cos(v)) * math.cos(u), (1.0 + 0.4 * math.cos(v)) * math.sin(u), 0.4 * math.sin(v)))
        at = lambda i, j: j % n * 2 * n + i % (2 * n)
        faces += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    return write_obj(path, rows, faces)


def exact_bumps(run, n):
    """A square with bumps, vertices at random beside those of a grid."""
    path, generator, rows, faces = run.path("exact.obj"), random.Random(7), [], []
    for j, i in ((j, i) for j in range(n + 1) for i in range(n + 1)):
        moved = 0 < i < n and 0 < j < n
        x, y = (2.0 * (k + (0.6 * (generator.random() - 0.5) if moved else 0.0)) / n - 1.0 for k in (i, j))
        rows.append((x, y, bumps_height(x, y)))
        a = j * (n + 1) + i
        faces += [(a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1)] if i < n and j < n else []
    return write_obj(path, rows, faces)


def exact_ellipsoid(run, n):
    return run.make("exact.obj", "ellipsoid", "--axes", "1.6", "1", "0.7", "-n", str(n))


def exact_sphere(run, n):
    return run.make("exact.obj", "sphere", "-n", str(n))


def write_obj(path, rows, faces):
    with open(path, "w") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in rows)
        file.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces)
    return path


# Surfaces of which everything is known: name, file for a size, level function, first size, diagonal.
EXACT = [
    ("torus 1 : 0.4", exact_torus, torus_level, 16, math.hypot(2.8, 2.8, 0.8)),
    ("bumps", exact_bumps, bumps_level, 20, math.hypot(2.0, 2.0, 0.4)),
    ("sphere", exact_sphere, sphere_level, 8, math.hypot(2.0, 2.0, 2.0)),
    ("ellipsoid 1.6 : 1 : 0.7", exact_ellipsoid, ellipsoid_level, 8, math.hypot(3.2, 2.0, 1.4)),
]
# Times that the control points become four times as many, and steps of differences.
FINER, STEP = 3, 1e-4


def slope(level, p):
    """The gradient of a level function."""
    at = lambda x, by: level([c + by if k == x else c for k, c in enumerate(p)])
    return [(8 * (at(x, STEP) - at(x, -STEP)) - at(x, 2 * STEP) + at(x, -2 * STEP)) / (12 * STEP) for x in range(3)]


def exact_at(level, p):
    """Distance, normal and mean curvature of the surface at a point near it."""
    def normal(q):
        g = slope(level, q)
        return [x / math.hypot(*g) for x in g]
    part = lambda x: (normal([c + 10 * STEP * (k == x) for k, c in enumerate(p)])[x] - normal([c - 10 * STEP * (k == x) for k, c in enumerate(p)])[x]) / (20 * STEP)
    return level(p) / math.hypot(*slope(level, p)), normal(p), -0.5 * sum(map(part, range(3)))


def exact_row(run, name, mesh, level, degree, diagonal):
    """The errors of a fit at places all over the surface: root mean square and largest."""
    (spline,) = run.fresh("S.json")
    quarter = str(sum(line.startswith("v ") for line in open(mesh)) // 4)
    report, why = run.try_report("spline", "fit", mesh, "--degree", str(degree), "--tolerance", "1e-9", "--control-points", quarter, "-o", spline, seconds=PATIENCE)
    if report is None:
        return {"name": name, "degree": degree, "refused": why.splitlines()[0]}
    of, rows = json.load(open(spline)), []
    for patch, knots in enumerate(p["knots"] for p in of["patches"]):
        for i, j in ((i, j) for i in range(4) for j in range(4 - i)):
            s, t = (i + 0.2) / 4.0, (j + 0.2) / 4.0
            rows.append((patch, *((1 - s - t) * knots[0][0][x] + s * knots[1][0][x] + t * knots[2][0][x] for x in (0, 1))))
    found, _ = evaluated(run, spline, rows, "--filled", "--derivatives")
    errors, largest = [], 0.0
    for r in (r for r in found if r["NX"]):
        far, normal, bend = exact_at(level, [float(r[k]) for k in "XYZ"])
        own = [float(r[k]) for k in ("NX", "NY", "NZ")]
        side = 1.0 if sum(a * b for a, b in zip(own, normal)) > 0 else -1.0
        sine = math.dist([side * x for x in own], normal)
        errors.append((abs(far) / diagonal, math.degrees(2.0 * math.asin(min(1.0, 0.5 * sine))), abs(side * 0.5 * (float(r["k1"]) + float(r["k2"])) - bend)))
        largest = max(largest, abs(bend))
    mean = [math.sqrt(sum(e[k] ** 2 for e in errors) / len(errors)) for k in range(3)]
    most = [max(e[k] for e in errors) for k in range(3)]
    mean[2], most[2] = mean[2] / largest, most[2] / largest
    return {"name": name, "degree": degree, "control_points": report["result"]["control_points"], "mean": mean, "most": most,
            "folded": len(report["result"]["folded_patches"]), "seconds": report["seconds"]["total"]}


def orders(run):
    """The table of errors under refinement, with the orders from row to row."""
    head = ["surface", "degree", "control points", "distance: rms, max", "order", "normals: rms, max", "order", "mean curvature: rms, max", "order", "folded", "s"]
    lines = []
    for name, make, level, first, diagonal in EXACT:
        for degree in (3, 4):
            before = None
            for k in range(FINER + 1):
                row = run.keep([name, degree, k], lambda: exact_row(run, name, make(run, first << k), level, degree, diagonal))
                if "refused" in row:
                    lines.append([name, degree, "refused: " + row["refused"]] + [""] * 8)
                    continue
                rate = lambda x: "" if before is None else f"{math.log2(before['mean'][x] / row['mean'][x]) * 2 / math.log2(row['control_points'] / before['control_points']):.1f}"
                cells = [cell for x in range(3) for cell in (f"{page.small(row['mean'][x])}, {page.small(row['most'][x])}", rate(x))]
                lines.append([name, degree, row["control_points"], *cells, row["folded"], f"{row['seconds']:.1f}"])
                before = row
    return page.table(head, lines)


def kept_rows(run, meshes):
    for mesh, degree, kind in jobs(meshes):
        row = run.keep([mesh["name"], degree, kind], lambda: fit(run, mesh, degree, kind))
        yield row | {"V": int(mesh["V"]), "genus": mesh["genus"], "loops": mesh["boundary_loops"]}


def fits(rows):
    head = ["mesh", "genus", "loops", "V", "degree", "control points + coefficients", "share", "patches", "singular", "rms", "max", "normals, median / 99 %, above 10°",
            "continuity", "unity", "folded", "rounds", "s", "outside: values, unity", "across sides"]
    lines = []
    for r in rows:
        values, unity, apart = r["outside"]
        lines.append([r["mesh"], r["genus"], r["loops"], r["V"], r["degree"], f"{r['control_points']} + {r['hole_coefficients']}",
                      f"{(r['control_points'] + r['hole_coefficients']) / r['V']:.3f}", r["patches"], len(r["singular_vertices"]), page.small(r["rms"]), page.small(r["max"]),
                      "{:.1f}° / {:.0f}°, {:.0%}".format(*r["angles"]), page.small(r["continuity"]), page.small(r["partition_of_unity"]), len(r["folded_patches"]), r["rounds"], f"{r['seconds']:.1f}",
                      "–" if values is None else f"{page.small(values)}, {page.small(unity)}", "–" if apart is None else page.small(apart)])
    return page.table(head, lines)


def exports(rows):
    head = ["mesh", "degree", "control points", "bicubic patches", "spans", "distance", "normals turn, largest / mean", "MB", "s"]
    lines = []
    for r in rows:
        e = r["export"]
        lines.append([r["mesh"], r["degree"], r["control_points"], e["bicubic_patches"], f"{e['spans_min']}–{e['spans_max']}", page.small(e["distance"]),
                      f"{e['normal_jump_max']:.2f}° / {e['normal_jump_mean']:.4f}°", f"{e['bytes'] / 1e6:.1f}", f"{e['seconds']:.1f}"])
    return page.table(head, lines)


def atlases(rows):
    """The splines from the flow beside those from a form."""
    head = ["mesh", "genus", "singular: flow, form", "control points: flow, form", "rms: flow, form", "max: flow, form", "continuity: flow, form", "s: flow, form"]
    of, lines = {(r["mesh"], r["degree"], r["kind"]): r for r in rows}, []
    for r in (r for r in rows if r["kind"] == "form"):
        flow = of[r["mesh"], 3, "flow"]
        if "refused" in flow:
            continue
        if "refused" in r:
            lines.append([r["mesh"], r["genus"], f"{len(flow['singular_vertices'])}, –", "refused: " + r["refused"].replace("|", "\\|"), "", "", "", ""])
            continue
        both = lambda show: f"{show(flow)}, {show(r)}"
        lines.append([r["mesh"], r["genus"], both(lambda r: len(r["singular_vertices"])), both(lambda r: r["control_points"] + r["hole_coefficients"]),
                      *[both(lambda r: page.small(r[name])) for name in ("rms", "max", "continuity")], both(lambda r: f"{r['seconds']:.1f}")])
    return page.table(head, lines)


TEXT = {
    "head": """# Splines near scanned surfaces

Made by `docs/results/splines.py`: `ricci spline fit MESH` with default options over every connected mesh of the corpus with 500 to 60,000 vertices. Default options
are degree 3, as few singular vertices as keep the factor between lengths within 30 where that can be, corners on the boundary of open surfaces, and a quarter as many control points as the mesh has vertices,
the coefficients of fillings included; where no such spline holds, twice and four times as many, up to 4000. Wanted: root mean square 1e-3 and largest distance 1e-2 of the diagonal of the bounding box, and no fold.

**{holding} of {all} hold, {quarter} of them with a quarter as many control points as vertices; {near} of {all} reach both distances; {refused} are refused.** Times are those of one run on two cores that had other work.
""",
    "fits": """## Fits

*control points + coefficients*: the second number is of the fillings around singular vertices; *share*: of both, in the vertices of the mesh. *rms*, *max*: distances
of the vertices, over the diagonal. *normals*: angle between the mesh's normal at a vertex and the spline's at the nearest point, median, 99th percentile, and the share of vertices where it is above 10 degrees; scans are rougher than
their splines. *continuity*: largest jump of derivatives up to order n − 1 across sides outside the fillings, relative. *unity*: partition of unity, of the report. *folded*: patches in which normals turn by more than 60° over a twelfth of a side, at a singular vertex also in the coordinate in which it is a point as any other.
*outside*: `check.py spline` at 30 places of the file, of which ten lie near sides, all summed over the charts that reach there: largest difference from `spline eval --at`
over the size of the surface, and its own partition of unity. *across sides*: largest difference of the surface at 30 places on sides, evaluated in the charts of both patches.
""",
    "order": """## Order

Fits to vertices that lie exactly on surfaces of which distance, normal and curvature are known, four times as many control points from row to row, a quarter as many
as vertices, `--tolerance 1e-9`. Errors are measured at ten places of each patch, fillings included: distance over the diagonal, normals in degrees, mean curvature over its largest value. *order*: of the root mean square,
by the size of triangles.
""",
    "export": """## Patches for CAD

Three to a triangle of the domain, as `docs/results/splines-step.md` tells, at T = 1e-3: the distance is to be below T, the normals of neighbours are to turn by one degree
at most. Fits that hold, of meshes of up to 2,500 vertices.
""",
    "form": """## The flow and a holomorphic 1-form

Closed surfaces of genus 2 and more with up to 2,500 vertices, with `--atlas form`: flat metrics |ω| have 2g − 2 cones of −2π, or fewer and larger ones at multiple zeros, in place of one.
Where a form turns triangles of the mesh over, zeros move to vertices, and the flow makes the metric with their curvatures.
""",
    "pictures": """## Pictures

`eight_3498`, degree 3, as in Figs 14 and 15 of the paper: the domain with its singular vertex, charts, patches, control net, Gaussian curvature, reflection lines. Lines
without gaps are continuous normals, lines without corners continuous curvatures. Below, reflection lines of a torus. `docs/pictures/README.md` has the commands.

![domain](../pictures/eight-domain.png)
![charts](../pictures/eight-charts.png)
![patches](../pictures/eight-spline.png)
![control net](../pictures/eight-spline-net.png)
![Gaussian curvature](../pictures/eight-spline-curvature.png)
![reflection lines](../pictures/eight-spline-lines.png)

![reflection lines of rocker_arm](../pictures/rocker-lines.png)
""",
}


def content(run):
    meshes = page.meshes(lambda m: m["components"] == "1" and int(m["V"]) in SIZES, key=lambda m: int(m["V"]))
    rows = list(kept_rows(run, meshes))
    of_flow = [r for r in rows if r["kind"] == "flow"]
    whole = [r for r in of_flow if "rms" in r]
    bad = [f"{r['mesh']}: {'; '.join(r['bad'])}" for r in of_flow if r["bad"]]
    bad += [f"{r['mesh']}: {r['refused']}" for r in of_flow if "refused" in r]
    near = [r for r in whole if r["rms"] <= RMS and r["max"] <= MOST]
    figures = {"all": len(of_flow), "near": len(near), "holding": len(of_flow) - len(bad), "refused": len(of_flow) - len(whole),
               "quarter": sum(r["quarter"] for r in whole if not r["bad"])}
    return [
        TEXT["head"].format(**figures), page.verdict(bad),
        TEXT["fits"], fits(whole),
        TEXT["order"], orders(run),
        TEXT["export"], exports([r for r in rows if r.get("export")]),
        TEXT["form"], atlases(rows),
        TEXT["pictures"],
    ]


page.main(content)
