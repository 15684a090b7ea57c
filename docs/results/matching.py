#!/usr/bin/env python3
"""Maps between the pairs of the corpus, with and without landmarks, of every mesh to itself, and times, as tables.

usage: docs/results/matching.py [CORPUS [NAME…]] > docs/results/matching.md     (after: cargo build --release -p ricci-apps)

Of the names two are of sections: figure12, cortices. RICCI_ROWS names a file that keeps what is finished, a line per run of the command: an interrupted
run goes on from there. RICCI_CHECK names the program that judges the files from outside (by default ../shared/tools/check.py beside the repository).
"""
import heapq
import json
import math
import os
import statistics
import tempfile

from page import WHY, corpus, failures, file_of, judged, make, meshes, named, run, small, table, verdict

# Pairs whose vertices correspond by number, and others.
SAME = [("pair_cat_A", "pair_cat_B"), ("human_man", "human_woman"), ("pair_face_reference", "pair_face_rage"),
        ("cortex_fsaverage5_pial_left", "cortex_fsaverage5_pial_right"), ("cortex_fsaverage5_pial_left", "cortex_fsaverage5_inflated_left"),
        ("cortex_fsaverage5_white_left", "cortex_fsaverage5_pial_left")]
OTHER = [("pair_cat_A", "pair_lion_A"), ("pair_faust_002", "pair_faust_085"), ("pair_hand_plain", "pair_hand_vulcan"), ("femur_01", "femur_02"),
         ("face_bff", "face_libigl"), ("pair_mac_smooth", "pair_mac_blocky"), ("eight_766", "eight_3498"), ("genus3", "pretzel"), ("bob", "kitten_10k"),
         ("spot_low", "cow_cgal"), ("homer", "human_man")]
LANDMARKS = [0, 4, 8, 16]
FIGURE_12 = """The case of [JKLLG08, Fig. 12]: every loop becomes a round hole of a flat torus (`--loop-shape circles`), and beside it a geodesic of a hyperbolic metric,
which is the default. *roundness*: largest distance of a vertex of a loop, of either surface, from the circle of the loop, over the radius. A hole bends
away from the surface around it, so that faces may fold beside it: the weights of the map are changed there, and where that does not open all of them, it is an error. Which
loops correspond is open, since their lengths differ by less than 5 %: of six orders that with the least energy is taken, and classes are
counted over all.
"""
REMESHED = """A surface and another mesh of it, by `cargo test --test matching another_mesh -- --nocapture`: a ball that is no ball, from geodesic
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


def read(path):
    places, faces = [], []
    for word in (line.split() for line in open(path)):
        if word and word[0] == "v":
            places.append([float(x) for x in word[1:4]])
        elif word and word[0] == "f":
            faces.append([int(corner.split("/")[0]) - 1 for corner in word[1:4]])
    return places, faces


def farthest(path, n):
    """Vertices inside a mesh, each farthest along edges from those before it."""
    places, faces = read(path)
    beside, sides = [{} for _ in places], set()
    for f in faces:
        for a, b in zip(f, f[1:] + f[:1]):
            beside[a][b] = beside[b][a] = math.dist(places[a], places[b])
            sides.add((a, b))
    rim = {v for a, b in sides if (b, a) not in sides for v in (a, b)}
    found, far = [], [math.inf] * len(places)
    start = min(v for v in range(len(places)) if v not in rim)
    while len(found) < n:
        found.append(start)
        far[start], heap = 0.0, [(0.0, start)]
        while heap:
            d, v = heapq.heappop(heap)
            for u, length in beside[v].items() if d <= far[v] else ():
                if d + length < far[u]:
                    far[u] = d + length
                    heapq.heappush(heap, (far[u], u))
        start = max((v for v in range(len(places)) if v not in rim), key=far.__getitem__)
    return found


def divided(path, folder, times):
    """A mesh with every triangle cut into four, so often."""
    places, faces = read(path)
    for _ in range(times):
        middle, finer = {}, []
        def between(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(places)
                places.append([(x + y) / 2 for x, y in zip(places[a], places[b])])
            return middle[key]
        for a, b, c in faces:
            ab, bc, ca = between(a, b), between(b, c), between(c, a)
            finer += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        faces = finer
    out = os.path.join(folder, "fine_" + os.path.basename(path))
    with open(out, "w") as file:
        file.writelines("v {!r} {!r} {!r}\n".format(*p) for p in places)
        file.writelines("f {} {} {}\n".format(*(v + 1 for v in f)) for f in faces)
    return out


KNOWN = {}


def matched(folder, name, paths, landmarks=(), same=False, seconds=None, overlay=False, more=()):
    """Report, or none and why; and what the outside program says of the map. `name` says of what: under it the answer is kept."""
    kept = os.environ.get("RICCI_ROWS")
    if kept and not KNOWN and os.path.exists(kept):
        KNOWN.update((key, answer) for key, answer in map(json.loads, open(kept)))
    if name not in KNOWN:
        KNOWN[name] = answer(folder, paths, landmarks, same, seconds, overlay, more)
        if kept:
            with open(kept, "a") as file:
                file.write(json.dumps([name, KNOWN[name]]) + "\n")
    return KNOWN[name]


def answer(folder, paths, landmarks, same, seconds, overlay, more):
    rows, places = os.path.join(folder, "map.csv"), os.path.join(folder, "landmarks.csv")
    asked = ["match", *paths, "--map", rows, *more]
    if landmarks:
        with open(places, "w") as file:
            file.write("source_vertex,target_vertex\n")
            file.writelines(f"{v},{v}\n" for v in landmarks)
        asked += ["--landmarks", places]
    asked += ["--same-numbering"] if same else []
    asked += ["--overlay", os.path.join(folder, "overlay.obj")] if overlay else []
    report, why = run(folder, *asked, seconds=seconds)
    if report is None or "error" in report["result"]:
        return None, why if report is None else report["result"]["error"]["message"], None
    return report, why, judged("map_", rows, *paths)


def row(name, report, seen, *more):
    r = report["result"]
    outside = "–" if seen is None else f"{'all' if seen['covered'] else 'not all'}, {small(seen['weights_off'])}, {seen['faces_oriented']:.4f}"
    return [name, *more, r["space"], str(r["flipped_triangles"]), small(r["landmark_error"]), f"{r['qc_mean']:.3f}", small(r["qc_max"]),
            f"{r['area_log']:.3f}", small(r["cycle_mean"]), str(r["markings"]), outside, f"{report['seconds']['total']:.1f}"]


HEAD = ["space", "flipped", "landmarks off", "K mean", "K max", "area", "there and back", "classes", "outside: covered, weights, oriented", "s"]


def pairs(folder):
    known = {mesh["name"]: mesh for mesh in meshes(lambda m: True)}
    rows, partners, bad = [], {n: [] for n in LANDMARKS}, []
    for first, second in SAME + OTHER:
        if first not in known or second not in known:
            continue
        paths, same = [file_of(known[name]) for name in (first, second)], (first, second) in SAME
        vertices = farthest(paths[0], max(LANDMARKS)) if same else []
        for n in LANDMARKS if same else LANDMARKS[:1]:
            name = f"{first} → {second}"
            report, why, seen = matched(folder, f"{name}, {n}", paths, vertices[:n], same, PATIENCE)
            if report is None:
                bad.append(f"{name}, {n} landmarks: {why}")
                continue
            bad += failures(f"{name}, {n} landmarks", report)
            if seen and not (seen["covered"] and seen["weights_off"] < 1e-12):
                bad.append(f"{name}, {n} landmarks, outside: {seen}")
            far = "–"
            if same:
                partners[n].append(report["result"]["partner_mean"])
                far = f"{report['result']['partner_mean']:.4f}, {report['result']['partner_max']:.4f}"
            rows.append(row(name, report, seen, str(n), far))
    medians = [[str(n), str(len(partners[n])), f"{statistics.median(partners[n]):.4f}"] for n in LANDMARKS if partners[n]]
    return table(["pair", "landmarks", "partners: mean, max", *HEAD], rows), medians, bad


def selves(folder):
    rows, bad = [], []
    for mesh in meshes(lambda m: int(m["V"]) <= LARGEST):
        path = file_of(mesh)
        report, why, seen = matched(folder, f"{mesh['name']} to itself", [path, path], (), True, OWN_PATIENCE)
        if report is None:
            bad.append(f"{mesh['name']} to itself: {why}")
            continue
        bad += failures(f"{mesh['name']} to itself", report)
        off = report["result"]["partner_max"]
        if off > 1e-8:
            bad.append(f"{mesh['name']} to itself: a vertex is {off:.1e} away from itself")
        rows.append([mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"], report["result"]["space"], small(off),
                     small(report["result"]["balance_residual"]), str(report["result"]["flipped_triangles"]), f"{report['seconds']['total']:.1f}"])
    return table(["mesh", "V", "genus", "loops", "space", "farthest from itself", "off the means", "flipped", "s"], rows), bad


def overlays(folder):
    """Source and target laid over each other."""
    known = {mesh["name"]: mesh for mesh in meshes(lambda m: True)}
    rows, bad = [], []
    for first, second in SAME[:3] + OTHER:
        if first not in known or second not in known:
            continue
        paths, name = [file_of(known[n]) for n in (first, second)], f"{first} over {second}"
        report, why, _ = matched(folder, name, paths, (), False, PATIENCE, True)
        if report is None:
            bad.append(f"{name}: {why}")
            continue
        bad += failures(name, report)
        r = report["result"]
        if "overlay_faces" not in r:
            bad.append(f"{name}: {r['failed']['overlay'] if 'failed' in r else 'no overlay'}")
            continue
        counts = [str(report["input"]["faces"]), str(report["input"]["target"]["faces"]), str(r["overlay_faces"]), str(r["overlay_crossings"])]
        rows.append([f"{first}, {second}", *counts, *map(small, r["overlay_uncovered"]), f"{report['seconds']['total']:.1f}"])
    return table(["source, target", "F", "F of the target", "F of the overlay", "crossings", "source missed", "target missed", "s"], rows), bad


def figure_12(folder):
    """Two surfaces of genus 1 with three boundary loops."""
    rows, bad = [], []
    shapes = [make(folder, f"{name}.obj", "torus", "--big", big, "--small", low, "--holes", "3") for name, big, low in
              (("thin", "1", "0.3"), ("thick", "1", "0.6"))]
    for first, second in ((0, 1), (1, 0)):
        for shape in ("circles", "geodesics"):
            report, why, seen = matched(folder, f"figure 12, {first}, {shape}", [shapes[first], shapes[second]], more=["--loop-shape", shape])
            if report is None:
                bad.append(f"tori with holes, {shape}: {why}")
                continue
            bad += failures(f"tori with holes, {shape}", report)
            circles = report["result"].get("circles")
            round_ = small(max(circle["deviation"] for circle in circles)) if circles else "–"
            names = ("thin", "thick")
            rows.append(row(f"{names[first]} torus → {names[second]} torus", report, seen, shape, round_))
    return table(["pair", "loops", "roundness", *HEAD], rows), bad


def speed(folder):
    rows, bad = [], []
    names = ["cortex_fsaverage5_pial_left", "cortex_fsaverage5_pial_right"]
    paths = [os.path.join(corpus, f"{name}.obj") for name in names]
    for times in (0, 2):
        both = [divided(path, folder, times) for path in paths] if times else paths
        for n in (0, 8):
            report, why, _ = matched(folder, f"hemispheres, {times} divisions, {n}", both, farthest(paths[0], n), False, 1200)
            if report is None:
                bad.append(f"hemispheres, {times} divisions, {n} landmarks: {why}")
                continue
            bad += failures("hemispheres", report)
            rows.append([str(report["input"]["vertices"]), str(n), f"{report['seconds']['total']:.1f}", f"{report['seconds']['solve']:.1f}",
                         f"{(report['peak_bytes'] or 0) / 2**20:.0f}", str(report["result"]["flipped_triangles"])])
    return table(["V each", "landmarks", "s", "s, matching alone", "MiB at most", "flipped"], rows), bad


def main():
    with tempfile.TemporaryDirectory() as folder:
        all_pairs, medians, bad = pairs(folder)
        own, more = selves(folder)
        over, fifth = overlays(folder)
        holes, third = figure_12(folder) if not named or "figure12" in named else ("", [])
        times, fourth = speed(folder) if not named or "cortices" in named else ("", [])
    print("# Surface matching\n")
    print("Made by `docs/results/matching.py`: `ricci match` with default options. Times are those of one run each, on two cores that were shared with other "
          "work at the same time: they say little.\n")
    print(verdict(bad + more + third + fourth + fifth) + "\n")
    print(REASONS)
    if WHY:
        print(f"No independent program has judged the files: {WHY}.\n")
    print("## Pairs\n")
    print("*landmarks*: vertices of the same number, each farthest along edges from those before it. *partners*: distance of a vertex's image from the vertex of the same "
          "number, over the diagonal of the target's box. *flipped*: faces of either surface that are not counterclockwise in the domain. *landmarks off*: "
          "of a landmark's image from its partner, over that diagonal. *K*: quasi-conformal dilatation from face to image in space, by area. *area*: mean by area of |ln| of a face's share of the area of the image over its share of its own surface. *there and back*: mean distance of a vertex from where the map and its inverse bring "
          "it. *classes*: ways to mark the map whose energies were compared. *outside*: check.py on the map: whether it covers the source, weights off, share of faces that keep "
          "their side in space.\n")
    print(all_pairs)
    if medians:
        print("\nMedian over the pairs with the same numbering of the mean distance to the partner:\n")
        print(table(["landmarks", "pairs", "median"], medians))
    print("\n## Every mesh to itself\n")
    print(f"Connected meshes of up to {LARGEST} vertices. *farthest from itself*: largest distance of a vertex from its image, over the diagonal. *off the means*: of a vertex from the "
          "mean of its neighbours, over their mean distance.\n")
    print(own)
    print("\n## Another mesh of the same surface\n")
    print(REMESHED)
    print("## Overlays\n")
    print("Source and target laid over each other in the domain, without landmarks: every face of the overlay is a part of one face of either. *missed*: share of the area of a "
          "surface that its parts miss.\n")
    print(over)
    if holes:
        print("\n## Genus 1 with three boundary loops\n")
        print(FIGURE_12)
        print(holes)
    if times:
        print("\n## Two hemispheres of the cortex\n")
        print("As they are, and with every triangle cut into four twice.\n")
        print(times)


main()
