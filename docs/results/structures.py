#!/usr/bin/env python3
"""Atlases of every mesh of the corpus, with every structure that it has, as tables.

usage: docs/results/structures.py [CORPUS [NAME…]] > docs/results/structures.md     (after: cargo build --release -p ricci-apps)
"""
import os

import page

# Bytes of a file above which the outside program is not asked: it would take minutes and much memory.
JUDGED = 15_000_000
# Seconds for the outside program, which compares triples one by one.
JUDGING = 120
TITLES = {
    "conformal": "Conformal", "spherical": "Spherical", "affine": "Affine, by the flow, stars", "affine patches": "Affine, by the flow, patches",
    "affine form": "Affine, from a holomorphic 1-form", "hyperbolic": "Hyperbolic, stars", "hyperbolic patches": "Hyperbolic, patches",
    "projective": "Projective", "integer": "Integer, of about 1000 quads",
}


def kinds(mesh):
    closed, genus, euler = page.loops(mesh) == 0, page.genus(mesh), page.euler(mesh)
    wanted = ["conformal", "affine", "affine patches"] + (["spherical"] if euler == 2 else [])
    wanted += ["affine form"] if closed and genus > 0 else []
    wanted += ["integer"]
    return wanted + (["hyperbolic", "hyperbolic patches", "projective"] if euler < 0 else [])


def one(run, mesh, kind):
    """One atlas: the figures of its report, what the outside program says, and what fails."""
    words, (out,) = kind.split(), run.fresh("A.json")
    asked = ["--from", "form"] if "form" in words else []
    asked += ["--charts", "patches"] if "patches" in words else []
    asked += ["--faces", "1000"] if words[0] == "integer" else []
    row = {"mesh": mesh["name"], "kind": kind, "bad": []}
    report, why = run.try_report("structure", page.file_of(mesh), "--kind", words[0], *asked, "--atlas", out)
    if report is None or not os.path.exists(out):
        return row | {"bad": [str(why if report is None else report["result"])]}
    figures = report["result"]
    row["seconds"] = report["seconds"]["total"]
    row["bad"] += [f"{name} is {c['value']:.1e}" for name, c in report["checks"].items() if not c["holds"]]
    for name in ("charts", "transitions", "triples", "transition_residual", "cocycle_residual", "relation_residual", "max_curvature_error"):
        row[name] = figures[name]
    row["singular"] = len(figures["singular_vertices"])
    row["zeros"] = sum(zero["multiplicity"] for zero in figures["zeros"])
    genus, closed = page.genus(mesh), page.loops(mesh) == 0
    if words[0] == "affine" and "form" not in words and closed and row["singular"] != int(genus != 1):
        row["bad"].append(f"{row['singular']} singular vertices")
    if "form" in words and row["zeros"] != 2 * genus - 2:
        row["bad"].append(f"{row['zeros']} zeros")
    outside = page.judged_within(JUDGING, "atlas", out) if os.path.getsize(out) <= JUDGED else None
    if outside is not None:
        row["outside"] = [outside["worst_transition"], outside["triples"], outside["worst_cocycle"]]
        if max(outside["worst_transition"], outside["worst_cocycle"]) > 1e-9:
            row["bad"].append(f"outside: {outside}")
    return row


def table(kind, rows):
    last = ["zeros", "singular"] if "form" in kind.split() else ["singular"]
    head = ["mesh", "V", "genus", "loops", "charts", "transitions", "at vertices", "triples", "cocycle", "relation", "curvature", *last,
            "outside: vertices, triples, cocycle", "s"]
    lines = []
    for row in rows:
        outside = row.get("outside")
        seen = "–" if outside is None else f"{page.small(outside[0])}, {outside[1]}, {page.small(outside[2])}"
        cells = [str(row["charts"]), str(row["transitions"]), page.small(row["transition_residual"]), str(row["triples"])]
        cells += [page.small(row[name]) for name in ("cocycle_residual", "relation_residual", "max_curvature_error")]
        singular = [row[name] for name in last]
        lines.append([row["mesh"], row["V"], row["genus"], row["loops"], *cells, *singular, seen, f"{row['seconds']:.1f}"])
    return page.table(head, lines)


def content(run):
    meshes = page.meshes(key=lambda m: int(m["V"]))
    rows = []
    for mesh, kind in ((mesh, kind) for mesh in meshes for kind in kinds(mesh)):
        row = run.keep([mesh["name"], kind], lambda: one(run, mesh, kind))
        rows.append(row | {"V": mesh["V"], "genus": mesh["genus"], "loops": mesh["boundary_loops"]})
    bad = [f"{row['mesh']}, {row['kind']}: {'; '.join(row['bad'])}" for row in rows if row["bad"]]
    whole = [row for row in rows if "charts" in row]
    most = lambda name: max(row[name] for row in whole)
    blocks = [
        "# Geometric structures",
        """Every mesh of the corpus with every structure that it has, made by `docs/results/structures.py`: `ricci structure MESH --kind …` with default
options. Times are those of one run on a shared machine and say little.""",
        f"""{len(rows)} atlases of {len(meshes)} meshes; {len(rows) - len(bad)} hold all their checks. Worst of those that were made: cocycle {page.small(most('cocycle_residual'))},
relation of the holonomy {page.small(most('relation_residual'))}, shared vertices {page.small(most('transition_residual'))}.""",
        page.verdict(bad),
        """*at vertices*: largest distance between the image of a shared vertex and its place, over the size of the chart; *cocycle*: largest difference of
T_jk T_ij and T_ik over all overlaps of three charts (*triples*); *relation*: of the holonomy; *curvature*: largest |K − K̄|, radians. *singular*: vertices that no chart
has inside: from a form those at its zeros and at faces that it draws clockwise, many where faces are thin; on a flat boundary those with an angle of 360° and more. *outside*:
check.py on the file where that is not too large or too long for it; it looks at the triples that begin at the first 300 charts.
It divides matrices by their largest entry; a rotation of the sphere by more than 90° between two charts, which only very coarse parts of a sphere
need, has two of the same size, and rounding decides which one a product is divided by.""",
    ]
    for kind, title in TITLES.items():
        of = [row for row in whole if row["kind"] == kind]
        blocks += [f"## {title}", table(kind, of)] if of else []
    return blocks


page.main(content)
