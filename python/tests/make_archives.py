"""Writes a small archive of every kind: make_archives.py FOLDER."""

import sys
from pathlib import Path

import numpy as np

import ricci


def archives():
    """A small object of every kind, by the name of its file."""
    tetrahedron = ricci.Mesh([[0, 0, 0], [1, 0, 0], [0, 1.2, 0], [0, 0.3, 0.9]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    disk, torus = ricci.make("disk", n=1), ricci.make("torus", n=6, m=4)
    flat = ricci.flow(tetrahedron, target=dict.fromkeys(range(4), np.pi))
    laid, seamless = ricci.layout(flat), ricci.seamless(torus)
    patches = ricci.quad_layout(seamless)
    return {
        "mesh": disk.with_attributes(uv=np.arange(36).reshape(6, 3, 2) / 36, colors=np.full((7, 4), 0.25)),
        "metric": flat,
        "layout": laid,
        "charts": ricci.charts(laid),
        "map": ricci.Map(flat),
        "uniformization": ricci.uniformize(ricci.make("one_vertex", genus=2)),
        "circle-domain": ricci.circles(ricci.make("annulus", a=0.5, b=1, n=1, m=6)),
        "forms": ricci.forms(ricci.make("torus", n=4, m=3)),
        "matching": ricci.match(tetrahedron, tetrahedron),
        "structure": ricci.structure(tetrahedron, kind="spherical"),
        "seamless": seamless,
        "quads": ricci.quads(seamless, n_quads=12),
        "quad-layout": patches,
        "quad-spline": ricci.quad_spline(seamless, patches, most_spans=1),
        "spline": ricci.Spline.plane(disk, degree=1),
    }


if __name__ == "__main__":
    for name, value in archives().items():
        value.save(Path(sys.argv[1]) / f"{name}.ricci")
