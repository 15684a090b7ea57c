#!/usr/bin/env python3
"""What the command writes for people's own meshes: faces that fold with --on input, without and with --repair.

usage: docs/results/input.py [CORPUS [NAME…]] > docs/results/input.md     (after: cargo build --release -p ricci-apps)
"""
import concurrent.futures
import os
import sys
import tempfile

from page import build, file_of, launch, main, meshes, small, table

# The longest run on the corpus takes a minute with a development build.
SECONDS = 400
WORKERS = int(os.environ.get("RICCI_WORKERS", "2"))


def folded_in(path):
    """The number of faces of an OBJ file, and how many of them do not run counterclockwise in its texture coordinates."""
    places, faces, folded = [], 0, 0
    for word in (line.split() for line in open(path)):
        if word and word[0] == "vt":
            places.append((float(word[1]), float(word[2])))
        elif word and word[0] == "f":
            (ax, ay), (bx, by), (cx, cy) = (places[int(corner.split("/")[1]) - 1] for corner in word[1:])
            faces += 1
            folded += (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) <= 0
    return faces, folded


def work(mesh):
    """A flow onto the input's own faces with folds repaired: exit code, figures, and what the file says."""
    print(mesh["name"], file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        uv = os.path.join(folder, "uv.obj")
        options = "--on", "input", "--repair", "--threads", "1"
        code, report, said = launch(folder, "flow", file_of(mesh), "--uv", uv, *options, seconds=SECONDS)
        if report is None or "error" in report["result"] or not os.path.exists(uv):
            failed = (report or {"result": {}})["result"].get("failed", {}).get("uv")
            return mesh, {"said": failed or said or "no file", "code": code}
        faces, folded = folded_in(uv)
        return mesh, {**report["result"], "code": code, "faces": faces, "folded": folded, "seconds": report["seconds"]["total"]}


def row(mesh, found):
    if "said" in found:
        return [mesh["name"], mesh["F"], found["said"], *[""] * 6]
    return [mesh["name"], mesh["F"], found["flipped_input_faces"], found["folded"], found["split_edges"], found["added_vertices"],
            found["code"], f"{found['qc_mean']:.3f}, {small(found['qc_max'])}", f"{found['seconds']:.2f}"]


def folds(found):
    """The lines about faces that fold."""
    done = [(m, x) for m, x in found if "said" not in x]
    before, after = ([x[key] for _, x in done] for key in ("flipped_input_faces", "folded"))
    share = sum(x["added_vertices"] for _, x in done) / max(1, sum(int(m["V"]) for m, _ in done))
    wrong = [m["name"] for m, x in done if x["folded"] != x["flipped_triangles"] or (x["folded"] > 0) > (x["code"] == 1)]
    head = ["mesh", "faces", "folded", "folded with --repair", "edges split", "points added", "exit", "dilatation mean, max", "s"]
    return [
        "## Folded faces with --on input",
        "`ricci flow MESH --uv OUT.obj --on input --repair`, default target, on every connected mesh of the corpus "
        f"({len(found)}). Folded: faces of the input that do not run counterclockwise in the layout where the map is made linear on them, "
        "as the report counts them; without `--repair` these are in the file. Folded with `--repair`: those of the written file, counted from "
        "its texture coordinates by this script. Points are added on edges of the input, so the surface stays as it is. "
        "Edges are split and never flipped: a flip replaces two triangles of the input by two others, which lie elsewhere in space wherever "
        "the surface bends between them.",
        f"Without `--repair`, {sum(n == 0 for n in before)} of {len(found)} meshes have no folded face, and {sum(before)} faces fold in all. "
        f"With it, {sum(n == 0 for n in after)} of {len(found)} have none, and {sum(after)} faces fold; {100 * share:.2f} % of the vertices "
        "are added. " + ("Every report counts the faces that fold in its file." if not wrong else "Reports that differ from their file: " +
                         ", ".join(wrong) + "."),
        f"Exit 1: the check `flipped_triangles` fails, or another one. Times are those of one run of {build} on a shared machine and say little.",
        table(head, [row(*x) for x in found]),
    ]


# Measured once by hand.
OVERLAP = """## Time of the measure of overlap

The share of a layout that lies on other parts of it (`overlap` in the report), as a part of all samples of `perf record -F 1999 --call-graph dwarf` over `ricci flow MESH --uv OUT.obj --report R.json --threads 1`, of a development build: samples in which a function of the measure is being called. They are few: ten of them tell a share to a third of itself, fewer less well.

| mesh | faces | samples in it | of all | share |
|---|---|---|---|---|
| spot_low | 1654 | 1 | 79 | 1 % |
| flatmesh_5b | 3646 | 3 | 107 | 3 % |
| skull_low | 10312 | 10 | 307 | 3 % |
| lion_head | 16674 | 5 | 218 | 2 % |
| kitten_10k | 20000 | 5 | 220 | 2 % |"""


def content(run):
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        found = list(pool.map(work, meshes()))
    return ["# What is written for an input", *folds(found), OVERLAP]


main(content)
