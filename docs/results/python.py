#!/usr/bin/env python3
"""Five common jobs by this package and by other packages: lines of code, seconds, and what comes out, in one run; writes the page.

usage: target/python/fresh/bin/python docs/results/python.py [CORPUS] > docs/results/python.md
(after: python/run, which makes that Python, and in it: pip install libigl potpourri3d xatlas trimesh)
"""
import importlib.metadata
import os
import platform
import sys
import time
from pathlib import Path

import numpy as np

import page

ROUNDS = 5
# Name, mesh, and for each package the program: `path` is the file, and V, F are its arrays where a program does not read it itself.
JOBS = [
    (
        "read a file, count",
        "igea_134k.obj",
        {
            "ricci": "import ricci\nmesh = ricci.read(path)\nfound = mesh.n_vertices, mesh.n_faces, mesh.euler",
            "libigl": "import igl\nV, _, _, F, _, _ = igl.readOBJ(path)\nfound = len(V), len(F), igl.euler_characteristic(F)",
            "trimesh": "import trimesh\nmesh = trimesh.load(path, process=False)\nfound = len(mesh.vertices), len(mesh.faces), mesh.euler_number",
            "potpourri3d": "import potpourri3d as pp\nV, F = pp.read_mesh(path)\nfound = len(V), len(F), len(V) - len(pp.edges(V, F)) + len(F)",
        },
    ),
    (
        "curvature of every vertex",
        "igea_134k.obj",
        {
            "ricci": "import ricci\nfound = ricci.Metric(V, F).curvature",
            "libigl": "import igl\nfound = igl.gaussian_curvature(V, F)",
            "trimesh": "import trimesh\nfound = trimesh.Trimesh(V, F, process=False).vertex_defects",
        },
    ),
    (
        "harmonic map to a disk",
        "face_libigl.obj",
        {
            "ricci": "import ricci\nfound = ricci.harmonic(V, F)[:, :2]",
            "libigl": "import igl\nrim = igl.boundary_loop(F)\nfound = igl.harmonic(V, F, rim, igl.map_vertices_to_circle(V, rim), 1)",
            "potpourri3d": "import numpy as np\nimport potpourri3d as pp\nfrom scipy.sparse.linalg import spsolve\nL = pp.cotan_laplacian(V, F).tocsr()\n"
            "sides = np.linalg.norm(V[np.roll(rim, -1)] - V[rim], axis=1)\n"
            "turn = 2 * np.pi * (np.cumsum(sides) - sides) / sides.sum()\ninside = np.setdiff1d(np.arange(len(V)), rim)\n"
            "found = np.empty((len(V), 2))\nfound[rim] = np.column_stack([np.cos(turn), np.sin(turn)])\n"
            "found[inside] = spsolve(L[inside][:, inside].tocsc(), -L[inside][:, rim] @ found[rim])",
        },
    ),
    (
        "conformal map to the plane",
        "camelhead.obj",
        {
            "ricci": "import ricci\nfound = ricci.layout(ricci.flow(V, F)).uv()",
            "libigl": "import igl\nimport numpy as np\nrim = igl.boundary_loop(F)\nends = np.array([rim[0], rim[len(rim) // 2]])\n"
            "uv, _ = igl.lscm(V, F, ends, np.array([[0.0, 0.0], [1.0, 0.0]]))\nfound = uv[F]",
        },
    ),
    (
        "texture atlas",
        "max_planck_25k.obj",
        {
            "ricci": "import ricci\nfound = ricci.charts(ricci.layout(ricci.flow(V, F, target='auto:8')))",
            "xatlas": "import xatlas\n_, indices, uv = xatlas.parametrize(V, F)\nfound = uv[indices]",
        },
    ),
]


def signed(uv):
    """Twice the signed areas of triangles in the plane, m x 3 x 2."""
    a, b = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def dilatation(V, F, uv):
    """The quasi-conformal dilatation of each face of a map to the plane; inf where it is turned over."""
    a, b = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    long = np.linalg.norm(a, axis=1)
    x = (a * b).sum(1) / long
    y = np.linalg.norm(b - a * (x / long)[:, None], axis=1)
    p, q = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
    first = p / long[:, None]
    second = (q - first * x[:, None]) / y[:, None]
    half = ((first**2).sum(1) + (second**2).sum(1)) / 2
    det = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    if np.median(det) < 0:
        det = -det
    with np.errstate(all="ignore"):
        return np.where(det > 0, (half + np.sqrt(np.maximum(half**2 - det**2, 0))) / det, np.inf)


def shared(values, V, F):
    """The mean over the faces by area."""
    areas = np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1)
    return (areas * values).sum() / areas.sum()


def figures(job, found, V, F):
    """What came out, in words."""
    if job == "read a file, count":
        return ", ".join(map(str, map(int, found)))
    if job == "curvature of every vertex":
        return f"sum {found.sum() / np.pi:.6f} pi"
    if job == "harmonic map to a disk":
        return f"{int((np.sign(signed(found[F])) != np.sign(np.median(signed(found[F])))).sum())} faces turned over"
    if job == "conformal map to the plane":
        values = dilatation(V, F, found)
        turned = np.isinf(values)
        return f"{int(turned.sum())} faces turned over, dilatation {shared(values[~turned], V, F[~turned]):.3f} in the mean, {values[~turned].max():.1f} at most"
    if hasattr(found, "summary"):
        return f"{counted(found.summary.n_charts)}, {100 * found.summary.efficiency:.0f} % of the square covered"
    covered = np.abs(signed(found.astype(float))).sum() / 2
    return f"{counted(parts(found))}, {100 * covered:.0f} % of the square covered"


def counted(n):
    return "1 chart" if n == 1 else f"{n} charts"


def parts(uv):
    """The number of connected pieces of triangles by their corners' coordinates."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    _, numbers = np.unique(uv.reshape(-1, 2), axis=0, return_inverse=True)
    f = numbers.reshape(-1, 3)
    n = int(f.max()) + 1
    ends = np.concatenate([f[:, [0, 1]], f[:, [1, 2]]])
    return connected_components(coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(n, n)), directed=False)[0]


def measured(programs, given):
    """The least seconds of each program over rounds in which they take turns, after one that is not counted; and what came out."""
    best, found = dict.fromkeys(programs, np.inf), {}
    for turn in range(ROUNDS + 1):
        for name, program in programs.items():
            code, space = compile(program, name, "exec"), dict(given)
            start = time.perf_counter()
            exec(code, space)
            seconds = time.perf_counter() - start
            if turn:
                best[name] = min(best[name], seconds)
            found[name] = space["found"]
    return best, found


def main():
    import ricci

    rows, busy = [], os.getloadavg()[0]
    for job, file, programs in JOBS:
        path = str(Path(page.corpus) / file)
        mesh = ricci.read(path)
        given = {"path": path, "V": mesh.V.copy(), "F": mesh.F.astype(np.int64), "rim": mesh.boundary[0] if mesh.boundary else None}
        best, found = measured(programs, given)
        for name, program in programs.items():
            lines = len(program.split("\n"))
            ratio = "" if name == "ricci" else f"{best[name] / best['ricci']:.2f}"
            told = figures(job, found[name], mesh.V, mesh.F)
            rows.append([job if name == "ricci" else "", file if name == "ricci" else "", name, lines, f"{1000 * best[name]:.1f}", ratio, told])
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in ("libigl", "potpourri3d", "trimesh", "xatlas"))
    print(f"""# Five common jobs in Python

Made by `docs/results/python.py` on {platform.machine()} with {os.cpu_count()} cores: the least of {ROUNDS} rounds in which the packages take turns, after
one that is not counted, with {versions}.
The load average of the minute before it began was {busy:.1f}. `lines` are those of the program, its imports included; `times ours` the seconds
over those of this package. All are given arrays of doubles and of 64-bit integers, but for the first job, which reads the file.

{page.table(["job", "mesh", "package", "lines", "ms", "times ours", "what comes out"], rows)}

The jobs are not the same throughout. The conformal map of libigl minimises an energy with two vertices fixed; ours has the curvature of a
flow inside and on the boundary, by a Newton method with flips, and is given on the faces of the mesh. An atlas of xatlas has many charts with little
distortion; ours is a conformal map with eight cones, cut into charts that do not overlap.""")


if __name__ == "__main__":
    sys.exit(main())
