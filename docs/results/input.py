#!/usr/bin/env python3
"""What the command writes for people's own meshes: faces that fold with --on input, without and with --repair.

usage: docs/results/input.py [CORPUS [NAME…]] > docs/results/input.md     (after: cargo build --release -p ricci-apps)
"""
import concurrent.futures
import os
import sys
import tempfile

from page import file_of, launch, main, meshes, table

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


def flown(folder, mesh, *options):
    """A flow onto the input's own faces: exit code, figures, seconds, and what the file says."""
    uv = os.path.join(folder, "uv.obj")
    if os.path.exists(uv):
        os.remove(uv)
    code, report, said = launch(folder, "flow", file_of(mesh), "--uv", uv, "--on", "input", "--threads", "1", *options, seconds=SECONDS)
    if report is None or "error" in report["result"] or not os.path.exists(uv):
        failed = (report or {"result": {}})["result"].get("failed", {}).get("uv")
        return {"said": failed or said or "no file", "code": code}
    faces, folded = folded_in(uv)
    return {"code": code, "faces": faces, "folded": folded, "seconds": report["seconds"]["total"], **report["result"]}


def work(mesh):
    print(mesh["name"], file=sys.stderr)
    with tempfile.TemporaryDirectory() as folder:
        return mesh, flown(folder, mesh), flown(folder, mesh, "--repair")


def row(mesh, before, after):
    if "said" in before or "said" in after:
        return [mesh["name"], mesh["F"], before.get("said") or after.get("said"), *[""] * 6]
    return [mesh["name"], before["faces"], before["folded"], before["code"], after["split_edges"], after["added_vertices"],
            after["folded"], after["code"], f"{before['seconds']:.2f}", f"{after['seconds']:.2f}"]


def folds(found):
    """The lines about faces that fold."""
    done = [(m, b, a) for m, b, a in found if "said" not in b and "said" not in a]
    none = [sum(x["folded"] == 0 for x in side) for side in ([b for _, b, _ in done], [a for _, _, a in done])]
    total = [sum(x["folded"] for x in side) for side in ([b for _, b, _ in done], [a for _, _, a in done])]
    share = sum(a["added_vertices"] for _, _, a in done) / max(1, sum(int(m["V"]) for m, _, _ in done))
    wrong = [m["name"] for m, b, a in done if any(x["folded"] != x["flipped_triangles"] for x in (b, a))]
    said = "every run" if not wrong else "all but " + ", ".join(wrong)
    head = ["mesh", "faces", "folded", "exit", "edges split", "points added", "folded after", "exit after", "s", "s with --repair"]
    return [
        "## Folded faces with --on input",
        "`ricci flow MESH --uv OUT.obj --on input`, default target, without and with `--repair`, on every connected mesh of the corpus "
        f"({len(found)}). Folded: faces of the written file that do not run counterclockwise in its texture coordinates, counted from the "
        "file by this script. Edges split, points added: what `--repair` has done; points lie on the input's edges, so the surface stays.",
        f"Without `--repair`, {none[0]} of {len(found)} meshes have no folded face, and {total[0]} faces fold in all. With it, {none[1]} of "
        f"{len(found)} have none, and {total[1]} faces fold; {100 * share:.2f} % of the vertices are added. In {said} the report counts the "
        "faces that the file has. Exit 1: the check `flipped_triangles` fails, or the flow did not converge. Times are those of one run "
        "on a shared machine and say little.",
        table(head, [row(*x) for x in found]),
    ]


def content(run):
    with concurrent.futures.ThreadPoolExecutor(WORKERS) as pool:
        found = list(pool.map(work, meshes()))
    return ["# What is written for an input", *folds(found)]


main(content)
