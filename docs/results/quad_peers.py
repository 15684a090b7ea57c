#!/usr/bin/env python3
"""Quad meshes of every mesh by `ricci quads` and by the packages of other programs, all judged by one reader of the files, in one run.

usage: python docs/results/quad_peers.py [CORPUS [NAME…]] > docs/results/quad_peers.md
(after: cargo build --release -p ricci-apps, in a Python with: pip install numpy scipy pyQuadriFlow pyinstantmeshes pynanoinstantmeshes)

A program of another package runs in a process of its own, which this file starts with `--call`, so that a crash is a line of the table.
"""

import importlib.metadata
import json
import os
import platform
import resource
import signal
import statistics
import subprocess
import sys
import time

import numpy as np
import page
from page import CAD, small, table
from quad_reader import NEAR, SHARP, arrays, judged

# So many faces are asked for, and so many seconds a run may take.
FACES = 1000
LONGEST = 60
OURS = "ricci"
DASH = small(None)
# Those programs whose meshes are to be of quads alone, and the one that leaves other faces.
PURE = [OURS, "QuadriFlow", "Instant Meshes", "Instant Meshes (nano)"]
DOMINANT = "Instant Meshes, dominant"
PROGRAMS = [*PURE, DOMINANT]
PACKAGES = ["pyQuadriFlow", "pyinstantmeshes", "pynanoinstantmeshes"]
# What is measured: the key, its title, how it is written.
MEASURES = [
    ("irregular", "irregular", str),
    ("angle", "angles: mean", lambda x: f"{x:.1f}"),
    ("angle_most", "angles: most", lambda x: f"{x:.0f}"),
    ("edges", "edges", lambda x: f"{x:.2f}"),
    ("distance", "distance: rms", small),
    ("distance_most", "distance: most", small),
    ("seconds", "s", lambda x: f"{x:.2f}"),
    ("busy", "s of processor", lambda x: f"{x:.2f}"),
]


# The programs of other packages, in a process of their own.


def quadriflow(path, out, wanted):
    """QuadriFlow, given lists."""
    from pyQuadriFlow.pyQuadriFlow import pyquadriflow

    V, F = (given.tolist() for given in arrays(path))
    start, busy = time.perf_counter(), time.process_time()
    found = pyquadriflow(wanted["faces"], 0, V, F, wanted["sharp"], wanted["open"], False, False, False)
    taken = time.perf_counter() - start, time.process_time() - busy
    write_faces(out, found["vertices"], found["faces"])
    return taken


def instant(path, out, wanted):
    """Instant Meshes by pyinstantmeshes, from file to file: its arrays are those of triangles."""
    from pyinstantmeshes import remesh_file

    pure = not wanted["dominant"]
    start, busy = time.perf_counter(), time.process_time()
    remesh_file(
        path,
        out,
        target_face_count=wanted["faces"] // 4 if pure else wanted["faces"],
        crease_angle=SHARP if wanted["sharp"] else -1.0,
        extrinsic=True,
        align_to_boundaries=wanted["open"],
        smooth_iterations=2,
        pure_quad=pure,
        deterministic=True,
    )
    return time.perf_counter() - start, time.process_time() - busy


def nano(path, out, wanted):
    """Instant Meshes by pynanoinstantmeshes, which always makes quads alone."""
    from pynanoinstantmeshes import remesh

    V, F = arrays(path)
    V, F = V.astype(np.float32), F.astype(np.uint32)
    start, busy = time.perf_counter(), time.process_time()
    V, F = remesh(
        V,
        F,
        -1,
        face_count=wanted["faces"] // 4,
        creaseAngle=SHARP if wanted["sharp"] else -1.0,
        align_to_boundaries=wanted["open"],
        extrinsic=True,
        smooth_iter=2,
        deterministic=True,
    )
    taken = time.perf_counter() - start, time.process_time() - busy
    write_faces(out, V.tolist(), F.tolist())
    return taken


CALLS = {"QuadriFlow": quadriflow, "Instant Meshes": instant, DOMINANT: instant, "Instant Meshes (nano)": nano}


def write_faces(path, places, faces):
    """Write an OBJ file of faces with any number of corners."""
    with open(path, "w") as file:
        file.writelines("v {!r} {!r} {!r}\n".format(*p) for p in places)
        file.writelines("f " + " ".join(str(v + 1) for v in f) + "\n" for f in faces)


def call(program, path, out, wanted):
    """Run one program, and write beside its mesh what it took or why it refused."""
    try:
        seconds, busy = CALLS[program](path, out, json.loads(wanted))
        said = {"seconds": seconds, "busy": busy}
    except Exception as why:
        said = {"error": f"{type(why).__name__}: {why}"}
    with open(out + ".json", "w") as file:
        json.dump(said, file)


# Runs.


def ours(run, mesh, out, wanted):
    """The command: the whole process, with reading and writing."""
    sharp = ["--features", str(SHARP)] if wanted["sharp"] else []
    start, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    code, report, said = page.launch(
        run.folder, "quads", page.file_of(mesh), "-o", out, "--faces", str(wanted["faces"]), *sharp, seconds=LONGEST
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if report is None:
        return {"error": said if code is None else f"crashed: exit code {code}"}
    if "error" in report["result"]:
        return {"error": "refused: " + report["result"]["error"]["message"]}
    run.bad += page.failures(mesh["name"], report)
    return {"seconds": time.perf_counter() - start, "busy": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime}


def theirs(program, mesh, out, wanted):
    """A program of another package: the call alone."""
    command = [sys.executable, os.path.abspath(__file__), "--call", program, page.file_of(mesh), out, json.dumps(wanted)]
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return {"error": f"stopped after {LONGEST} s"}
    if done.returncode < 0:
        return {"error": f"crashed: {signal.Signals(-done.returncode).name}"}
    if not os.path.exists(out + ".json"):
        last = (done.stdout.strip().splitlines() or [""])[-1]
        return {"error": f"crashed: exit code {done.returncode}, “{last[:60]}”"}
    with open(out + ".json") as file:
        said = json.load(file)
    return {"error": "refused: " + said["error"].replace("|", "/")[:80]} if "error" in said else said


def measured(run, mesh, program, sharp):
    """All that is known of one run."""
    out, _ = run.fresh("quads.obj", "quads.obj.json")
    wanted = {"faces": FACES, "sharp": sharp, "open": page.loops(mesh) > 0, "dominant": program == DOMINANT}
    found = ours(run, mesh, out, wanted) if program == OURS else theirs(program, mesh, out, wanted)
    if "error" not in found:
        found |= judged(out, mesh, sharp)
    if program == OURS:
        run.insist(valid(found), f"{mesh['name']}{', sharp edges kept' if sharp else ''}: {fault(mesh, found)}")
    return found


# The page.


def sound(found):
    """Whether there is a mesh, a manifold of the topology of the input."""
    return "error" not in found and found["manifold"] and found["topology"]


def valid(found):
    """Whether it is sound and of quads alone."""
    return sound(found) and found["pure"]


def fit(program, found):
    """What is asked of a program's mesh before it is compared."""
    return sound(found) if program == DOMINANT else valid(found)


def fault(mesh, found):
    """What a mesh is not."""
    if "error" in found:
        return found["error"]
    asked = [("parts", 1), ("loops", page.loops(mesh)), ("euler", page.euler(mesh))]
    lacks = [] if found["manifold"] else ["not manifold"]
    lacks += [f"{'χ' if key == 'euler' else key} {found[key]}, not {value}" for key, value in asked if found[key] != value]
    if not found["pure"]:
        lacks.append("not quads alone" if found["quads"] < 1 else "a face with a corner twice")
    return "; ".join(lacks) or "valid"


def cells(mesh, program, found, more=()):
    """A row of the long tables; the mesh is named once."""
    name = [mesh["name"], mesh["V"], mesh["genus"], mesh["boundary_loops"]] if program == OURS else [""] * 4
    if "error" in found:
        return [*name, program, fault(mesh, found)] + [DASH] * (2 + len(MEASURES) + len(more))
    values = [write(found[key]) for key, _, write in MEASURES]
    return [
        *name,
        program,
        fault(mesh, found),
        found["faces"],
        f"{100 * found['quads']:.1f}",
        *values,
        *(write(found[key]) for key, write in more),
    ]


def counts(results):
    """How many meshes of each program are what they should be."""
    rows = []
    for program in PROGRAMS:
        found = [known[program] for _, known in results]
        made = [f for f in found if "error" not in f]
        ended = [sum(f.get("error", "").startswith(word) for f in found) for word in ("crashed", "stopped", "refused")]
        sides = [[sound(known[program]) for mesh, known in results if (page.loops(mesh) > 0) == rim] for rim in (False, True)]
        rows.append(
            [program, len(found), *ended, len(made), sum(f["pure"] for f in made), sum(f["manifold"] for f in made)]
            + [*(f"{sum(side)} of {len(side)}" for side in sides), sum(map(valid, found))]
        )
    head = ["program", "runs", "crashed", "stopped", "refused", "meshes", "quads alone", "manifold"]
    return table([*head, "… and same topology: closed", "… with boundary", "valid"], rows)


def medians(results):
    """Medians over the meshes of which all programs of quads alone have a valid mesh; the dominant one over those that are sound."""
    every = [known for _, known in results if all(valid(known[program]) for program in PURE)]
    rows = []
    for program in PROGRAMS:
        found = [known[program] for known in every if fit(program, known[program])]
        middle = [statistics.median(f[key] for f in found) if found else None for key in ("faces", *(key for key, _, _ in MEASURES))]
        written = [f"{middle[0]:.0f}" if found else DASH]
        written += [
            DASH if x is None else f"{x:.0f}" if write is str else write(x) for x, (_, _, write) in zip(middle[1:], MEASURES, strict=True)
        ]
        rows.append([program, len(found), *written])
    return len(every), table(["program", "meshes", "faces", *(title for _, title, _ in MEASURES)], rows)


def ratios(results):
    """For each other program and measure, over the meshes where it and we are fit: the ratios to ours."""
    known = {}
    for program in PROGRAMS[1:]:
        pairs = [(found[program], found[OURS]) for _, found in results if valid(found[OURS]) and fit(program, found[program])]
        known[program] = (
            len(pairs),
            {key: ([a[key] / b[key] for a, b in pairs if b[key] > 0], sum(a[key] < b[key] for a, b in pairs)) for key, _, _ in MEASURES},
        )
    return known


def ratio_table(known):
    """The medians of ratios, and on how many meshes the other program has less."""
    rows = []
    for program, (n, measures) in known.items():
        said = [f"{statistics.median(values):.2f} ({lower})" if values else DASH for values, lower in measures.values()]
        rows.append([program, n, *said])
    return table(["program", "meshes", *(title for _, title, _ in MEASURES)], rows)


def told(results, known):
    """Where the others are better, and where they are not, in words."""
    lines = []
    for program, (n, measures) in known.items():
        middle = [(statistics.median(measures[key][0]), title) for key, title, _ in MEASURES if measures[key][0]]
        better = ", ".join(f"{title} ({x:.2f})" for x, title in middle if x < 0.995) or "nothing"
        worse = ", ".join(f"{title} ({x:.2f})" for x, title in middle if x > 1.005) or "nothing"
        made = sum(fit(program, found[program]) for _, found in results)
        but = " but for faces that are no quads" if program == DOMINANT else ""
        lines.append(f"- **{program}**: valid{but} on {made} of {len(results)}. On {n} with ours: better in {better}; worse in {worse}.")
    return "\n".join(lines)


def features(results):
    """The share of sharp edges that each program keeps."""
    rows = []
    results = [(mesh, known) for mesh, known in results if any(f.get("kept") for f in known.values())]
    for program in PROGRAMS:
        made = [known[program]["kept"] for _, known in results if "error" not in known[program]]
        both = [known for _, known in results if all(fit(p, known[p]) for p in (program, OURS))]
        pairs = [(known[program]["kept"][0], known[OURS]["kept"][0]) for known in both]
        middle = [f"{statistics.median(shares):.3f}, {min(shares):.3f}" for shares in zip(*made, strict=True)]
        more = f"{sum(a > b for a, b in pairs)}, {sum(a < b for a, b in pairs)}"
        rows.append([program, len(results), len(made), *middle, *([DASH] * 2 if program == OURS else [len(pairs), more])])
    near = [f"kept within {share:g}: median, least" for share in NEAR]
    return table(["program", "meshes with sharp edges", "meshes made", *near, "both valid", "keeps more, less than ours"], rows)


LONG = ["mesh", "V", "genus", "loops", "program", "what it is", "faces", "quads, %", *(title for _, title, _ in MEASURES)]


def gathered(run, every, sharp):
    """The results of all programs, mesh by mesh."""

    def one(mesh, program):
        return run.keep([mesh["name"], program, sharp], lambda: measured(run, mesh, program, sharp))

    return [(mesh, {program: one(mesh, program) for program in PROGRAMS}) for mesh in every]


def content(run):
    """The blocks of the page."""
    busy, every = run.keep(["load"], lambda: os.getloadavg()[0]), page.meshes()
    plain = gathered(run, every, False)
    edged = gathered(run, [mesh for mesh in every if mesh["name"] in CAD], True)
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in PACKAGES)
    shared, middle = medians(plain)
    known, edges = ratios(plain), ratios(edged)
    head = f"""# Quad meshes beside other programs

Made by `docs/results/quad_peers.py` with {page.build}: about {FACES} quads of every mesh of one component, by `ricci quads` and, in the
same run, by packages of two other programs, {versions} (PyPI; Debian has neither). One reader judges the files."""
    summary = f"""## Summary

{counts(plain)}

Medians over the {shared} meshes of which all programs of quads alone have a valid mesh; of *{DOMINANT}* over those of them where its mesh
is valid but for faces that are no quads:

{middle}

Medians of the ratios to ours, over the meshes where that program's mesh and ours are valid; in brackets the number of meshes on which the
other has less. Less is better throughout:

{ratio_table(known)}

By these medians:

{told(plain, known)}"""
    how = f"""## Programs and measures

On {platform.machine()} with {os.cpu_count()} cores, which other work shared: the load average of the minute before it began was {busy:.1f}.
A run may take {LONGEST} s.

- **ricci**: `ricci quads MESH --faces {FACES}`, with `--features {SHARP}` where sharp edges are kept. Threads: one per core.
- **QuadriFlow** by pyQuadriFlow: `pyquadriflow({FACES}, 0, V, F, preserve_sharp, preserve_boundary, False, False, False)`, the boundary
  preserved where there is one. Its sharp edges are those of more than 60°, which is no option. One thread.
- **Instant Meshes** by pyinstantmeshes, with the defaults of that program's own command: `pure_quad=True, extrinsic=True`,
  `smooth_iterations=2`; `align_to_boundaries` where there is a boundary, `crease_angle={SHARP}` where sharp edges are kept and none
  otherwise, and `deterministic=True`. Quads alone come of cutting each face of a mixed mesh at its middle, so {FACES // 4} faces are asked
  for. `remesh` returns triangles even then, so it is `remesh_file`. Threads: one per core.
- **{DOMINANT}**: the same with `pure_quad=False` and {FACES} faces, which are quads, triangles and some larger ones.
- **Instant Meshes (nano)** by pynanoinstantmeshes: the same program and options. It knows quads alone, so {FACES // 4} faces are asked for.

*valid*: quads alone, a manifold of one part whose faces are all turned one way, with the loops and the Euler characteristic of the input.
*irregular*: vertices inside without four edges, and vertices of the boundary without two faces, so that corners of one quad or of three
count. *angles*: deviation of the corners of quads from 90°, degrees. *edges*: deviation of their lengths over the mean. *distance*: of the
input's vertices from the faces, over the diagonal; a face is the triangles about its middle. *s*: of one run; of `ricci` the whole process
with reading and writing, of the others the call alone, without the start of Python. *s of processor*: summed over threads; beside other
work it says more."""
    sharp = f"""## Sharp edges

The {len(edged)} meshes of flat and round faces, sharp edges of {SHARP}° kept:

{counts(edged)}

*kept*: share of the length of the input's edges that turn by more than {SHARP}° which lies within {NEAR[0]:g}, and within {NEAR[1]:g}, of
the diagonal of edges of the faces, over the meshes that have such edges. Edges of the faces are straight, so that a round sharp edge leaves
them by more than that where they are long; those of {FACES} squares on a cube have {(2 / FACES) ** 0.5:.3f} of its diagonal.

{features(edged)}

Medians of the ratios to ours:

{ratio_table(edges)}

By these medians:

{told(edged, edges)}"""
    kept = [("kept", lambda shares: ", ".join(f"{x:.3f}" for x in shares) if shares else DASH)]
    return [
        head,
        page.verdict(run.bad, "Every mesh of ours is valid, and all checks of its report hold."),
        summary,
        how,
        sharp,
        "## Sharp edges, mesh by mesh",
        table([*LONG, "kept"], [cells(mesh, program, found, kept) for mesh, known in edged for program, found in known.items()]),
        "## Every mesh",
        table(LONG, [cells(mesh, program, found) for mesh, known in plain for program, found in known.items()]),
    ]


if __name__ == "__main__":
    if sys.argv[1:2] == ["--call"]:
        call(*sys.argv[2:])
    else:
        page.main(content)
