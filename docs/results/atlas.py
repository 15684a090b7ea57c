#!/usr/bin/env python3
"""Texture atlases of every mesh that has a face, beside those of xatlas, as a table.

usage: docs/results/atlas.py CORPUS ROWS.json [most faces [NAME…]] > docs/results/atlas.md
(after: cargo build --release -p ricci-apps, in a Python with: pip install numpy xatlas)

ROWS.json keeps what has been measured, so that a run that was ended goes on where it was. All figures are those that this file finds in the
written numbers: no code of either program is asked. The environment variable RICCI names another binary of the command.
"""
import csv
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

# Seconds after which either program is ended.
LONGEST = 120
# A face whose area is less than this share of its longest side squared has no directions to stretch.
THINNEST = 1e-9


def wavefront(path):
    """Positions, faces, texture coordinates of the corners."""
    V, T, F, G = [], [], [], []
    for word in (line.split() for line in Path(path).read_text(errors="replace").splitlines()):
        if word and word[0] == "v":
            V.append([float(x) for x in word[1:4]])
        elif word and word[0] == "vt":
            T.append([float(x) for x in word[1:3]])
        elif word and word[0] == "f":
            corners = [corner.split("/") for corner in word[1:4]]
            F.append([int(c[0]) - 1 for c in corners])
            G.append([int(c[1]) - 1 for c in corners])
    return np.array(V), np.array(F), np.array(T)[np.array(G)]


def seams(V, F, uv):
    """The length of the edges along which the faces have other coordinates: once for each pair of coordinates beyond those that n faces in
    an edge need at least, half of n."""
    _, place = np.unique(V, axis=0, return_inverse=True)
    place = place.ravel()
    a, b = place[F].ravel(), place[np.roll(F, -1, axis=1)].ravel()
    p, q = uv.reshape(-1, 2), np.roll(uv, -1, axis=1).reshape(-1, 2)
    ahead = (a < b)[:, None]
    ends = np.stack([np.minimum(a, b), np.maximum(a, b)], 1)
    sides = np.concatenate([np.where(ahead, p, q), np.where(ahead, q, p)], 1)
    length = np.linalg.norm(V[F].reshape(-1, 3) - V[np.roll(F, -1, axis=1)].reshape(-1, 3), axis=1)
    _, edge, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    edge = edge.ravel()
    _, first = np.unique(np.concatenate([edge[:, None], np.round(sides * 2**22)], 1), axis=0, return_index=True)
    places = np.bincount(edge[first], minlength=len(count))
    lengths = np.zeros(len(count))
    lengths[edge] = length
    return float((lengths * np.maximum(places - (count + 1) // 2, 0)).sum())


def exceeded(values, weight):
    """The value that is exceeded on a hundredth of the weight."""
    order = np.argsort(values)
    reached = np.searchsorted(np.cumsum(weight[order]), 0.99 * weight.sum())
    return float(values[order][min(reached, len(order) - 1)])


def figures(V, F, uv):
    """Stretch, angles, areas, seams and fill; none of a model without area."""
    V = np.asarray(V, float)
    p, q = V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]]
    doubled = np.linalg.norm(np.cross(p, q), axis=1)
    longest = np.max([np.linalg.norm(side, axis=1) for side in (p, q, q - p)], axis=0)
    good = 0.5 * doubled > THINNEST * longest**2
    F, uv, p, q, doubled = F[good], np.asarray(uv, float)[good], p[good], q[good], doubled[good]
    length = np.linalg.norm(p, axis=1)
    first = (uv[:, 1] - uv[:, 0]) / length[:, None]
    second = (uv[:, 2] - uv[:, 0] - first * ((p * q).sum(1) / length)[:, None]) / (doubled / length)[:, None]
    e, g, mixed = (first**2).sum(1), (second**2).sum(1), (first * second).sum(1)
    det = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    s = np.sqrt((e + g) / 2 + np.hypot((e - g) / 2, mixed))
    t = np.maximum(det / s, 1e-300)
    area = doubled.sum() / 2
    scale = np.sqrt((doubled * det).sum() / 2 / area)
    s, t, weight = s / scale, t / scale, doubled / doubled.sum()
    grown = np.log(s * t)
    angle = 2 * np.degrees(np.arctan((s - t) / (s + t)))
    stretch = np.maximum(s, 1 / t)
    return {
        "l2": float(np.sqrt((weight * (s**-2 + t**-2) / 2).sum())),
        "linf": float(stretch.max()),
        "stretch_99": exceeded(stretch, weight),
        "angle": float((weight * angle).sum()),
        "angle_99": exceeded(angle, weight),
        "sigma": float(np.sqrt((weight * (grown - (weight * grown).sum()) ** 2).sum())),
        "seam": seams(V, F, uv) / float(np.sqrt(area)),
        "fill": float((doubled * det).sum() / 2),
    }


def ours(path, folder):
    """The command's row: figures of the file that it writes, and what its report says of folds, overlaps and faces without a place."""
    command = os.environ.get("RICCI", "target/release/ricci")
    out, report = Path(folder) / "atlas.obj", Path(folder) / "report.json"
    begun = time.time()
    words = [command, "atlas", path, "-o", out, "--report", report, "--quiet"]
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return {"error": f"not done in {LONGEST} s"}
    if done.returncode > 1:
        return {"error": (done.stderr.strip().splitlines() or [f"exit {done.returncode}"])[-1].replace(str(path), path.name)}
    seconds, said = time.time() - begun, json.loads(report.read_text())["result"]
    checks = json.loads(report.read_text())["checks"]
    V, F, uv = wavefront(out)
    row = figures(V, F, uv) | {"faces": len(F), "seconds": seconds, "charts": said["charts"]}
    return row | {
        "folded": checks["folded_faces"]["value"],
        "overlapping": checks["overlapping_faces"]["value"],
        "placeless": len(said["placeless_faces"]),
        "turned": len(said["turned_faces"]),
    }


def theirs(model):
    """The row of xatlas on the model of an OBJ file, in this process; to be run in one of its own."""
    import xatlas

    V, F, _ = wavefront(model)
    begun = time.time()
    atlas = xatlas.Atlas()
    atlas.add_mesh(V.astype(np.float32), F.astype(np.uint32))
    options = xatlas.PackOptions()
    options.bruteForce, options.resolution, options.padding = True, 1024, 2
    atlas.generate(xatlas.ChartOptions(), options)
    seconds = time.time() - begun
    origin, corners, uv = atlas[0]
    return figures(V, origin[corners], uv[corners]) | {"faces": len(corners), "charts": atlas.chart_count, "seconds": seconds}


def row(path, known, folder):
    """The row of a mesh, with what is known of it already."""
    if "ricci" not in known:
        known["ricci"] = ours(path, folder)
    if "xatlas" not in known and "error" not in known["ricci"]:
        words = [sys.executable, __file__, "--xatlas", Path(folder) / "atlas.obj"]
        try:
            done = subprocess.run(words, capture_output=True, text=True, timeout=LONGEST, check=False)
            known["xatlas"] = json.loads(done.stdout) if done.returncode == 0 else {"error": f"exit {done.returncode}"}
        except subprocess.TimeoutExpired:
            known["xatlas"] = {"error": f"not done in {LONGEST} s"}
    return known


def cells(known):
    a, b = known.get("ricci", {}), known.get("xatlas", {})
    if "error" in a:
        return [a["error"]] + [""] * 9
    pair = lambda key, form: f"{a[key]:{form}} | " + (f"{b[key]:{form}}" if key in b else "–")
    return [
        str(a["faces"]),
        pair("charts", "d"),
        pair("l2", ".3f"),
        f"{a['linf']:.3g}",
        f"{a['stretch_99']:.3f}",
        pair("angle", ".1f"),
        f"{a['angle_99']:.0f}",
        pair("sigma", ".3f"),
        pair("seam", ".2f"),
        pair("fill", ".3f"),
        pair("seconds", ".1f"),
    ]


def say(rows, left_out):
    names = ["mesh", "faces", "charts", "x", "L2", "x", "L∞", "99 %", "angle", "x", "angle 99 %", "σ", "x", "seam", "x", "fill", "x", "s", "x"]
    done = {name: r for name, r in rows.items() if "error" not in r["ricci"]}
    both = [r for r in done.values() if "error" not in r.get("xatlas", {"error": ""})]
    share = lambda test: f"{sum(map(test, both))} of {len(both)}"
    print("# Texture atlases: `ricci atlas` beside xatlas\n")
    print("By `docs/results/atlas.py`: page of 1024 texels, margin 2, defaults; xatlas (`bruteForce`, resolution 1024, padding 2) on the file")
    print("that the command wrote, its columns are those headed x. Figures are computed from the written coordinates, seconds include reading and")
    print("writing for the command alone, on a machine that other work shared. `fill` of xatlas is that of its own page, which is neither square nor a power of")
    print("two. L2, L∞: stretch [SSGH01]; 99 %: the stretch that a hundredth of the area exceeds; angle: mean and 99 %, degrees;")
    print("σ: standard deviation of the logarithm of areas; seam: length over the root of the area.\n")
    clean = [n for n, r in done.items() if not r["ricci"]["folded"] and not r["ricci"]["overlapping"]]
    fills = [r["ricci"]["fill"] for r in done.values()]
    print(f"- {len(done)} of {len(rows)} models have an atlas; {len(clean)} of these without a folded or overlapping face (exact).")
    for name in sorted(set(done) - set(clean)):
        r = done[name]["ricci"]
        print(f"  - {name}: {r['folded']:.0f} folded, {r['overlapping']:.0f} overlapping of {r['faces']} faces")
    print(f"- Fill: median {statistics.median(fills):.3f}, least {min(fills):.3f}; better than xatlas on {share(lambda r: r['ricci']['fill'] > r['xatlas']['fill'])}.")
    print(f"- Seams at most half as long as those of xatlas on {share(lambda r: r['ricci']['seam'] <= 0.5 * r['xatlas']['seam'])}, shorter on {share(lambda r: r['ricci']['seam'] <= r['xatlas']['seam'])}.")
    print(f"- σ of log area at most that of xatlas on {share(lambda r: r['ricci']['sigma'] <= r['xatlas']['sigma'])}.")
    print(f"- Seconds at most those of xatlas on {share(lambda r: r['ricci']['seconds'] <= r['xatlas']['seconds'])}.")
    print(f"- 99 % of the area within the bound 1.3 of the stretch (and 2 % for the scales of charts) on {sum(r['ricci']['stretch_99'] <= 1.326 for r in done.values())} of {len(done)}.")
    placeless = {n: r["ricci"]["placeless"] for n, r in done.items() if r["ricci"]["placeless"]}
    print(f"- Faces without a place (two corners in one place, or not finite): {placeless or 'none'}.")
    alone = [n for n, r in done.items() if "error" in r.get("xatlas", {"error": ""})]
    print(f"- Without xatlas beside it: {len(alone)} models.")
    if left_out:
        print(f"- Left out for time: {', '.join(left_out)}.")
    print("\n| " + " | ".join(names) + " |\n|" + "---|" * len(names))
    for name, known in rows.items():
        print(f"| {name} | " + " | ".join(cells(known)) + " |")


def main():
    if sys.argv[1] == "--xatlas":
        print(json.dumps(theirs(sys.argv[2])))
        return
    corpus, kept, most, only = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]), sys.argv[4:]
    rows, left_out = json.loads(kept.read_text()) if kept.exists() else {}, []
    order = {}
    for part in ("bad", "good"):
        for entry in csv.DictReader((corpus / part / "INDEX.csv").read_text().splitlines()):
            order[entry["file"]] = (corpus / part / entry["file"], int(entry["F"] or 0))
    with tempfile.TemporaryDirectory() as folder:
        for name, (path, n) in sorted(order.items(), key=lambda entry: entry[1][1]):
            if only and path.stem not in only:
                continue
            if n > most:
                left_out.append(name)
                continue
            rows[name] = row(path, rows.get(name, {}), folder)
            kept.write_text(json.dumps(rows, indent=0))
    say({name: rows[name] for name in order if name in rows and "ricci" in rows[name]}, left_out)


if __name__ == "__main__":
    main()
