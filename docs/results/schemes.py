#!/usr/bin/env python3
"""Compare the moduli that each scheme finds of surfaces whose moduli are known, at four refinements, and write the table.

usage: docs/results/schemes.py > docs/results/schemes.md     (after: cargo build --release -p ricci-apps)
"""
import math

from page import main, table, verdict

SCHEMES = ["yamabe", "inversive", "virtual", "thurston", "tangential"]
LEVELS = [1, 2, 4, 8]
HEAD = ["surface", "scheme", "error at 4 refinements", "", "", "", "order", "dilatation of the start: mean", "max", "converges"]
# An error that falls by less than this power of the edge length from the last but one mesh to the last does not go to 0.
LEAST_ORDER = 0.5
# Errors below this are rounding.
ROUNDING = 1e-9


def torus(big, small, n, m):
    """A torus of revolution: the rectangle with the sides 2π and 2π small/√(big² − small²)."""
    exact = math.sqrt(big * big - small * small) / small
    return f"torus of revolution, radii {big:g} and {small:g}", "flow", [0.0, exact], lambda k: [
        "torus", "--big", str(big), "--small", str(small), "--n", str(n * k), "--m", str(m * k)]


def flat_torus(re, im):
    return f"flat torus {re} + {im} i", "flow", [re, im], lambda k: ["flat-torus", "--tau", str(re), str(im), "--n", str(6 * k), "--m", str(6 * k)]


def rows_of(run, surface):
    name, command, exact, make = surface
    paths = [run.make(f"{k}.json", *make(k)) for k in LEVELS]
    rows = []
    for scheme in SCHEMES:
        reports = [run.report(f"{name}, {scheme}", command, path, "--scheme", scheme) for path in paths]
        if None in reports:
            rows.append([name, scheme, "not reached"] + [""] * 7)
            continue
        errors = [distance(report["result"]["modulus"], exact) for report in reports]
        start = reports[-1]["result"].get("scheme_distance")
        order = math.log2(errors[-2] / errors[-1]) if min(errors) > ROUNDING else None
        converges = errors[-1] <= ROUNDING or (order is not None and order > LEAST_ORDER)
        rows.append([name, scheme, *(f"{e:.1e}" if e > ROUNDING else "rounding" for e in errors), "–" if order is None else f"{round(order, 2) + 0.0:.2f}",
                     f"{start['mean_dilatation']:.3f}" if start else "1", f"{start['max_dilatation']:.3f}" if start else "1", "yes" if converges else "no"])
    return rows


def distance(found, exact):
    """Of moduli of tori up to the transformations that leave the torus as it is; of annuli as numbers."""
    if isinstance(found, float):
        return abs(found - exact[1])
    (x, y), (re, im) = found, exact
    return min(math.hypot(x - s * re - k, y - im) for s in (1, -1) for k in (-1, 0, 1))


def content(run):
    annulus = "plane annulus, radii 1/2 and 1", "uniformize", [0.0, math.log(2) / math.tau], lambda k: [
        "annulus", "--inner", "0.5", "--n", str(4 * k), "--m", str(18 * k)]
    surfaces = [torus(2.0, 1.0, 16, 8), torus(3.0, 1.0, 18, 8), flat_torus(0.3, 1.1), annulus]
    rows = [row for surface in surfaces for row in rows_of(run, surface)]
    stay = sorted({row[1] for row in rows if row[-1] == "no"}, key=SCHEMES.index)
    go = [s for s in SCHEMES if all(row[-1] == "yes" for row in rows if row[1] == s)]
    return [
        "# Schemes and the conformal structure of the surface",
        "A flow is conformal to the metric that its scheme starts from. Made by `docs/results/schemes.py`: the moduli that each scheme finds of surfaces "
        "whose moduli are known, on meshes with 1, 2, 4 and 8 times as many edges along each direction.",
        verdict(run.bad),
        f"**Schemes whose moduli converge to those of the surface on all of these: {', '.join(go)}.** They start from the surface's own lengths. "
        f"**Schemes that do not, on one surface or more: {', '.join(stay)}.** A circle packing has radii and intersection angles that fit the lengths only "
        "approximately (Thurston's: between 0 and 90 degrees) or not at all (tangential: the connectivity alone decides), so the result belongs to "
        "another surface, at a distance that refining does not lower. `ricci flow` and `ricci uniformize` print that distance in the line `start`, with a warning where the "
        "mean dilatation is above 1.02 or a largest one above 2; the report has it as `scheme_distance`.",
        "*error*: |τ − exact| of a torus, of an annulus the difference of height over circumference. *order*: the power of the edge length with which it falls between the last two. "
        "A modulus can agree by chance: a tangential packing knows the connectivity alone, and equal triangles on the mesh of 16 by 8 quadrilaterals make the torus √3 i, "
        "which that of the radii 2 and 1 happens to be.",
        table(HEAD, rows),
    ]


main(content)
