#!/usr/bin/env python3
"""Brackets of Teichmüller distances: of surfaces whose distance is known, of pairs of the corpus, and pictures of families; writes the page.

usage: target/python/fresh/bin/python docs/results/teichmuller.py [CORPUS] > docs/results/teichmuller.md
(after: python/run, which makes that Python, and in it: pip install matplotlib)
"""
import sys
import time
from pathlib import Path

import matplotlib
import numpy as np

import ricci

import page

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PICTURES = Path(__file__).resolve().parents[1] / "pictures"
HEAD = ["pair", "V", "K* exact", "K from below", "K from above", "above / below", "99 % of the area below", "left out", "gaps", "s"]
PAIRS = [("bob", "kitten_10k"), ("eight_766", "eight_3498"), ("genus3", "pretzel"), ("pair_mac_smooth", "pair_mac_blocky")]


def row(name, source, target, exact, corners=None):
    start = time.perf_counter()
    found = ricci.dilatation_bracket(ricci.match(source, target, landmarks=corners), corners)
    taken = time.perf_counter() - start
    size = f"{source.n_vertices} → {target.n_vertices}"
    if exact is not None and found.lower > exact * (1 + 1e-9):
        print(f"{name}: {found.lower} from below is above {exact}", file=sys.stderr)
    gaps = " ".join(page.small(x) for x in found.gaps)
    left = f"{found.n_left_out}, {page.small(found.left_out_area)}" if found.n_left_out else 0
    told = "–" if exact is None else f"{exact:.6f}"
    return [name, size, told, f"{found.lower:.6f}", f"{found.upper:.6f}", f"{found.upper / found.lower:.4f}", f"{found.most:.4f}", left, gaps, f"{taken:.1f}"]


def hyperbolic(z, w):
    return 2 * np.arcsinh(abs(z - w) / (2 * np.sqrt(z.imag * w.imag)))


def torus(tau, n):
    return ricci.make("flat_torus", a=tau.real, b=tau.imag, n=n, m=n)


def tori():
    rows = []
    for z, w in ((1j, 2j), (0.1 + 1.1j, 0.35 + 1.4j), (-0.3 + 2j, 0.3 + 1.2j)):
        for n in (10, 45, 142):
            exact = min(np.exp(hyperbolic(z, w + k)) for k in (-1, 0, 1))
            rows.append(row(f"τ = {page.complex_text([z.real, z.imag], 2)} and {page.complex_text([w.real, w.imag], 2)}", torus(z, n), torus(w, n - 3), exact))
    return rows


def annuli():
    exact = np.log(0.3) / np.log(0.5)
    return [row("rings 0.5 and 0.3", ricci.make("annulus", a=0.5, n=n, m=9 * n), ricci.make("annulus", a=0.3, n=n + 2, m=6 * n), exact) for n in (8, 16, 32, 48)]


def rectangle(width, n, m):
    """An n x m grid of the rectangle of height 1, and its corners counterclockwise."""
    x, y = np.meshgrid(np.linspace(0, width, n + 1), np.linspace(0, 1, m + 1))
    V = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
    at = lambda i, j: i + (n + 1) * j
    F = [t for j in range(m) for i in range(n) for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1)))]
    return ricci.Mesh(V, F), [at(0, 0), at(n, 0), at(n, m), at(0, m)]


def rectangles():
    rows = []
    for n in (8, 24, 72):
        (a, at), (b, there) = rectangle(1.0, n, n), rectangle(2.5, 2 * n, n - 1)
        rows.append(row("rectangles 1 and 2.5 wide", a, b, 2.5, np.column_stack([at, there])))
    return rows


def glued_squares(right, up, width, height, n):
    """Squares glued by permutations, each a width x height rectangle of n x n cells, as lengths."""
    count = len(right)
    names, faces, edges, numbers, lengths = {}, [], [], {}, []
    root = {}

    def find(x):
        while root.setdefault(x, x) != x:
            x = root[x]
        return x

    def join(x, y):
        root[find(x)] = find(y)

    for i in range(count):
        for k in range(n + 1):
            join((i, n, k), (right[i], 0, k))
            join((i, k, n), (up[i], k, 0))

    def edge(key, length):
        if key not in numbers:
            lengths.append(length)
            numbers[key] = len(lengths)
        return numbers[key]

    def side(i, kind, x, y):
        """Horizontal from (x, y), vertical from (x, y), or the diagonal; those on the far sides belong to the neighbours."""
        if kind == "h" and y == n:
            i, y = up[i], 0
        if kind == "v" and x == n:
            i, x = right[i], 0
        sizes = {"h": width / n, "v": height / n, "d": np.hypot(width, height) / n}
        return edge((i, kind, x, y), sizes[kind])

    for i in range(count):
        for x in range(n):
            for y in range(n):
                a, b, c, d = (names.setdefault(find((i, *p)), len(names)) for p in ((x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)))
                faces += [[a, b, c], [a, c, d]]
                edges.append([side(i, "v", x + 1, y), -side(i, "d", x, y), side(i, "h", x, y)])
                edges.append([-side(i, "h", x, y + 1), -side(i, "v", x, y), side(i, "d", x, y)])
    return ricci.Mesh.from_gluing(faces, edges, lengths)


def origamis():
    rows = []
    for name, right, up in (("L of 3 squares", [1, 0, 2], [2, 1, 0]), ("4 squares, H(1, 1)", [1, 2, 3, 0], [1, 0, 3, 2])):
        for n in (6, 20, 60):
            k = np.sqrt(2.0)
            rows.append(row(name, glued_squares(right, up, 1, 1, n), glued_squares(right, up, np.sqrt(k), 1 / np.sqrt(k), n), k))
    return rows


def pairs(corpus):
    rows = []
    for a, b in PAIRS:
        files = [next(iter(sorted(corpus.rglob(f"{name}.*"))), None) for name in (a, b)]
        if None not in files:
            rows.append(row(f"{a} → {b}", *map(ricci.read, files), None))
    return rows


def picture(name, points, labels, title):
    figure, axes = plt.subplots(figsize=(6, 5))
    axes.scatter(points[:, 0], points[:, 1], s=18)
    for point, label in zip(points, labels):
        axes.annotate(label, point, textcoords="offset points", xytext=(4, 3), fontsize=7)
    axes.set_aspect("equal")
    axes.set_title(title, fontsize=9)
    figure.savefig(PICTURES / f"{name}.png", dpi=110, bbox_inches="tight")
    plt.close(figure)


def families():
    moduli = [complex(x, y) for y in (1.0, 1.4, 2.0, 2.8) for x in (0.0, 0.2, 0.4) if abs(complex(x, y)) >= 1]
    found = ricci.moduli_distances([torus(tau, 6) for tau in moduli])
    points = ricci.classical_scaling(0.5 * (found.lower + found.upper))
    left = np.abs(np.linalg.norm(points[:, None] - points[None], axis=-1) - found.lower).max()
    picture("moduli_tori", points, [page.complex_text([t.real, t.imag], 1) for t in moduli], "flat tori by their Teichmüller distances")
    curves = [[first, second, 2.0] for first in (1.0, 1.6, 2.6) for second in (1.0, 2.0)]
    surfaces = [ricci.make("fenchel_nielsen", genus=2, points=points, n=3) for points in curves]
    two = ricci.moduli_distances(surfaces, loops=[ricci.make_loops(2, points, 3) for points in curves])
    labels = [f"{c[0]:g}, {c[1]:g}" for c in curves]
    picture("moduli_genus2", ricci.classical_scaling(two.lower), labels, "surfaces of genus 2 by the lengths of a1 and a2")
    off = two.upper > 0
    ratio = np.exp(2 * (two.upper - two.lower))[off]
    return left, len(moduli), len(curves), float(np.median(ratio)), float(ratio.max())


def main():
    corpus = Path(sys.argv[1] if len(sys.argv) > 1 else "meshes")
    left, n, m, median, worst = families()
    parts = [
        "# Brackets of Teichmüller distances",
        """Made by `docs/results/teichmuller.py`: `ricci.match` with default options, then `ricci.dilatation_bracket`, which `ricci match --distance` tells too. The distance
is half of the logarithm of the least dilatation K* of the maps of one class. *K from below*: by period matrices, or moduli, with their proven gaps; never above
K*. *K from above*: the largest dilatation of the map on the pieces of the common subdivision. *left out*: pieces without a shape in f64, their number and share of
the area; they do not count in it.""",
        "## Known distances",
        """Flat tori: K* is the exponential of the hyperbolic distance of the moduli in the class of the map, which is affine. Rings between circles, by inscribed polygons: the ratio of the
logarithms of their radii. Rectangles with their corners. Square-tiled surfaces, stretched by the diagonal matrix of 2^(1/4) and its inverse, K* = √2: the upper end is
that of the map by the numbers of vertices, which is affine; the lower one is as near as the gaps of 1e-3 allow.""",
        page.table(HEAD, tori() + annuli() + rectangles() + origamis()),
        "## Pairs of the corpus with handles",
        """The upper end is that of a harmonic map, which is not extremal, and the lower one that of period matrices, which the extremal map attains only if its quadratic
differential is a square; so these brackets stay open.""",
        page.table(HEAD, pairs(corpus)),
        "## Families",
        f"""{n} flat tori by classical scaling of their distances, which the plane shows to {left:.2f}, and {m} surfaces of genus 2 with the length 2 of c1, those of a1 and a2 as
written, and no twists, marked by the loops of these coordinates, by their distances from below; distances of pairs of these are known to a ratio of K of {median:.3f} in the median, {worst:.3f} at most.

![flat tori](../pictures/moduli_tori.png) ![surfaces of genus 2](../pictures/moduli_genus2.png)""",
    ]
    print("\n\n".join(parts))


if __name__ == "__main__":
    main()
