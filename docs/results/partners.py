#!/usr/bin/env python3
"""Maps between surfaces whose partners are known, without landmarks and with eight, beside functional maps of pyFM, as tables.

usage: docs/results/partners.py [CORPUS [NAME…]] > docs/results/partners.md     (the names are those of first surfaces, and of deformed ones)
(after: cargo build --release -p ricci-apps, in a Python with: pip install numpy scipy pyfmaps)
"""
import contextlib
import importlib.metadata
import io
import os
import resource
import time

import numpy as np
from deformed import KINDS, NOISE, SWOLLEN, TURNED, deformed, renumbered
from page import corpus, main, named, read_obj, ricci, table, verdict, write_obj, write_rows
from pyFM.functional import FunctionalMapping
from pyFM.mesh import TriMesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

# Pairs of the corpus whose vertices of the same number correspond, and surfaces that are deformed.
GIVEN = [("pair_cat_A", "pair_cat_B"), ("human_man", "human_woman"),
         ("cortex_fsaverage5_pial_left", "cortex_fsaverage5_inflated_left"), ("cortex_fsaverage5_white_left", "cortex_fsaverage5_pial_left"),
         ("pair_face_reference", "pair_face_rage")]
SHAPES = ["spot_low", "hand_cgal", "cow_cgal", "dino"]
LANDMARKS = 8
# Vertices of which errors are measured, and the distances within which shares of them are counted.
MEASURED = 200
WITHIN = [0.01, 0.02, 0.05, 0.1, 0.2]
# Mean error from which a map is said to have failed: parts go to other parts.
FAILED = 0.1
METHODS = ["none", "auto", "eight", "pyFM", "pyFM, eight"]
SAID = {"none": "`--landmarks none`", "auto": "`--landmarks auto`", "eight": "eight landmarks", "pyFM": "pyFM", "pyFM, eight": "pyFM, eight landmarks"}


def graph(V, F):
    ends = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]])
    lengths = np.linalg.norm(V[ends[:, 0]] - V[ends[:, 1]], axis=1)
    # A side of two faces would be added up: it is kept once.
    ends, first = np.unique(np.sort(ends, 1), axis=0, return_index=True)
    return coo_matrix((lengths[first], ends.T), shape=(len(V), len(V))).tocsr()


def area(V, F):
    return np.linalg.norm(np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]), axis=1).sum() / 2


def farthest(sides, F, count):
    """Vertices inside a mesh, each farthest along edges from those before it."""
    edges = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), 1)
    kinds, times = np.unique(edges, axis=0, return_counts=True)
    is_inside = np.ones(sides.shape[0], bool)
    is_inside[kinds[times == 1].ravel()] = False
    found, least = [], np.where(is_inside, np.inf, -np.inf)
    while len(found) < count:
        found.append(int(least.argmax()))
        least = np.minimum(least, dijkstra(sides, False, found[-1]))
    return found


class Case:
    """Two surfaces and the partner of each vertex of the first."""

    def __init__(self, run, name, source, target, partner):
        self.name, self.run = name, run
        self.source, self.target, self.partner = source, target, partner
        self.paths = [write_obj(run.path(f"{side}.obj"), V.tolist(), F.tolist()) for side, (V, F) in (("source", source), ("target", target))]
        self.sides, self.unit = graph(*target), np.sqrt(area(*target))
        self.marks = farthest(graph(*source), source[1], LANDMARKS)

    def errors(self, faces, weights):
        """Distances along edges, at last in the face of the image, from the partners to the images, over the root of the area."""
        V, F = self.target
        measured = np.unique(np.linspace(0, len(self.partner) - 1, MEASURED).astype(int))
        corners = F[faces[measured]]
        images = np.einsum("kc,kcx->kx", weights[measured], V[corners])
        off = []
        for k, v in enumerate(measured):
            far = dijkstra(self.sides, False, self.partner[v])
            off.append(min(far[corners[k]] + np.linalg.norm(V[corners[k]] - images[k], axis=1)))
        return np.array(off) / self.unit

    def ours(self, landmarks):
        rows, = self.run.fresh("map.csv")
        if landmarks == "eight":
            pairs = [(v, int(self.partner[v])) for v in self.marks]
            landmarks = write_rows(self.run.path("landmarks.csv"), "source_vertex,target_vertex", pairs)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        report, why = self.run.try_report("match", *self.paths, "--map", rows, "--landmarks", landmarks, "--threads", "1", seconds=400)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if report is None:
            return {"why": why}
        found = np.loadtxt(rows, delimiter=",", skiprows=1)
        result = report["result"]
        return {"faces": found[:, 1].astype(int), "weights": found[:, 2:], "verdict": result["verdict"], "misfit": (result.get("search") or {}).get("kept"),
                "landmarks": result["landmarks"], "seconds": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}

    def functional(self, landmarks):
        """The map that pyFM finds by wave kernels, refined by ZoomOut: its first mesh is the one that points come to."""
        before = time.process_time()
        with contextlib.redirect_stdout(io.StringIO()):
            model = FunctionalMapping(*(TriMesh(V, F, area_normalize=True) for V, F in (self.target, self.source)))
            pairs = np.array([(self.partner[v], v) for v in self.marks]) if landmarks else None
            model.preprocess(n_descr=100, descr_type="WKS", landmarks=pairs, subsample_step=5, k_process=128)
            model.fit(K=(20, 20), w_orient=0.1)
            vertices = model.get_p2p(model.zoomout_refine(nit=20, step=5))
        face = np.zeros(len(self.target[0]), int)
        face[self.target[1].ravel()] = np.repeat(np.arange(len(self.target[1])), 3)
        faces = face[vertices]
        weights = (self.target[1][faces] == vertices[:, None]).astype(float)
        return {"faces": faces, "weights": weights, "verdict": "–", "landmarks": LANDMARKS if landmarks else 0, "seconds": time.process_time() - before}

    def row(self, method):
        made = self.functional(method != "pyFM") if method.startswith("pyFM") else self.ours(method)
        if "why" in made:
            return {"why": made["why"]}
        off = self.errors(made["faces"], made["weights"])
        misfit = (made.get("misfit") or {}).get("misfit")
        return {"mean": off.mean(), "median": float(np.median(off)), "most": off.max(), "within": [float((off <= r).mean()) for r in WITHIN], "verdict": made["verdict"],
                "landmarks": made["landmarks"], "seconds": made["seconds"], "misfit": misfit}


def surface(name):
    places, faces = read_obj(os.path.join(corpus, f"{name}.obj"))
    return np.array(places), np.array(faces)


def cases(run):
    """The pairs, each made when it is its turn."""
    for seed, (first, second) in enumerate(GIVEN):
        if named and first not in named:
            continue
        places, faces, new = renumbered(*surface(second), np.random.default_rng(seed))
        yield f"{first} → {second}", lambda name, s=surface(first), t=(places, faces), new=new: Case(run, name, s, t, new)
    for seed, shape in enumerate(SHAPES):
        if named and shape not in named:
            continue
        for kind in KINDS:
            V, F = surface(shape)
            yield f"{shape}, {kind}", lambda name, V=V, F=F, d=deformed(V, F, kind, 100 + seed): Case(run, name, (V, F), d[:2], d[2])


def measured(run):
    found = {}
    for name, make in cases(run):
        case = None
        for method in METHODS:
            def row(name=name, method=method):
                nonlocal case
                case = case or make(name)
                return case.row(method)
            found[name, method] = run.keep(f"{name}: {method}", row)
    return found


def content(run):
    found = measured(run)
    names = list(dict.fromkeys(name for name, _ in found))
    rows, curves = [], []
    for name in names:
        cells = []
        for method in METHODS:
            r = found[name, method]
            cells += ["–", "–"] if "why" in r else [f"{r['median']:.4f}, {r['mean']:.4f}", f"{r['seconds']:.1f}"]
        auto = found[name, "auto"]
        rows.append([name, auto.get("verdict", "–"), auto.get("landmarks", "–"), "–" if auto.get("misfit") is None else f"{auto['misfit']:.3f}", *cells])
        run.bad += [f"{name}, {SAID[method]}: {found[name, method]['why']}" for method in METHODS if "why" in found[name, method]]
    for part, kept in (("of the corpus", [n for n in names if "→" in n]), ("deformed", [n for n in names if "→" not in n])):
        for method in METHODS:
            all_of = [found[n, method] for n in kept if "why" not in found[n, method]]
            if not all_of:
                continue
            failed = [n for n in kept if "why" in found[n, method] or found[n, method]["mean"] > FAILED]
            shares = np.mean([r["within"] for r in all_of], 0)
            curves.append([part, SAID[method], len(all_of), f"{np.median([r['median'] for r in all_of]):.4f}", f"{np.median([r['mean'] for r in all_of]):.4f}",
                           *(f"{share:.3f}" for share in shares), len(failed), ", ".join(failed) or "–"])
    head = ["pair", "verdict of auto", "landmarks", "misfit"] + [cell for method in METHODS for cell in (f"{SAID[method]}: median, mean", "s")]
    return [
        "# Maps of surfaces with known partners",
        f"Made by `docs/results/partners.py` with `{os.path.basename(ricci)} match` on one thread, beside functional maps of pyFM (`pyfmaps` "
        f"{importlib.metadata.version('pyfmaps')} on PyPI: wave kernels, 20 functions, orientation, ZoomOut to 120). *Error*: distance along the target's edges from the partner of a "
        f"vertex to its image, over the root of the target's area, of {MEASURED} vertices of the source. Targets have other numbers of vertices than their sources, so that nothing is "
        f"to be learned from them. *Eight landmarks*: vertices, each farthest from those before it, with their partners. *s*: seconds of the processor.",
        verdict(run.bad, "Every map was found."),
        "## Shares within a distance",
        f"Means over the pairs of the share of vertices whose error is at most 0.01, …; medians over the pairs of their median and mean errors. *failed*: pairs whose mean error is above {FAILED}, "
        "since parts of the surface go to other parts.",
        table(["pairs", "method", "number", "median error", "mean error", *(f"≤ {r}" for r in WITHIN), "failed", "which"], curves),
        "## Pairs",
        f"Four surfaces of the corpus are deformed in five ways (`docs/results/deformed.py`): *bent* and *twisted* by {np.degrees(TURNED):.0f}° from end to end, *noisy* along normals by "
        f"{NOISE} of an edge, *swollen*, one end {SWOLLEN} times the size of the other, and *remeshed*, half of the sides cut at random.",
        table(head, rows),
    ]


main(content)
