#!/usr/bin/env python3
"""Maps between the pairs of the corpus, with and without landmarks, of every mesh to itself, and times, as tables.

usage: docs/results/matching.py [CORPUS [NAME…]] > docs/results/matching.md     (after: cargo build --release -p ricci-apps)

Of the names two are of sections: figure12, cortices.
"""
import heapq
import math
import os
import statistics

from page import (corpus, divided, failures, file_of, judged, main, meshes, named, read_obj, rim, small, table, verdict, verdict_of_outside,
                  write_rows)

# Pairs whose vertices correspond by number, and others.
SAME = [("pair_cat_A", "pair_cat_B"), ("human_man", "human_woman"), ("pair_face_reference", "pair_face_rage"),
        ("cortex_fsaverage5_pial_left", "cortex_fsaverage5_pial_right"), ("cortex_fsaverage5_pial_left", "cortex_fsaverage5_inflated_left"),
        ("cortex_fsaverage5_white_left", "cortex_fsaverage5_pial_left")]
OTHER = [("pair_cat_A", "pair_lion_A"), ("pair_faust_002", "pair_faust_085"), ("pair_hand_plain", "pair_hand_vulcan"), ("femur_01", "femur_02"),
         ("face_bff", "face_libigl"), ("pair_mac_smooth", "pair_mac_blocky"), ("eight_766", "eight_3498"), ("genus3", "pretzel"), ("bob", "kitten_10k"),
         ("spot_low", "cow_cgal"), ("homer", "human_man")]
# Numbers of landmarks; auto: they are found by the shapes of the surfaces.
LANDMARKS = ["auto", 0, 4, 8, 16]
FIGURE_12 = """The case of [JKLLG08, Fig. 12]: every loop becomes a round hole of a flat torus (`--loop-shape circles`), and beside it a geodesic of a hyperbolic metric,
which is the default. *roundness*: largest distance of a vertex of a loop, of either surface, from the circle of the loop, over the radius. A hole bends
away from the surface around it, so that faces may fold beside it: the weights of the map are changed there, and where that does not open all of them, it is an error. Which
loops correspond is open, since their lengths differ by less than 5 %: of six orders that with the least energy is taken, and classes are
counted over all.
"""
REMESHED = """A surface and another mesh of it, by `cargo test --test library another_mesh -- --nocapture`: a ball that is no ball, from geodesic
frequencies 4, 8 and 16 to 24, with five landmarks that are vertices of all. Distances of vertices from where they should be, over the diagonal, and by which factor they fall.

| frequency | largest | falls by | largest away from landmarks | falls by | mean | falls by |
|---|---|---|---|---|---|---|
| 4 | 6.4e-03 | – | 4.5e-03 | – | 2.2e-03 | – |
| 8 | 2.1e-03 | 2.99 | 1.3e-03 | 3.52 | 5.9e-04 | 3.80 |
| 16 | 7.7e-04 | 2.76 | 3.5e-04 | 3.65 | 1.4e-04 | 4.13 |

The mean falls as h². The largest distance lies at landmarks and falls as h^{3/2}, which is by 2.83: there the canonical metric has a cone of angle π, about which the conformal
map is like a root of the distance, and faces with straight sides follow that no better. *Away from landmarks* is farther than 0.5 from all of them, with a size of the ball of about 2.
"""
REASONS = """Why these do not hold:

- ember_520644: triangles of down to 0.014° are flipped 34,014 times on the way to the sphere. Drawn there with its own straight edges the surface folds in 83 of its
  7,834 faces, and putting vertices around them at the means of their neighbours does not open them.
- maze: a long way folded into a disk. In its flat metric edges at the end of the way have length 0 to the range of f64.
"""
# Largest mesh that is matched to itself, and the seconds that one run may take: of a pair, of a mesh and itself.
LARGEST = 30000
PATIENCE = 300
OWN_PATIENCE = 100


def farthest(path, n):
    """Vertices inside a mesh, each farthest along edges from those before it."""
    places, faces = read_obj(path)
    beside, border = [{} for _ in places], rim(faces)
    for f in faces:
        for a, b in zip(f, f[1:] + f[:1]):
            beside[a][b] = beside[b][a] = math.dist(places[a], places[b])
    inside = [v for v in range(len(places)) if v not in border]
    found, far, start = [], [math.inf] * len(places), inside[0]
    while len(found) < n:
        found.append(start)
        far[start], heap = 0.0, [(0.0, start)]
        while heap:
            d, v = heapq.heappop(heap)
            for u, length in beside[v].items() if d <= far[v] else ():
                if d + length < far[u]:
                    far[u] = d + length
                    heapq.heappush(heap, (far[u], u))
        start = max(inside, key=far.__getitem__)
    return found


def matched(run, name, paths, landmarks=(), same=False, seconds=None, overlay=False, more=()):
    """Report and what the outside program says of the map, or two times None: then it is told why. The answer is kept under the name."""
    report, why, seen = run.keep(name, lambda: answer(run, paths, landmarks, same, seconds, overlay, more))
    run.bad += [f"{name}: {why}"] if report is None else failures(name, report)
    return report, seen


def answer(run, paths, landmarks, same, seconds, overlay, more):
    rows, over = run.fresh("map.csv", "overlay.obj")
    asked = ["match", *paths, "--map", rows, *more]
    if landmarks == "auto":
        asked += ["--landmarks", "auto"]
    elif not landmarks:
        asked += ["--landmarks", "none"]
    else:
        pairs = write_rows(run.path("landmarks.csv"), "source_vertex,target_vertex", [(v, v) for v in landmarks])
        asked += ["--landmarks", pairs]
    asked += ["--same-numbering"] if same else []
    asked += ["--overlay", over] if overlay else []
    report, why = run.try_report(*asked, seconds=seconds)
    return report, why, None if report is None else judged("map_", rows, *paths)


def row(name, report, seen, *more):
    r = report["result"]
    outside = "–" if seen is None else f"{'all' if seen['covered'] else 'not all'}, {small(seen['weights_off'])}, {seen['faces_oriented']:.4f}"
    return [name, *more, r["space"], r["flipped_triangles"], small(r["landmark_error"]), f"{r['qc_mean']:.3f}", small(r["qc_max"]),
            f"{r['area_log']:.3f}", small(r["cycle_mean"]), r["markings"], outside, f"{report['seconds']['total']:.1f}"]


HEAD = ["space", "flipped", "landmarks off", "K mean", "K max", "area", "there and back", "classes", "outside: covered, weights, oriented", "s"]


def known_pairs(pairs):
    """The pairs of which the corpus has both meshes, with their files."""
    known = {mesh["name"]: mesh for mesh in meshes()}
    return [(pair, [file_of(known[name]) for name in pair]) for pair in pairs if all(name in known for name in pair)]


def pairs(run):
    rows, partners = [], {n: [] for n in LANDMARKS}
    for pair, paths in known_pairs(SAME + OTHER):
        same, name = pair in SAME, " → ".join(pair)
        vertices = farthest(paths[0], max(LANDMARKS[1:])) if same else []
        for n in LANDMARKS if same else LANDMARKS[:2]:
            title, far = f"{name}, {n} landmarks", "–"
            report, seen = matched(run, title, paths, n if n == "auto" else vertices[:n], same, PATIENCE)
            if report is None:
                continue
            run.insist(not seen or seen["covered"] and seen["weights_off"] < 1e-12, f"{title}, outside: {seen}")
            if same:
                partners[n].append(report["result"]["partner_mean"])
                far = f"{report['result']['partner_mean']:.4f}, {report['result']['partner_max']:.4f}"
            r = report["result"]
            n = f"auto: {r['landmarks']}" if n == "auto" else n
            rows.append(row(name, report, seen, n, far))
    medians = [[n, len(partners[n]), f"{statistics.median(partners[n]):.4f}"] for n in LANDMARKS if partners[n]]
    return table(["pair", "landmarks", "partners: mean, max", *HEAD], rows), medians


def itself(run, mesh):
    path, name = file_of(mesh), f"{mesh['name']} to itself"
    report, _ = matched(run, name, [path, path], (), True, OWN_PATIENCE)
    if report is None:
        return None
    off = report["result"]["partner_max"]
    run.insist(off <= 1e-8, f"{name}: a vertex is {off:.1e} away from itself")
    return [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"], report["result"]["space"], small(off),
            small(report["result"]["balance_residual"]), report["result"]["flipped_triangles"], f"{report['seconds']['total']:.1f}"]


def overlay(run, known):
    """Source and target laid over each other."""
    pair, paths = known
    name = " over ".join(pair)
    report, _ = matched(run, name, paths, (), False, PATIENCE, True)
    if report is None:
        return None
    r = report["result"]
    if "overlay_faces" not in r:
        run.bad.append(f"{name}: {r['failed']['overlay'] if 'failed' in r else 'no overlay'}")
        return None
    counts = [report["input"]["faces"], report["input"]["target"]["faces"], r["overlay_faces"], r["overlay_crossings"]]
    return [", ".join(pair), *counts, *map(small, r["overlay_uncovered"]), f"{report['seconds']['total']:.1f}"]


def figure_12(run):
    """Two surfaces of genus 1 with three boundary loops."""
    rows, names = [], ("thin", "thick")
    shapes = [run.make(f"{name}.obj", "torus", "--big", "1", "--small", low, "--holes", "3") for name, low in zip(names, ("0.3", "0.6"))]
    for first, second in ((0, 1), (1, 0)):
        for shape in ("circles", "geodesics"):
            name = f"{names[first]} torus → {names[second]} torus"
            report, seen = matched(run, f"{name}, {shape}", [shapes[first], shapes[second]], more=["--loop-shape", shape])
            if report is not None:
                circles = report["result"].get("circles")
                round_ = small(max(circle["deviation"] for circle in circles)) if circles else "–"
                rows.append(row(name, report, seen, shape, round_))
    return table(["pair", "loops", "roundness", *HEAD], rows)


def speed(run):
    rows = []
    paths = [os.path.join(corpus, f"cortex_fsaverage5_pial_{side}.obj") for side in ("left", "right")]
    for times in (0, 2):
        both = [divided(path, run.path("fine_" + os.path.basename(path)), times) for path in paths] if times else paths
        for n in (0, 8):
            report, _ = matched(run, f"hemispheres, {times} divisions, {n} landmarks", both, farthest(paths[0], n), False, 1200)
            if report is not None:
                rows.append([report["input"]["vertices"], n, f"{report['seconds']['total']:.1f}", f"{report['seconds']['solve']:.1f}",
                             f"{(report['peak_bytes'] or 0) / 2**20:.0f}", report["result"]["flipped_triangles"]])
    return table(["V each", "landmarks", "s", "s, matching alone", "MiB at most", "flipped"], rows)


def content(run):
    all_pairs, medians = pairs(run)
    own = run.rows(meshes(lambda m: int(m["V"]) <= LARGEST), itself)
    over = run.rows(known_pairs(SAME[:3] + OTHER), overlay)
    holes = figure_12(run) if not named or "figure12" in named else ""
    times = speed(run) if not named or "cortices" in named else ""
    return [
        "# Surface matching",
        "Made by `docs/results/matching.py`: `ricci match` with default options. Times are those of one run each, on two cores that were shared with other "
        "work at the same time: they say little.",
        verdict(run.bad),
        REASONS,
        verdict_of_outside(""),
        "## Pairs",
        "*landmarks*: vertices of the same number, each farthest along edges from those before it. *partners*: distance of a vertex's image from the vertex of the same "
        "number, over the diagonal of the target's box. *flipped*: faces of either surface that are not counterclockwise in the domain. *landmarks off*: "
        "of a landmark's image from its partner, over that diagonal. *K*: quasi-conformal dilatation from face to image in space, by area. *area*: mean by area of |ln| of a face's share of the area of the image over its share of its own surface. *there and back*: mean distance of a vertex from where the map and its inverse bring "
        "it. *classes*: ways to mark the map whose energies were compared. *outside*: check.py on the map: whether it covers the source, weights off, share of faces that keep "
        "their side in space.",
        all_pairs,
        medians and "Median over the pairs with the same numbering of the mean distance to the partner:",
        medians and table(["landmarks", "pairs", "median"], medians),
        "## Every mesh to itself",
        f"Connected meshes of up to {LARGEST} vertices. *farthest from itself*: largest distance of a vertex from its image, over the diagonal. *off the means*: of a vertex from the "
        "mean of its neighbours, over their mean distance.",
        table(["mesh", "V", "genus", "loops", "space", "farthest from itself", "off the means", "flipped", "s"], own),
        "## Another mesh of the same surface",
        REMESHED,
        "## Overlays",
        "Source and target laid over each other in the domain, without landmarks: every face of the overlay is a part of one face of either. *missed*: share of the area of a "
        "surface that its parts miss.",
        table(["source, target", "F", "F of the target", "F of the overlay", "crossings", "source missed", "target missed", "s"], over),
        holes and "## Genus 1 with three boundary loops",
        holes and FIGURE_12,
        holes,
        times and "## Two hemispheres of the cortex",
        times and "As they are, and with every triangle cut into four twice.",
        times,
    ]


main(content)
